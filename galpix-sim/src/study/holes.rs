//! The cells that are judged: those of the display that no galpixel of the update reached, by the warp alone, whatever
//! is put into them. Those connected with the border are counted separately: what enters the picture was never next to
//! anything known.

use galpix_core::FillMode;

use super::cells::Cells;
use super::job::{ExperimentError, Job};
use super::run;
use crate::engine::Scheme;
use crate::engine::fill::in_fovea;
use crate::metric::area::{self, Window};
use crate::picture::Picture;
use crate::update::Truth;

/// A frame whose truth is known.
pub struct Holes {
    /// Frames since the update.
    pub frame: u32,
    /// The true picture.
    pub truth: Picture,
    /// All cells that nothing reached and that the truth counts.
    pub all: Vec<bool>,
    /// Of these, those connected with the border.
    pub at_border: Vec<bool>,
    /// The other ones that are judged, the disoccluded ones: not connected with the border, and outside of the fovea.
    pub disoccluded: Vec<bool>,
    /// The warped picture: the cells that nothing reached are black.
    pub warped: Picture,
}

impl Holes {
    fn new(frame: u32, truth: &Truth, warped: &Picture, reached: &[bool], fovea: Option<u32>) -> Self {
        let (width, height) = (warped.width, warped.height);
        let cells = Cells::of(truth, reached);
        let (at_border, all) = (cells.at_border(), cells.missing);
        let disoccluded =
            (0..all.len()).map(|cell| all[cell] && !at_border[cell] && !in_fovea(fovea, cell, width, height)).collect();
        let pixels = warped.pixels.iter().zip(reached).map(|(&pixel, &reached)| if reached { pixel } else { [0; 3] });
        let warped = Picture { width, height, pixels: pixels.collect() };
        Self { frame, truth: truth.picture.clone(), all, at_border, disoccluded, warped }
    }

    /// Returns the same where all cells are judged that nothing reached, those connected with the border too.
    #[must_use]
    pub fn with_border(&self, fovea: Option<u32>) -> Self {
        let (width, height) = (self.truth.width, self.truth.height);
        let outside = |(cell, &open): (usize, &bool)| open && !in_fovea(fovea, cell, width, height);
        Self {
            frame: self.frame,
            truth: self.truth.clone(),
            all: self.all.clone(),
            at_border: self.at_border.clone(),
            disoccluded: self.all.iter().enumerate().map(outside).collect(),
            warped: Picture { width: 0, height: 0, pixels: Vec::new() },
        }
    }

    /// Returns the largest connected disoccluded area: its cells and the window around them.
    #[must_use]
    pub fn largest(&self) -> Option<(usize, Window)> {
        let (width, height) = (self.truth.width, self.truth.height);
        let cells = area::largest(&self.disoccluded, width);
        let count = cells.len();
        Some((count, Window::around(cells, 0, width, height)?))
    }
}

/// Returns the frames of a job with a truth, as the warp of the first layer alone leaves them in a map, whatever the
/// job's scheme: what is judged is the same for all.
///
/// *Errors:* a map that does not fit.
pub fn of(job: &Job<'_>, fovea: Option<u32>) -> Result<Vec<Holes>, ExperimentError> {
    let mut frames = Vec::new();
    let warp = job.with_scheme(Scheme::Map).with_fill(FillMode::None.into()).without_perception();
    run::job(&warp, |shown| {
        if let (Some(truth), true) = (shown.truth, shown.frame > 0) {
            frames.push(Holes::new(shown.frame, truth, shown.picture, shown.reached, fovea));
        }
    })?;
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_enters_and_what_does_not_count_is_not_disoccluded() {
        let reached: Vec<bool> = "#####.##.##.#.#######.###".chars().map(|c| c == '#').collect();
        let picture = Picture::filled(5, 5, [9; 3]);
        let mut mask = vec![true; 25];
        mask[13] = false;
        let truth = Truth { frame: 1, picture: picture.clone(), mask: Some(mask) };
        let holes = Holes::new(1, &truth, &picture, &reached, None);
        // 5 and 21 lie at the border, 13 is not counted by the truth.
        let set = |cells: &[bool]| (0..25).filter(|&cell| cells[cell]).collect::<Vec<_>>();
        assert_eq!(set(&holes.all), [5, 8, 11, 21]);
        assert_eq!(set(&holes.disoccluded), [8, 11]);
        assert_eq!(set(&holes.with_border(None).disoccluded), [5, 8, 11, 21]);
        assert_eq!((holes.warped.pixels[13], holes.warped.pixels[0]), ([0; 3], [9; 3]));
        assert_eq!(holes.largest().map(|largest| largest.0), Some(1));
    }
}
