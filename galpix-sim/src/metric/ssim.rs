//! Structural similarity as Wang, Bovik, Sheikh and Simoncelli define it (2004): Gaussian windows, so that figures
//! compare with published ones.

use crate::picture::Picture;

/// Half the side of the window: 11x11 cells.
const RADIUS: usize = 5;
const SIGMA: f64 = 1.5;
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// One number per cell.
struct Plane {
    width: usize,
    height: usize,
    cells: Vec<f64>,
}

impl Plane {
    fn of(width: usize, height: usize, cell: impl Fn(usize) -> f64) -> Self {
        Self { width, height, cells: (0..width * height).map(cell).collect() }
    }

    fn luma(picture: &Picture) -> Self {
        Self::of(picture.width, picture.height, |cell| super::luma(&picture.pixels[cell]))
    }

    fn product(&self, other: &Self) -> Self {
        Self::of(self.width, self.height, |cell| self.cells[cell] * other.cells[cell])
    }

    /// Returns the Gaussian mean around each cell; the plane is mirrored at its border.
    fn blurred(&self) -> Self {
        let weights: Vec<f64> = (0..=RADIUS).map(|i| (-((i * i) as f64) / (2.0 * SIGMA * SIGMA)).exp()).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        let mean = |cell: &dyn Fn(isize) -> f64| {
            let sides = (1..=RADIUS).map(|i| weights[i] * (cell(-(i as isize)) + cell(i as isize)));
            (weights[0] * cell(0) + sides.sum::<f64>()) / sum
        };
        let (width, height) = (self.width, self.height);
        let rows = Self::of(width, height, |cell| {
            let (x, row) = (cell % width, cell - cell % width);
            mean(&|i| self.cells[row + mirrored(x as isize + i, width)])
        });
        Self::of(width, height, |cell| {
            let (x, y) = (cell % width, cell / width);
            mean(&|i| rows.cells[mirrored(y as isize + i, height) * width + x])
        })
    }
}

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
    let (mean_a, mean_b) = (a.blurred(), b.blurred());
    let (square_a, square_b, product) = (a.product(&a).blurred(), b.product(&b).blurred(), a.product(&b).blurred());
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
