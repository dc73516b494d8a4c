//! A frame compared with the truth: as a picture, and galpixel by galpixel.

use super::report::{ChangeReport, PositionReport, TruthReport};
use crate::engine::Frame;
use crate::metric;
use crate::metric::{area, time};
use crate::picture::Picture;
use crate::source::Source;
use crate::update::{Truth, Update};

/// Which cells hold a galpixel of the update.
pub(super) struct Reached<'r> {
    /// In the scheme that was run.
    pub reached: &'r [bool],
    /// As [`Frame::outline`]: the same for all schemes and fills.
    pub outline: &'r [bool],
}

/// Which cells of a frame count, and for what.
struct Cells {
    /// Reached by a galpixel of the update.
    known: Vec<bool>,
    /// Missing in connection with the border.
    at_border: Vec<bool>,
    /// All but those that are missing in connection with the border in the outline: what enters there is known to
    /// nobody.
    inside: Vec<bool>,
    missing: usize,
}

impl Cells {
    fn of(truth: &Truth, &Reached { reached, outline }: &Reached<'_>) -> Self {
        let counted = |cell: usize| truth.mask.as_ref().is_none_or(|mask| mask[cell]);
        let which = |of: &dyn Fn(usize) -> bool| -> Vec<bool> {
            (0..reached.len()).map(|cell| counted(cell) && of(cell)).collect()
        };
        let missing = which(&|cell| !reached[cell]);
        let border = |missing: &[bool]| area::at_border(missing, truth.picture.width, truth.picture.height);
        let (at_border, outside) = (border(&missing), border(&which(&|cell| !outline[cell])));
        Self {
            known: which(&|cell| reached[cell]),
            inside: which(&|cell| !outside[cell]),
            missing: count(&missing),
            at_border,
        }
    }
}

fn count(cells: &[bool]) -> usize {
    cells.iter().filter(|&&cell| cell).count()
}

/// Compares the frames of a run with the truth, one after the other.
pub(super) struct Comparison<'h> {
    /// The update's picture.
    hold: &'h Picture,
    /// Whether SSIM, FLIP and the changes are worked out too.
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

impl<'h> Comparison<'h> {
    /// Begins with the update, which shows the truth.
    pub(super) fn new(hold: &'h Picture, perceptual: bool) -> Self {
        let inside = vec![true; hold.pixels.len()];
        let before = Before { frame: 0, shown: hold.clone(), truth: hold.clone(), inside, displacements: Vec::new() };
        Self { hold, perceptual, before }
    }

    /// Compares a shown picture with the truth.
    pub(super) fn frame(&mut self, frame: u32, picture: &Picture, truth: &Truth, reached: &Reached<'_>) -> TruthReport {
        let cells = Cells::of(truth, reached);
        let mask = truth.mask.as_deref();
        let perceptual = |measure: fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>| {
            self.perceptual.then(|| measure(picture, &truth.picture, mask)).flatten()
        };
        TruthReport {
            psnr_db: metric::psnr_db(picture, &truth.picture, mask),
            psnr_hold_db: metric::psnr_db(self.hold, &truth.picture, mask),
            psnr_known_db: metric::psnr_db(picture, &truth.picture, Some(&cells.known)),
            psnr_inside_db: metric::psnr_db(picture, &truth.picture, Some(&cells.inside)),
            ssim: perceptual(metric::ssim),
            flip: perceptual(metric::flip),
            missing: cells.missing as u64,
            missing_at_border: count(&cells.at_border) as u64,
            change: if self.perceptual { self.change(frame, picture, truth, cells) } else { None },
        }
    }

    /// Compares the change from the frame before with the true one. `None` if the truth of that frame is not known.
    fn change(&mut self, frame: u32, shown: &Picture, truth: &Truth, cells: Cells) -> Option<ChangeReport> {
        let displacements = time::displacements(shown, &truth.picture, Some(&cells.known));
        let (shown, truth) = (shown.clone(), truth.picture.clone());
        let now = Before { frame, shown, truth, inside: cells.inside, displacements };
        let before = std::mem::replace(&mut self.before, now);
        let now = &self.before;
        (now.frame == before.frame + 1).then(|| {
            let both: Vec<bool> = before.inside.iter().zip(&now.inside).map(|(&before, &now)| before && now).collect();
            ChangeReport {
                error: time::change_error([&before.shown, &now.shown], [&before.truth, &now.truth], Some(&both)),
                truth: metric::change(&before.truth, &now.truth, Some(&both)),
                judder_px: time::judder(&before.displacements, &now.displacements),
            }
        })
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
