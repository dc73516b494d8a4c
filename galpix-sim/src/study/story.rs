//! A run as a page shows it: its film, its certificate, its frames.

use crate::certificate::FrameBound;
use crate::engine::Scheme;
use crate::output::film::{self, Colours};
use crate::output::html::{CertificateLine, Heat, Row, Story};
use crate::output::measures::Measured;
use crate::picture::Picture;
use crate::study::run::{FrameReport, RunReport, Shown};
use crate::{metric, update::Truth};

/// A film's frame is shown for this long.
const FRAME_MS: u16 = 120;

/// A film may be this large before its colours are counted.
const FILM_BYTES: usize = 1_000_000;

/// A picture of a film is at most so wide, in pixels; larger ones are reduced.
const PANEL: usize = 400;

/// A film has at most so many pictures.
const LONGEST: usize = 128;

/// The film of a run while it is made.
#[derive(Default)]
pub struct Film {
    /// Another scheme, and its pictures of the same frames.
    other: Option<(Scheme, Vec<Picture>)>,
    /// With a truth, and without one: a film has the first where there are any.
    compared: Vec<Picture>,
    alone: Vec<Picture>,
    /// The last frame with a truth, and what was shown.
    last: Option<(Truth, Picture)>,
    reduced: usize,
    /// Whether there were more pictures than it has.
    cut: bool,
}

impl Film {
    /// Makes a film that shows another scheme too.
    #[must_use]
    pub fn beside(scheme: Scheme, pictures: Vec<Picture>) -> Self {
        Self { other: Some((scheme, pictures)), ..Self::default() }
    }

    /// Looks at the next frame.
    pub fn see(&mut self, shown: &Shown<'_>) {
        self.reduced = shown.picture.width.div_ceil(PANEL).max(1);
        let other = self
            .other
            .as_ref()
            .and_then(|(scheme, pictures)| Some((pictures.get(shown.frame as usize)?, scheme.name())));
        let difference = shown.truth.map(|truth| film::difference(shown.picture, &truth.picture));
        let panels = [
            shown.truth.map(|truth| (&truth.picture, "truth")),
            Some((shown.hold, "sample-and-hold")),
            Some((shown.picture, "galpix")),
            other,
            difference.as_ref().map(|difference| (difference, "difference x4")),
        ];
        let panel = |(picture, label)| film::labelled(&film::reduced(picture, self.reduced), label);
        let panels: Vec<Picture> = panels.into_iter().flatten().map(panel).collect();
        let sheet = film::side_by_side(&panels.iter().collect::<Vec<_>>(), 4);
        let pictures = if shown.truth.is_some() { &mut self.compared } else { &mut self.alone };
        self.cut |= pictures.len() == LONGEST;
        if pictures.len() < LONGEST {
            pictures.push(sheet);
        }
        if let Some(truth) = shown.truth {
            self.last = Some((truth.clone(), shown.picture.clone()));
        }
    }

    /// Returns the story of the run, with remarks of its own after others.
    #[must_use]
    pub fn story(self, about: &str, run: &RunReport, mut notes: Vec<String>) -> Story {
        if run.loaded.saturated > 0 {
            notes.push(format!("{} fields of the update were clamped to their range.", run.loaded.saturated));
        }
        // The update alone is no film of what was compared: its truth is itself.
        let pictures = if self.compared.len() > 1 { &self.compared } else { &self.alone };
        if self.reduced > 1 {
            notes
                .push(format!("In the film {0}\u{00D7}{0} pixels are one, in the figures they are not.", self.reduced));
        }
        if self.cut {
            notes.push(format!("The film ends after {LONGEST} pictures, the figures do not."));
        }
        let film_apng = match film::apng_within(pictures, FRAME_MS, FILM_BYTES) {
            Ok((film, colours)) => {
                if matches!(colours, Colours::Palette) {
                    notes.push("The film above has 256 colours; every figure comes from the full ones.".to_owned());
                }
                film
            }
            Err(error) => {
                notes.push(format!("There is no film: {error}."));
                Vec::new()
            }
        };
        Story {
            name: run.source.clone(),
            about: about.to_owned(),
            width: run.width,
            height: run.height,
            budget_line: budget_line(run),
            rounding: run.rounding.to_owned(),
            fill: run.fill.to_owned(),
            certificate: Some(certificate(run)),
            film_apng,
            heat: self.last.filter(|_| run.perceptual()).and_then(|(truth, shown)| heat(&truth, &shown)),
            rows: run.frames.iter().map(row).collect(),
            notes,
        }
    }
}

/// Returns where the error of a frame is seen.
fn heat(truth: &Truth, shown: &Picture) -> Option<Heat> {
    let picture = metric::flip_map(shown, &truth.picture, truth.mask.as_deref())?;
    Some(Heat { frame: truth.frame, picture })
}

fn certificate(run: &RunReport) -> CertificateLine {
    CertificateLine {
        quantisation_px: run.certificate.quantisation_px,
        drift_px: run.certificate.drift_px,
        total_px: run.certificate.total_px,
        holds: run.certificate.keeps_one_pixel(),
        prop: run.budget.prop,
        per_frame_px: std::iter::once(0.0).chain(run.certificate.frames.iter().map(FrameBound::total_px)).collect(),
    }
}

fn budget_line(run: &RunReport) -> String {
    let budget = &run.budget;
    format!(
        "D = {} px, tau_recog = {}, tau_prop = {}: velocity {}+{}, acceleration {}+{}, position +{} bits; {} bytes a galpixel",
        budget.extent,
        budget.recog,
        budget.prop,
        budget.velocity_int_bits,
        budget.velocity_frac_bits,
        budget.acceleration_int_bits,
        budget.acceleration_frac_bits,
        budget.position_frac_bits,
        budget.stored_bytes_per_galpixel
    )
}

fn row(frame: &FrameReport) -> Row {
    let truth = frame.truth.as_ref();
    Row {
        frame: frame.frame,
        flip: truth.and_then(|truth| truth.flip),
        measures: frame.measures(),
        psnr_hold_db: truth.and_then(|truth| truth.psnr_hold_db),
        psnr_known_db: truth.and_then(|truth| truth.psnr_known_db),
        position_error_px: frame.position.map(|position| position.worst_px),
        mean_position_error_px: frame.position.map(|position| position.mean_px),
        truth_error_px: frame.position.and_then(|position| position.truth_worst_px),
        holes: frame.holes.into(),
        filled: frame.filled.into(),
        lost: frame.lost.into(),
        collided: frame.collided.into(),
        saturated: frame.saturated.into(),
        bullets: frame.bullets.into(),
        unobscured: (frame.debris + frame.galdebris).into(),
        ns_per_galpixel: Some(frame.ns_per_galpixel),
    }
}
