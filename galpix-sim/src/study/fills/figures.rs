//! How well the disoccluded cells of a frame are filled.

use schemars::JsonSchema;
use serde::Serialize;

use crate::metric;
use crate::metric::area::Window;
use crate::metric::stats::weighted_mean;
use crate::picture::Picture;
use crate::study::cells::count;
use crate::study::holes::Holes;

/// Cells around the disoccluded ones that are used. No filter of FLIP or SSIM reaches farther, and farther out a
/// picture and the truth are the same.
const MARGIN: usize = 24;

/// Figures of one picture, or means of several, weighted by their cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Figures {
    /// Over the disoccluded cells, in decibels; of several pictures that of all cells together.
    pub psnr_db: Option<f64>,
    /// Structural similarity over the disoccluded cells, all others set to the truth.
    pub ssim: Option<f64>,
    /// FLIP likewise.
    pub flip: Option<f64>,
    /// The variance of luma in the 7x7 cells around each disoccluded one, all others set to the truth; in code values
    /// squared.
    pub variance: Option<f64>,
    /// The mean absolute change of luma, from the frame before, of the cells that are disoccluded in both, less that of
    /// the truth at the same cells; in code values.
    pub flicker: Option<f64>,
    /// SSIMULACRA2 of the whole picture.
    pub ssimulacra2: Option<f64>,
}

/// The truth's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct TruthFigures {
    /// See [`Figures::variance`].
    pub variance: Option<f64>,
    /// The change of the truth that is taken off [`Figures::flicker`].
    pub change: Option<f64>,
}

/// Returns the cells that are disoccluded in a frame and in the one before it.
pub fn in_both(before: Option<&Holes>, now: &Holes) -> Option<Vec<bool>> {
    let before = before.filter(|before| before.frame + 1 == now.frame)?;
    let both: Vec<bool> = before.disoccluded.iter().zip(&now.disoccluded).map(|(&a, &b)| a && b).collect();
    both.contains(&true).then_some(both)
}

/// Returns the truth's own figures in a frame.
pub fn truth(before: Option<&Holes>, now: &Holes) -> TruthFigures {
    let change = in_both(before, now).and_then(|both| metric::change(&before?.truth, &now.truth, Some(&both)));
    TruthFigures { variance: around(now, &now.truth, metric::variance), change }
}

/// Returns the figures of a picture; `last` is that of the frame before.
pub fn of(holes: &Holes, shown: &Picture, before: Option<(&Holes, &Picture)>, truth: &TruthFigures) -> Figures {
    let change = before.and_then(|(before, last)| metric::change(last, shown, Some(&in_both(Some(before), holes)?)));
    Figures {
        psnr_db: metric::psnr_db(shown, &holes.truth, Some(&holes.disoccluded)),
        ssim: around(holes, shown, metric::ssim),
        flip: around(holes, shown, metric::flip),
        variance: around(holes, shown, metric::variance),
        flicker: change.zip(truth.change).map(|(change, truth)| change - truth),
        ssimulacra2: metric::ssimulacra2(shown, &holes.truth),
    }
}

/// Returns the errors of a picture over all cells that the warp leaves open.
pub fn open(open: &Holes, shown: &Picture) -> Figures {
    Figures {
        psnr_db: metric::psnr_db(shown, &open.truth, Some(&open.disoccluded)),
        ssim: around(open, shown, metric::ssim),
        flip: around(open, shown, metric::flip),
        ..Figures::default()
    }
}

type Metric = fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>;

/// Returns a figure over the disoccluded cells, for which only what is near them is looked at.
fn around(holes: &Holes, shown: &Picture, metric: Metric) -> Option<f64> {
    let (width, height) = (shown.width, shown.height);
    let cells = (0..holes.disoccluded.len()).filter(|&cell| holes.disoccluded[cell]);
    let window = Window::around(cells, MARGIN, width, height)?;
    let crop = |picture: &Picture| picture.crop(window.left, window.top, window.width, window.height);
    metric(&crop(shown), &crop(&holes.truth), Some(&window.of(&holes.disoccluded, width)))
}

/// Returns the mean of a figure by weights, where it is known; `None` without any.
fn mean(weighted: impl Iterator<Item = (f64, Option<f64>)>) -> Option<f64> {
    weighted_mean(weighted.filter_map(|(weight, figure)| Some((weight, figure?))))
}

/// The weights of a frame: its disoccluded cells, and those that are so in the frame before as well.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// Disoccluded cells.
    pub cells: u64,
    /// Those that were so before.
    pub both: u64,
}

impl Weight {
    /// Of a frame.
    pub fn of(before: Option<&Holes>, now: &Holes) -> Self {
        Self { cells: count(&now.disoccluded), both: in_both(before, now).map_or(0, |both| count(&both)) }
    }
}

/// Returns the figures of all frames in one.
pub fn summary(frames: &[Figures], weights: &[Weight]) -> Figures {
    let by_cells = |figure: fn(&Figures) -> Option<f64>| {
        mean(frames.iter().zip(weights).map(|(frame, weight)| (weight.cells as f64, figure(frame))))
    };
    let squares = by_cells(|frame| frame.psnr_db.map(|psnr| 255.0f64.powi(2) / 10f64.powf(psnr / 10.0)));
    Figures {
        psnr_db: squares.map(|mse| (10.0 * (255.0f64.powi(2) / mse).log10()).min(metric::PSNR_CAP_DB)),
        ssim: by_cells(|frame| frame.ssim),
        flip: by_cells(|frame| frame.flip),
        variance: by_cells(|frame| frame.variance),
        flicker: mean(frames.iter().zip(weights).map(|(frame, weight)| (weight.both as f64, frame.flicker))),
        ssimulacra2: mean(frames.iter().map(|frame| (1.0, frame.ssimulacra2))),
    }
}

/// Returns the truth's figures of all frames in one.
pub fn truth_summary(frames: &[TruthFigures], weights: &[Weight]) -> TruthFigures {
    let pairs = || frames.iter().zip(weights);
    TruthFigures {
        variance: mean(pairs().map(|(frame, weight)| (weight.cells as f64, frame.variance))),
        change: mean(pairs().map(|(frame, weight)| (weight.both as f64, frame.change))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_weighted_by_cells_and_decibels_by_their_errors() {
        let frame = |psnr_db: f64, flip: f64, flicker: f64| Figures {
            psnr_db: Some(psnr_db),
            flip: Some(flip),
            flicker: Some(flicker),
            ..Figures::default()
        };
        let weights = [Weight { cells: 3, both: 0 }, Weight { cells: 1, both: 1 }];
        let summary = summary(&[frame(20.0, 0.1, 9.0), frame(10.0, 0.5, 2.0)], &weights);
        // Squared errors of 1/100 and 1/10 of 255²: (3/100 + 1/10) / 4 = 0.0325.
        assert!((summary.psnr_db.unwrap() - 10.0 * (1.0f64 / 0.0325).log10()).abs() < 1e-9);
        assert!((summary.flip.unwrap() - 0.2).abs() < 1e-12);
        assert_eq!((summary.flicker, summary.ssim), (Some(2.0), None));
    }

    /// Returns a picture of noise with a hole in it, and what is shown there.
    fn hole(frame: u32, level: u8) -> (Holes, Picture) {
        let noise = |cell: usize| [(cell.wrapping_mul(2_654_435_761) >> 24 & 0xff) as u8; 3];
        let truth = Picture { width: 96, height: 80, pixels: (0..96 * 80).map(noise).collect() };
        let hole = |cell: usize| (40..50).contains(&(cell % 96)) && (30..44).contains(&(cell / 96));
        let disoccluded: Vec<bool> = (0..96 * 80).map(hole).collect();
        let mut shown = truth.clone();
        for cell in (0..96 * 80).filter(|&cell| hole(cell)) {
            shown.pixels[cell] = [level; 3];
        }
        let (warped, all, at_border) = (shown.clone(), disoccluded.clone(), vec![false; 96 * 80]);
        (Holes { frame, warped, all, at_border, truth, disoccluded }, shown)
    }

    #[test]
    fn a_window_gives_the_figures_of_the_whole_picture() {
        let (holes, shown) = hole(1, 90);
        for metric in [metric::ssim as Metric, metric::flip, metric::variance] {
            let whole = metric(&shown, &holes.truth, Some(&holes.disoccluded)).unwrap();
            let window = around(&holes, &shown, metric).unwrap();
            assert!((whole - window).abs() < 1e-5, "{whole} {window}");
        }
    }

    #[test]
    fn a_flat_fill_is_too_smooth_and_flickers_by_its_steps() {
        let ((first, one), (second, two)) = (hole(1, 90), hole(2, 100));
        let own = truth(Some(&first), &second);
        assert_eq!(own.change, Some(0.0));
        let figures = of(&second, &two, Some((&first, &one)), &own);
        assert!((figures.flicker.unwrap() - 10.0).abs() < 1e-9);
        assert!(figures.variance.unwrap() < 0.6 * own.variance.unwrap(), "{figures:?} {own:?}");
        assert_eq!(of(&first, &one, None, &own).flicker, None);
        assert_eq!(in_both(Some(&first), &Holes { frame: 3, ..second }), None);
    }
}
