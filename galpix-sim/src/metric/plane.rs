//! Planes of numbers, one per cell of a picture, and their Gaussian means.

use crate::picture::Picture;

/// One number per cell, row by row.
pub struct Plane {
    pub width: usize,
    pub height: usize,
    pub cells: Vec<f64>,
}

/// A Gaussian window.
pub struct Gaussian {
    /// Cells to each side of the middle.
    pub radius: usize,
    /// The standard deviation, in cells.
    pub sigma: f64,
    /// Brings a column or row beyond the border back into `0 .. length`.
    pub mirrored: fn(isize, usize) -> usize,
}

impl Plane {
    /// Makes a plane of what `cell` gives for each cell.
    pub fn of(width: usize, height: usize, cell: impl Fn(usize) -> f64) -> Self {
        Self { width, height, cells: (0..width * height).map(cell).collect() }
    }

    /// Makes the plane of a picture's luma.
    pub fn luma(picture: &Picture) -> Self {
        Self::of(picture.width, picture.height, |cell| super::luma(&picture.pixels[cell]))
    }

    /// Returns the products cell by cell; both planes have one size.
    pub fn product(&self, other: &Self) -> Self {
        Self::of(self.width, self.height, |cell| self.cells[cell] * other.cells[cell])
    }

    /// Returns the Gaussian mean around each cell.
    pub fn blurred(&self, gaussian: &Gaussian) -> Self {
        let &Gaussian { radius, sigma, mirrored } = gaussian;
        let weights: Vec<f64> = (0..=radius).map(|i| (-((i * i) as f64) / (2.0 * sigma * sigma)).exp()).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        let mean = |cell: &dyn Fn(isize) -> f64| {
            let sides = (1..=radius).map(|i| weights[i] * (cell(-(i as isize)) + cell(i as isize)));
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
