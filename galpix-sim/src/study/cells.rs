//! Which cells of a frame count, and for what: one definition for all studies, schemes and fills.

use crate::metric::area;
use crate::update::Truth;

/// The cells of a frame that its truth counts, by whether a galpixel of the update reached them.
#[derive(Clone, Debug)]
pub struct Cells {
    width: usize,
    height: usize,
    /// Reached by a galpixel of the update.
    pub known: Vec<bool>,
    /// Reached by none, before anything was put there.
    pub missing: Vec<bool>,
}

/// Returns how many cells are set.
#[must_use]
pub fn count(cells: &[bool]) -> u64 {
    cells.iter().filter(|&&set| set).count() as u64
}

impl Cells {
    /// Divides the cells of a frame; `reached` is [`crate::engine::Frame::reached`], or its outline.
    #[must_use]
    pub fn of(truth: &Truth, reached: &[bool]) -> Self {
        let counts = |cell: usize| truth.mask.as_ref().is_none_or(|mask| mask[cell]);
        let which = |wanted: bool| (0..reached.len()).map(|cell| counts(cell) && reached[cell] == wanted).collect();
        Self { width: truth.picture.width, height: truth.picture.height, known: which(true), missing: which(false) }
    }

    /// Returns the missing cells that are connected with the border by missing cells: what enters the picture.
    #[must_use]
    pub fn at_border(&self) -> Vec<bool> {
        area::at_border(&self.missing, self.width, self.height)
    }

    /// Returns all cells but those [at the border](Self::at_border).
    #[must_use]
    pub fn inside(&self) -> Vec<bool> {
        let cells = self.known.iter().zip(&self.missing).zip(self.at_border());
        cells.map(|((&known, &missing), at_border)| known || missing && !at_border).collect()
    }

    /// Returns the missing cells, per cent.
    #[must_use]
    pub fn missing_percent(&self) -> f64 {
        let (known, missing) = (count(&self.known), count(&self.missing));
        100.0 * missing as f64 / (known + missing).max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    #[test]
    fn every_cell_that_counts_is_known_or_missing_and_inside_or_at_the_border() {
        // Reached cells are #; the truth does not count the one in the middle.
        let reached: Vec<bool> = "#####.##.##.#.#######.###".chars().map(|c| c == '#').collect();
        let mask: Vec<bool> = (0..25).map(|cell| cell != 12).collect();
        let truth = Truth { frame: 1, picture: Picture::filled(5, 5, [0; 3]), mask: Some(mask) };
        let cells = Cells::of(&truth, &reached);
        let set = |cells: &[bool]| (0..25).filter(|&cell| cells[cell]).collect::<Vec<_>>();
        assert_eq!(set(&cells.missing), [5, 8, 11, 13, 21]);
        assert_eq!(set(&cells.at_border()), [5, 21]);
        let outside = set(&cells.inside().iter().map(|&inside| !inside).collect::<Vec<_>>());
        assert_eq!(outside, [5, 12, 21]);
        assert_eq!((count(&cells.known), cells.missing_percent()), (19, 100.0 * 5.0 / 24.0));
        let all = Cells::of(&Truth { mask: None, ..truth }, &[true; 25]);
        assert_eq!((count(&all.inside()), all.missing_percent()), (25, 0.0));
    }
}
