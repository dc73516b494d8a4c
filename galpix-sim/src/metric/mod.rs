//! How far a shown picture is from the truth: PSNR, structural similarity, FLIP, SSIMULACRA2; how rough it is, and
//! how much it flickers.
//!
//! The first three take the shown picture first, the truth second, and an optional mask of the cells that count
//! (row-major, of the pictures' size; everything counts without it). They answer `None`, never panic, where there is
//! no defined value: sizes that differ (pictures or mask), a picture whose `pixels` do not match its size, no
//! pixel, none that counts.
//!
//! | metric | 8-bit sRGB becomes | range, best |
//! | --- | --- | --- |
//! | [`psnr_db`] | code values, R, G and B alike | 0 ..= 100 dB, 100 |
//! | [`ssim()`] | luma | about -1 ..= 1, 1 |
//! | [`flip`] | contrast-filtered opponent colours | 0 ..= 1, **0** |
//! | [`ssimulacra2()`] | XYB | below 100, 100; whole pictures only |

pub mod area;
mod local;
pub mod measures;
mod plane;
mod ssim;
mod ssimulacra;
pub mod stats;
pub mod time;

pub use local::{change, variance};

use crate::picture::Picture;
use nv_flip::FlipImageRgb8;

/// What [`psnr_db`] returns for identical pictures, in decibels, so that JSON and plots stay finite.
///
/// One channel of one pixel wrong by one step reaches this figure only in a picture of more than 51 000 pixels; larger
/// pictures with less error than that are capped too.
pub const PSNR_CAP_DB: f64 = 100.0;

/// The pixels per degree of visual angle at which [`flip`] looks: FLIP's own default, a 0.7 m wide display of 3840
/// pixels seen from 0.7 m, about 67.
pub const PIXELS_PER_DEGREE: f32 = nv_flip::DEFAULT_PIXELS_PER_DEGREE;

/// Returns the peak signal-to-noise ratio in decibels, `10 log10(255² / MSE)`, the mean squared error taken over all
/// three channels of the counted cells, in 8-bit code values. At most [`PSNR_CAP_DB`].
#[must_use]
pub fn psnr_db(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<f64> {
    comparable(shown, truth, counted)?;
    let mut squares = 0_u64;
    let mut cells = 0_u64;
    for (cell, (a, b)) in shown.pixels.iter().zip(&truth.pixels).enumerate() {
        if counts(counted, cell) {
            squares += a.iter().zip(b).map(|(&a, &b)| u64::from(a.abs_diff(b)).pow(2)).sum::<u64>();
            cells += 1;
        }
    }
    if cells == 0 {
        return None;
    }
    let mean = squares as f64 / (3 * cells) as f64;
    Some((10.0 * (255.0_f64.powi(2) / mean).log10()).min(PSNR_CAP_DB))
}

/// Returns the PSNR of several pictures of one size taken together, from each one's: that of their mean squared error,
/// so that a picture without error among them does not outweigh the others. At most [`PSNR_CAP_DB`], which it also is
/// of none.
#[must_use]
pub fn pooled_db(decibels: &[f64]) -> f64 {
    let errors: f64 = decibels.iter().map(|db| if *db >= PSNR_CAP_DB { 0.0 } else { 10_f64.powf(-db / 10.0) }).sum();
    let mean = errors / decibels.len().max(1) as f64;
    (-10.0 * mean.log10()).min(PSNR_CAP_DB)
}

/// Returns the mean structural similarity of luma (Rec. 709 weights on the sRGB code values): 1 for identical pictures.
///
/// As Wang et al. 2004 define it, with Gaussian windows of 11x11 and sigma 1.5, averaged over the counted cells whose
/// window lies inside the picture (over all counted cells where there is none). Cells that do not count are set to the
/// truth, so that they do not spoil the windows of their neighbours.
#[must_use]
pub fn ssim(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<f64> {
    comparable(shown, truth, counted)?;
    ssim::mean(&with_truth_where_not_counted(shown, truth, counted), truth, |cell| counts(counted, cell))
}

/// Returns the mean FLIP error (Andersson et al. 2020) over the counted cells, at [`PIXELS_PER_DEGREE`]: 0 for
/// identical pictures.
///
/// What is drawn is how visible the difference is when one flips between the two pictures. Cells that do not count are
/// set to the truth, so that they cannot bleed into their neighbours through FLIP's filters, and are left out of the
/// mean.
#[must_use]
pub fn flip(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<f64> {
    let map = flip_of(shown, truth, counted)?;
    let (mut sum, mut cells) = (0.0, 0_u64);
    for (cell, error) in map.to_vec().into_iter().enumerate() {
        if counts(counted, cell) {
            sum += f64::from(error);
            cells += 1;
        }
    }
    Some(sum / cells as f64)
}

/// Returns FLIP of each pixel as a colour of the map that FLIP comes with, from black for equals; `None` as [`flip`].
#[must_use]
pub fn flip_map(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<Picture> {
    let map = flip_of(shown, truth, counted)?.apply_color_lut(&nv_flip::magma_lut());
    let pixels = map.to_vec().chunks_exact(3).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    Some(Picture { width: truth.width, height: truth.height, pixels })
}

/// Returns FLIP of each pixel.
fn flip_of(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<nv_flip::FlipImageFloat> {
    comparable(shown, truth, counted)?;
    let (width, height) = (u32::try_from(truth.width).ok()?, u32::try_from(truth.height).ok()?);
    width.checked_mul(height)?.checked_mul(3)?; // nv-flip multiplies in 32 bits
    let shown = with_truth_where_not_counted(shown, truth, counted);
    Some(nv_flip::flip(
        FlipImageRgb8::with_data(width, height, truth.bytes()),
        FlipImageRgb8::with_data(width, height, shown.bytes()),
        PIXELS_PER_DEGREE,
    ))
}

/// SSIMULACRA2 (Sneyers) of whole pictures: 100 for identical ones, 90 and above is hard to distinguish, 30 and below
/// is poor. `None` for pictures with a side below 8 pixels.
#[must_use]
pub fn ssimulacra2(shown: &Picture, truth: &Picture) -> Option<f64> {
    comparable(shown, truth, None)?;
    ssimulacra::score(shown, truth)
}

/// Luma by Rec. 709 weights on the sRGB code values, 0 to 255.
#[must_use]
pub fn luma(pixel: &[u8; 3]) -> f64 {
    let [red, green, blue] = pixel.map(f64::from);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/// Returns `Some` if the two pictures and the mask have one size, hold as much as their size says, and at least one
/// cell counts.
fn comparable(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<()> {
    let cells = truth.width.checked_mul(truth.height)?;
    let whole = (shown.width, shown.height) == (truth.width, truth.height)
        && shown.pixels.len() == cells
        && truth.pixels.len() == cells
        && counted.is_none_or(|mask| mask.len() == cells);
    let some_count = counted.map_or(cells > 0, |mask| mask.contains(&true));
    (whole && some_count).then_some(())
}

fn counts(counted: Option<&[bool]>, cell: usize) -> bool {
    counted.is_none_or(|mask| mask[cell])
}

fn with_truth_where_not_counted(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Picture {
    let mut merged = shown.clone();
    for (cell, (pixel, &true_pixel)) in merged.pixels.iter_mut().zip(&truth.pixels).enumerate() {
        if !counts(counted, cell) {
            *pixel = true_pixel;
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(value: Option<f64>, expected: f64, tolerance: f64) {
        let value = value.expect("a figure");
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    /// Black, with one pixel's red at `red`.
    fn spot(width: usize, height: usize, red: u8) -> Picture {
        let mut picture = Picture::filled(width, height, [0; 3]);
        picture.pixels[0][0] = red;
        picture
    }

    #[test]
    fn a_picture_without_error_does_not_outweigh_the_others() {
        near(Some(pooled_db(&[30.0, 30.0])), 30.0, 1e-12);
        // Half the error is 3.01 dB more, whatever the exact picture's own figure is.
        near(Some(pooled_db(&[30.0, 100.0])), 33.010_299_956_6, 1e-9);
        // Ten times and a hundredth of it: (10 + 0.01) / 2.
        near(Some(pooled_db(&[20.0, 50.0])), 23.006_8, 1e-3);
        near(Some(pooled_db(&[100.0])), 100.0, 0.0);
        near(Some(pooled_db(&[])), 100.0, 0.0);
    }

    #[test]
    fn psnr_of_hand_computed_pictures() {
        let black = Picture::filled(2, 2, [0; 3]);
        near(psnr_db(&black, &Picture::filled(2, 2, [255; 3]), None), 0.0, 1e-12);
        // every code value off by one: 20 log10(255)
        near(psnr_db(&black, &Picture::filled(2, 2, [1; 3]), None), 48.130_803_608_679_1, 1e-9);
        // one channel of four pixels off by 12: MSE = 144 / 12 = 12, so 10 log10(65025 / 12)
        near(psnr_db(&spot(2, 2, 12), &black, None), 37.338_991_147_993_9, 1e-9);
        assert_eq!(psnr_db(&black, &black, None), Some(PSNR_CAP_DB));
    }

    #[test]
    fn psnr_counts_only_the_mask() {
        let (shown, truth) = (spot(2, 2, 12), Picture::filled(2, 2, [0; 3]));
        // the wrong pixel alone: MSE = 144 / 3 = 48
        near(psnr_db(&shown, &truth, Some(&[true, false, false, false])), 31.318_391_234_714_3, 1e-9);
        assert_eq!(psnr_db(&shown, &truth, Some(&[false, true, true, true])), Some(PSNR_CAP_DB));
        assert_eq!(psnr_db(&shown, &truth, Some(&[false; 4])), None);
    }

    #[test]
    fn ssim_of_flat_pictures_is_the_luminance_term() {
        let grey = |level| Picture::filled(8, 8, [level; 3]);
        // no variance: (2 * 100 * 110 + C1) / (100² + 110² + C1), C1 = (0.01 * 255)² = 6.5025
        near(ssim(&grey(100), &grey(110), None), 22006.5025 / 22106.5025, 1e-9);
        near(ssim(&grey(100), &grey(100), None), 1.0, 1e-12);
    }

    #[test]
    fn ssim_of_mirror_images_is_that_of_their_gaussian_moments() {
        // A row of period 2, 0 and 100 in turn: in the middle the Gaussian mean of every other cell is 50 to 5 digits,
        // so means 50, variances 2500, covariance -2500: (-5000 + C2) / (5000 + C2) = -0.9769 with C2 = (0.03 * 255)² =
        // 58.5225; at the ends the mirror makes a pair of equals.
        let row = |first: usize| Picture {
            width: 41,
            height: 1,
            pixels: (0..41).map(|x| [if (x + first).is_multiple_of(2) { 0 } else { 100 }; 3]).collect(),
        };
        near(ssim(&row(0), &row(1), None), -0.9769, 0.012);
    }

    #[test]
    fn ssim_takes_luma() {
        let flat = |colour| Picture::filled(3, 3, colour);
        let (a, b) = (0.0722 * 255.0, 0.7152 * 255.0);
        let expected = (2.0 * a * b + 6.5025) / (a * a + b * b + 6.5025);
        near(ssim(&flat([0, 0, 255]), &flat([0, 255, 0]), None), expected, 1e-9);
    }

    #[test]
    fn masked_cells_take_the_truth() {
        let (shown, truth) = (spot(9, 9, 255), Picture::filled(9, 9, [0; 3]));
        let mut mask = vec![true; 81];
        mask[0] = false;
        near(ssim(&shown, &truth, Some(&mask)), 1.0, 1e-12);
        near(flip(&shown, &truth, Some(&mask)), 0.0, 1e-7);
        assert!(ssim(&shown, &truth, None) < Some(0.99));
        assert!(flip(&shown, &truth, None) > Some(0.001));
    }

    #[test]
    fn flip_is_zero_for_equals_and_near_one_from_black_to_white() {
        let (black, white) = (Picture::filled(16, 16, [0; 3]), Picture::filled(16, 16, [255; 3]));
        near(flip(&black, &black, None), 0.0, 1e-7);
        // Flat: only the colour term. HyAB of black and white is 100, of green and blue (FLIP's maximum, with its Hunt
        // adjustment) 203.3; to the power of 0.7 these are 25.12 and 41.3. The first exceeds 0.4 * 41.3 = 16.5, hence
        // 0.95 + 0.05 * (25.12 - 16.5) / (41.3 - 16.5) = 0.9674; with no edges the feature term leaves it as it is.
        near(flip(&black, &white, None), 0.9674, 2e-4);
        assert!(flip(&Picture::filled(16, 16, [10; 3]), &black, None) < flip(&white, &black, None));
    }

    #[test]
    fn flip_counts_the_mean_over_the_mask_alone() {
        let (black, white) = (Picture::filled(4, 4, [0; 3]), Picture::filled(4, 4, [255; 3]));
        let mut one = vec![false; 16];
        one[5] = true;
        // fifteen cells agree; averaged over all sixteen the figure would be below 1/16
        assert!(flip(&white, &black, Some(&one)) > Some(0.1));
    }

    #[test]
    fn ssimulacra2_is_100_for_equals_and_falls_with_the_error() {
        let truth = Picture { width: 32, height: 32, pixels: (0..1024).map(|i| [(i * 37 % 251) as u8; 3]).collect() };
        let off = |by: u8| {
            let pixels = truth.pixels.iter().map(|pixel| pixel.map(|channel| channel.saturating_add(by))).collect();
            Picture { pixels, ..truth.clone() }
        };
        near(ssimulacra2(&truth, &truth), 100.0, 1e-3);
        let scores = [4, 20, 80].map(|by| ssimulacra2(&off(by), &truth).unwrap());
        assert!(100.0 > scores[0] && scores[0] > scores[1] && scores[1] > scores[2], "{scores:?}");
        assert_eq!(ssimulacra2(&Picture::filled(7, 9, [0; 3]), &Picture::filled(7, 9, [0; 3])), None);
    }

    #[test]
    fn tiny_pictures_have_figures() {
        for (width, height) in [(1, 1), (1, 7), (2, 3), (7, 1), (8, 8), (9, 1)] {
            let (a, b) = (Picture::filled(width, height, [10; 3]), Picture::filled(width, height, [20; 3]));
            for figure in [psnr_db(&a, &b, None), ssim(&a, &b, None), flip(&a, &b, None)] {
                assert!(figure.is_some_and(f64::is_finite), "{width}x{height}: {figure:?}");
            }
        }
    }

    #[test]
    fn nothing_to_compare_is_none_and_never_a_panic() {
        let black = Picture::filled(4, 2, [0; 3]);
        let torn = Picture { width: 4, height: 2, pixels: vec![[0; 3]; 7] };
        let huge = Picture { width: usize::MAX, height: 2, pixels: Vec::new() };
        let empty = Picture::filled(0, 5, [0; 3]);
        type Metric = fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>;
        for metric in [psnr_db as Metric, ssim, flip] {
            assert_eq!(metric(&black, &Picture::filled(2, 4, [0; 3]), None), None);
            assert_eq!(metric(&torn, &black, None), None);
            assert_eq!(metric(&black, &torn, None), None);
            assert_eq!(metric(&huge, &huge, None), None);
            assert_eq!(metric(&empty, &empty, None), None);
            assert_eq!(metric(&black, &black, Some(&[true; 7])), None);
            assert_eq!(metric(&black, &black, Some(&[false; 8])), None);
        }
    }
}
