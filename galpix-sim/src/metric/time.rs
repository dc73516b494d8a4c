//! How a shown sequence moves, against the true one: the error of its changes, and its judder.
//!
//! A picture may be near the truth in each frame and still be unrest to look at: what stands still for three frames and
//! then jumps by a cell is off by at most half a cell in each. Both figures here are of two frames in succession.

use super::plane::{Gaussian, Plane};
use super::{comparable, counts, luma};
use crate::metric::stats::mean;
use crate::picture::Picture;

/// The side of a block whose displacement is estimated, in cells.
const BLOCK: usize = 16;

/// The least eigenvalue of a block's gradients, code values squared per cell: with less texture a displacement is
/// noise.
const TEXTURE: f64 = 4.0;

/// The part of a block that must count.
const COUNTED: f64 = 0.9;

/// What is applied before gradients are taken.
const GAUSSIAN: Gaussian = Gaussian { radius: 4, sigma: 1.0, mirrored };

/// Returns an index brought back into `0 .. length` by mirrors at the cells of both ends (`… 2 1 0 1 2 …`).
fn mirrored(index: isize, length: usize) -> usize {
    let period = 2 * (length as isize - 1).max(1);
    let within = index.rem_euclid(period);
    within.min(period - within).min(length as isize - 1) as usize
}

/// Returns the mean over the counted cells of |(shown now - shown before) - (true now - true before)| of luma, in code
/// values: 0 where the shown picture changes as the truth does. Pictures are given as `[before, now]`.
#[must_use]
pub fn change_error(shown: [&Picture; 2], truth: [&Picture; 2], counted: Option<&[bool]>) -> Option<f64> {
    for (shown, truth) in shown.into_iter().zip(truth) {
        comparable(shown, truth, counted)?;
    }
    comparable(truth[0], truth[1], counted)?;
    let [before, now] = [0, 1].map(|at: usize| {
        shown[at].pixels.iter().zip(&truth[at].pixels).map(|(shown, truth)| luma(shown) - luma(truth))
    });
    let errors = before.zip(now).enumerate().filter(|&(cell, _)| counts(counted, cell));
    mean(errors.map(|(_, (before, now))| (now - before).abs()))
}

/// Returns the displacement of the shown picture against the truth, in pixels right and down, of each block of 16x16
/// cells, row by row: by one step of Lucas and Kanade (1981) on luma. `None` for a block without enough texture, or of
/// which less than nine tenths count; no blocks if the pictures cannot be compared.
#[must_use]
pub fn displacements(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Vec<Option<[f64; 2]>> {
    if comparable(shown, truth, counted).is_none() {
        return Vec::new();
    }
    let (width, height) = (truth.width, truth.height);
    let [shown, truth] = [shown, truth].map(|picture| Plane::luma(picture).blurred(&GAUSSIAN).cells);
    let blocks = (0..height / BLOCK).flat_map(|y| (0..width / BLOCK).map(move |x| (x * BLOCK, y * BLOCK)));
    blocks.map(|corner| displacement([&shown, &truth], (width, height), counted, corner)).collect()
}

/// Returns the root of the mean square of the changes of both components from one frame's displacements to the next's,
/// in pixels, over the blocks that both have.
#[must_use]
pub fn judder(before: &[Option<[f64; 2]>], now: &[Option<[f64; 2]>]) -> Option<f64> {
    let both = before.iter().zip(now).filter_map(|(before, now)| Some((before.as_ref()?, now.as_ref()?)));
    let squares = both.map(|(before, now)| ((now[0] - before[0]).powi(2) + (now[1] - before[1]).powi(2)) / 2.0);
    Some(mean(squares)?.sqrt())
}

fn displacement(
    [shown, truth]: [&[f64]; 2],
    (width, height): (usize, usize),
    counted: Option<&[bool]>,
    (left, top): (usize, usize),
) -> Option<[f64; 2]> {
    let [mut xx, mut yy, mut xy, mut xe, mut ye, mut cells] = [0.0; 6];
    for (x, y) in (top..top + BLOCK).flat_map(|y| (left..left + BLOCK).map(move |x| (x, y))) {
        let cell = y * width + x;
        if !counts(counted, cell) {
            continue;
        }
        let gradient = |inside: bool, step: usize| {
            if inside { (truth[cell + step] - truth[cell - step]) / 2.0 } else { 0.0 }
        };
        let (gx, gy) = (gradient(x > 0 && x + 1 < width, 1), gradient(y > 0 && y + 1 < height, width));
        let error = shown[cell] - truth[cell];
        (xx, yy, xy) = (xx + gx * gx, yy + gy * gy, xy + gx * gy);
        (xe, ye, cells) = (xe + gx * error, ye + gy * error, cells + 1.0);
    }
    let area = (BLOCK * BLOCK) as f64;
    let (determinant, trace) = (xx * yy - xy * xy, xx + yy);
    let least = trace / 2.0 - (trace * trace / 4.0 - determinant).max(0.0).sqrt();
    (least > TEXTURE * area && cells > COUNTED * area)
        .then(|| [-(yy * xe - xy * ye) / determinant, -(xx * ye - xy * xe) / determinant])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth texture, moved to the right and down.
    fn texture(width: usize, height: usize, [right, down]: [f64; 2]) -> Picture {
        let level = |cell: usize| {
            let (x, y) = ((cell % width) as f64 - right, (cell / width) as f64 - down);
            let level = 128.0 + 50.0 * (x * 0.5).sin() + 50.0 * (y * 0.45 + x * 0.1).cos();
            [level.round() as u8; 3]
        };
        Picture { width, height, pixels: (0..width * height).map(level).collect() }
    }

    #[test]
    fn a_change_is_compared_with_the_true_change() {
        let gray = |levels: [u8; 2]| Picture { width: 2, height: 1, pixels: levels.map(|l| [l; 3]).to_vec() };
        let [still, step] = [gray([100, 100]), gray([110, 90])];
        let [before, now] = [gray([50, 50]), gray([60, 50])];
        let error = |shown, counted| change_error(shown, [&before, &now], counted).unwrap();
        assert!((error([&still, &step], None) - 5.0).abs() < 1e-9, "as much too dark as the other is right");
        assert!(error([&still, &step], Some(&[true, false])).abs() < 1e-9);
        assert!((error([&still, &still], None) - 5.0).abs() < 1e-9);
        assert_eq!(change_error([&still, &Picture::filled(1, 2, [0; 3])], [&before, &now], None), None);
        assert_eq!(change_error([&still, &still], [&before, &now], Some(&[false; 2])), None);
    }

    #[test]
    fn a_displacement_is_found_to_a_tenth() {
        let truth = texture(70, 40, [0.0; 2]);
        for moved in [[0.0, 0.0], [0.3, 0.0], [-0.25, 0.4], [0.5, -0.5]] {
            let found = displacements(&texture(70, 40, moved), &truth, None);
            assert_eq!(found.len(), 8);
            for block in found {
                let block = block.expect("texture");
                let off = (block[0] - moved[0]).abs().max((block[1] - moved[1]).abs());
                assert!(off < 0.06, "{block:?} is not {moved:?}");
            }
        }
    }

    #[test]
    fn blocks_without_texture_or_cells_have_none() {
        let (flat, truth) = (Picture::filled(32, 16, [9; 3]), texture(32, 16, [0.0; 2]));
        assert_eq!(displacements(&flat, &flat, None), [None, None]);
        let mut counted = vec![true; 512];
        counted.iter_mut().step_by(32).for_each(|cell| *cell = false);
        assert!(displacements(&truth, &truth, Some(&counted))[0].is_some(), "15 of 16 columns");
        counted.iter_mut().skip(1).step_by(32).for_each(|cell| *cell = false);
        let found = displacements(&truth, &truth, Some(&counted));
        assert!(found[0].is_none() && found[1].is_some(), "14 of 16 columns");
        assert!(displacements(&truth, &flat, Some(&[true; 3])).is_empty());
        assert!(displacements(&Picture::filled(15, 40, [0; 3]), &Picture::filled(15, 40, [0; 3]), None).is_empty());
    }

    #[test]
    fn judder_is_the_change_of_the_displacement() {
        let before = [Some([0.0, 0.0]), Some([1.0, 1.0]), None];
        let now = [Some([0.3, 0.4]), Some([1.0, 1.0]), Some([9.0, 9.0])];
        let rms = judder(&before, &now).unwrap();
        assert!((rms - (0.25_f64 / 4.0).sqrt()).abs() < 1e-12, "{rms}");
        assert_eq!(judder(&before, &[None; 3]), None);
    }

    #[test]
    fn a_blur_keeps_what_is_even_and_any_size() {
        for (width, height) in [(1, 1), (1, 9), (2, 3), (20, 1)] {
            let even = Plane::of(width, height, |_| 7.0).blurred(&GAUSSIAN);
            assert!(even.cells.iter().all(|value| (value - 7.0).abs() < 1e-12), "{width}x{height}");
        }
    }
}
