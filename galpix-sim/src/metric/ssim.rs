//! Structural similarity as Wang, Bovik, Sheikh and Simoncelli define it (2004): Gaussian windows, so that figures
//! compare with published ones.

use super::plane::{Gaussian, Plane};
use crate::picture::Picture;

/// Half the side of the window: 11x11 cells.
const RADIUS: usize = 5;
const SIGMA: f64 = 1.5;
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// The windows.
const GAUSSIAN: Gaussian = Gaussian { radius: RADIUS, sigma: SIGMA, mirrored };

/// Returns an index brought back into `0 .. length` by mirrors at both ends (`… 1 0 | 0 1 2 … `).
fn mirrored(index: isize, length: usize) -> usize {
    let period = 2 * length as isize;
    let within = index.rem_euclid(period) as usize;
    if within < length { within } else { period as usize - 1 - within }
}

/// Returns the mean over the counted cells whose window lies inside the picture; over all counted ones if there is
/// none.
///
/// The pictures have the same size, and at least one pixel.
pub fn mean(shown: &Picture, truth: &Picture, counted: impl Fn(usize) -> bool) -> Option<f64> {
    let (a, b) = (Plane::luma(shown), Plane::luma(truth));
    let (mean_a, mean_b) = (a.blurred(&GAUSSIAN), b.blurred(&GAUSSIAN));
    let (square_a, square_b, product) =
        (a.product(&a).blurred(&GAUSSIAN), b.product(&b).blurred(&GAUSSIAN), a.product(&b).blurred(&GAUSSIAN));
    let similarity = |cell: usize| {
        let (ma, mb) = (mean_a.cells[cell], mean_b.cells[cell]);
        let (va, vb) = (square_a.cells[cell] - ma * ma, square_b.cells[cell] - mb * mb);
        let covariance = product.cells[cell] - ma * mb;
        (2.0 * ma * mb + C1) * (2.0 * covariance + C2) / ((ma * ma + mb * mb + C1) * (va + vb + C2))
    };
    let average = |among: &dyn Fn(usize) -> bool| {
        let (mut sum, mut count) = (0.0, 0.0);
        for cell in (0..a.cells.len()).filter(|&cell| counted(cell) && among(cell)) {
            sum += similarity(cell);
            count += 1.0;
        }
        (count > 0.0).then(|| sum / count)
    };
    let inside = |at: usize, length: usize| at >= RADIUS && at + RADIUS < length;
    average(&|cell| inside(cell % a.width, a.width) && inside(cell / a.width, a.height)).or_else(|| average(&|_| true))
}
