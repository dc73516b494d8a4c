//! The error of one configuration: galpixel by galpixel, and as pictures.

use galpix_core::{Bits, Dynamic, Layout, Settings};

use super::design::Configuration;
use super::float;
use super::frames::{FrameError, Summary};
use super::ranges::Stored;
use super::reference::{Compared, Reference, displacement};
use crate::engine::{Engine, EngineError, LoadTally};
use crate::metric::measures::Measures;
use crate::picture::Picture;
use crate::study::run::{Comparison, Seen, TruthReport};

/// What a configuration gave.
pub struct Measured {
    /// What entered.
    pub loaded: LoadTally,
    /// Fields clamped in all frames.
    pub saturated: u64,
    /// The frames that were looked at.
    pub frames: Vec<FrameError>,
}

/// Runs a configuration and looks at it. `bits` are its widths.
///
/// *Errors:* a budget that does not fit the fields, an update that cannot be laid out.
pub fn engine(
    reference: &Reference<'_>,
    configuration: &Configuration,
    bits: Bits,
    settings: Settings,
) -> Result<Measured, EngineError> {
    let layout = configuration.kept.layout();
    let scheme = configuration.scheme;
    let engine = Engine::new(Dynamic::new(bits, layout)?, settings)
        .inpainting(configuration.fill.inpaint())
        .showing(scheme, scheme.scan_out());
    let mut frames = Vec::with_capacity(reference.looked.len());
    let mut pictures = Pictures::of(reference);
    let mut saturated = 0;
    let loaded = engine.run(&reference.update, reference.frames, |frame| {
        saturated += u64::from(frame.tally.saturated);
        let picture = pictures.compare(frame.number, || (frame.picture(), frame.reached()));
        if reference.looked.contains(&frame.number) {
            let error = positions(reference, frame.number, layout, Some(bits), frame.places().into_iter());
            frames.push(FrameError { picture, ..error });
        }
    })?;
    Ok(Measured { loaded, saturated, frames })
}

/// Runs the floats with the fields and the fill mode of a configuration and looks at them.
#[must_use]
pub fn floats(reference: &Reference<'_>, configuration: &Configuration) -> Measured {
    let layout = configuration.kept.layout();
    let mut frames = Vec::with_capacity(reference.looked.len());
    let mut pictures = Pictures::of(reference);
    float::run(&reference.update, configuration.kept, configuration.fill.mode(), &reference.made(), |frame| {
        let picture = pictures.compare(frame.number, || (frame.picture.clone(), frame.reached.clone()));
        if reference.looked.contains(&frame.number) {
            let error = positions(reference, frame.number, layout, None, frame.places.iter().copied());
            frames.push(FrameError { picture, ..error });
        }
    });
    Measured { loaded: LoadTally::default(), saturated: 0, frames }
}

/// Returns sample-and-hold in the frames that are looked at. It has no galpixel, so that nothing is known or missing.
#[must_use]
pub fn hold(reference: &Reference<'_>) -> Summary {
    let none = vec![false; reference.hold.pixels.len()];
    let mut pictures = Pictures::of(reference);
    let still = |frame| {
        let picture = pictures.compare(frame, || (reference.hold.clone(), none.clone()));
        FrameError { picture, ..FrameError::at(frame) }
    };
    let mut frames = reference.made();
    frames.sort_unstable();
    frames.dedup();
    let frames: Vec<FrameError> = frames.into_iter().map(still).collect();
    let summary = Summary::of(&frames);
    Summary { psnr_known_db: None, measures: Measures { missing_percent: None, ..summary.measures }, ..summary }
}

/// The larger of the errors in x and y.
pub fn apart(place: [f64; 2], should: [f64; 2]) -> f64 {
    (place[0] - should[0]).abs().max((place[1] - should[1]).abs())
}

fn positions(
    reference: &Reference<'_>,
    frame: u32,
    layout: Layout,
    bits: Option<Bits>,
    places: impl Iterator<Item = (u32, [f64; 2])>,
) -> FrameError {
    let mut error = FrameError::at(frame);
    let (mut count, mut known, mut sum, mut true_sum, mut true_worst) = (0u32, 0u32, 0.0, 0.0, 0.0f64);
    let (mut worst, mut kept_worst) = (0.0f64, 0.0f64);
    for (origin, place) in places {
        let Some(sample) = reference.update.samples.get(origin as usize) else { continue };
        let from = reference.from(origin);
        let after = |displacement: [f64; 2]| [from[0] + displacement[0], from[1] + displacement[1]];
        let second_order = apart(place, after(displacement(sample, Layout::FULL, frame)));
        worst = worst.max(second_order);
        sum += second_order;
        count += 1;
        // What saturated is outside of the certificate.
        let fits =
            bits.is_none_or(|bits| [0, 1].iter().all(|&axis| Stored::of(sample, axis, bits, layout, frame).fits));
        if fits {
            kept_worst = kept_worst.max(apart(place, after(displacement(sample, layout, frame))));
        } else {
            error.saturated_galpixels += 1;
        }
        if let Some(truth) = reference.track(origin, frame) {
            let off = apart(place, truth);
            true_worst = true_worst.max(off);
            true_sum += off;
            known += 1;
        }
    }
    error.galpixels = count;
    if count > 0 {
        error.kept_worst_px = Some(kept_worst);
        error.worst_px = Some(worst);
        error.mean_px = Some(sum / f64::from(count));
    }
    if known > 0 {
        error.truth_worst_px = Some(true_worst);
        error.truth_mean_px = Some(true_sum / f64::from(known));
    }
    error
}

/// Compares the pictures of a configuration with the truth, in ascending frames.
struct Pictures<'r> {
    reference: &'r Reference<'r>,
    comparison: Comparison<'r>,
}

impl<'r> Pictures<'r> {
    fn of(reference: &'r Reference<'r>) -> Self {
        Self { reference, comparison: Comparison::new(&reference.hold, true) }
    }

    /// Returns how far the picture of a frame is from the truth, if that is reported; `shown` gives the picture, and
    /// which of its cells were reached.
    fn compare(&mut self, frame: u32, shown: impl FnOnce() -> (Picture, Vec<bool>)) -> Option<TruthReport> {
        let compared = self.reference.compared.iter().find(|compared| compared.truth.frame == frame)?;
        let (picture, reached) = shown();
        let Compared { truth, outline, reported } = compared;
        let seen = Seen { picture: &picture, truth, reached: &reached, outline };
        if *reported {
            return Some(self.comparison.frame(&seen));
        }
        self.comparison.pass(&seen);
        None
    }
}
