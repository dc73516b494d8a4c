//! A frame compared with the truth: as a picture, and galpixel by galpixel.

use super::report::{PositionReport, TruthReport};
use crate::engine::Frame;
use crate::metric;
use crate::metric::area;
use crate::picture::Picture;
use crate::source::Source;
use crate::update::{Truth, Update};

/// Compares a shown picture with the truth.
#[must_use]
pub fn compare(picture: &Picture, hold: &Picture, truth: &Truth, reached: &[bool], perceptual: bool) -> TruthReport {
    let counted = |index: usize| truth.mask.as_ref().is_none_or(|mask| mask[index]);
    let known: Vec<bool> = reached.iter().enumerate().map(|(index, &reached)| reached && counted(index)).collect();
    let missing: Vec<bool> = reached.iter().enumerate().map(|(index, &reached)| !reached && counted(index)).collect();
    let mask = truth.mask.as_deref();
    let perceptual = |measure: fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>| {
        perceptual.then(|| measure(picture, &truth.picture, mask)).flatten()
    };
    TruthReport {
        psnr_db: metric::psnr_db(picture, &truth.picture, mask),
        psnr_hold_db: metric::psnr_db(hold, &truth.picture, mask),
        psnr_known_db: metric::psnr_db(picture, &truth.picture, Some(&known)),
        ssim: perceptual(metric::ssim),
        flip: perceptual(metric::flip),
        missing: missing.iter().filter(|&&missing| missing).count() as u64,
        missing_at_border: area::at_border(&missing, truth.picture.width, truth.picture.height)
            .into_iter()
            .filter(|&there| there)
            .count() as u64,
    }
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
