//! How rough a picture is around some cells, and how much it changes there from frame to frame.

use super::stats::mean;
use super::{comparable, counts, luma, with_truth_where_not_counted};
use crate::picture::Picture;

/// Half the side of the window: 7x7 cells.
const RADIUS: usize = 3;

/// Returns the mean over the counted cells of the variance of luma (code values squared) in the 7x7 cells around each,
/// as many of them as the picture has. Cells that do not count are set to the truth, so that only what is shown in the
/// others differs.
///
/// With the truth as the shown picture it is what the figure should be: less is blurred, more is noisy.
#[must_use]
pub fn variance(shown: &Picture, truth: &Picture, counted: Option<&[bool]>) -> Option<f64> {
    comparable(shown, truth, counted)?;
    let merged = with_truth_where_not_counted(shown, truth, counted);
    let (width, height) = (merged.width, merged.height);
    let lumas: Vec<f64> = merged.pixels.iter().map(luma).collect();
    let span = |at: usize, length: usize| at.saturating_sub(RADIUS)..(at + RADIUS + 1).min(length);
    let around = |cell: usize| {
        let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
        for y in span(cell / width, height) {
            for luma in &lumas[y * width..][span(cell % width, width)] {
                sum += luma;
                squares += luma * luma;
                count += 1.0;
            }
        }
        (squares / count - (sum / count) * (sum / count)).max(0.0)
    };
    mean((0..lumas.len()).filter(|&cell| counts(counted, cell)).map(around))
}

/// Returns the mean change of luma (code values) over the counted cells from one picture to the next: its absolute
/// value.
#[must_use]
pub fn change(before: &Picture, after: &Picture, counted: Option<&[bool]>) -> Option<f64> {
    comparable(before, after, counted)?;
    let pairs = before.pixels.iter().zip(&after.pixels).enumerate();
    mean(pairs.filter(|&(cell, _)| counts(counted, cell)).map(|(_, (a, b))| (luma(a) - luma(b)).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(width: usize, height: usize, level: impl Fn(usize, usize) -> u8) -> Picture {
        let pixels = (0..width * height).map(|cell| [level(cell % width, cell / width); 3]).collect();
        Picture { width, height, pixels }
    }

    #[test]
    fn variance_of_a_hand_computed_window() {
        // One white cell among 49: 255² (1/49 - 1/49²) in each window that holds it.
        let truth = gray(15, 15, |_, _| 0);
        let shown = gray(15, 15, |x, y| if (x, y) == (7, 7) { 255 } else { 0 });
        let mut counted = vec![false; 225];
        (counted[7 * 15 + 7], counted[7 * 15 + 5]) = (true, true);
        let expected = 255.0 * 255.0 * (1.0 / 49.0 - 1.0 / (49.0 * 49.0));
        assert!((variance(&shown, &truth, Some(&counted)).unwrap() - expected).abs() < 1e-6);
        // Where the white cell does not count, the truth stands there.
        counted[7 * 15 + 7] = false;
        assert_eq!(variance(&shown, &truth, Some(&counted)), Some(0.0));
        assert_eq!(variance(&shown, &truth, Some(&[false; 225])), None);
    }

    #[test]
    fn change_is_absolute_and_only_of_what_counts() {
        let (before, after) = (gray(2, 1, |_, _| 100), gray(2, 1, |x, _| if x == 0 { 90 } else { 130 }));
        assert!((change(&before, &after, None).unwrap() - 20.0).abs() < 1e-9);
        assert!((change(&before, &after, Some(&[true, false])).unwrap() - 10.0).abs() < 1e-9);
    }
}
