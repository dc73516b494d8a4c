//! Pictures of pictures: panels side by side with labels, a difference made visible, and films of them.
//!
//! A film is an animated PNG ([`apng()`]): every browser plays it, it is lossless, and one `<img>` shows it without a
//! script.

mod apng;
mod label;
mod palette;

pub use apng::{Colours, FilmError, apng, apng_within};
pub use label::{LABEL_ROWS, labelled};

use crate::picture::Picture;

/// What is between and around panels: a dark grey that suits light and dark pages.
pub const GROUND: [u8; 3] = [30, 31, 36];

/// How many times [`difference`] enlarges an error: from 64 code values on it is full.
pub const DIFFERENCE_GAIN: u8 = 4;

/// Returns the panels in one row from left to right, top edges aligned, `gap` pixels of [`GROUND`] between neighbours.
///
/// Panels may differ in size. Without panels the picture has no pixels.
#[must_use]
pub fn side_by_side(panels: &[&Picture], gap: usize) -> Picture {
    grid(panels, panels.len(), gap)
}

/// Returns the panels in rows of `columns` (0 counts as 1), filled row by row; each cell has the size of the largest
/// panel, `gap` pixels of [`GROUND`] between cells. Without panels the picture has no pixels.
#[must_use]
pub fn grid(panels: &[&Picture], columns: usize, gap: usize) -> Picture {
    let columns = columns.clamp(1, panels.len().max(1));
    let rows = panels.len().div_ceil(columns);
    let cell_width = panels.iter().map(|panel| panel.width).max().unwrap_or(0);
    let cell_height = panels.iter().map(|panel| panel.height).max().unwrap_or(0);
    let extent = |cells: usize, cell: usize| cells * cell + cells.saturating_sub(1) * gap;
    let mut sheet = match rows {
        0 => Picture::filled(0, 0, GROUND),
        _ => Picture::filled(extent(columns, cell_width), extent(rows, cell_height), GROUND),
    };
    for (index, panel) in panels.iter().enumerate() {
        paste(panel, &mut sheet, index % columns * (cell_width + gap), index / columns * (cell_height + gap));
    }
    sheet
}

/// Returns the absolute difference of each channel, enlarged [`DIFFERENCE_GAIN`] times and cut at 255: identical cells
/// are black.
///
/// Has the size of `truth`; a cell that `shown` lacks is white, so that a wrong size is seen and not hidden.
#[must_use]
pub fn difference(shown: &Picture, truth: &Picture) -> Picture {
    let mut map = Picture::filled(truth.width, truth.height, [255; 3]);
    for y in 0..truth.height.min(shown.height) {
        for x in 0..truth.width.min(shown.width) {
            let (a, b) = (shown.at(x, y), truth.at(x, y));
            map.pixels[y * truth.width + x] =
                std::array::from_fn(|channel| a[channel].abs_diff(b[channel]).saturating_mul(DIFFERENCE_GAIN));
        }
    }
    map
}

/// Returns the picture with each pixel repeated `factor` times in both directions; 0 counts as 1.
#[must_use]
pub fn magnified(picture: &Picture, factor: usize) -> Picture {
    let factor = factor.max(1);
    let (width, height) = (picture.width * factor, picture.height * factor);
    let pixels =
        (0..height).flat_map(|y| (0..width).map(move |x| (x / factor, y / factor))).map(|(x, y)| picture.at(x, y));
    Picture { width, height, pixels: pixels.collect() }
}

/// Returns the picture with squares of `factor` by `factor` pixels as one, their mean; 0 counts as 1.
#[must_use]
pub fn reduced(picture: &Picture, factor: usize) -> Picture {
    if factor <= 1 {
        return picture.clone();
    }
    let (width, height) = (picture.width.div_ceil(factor), picture.height.div_ceil(factor));
    let mean = |x: usize, y: usize| -> [u8; 3] {
        let (right, lower) = (picture.width.min((x + 1) * factor), picture.height.min((y + 1) * factor));
        let square = || (y * factor..lower).flat_map(|y| (x * factor..right).map(move |x| picture.at(x, y)));
        let count = square().count().max(1);
        std::array::from_fn(|channel| {
            let sum: usize = square().map(|pixel| usize::from(pixel[channel])).sum();
            ((sum + count / 2) / count) as u8
        })
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y));
    Picture { width, height, pixels: pixels.collect() }
}

/// Copies `panel` into `sheet` with its top left corner at (`left`, `top`); it must fit.
fn paste(panel: &Picture, sheet: &mut Picture, left: usize, top: usize) {
    for (y, row) in panel.pixels.chunks_exact(panel.width.max(1)).enumerate() {
        sheet.pixels[(top + y) * sheet.width + left..][..panel.width].copy_from_slice(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_stand_in_order_with_gaps() {
        let (red, blue) = (Picture::filled(2, 1, [255, 0, 0]), Picture::filled(1, 2, [0, 0, 255]));
        let sheet = side_by_side(&[&red, &blue], 3);
        assert_eq!((sheet.width, sheet.height), (2 + 3 + 2, 2)); // cells are as wide as the widest panel
        assert_eq!((sheet.at(1, 0), sheet.at(5, 1)), ([255, 0, 0], [0, 0, 255]));
        assert_eq!((sheet.at(1, 1), sheet.at(3, 0), sheet.at(6, 0)), (GROUND, GROUND, GROUND));
    }

    #[test]
    fn a_grid_breaks_rows() {
        let panels: Vec<_> = (0..3).map(|level| Picture::filled(2, 2, [level; 3])).collect();
        let sheet = grid(&panels.iter().collect::<Vec<_>>(), 2, 1);
        assert_eq!((sheet.width, sheet.height), (5, 5));
        assert_eq!((sheet.at(0, 0), sheet.at(3, 0), sheet.at(0, 3)), ([0; 3], [1; 3], [2; 3]));
        assert_eq!((sheet.at(2, 0), sheet.at(3, 3)), (GROUND, GROUND));
    }

    #[test]
    fn nothing_in_nothing_out() {
        assert_eq!(side_by_side(&[], 5).pixels.len(), 0);
        let empty = Picture::filled(0, 0, [0; 3]);
        assert_eq!(grid(&[&empty, &empty], 0, 0).pixels.len(), 0);
        assert_eq!(magnified(&empty, 3).pixels.len(), 0);
        assert_eq!(difference(&empty, &empty).pixels.len(), 0);
    }

    #[test]
    fn a_difference_is_enlarged_and_identity_is_black() {
        let truth = Picture { width: 3, height: 1, pixels: vec![[10, 20, 30]; 3] };
        let shown = Picture { width: 2, height: 1, pixels: vec![[10, 20, 30], [15, 0, 255]] };
        assert_eq!(difference(&shown, &truth).pixels, [[0; 3], [20, 80, 255], [255; 3]]);
    }

    #[test]
    fn magnifying_repeats_pixels() {
        let pair = Picture { width: 2, height: 1, pixels: vec![[1; 3], [2; 3]] };
        assert_eq!(magnified(&pair, 2).pixels, [[1; 3], [1; 3], [2; 3], [2; 3], [1; 3], [1; 3], [2; 3], [2; 3]]);
        assert_eq!(magnified(&pair, 0), pair);
    }

    #[test]
    fn reducing_is_undone_by_magnifying_and_rims_are_means_of_what_is_there() {
        let pair = Picture { width: 2, height: 1, pixels: vec![[1; 3], [2; 3]] };
        assert_eq!((reduced(&magnified(&pair, 3), 3), reduced(&pair, 0)), (pair.clone(), pair));
        let three = Picture { width: 3, height: 1, pixels: vec![[10; 3], [21; 3], [7; 3]] };
        assert_eq!(reduced(&three, 2).pixels, [[16; 3], [7; 3]]);
    }
}
