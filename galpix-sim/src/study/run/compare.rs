//! A frame compared with the truth: as a picture, and galpixel by galpixel.

use super::report::{ChangeReport, PositionReport, TruthReport};
use crate::engine::Frame;
use crate::metric;
use crate::metric::time;
use crate::picture::Picture;
use crate::source::Source;
use crate::study::cells::{Cells, count};
use crate::update::{Truth, Update};

/// A frame whose truth is known, as it is seen.
#[derive(Clone, Copy)]
pub(crate) struct Seen<'s> {
    /// What is shown.
    pub picture: &'s Picture,
    /// The truth.
    pub truth: &'s Truth,
    /// [`Frame::reached`]: in the scheme and with the fill that was run.
    pub reached: &'s [bool],
    /// [`Frame::outline`]: the same for all schemes and fills.
    pub outline: &'s [bool],
}

/// Compares the frames of a run with the truth, one after the other. What every study reports of a picture comes from
/// here.
pub(crate) struct Comparison<'h> {
    /// The update's picture.
    hold: &'h Picture,
    /// Whether SSIM and FLIP are worked out too.
    perceptual: bool,
    before: Before,
}

/// The last frame whose truth is known.
struct Before {
    frame: u32,
    shown: Picture,
    truth: Picture,
    inside: Vec<bool>,
    displacements: Vec<Option<[f64; 2]>>,
}

impl Before {
    fn of(&Seen { picture, truth, outline, .. }: &Seen<'_>, cells: &Cells) -> Self {
        Self {
            frame: truth.frame,
            shown: picture.clone(),
            truth: truth.picture.clone(),
            inside: Cells::of(truth, outline).inside(),
            displacements: time::displacements(picture, &truth.picture, Some(&cells.known)),
        }
    }
}

impl<'h> Comparison<'h> {
    /// Begins with the update, which shows the truth.
    pub(crate) fn new(hold: &'h Picture, perceptual: bool) -> Self {
        let inside = vec![true; hold.pixels.len()];
        let before = Before { frame: 0, shown: hold.clone(), truth: hold.clone(), inside, displacements: Vec::new() };
        Self { hold, perceptual, before }
    }

    /// Compares the next frame with the truth.
    pub(crate) fn frame(&mut self, seen: &Seen<'_>) -> TruthReport {
        let &Seen { picture, truth, reached, .. } = seen;
        let cells = Cells::of(truth, reached);
        let now = Before::of(seen, &cells);
        let mask = truth.mask.as_deref();
        let psnr_db = |picture: &Picture, mask: Option<&[bool]>| metric::psnr_db(picture, &truth.picture, mask);
        let perceptual = |measure: fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>| {
            self.perceptual.then(|| measure(picture, &truth.picture, mask)).flatten()
        };
        let report = TruthReport {
            psnr_db: psnr_db(picture, mask),
            psnr_hold_db: psnr_db(self.hold, mask),
            psnr_known_db: psnr_db(picture, Some(&cells.known)),
            psnr_inside_db: psnr_db(picture, Some(&now.inside)),
            ssim: perceptual(metric::ssim),
            flip: perceptual(metric::flip),
            missing: count(&cells.missing),
            missing_percent: cells.missing_percent(),
            missing_at_border: count(&cells.at_border()),
            inside: count(&now.inside),
            change: change(&self.before, &now),
        };
        self.before = now;
        report
    }

    /// Passes a frame that is only needed for the change to the next.
    pub(crate) fn pass(&mut self, seen: &Seen<'_>) {
        self.before = Before::of(seen, &Cells::of(seen.truth, seen.reached));
    }
}

/// Compares the change from one frame to the next with the true one. `None` if there is a frame between them.
fn change(before: &Before, now: &Before) -> Option<ChangeReport> {
    (now.frame == before.frame + 1).then(|| {
        let both: Vec<bool> = before.inside.iter().zip(&now.inside).map(|(&before, &now)| before && now).collect();
        ChangeReport {
            error: time::change_error([&before.shown, &now.shown], [&before.truth, &now.truth], Some(&both)),
            truth: metric::change(&before.truth, &now.truth, Some(&both)),
            judder_px: time::judder(&before.displacements, &now.displacements),
        }
    })
}

/// The worst and the mean of some errors.
#[derive(Default)]
struct Errors {
    worst: f64,
    sum: f64,
    count: u32,
}

impl Errors {
    fn add(&mut self, place: [f64; 2], should: [f64; 2]) {
        let error = (place[0] - should[0]).abs().max((place[1] - should[1]).abs());
        self.worst = self.worst.max(error);
        self.sum += error;
        self.count += 1;
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.count)
    }
}

/// Returns how far the galpixels of a frame are from where they should be: of those that are samples of the update by
/// `cell`, and which.
pub(crate) fn position(
    source: &Source,
    update: &Update,
    frame: &Frame<'_>,
    cell: impl Fn(u32) -> Option<usize>,
) -> Option<PositionReport> {
    let margin = [update.margin.left as f64, update.margin.top as f64];
    let time = f64::from(frame.number);
    let (mut second_order, mut truth) = (Errors::default(), Errors::default());
    for (origin, place) in frame.places() {
        let Some(cell) = cell(origin) else { continue };
        let sample = update.samples.get(cell)?;
        let from = [(cell % update.width) as f64, (cell / update.width) as f64];
        let along = |i: usize| from[i] + sample.velocity[i] * time + sample.acceleration[i] / 2.0 * time * time;
        second_order.add(place, [along(0), along(1)]);
        if let Source::Scene(scene) = source {
            let [x, y, _] = scene.track(from[0] - margin[0], from[1] - margin[1], 0.0, time);
            truth.add(place, [x + margin[0], y + margin[1]]);
        }
    }
    (second_order.count > 0).then(|| PositionReport {
        worst_px: second_order.worst,
        mean_px: second_order.mean(),
        truth_worst_px: (truth.count > 0).then_some(truth.worst),
        truth_mean_px: (truth.count > 0).then(|| truth.mean()),
    })
}
