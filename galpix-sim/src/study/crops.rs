//! What each fill shows around the largest disocclusion, and the truth.

use std::borrow::Cow;

use maud::{Markup, html};
use schemars::JsonSchema;
use serde::Serialize;

use super::holes::Holes;
use crate::metric::area::Window;
use crate::output::film;
use crate::output::html::{picture, text::count};
use crate::picture::Picture;

/// Cells around the area that are shown with it.
const MARGIN: usize = 10;
/// A part is magnified to about so many pixels, by a whole factor.
const SHOWN: usize = 300;
/// Cells of a side that are shown at least, and at most.
const SIDE: [usize; 2] = [40, 96];

/// The largest connected disoccluded area of all frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Largest {
    /// Frames since the update.
    pub frame: u32,
    /// Its cells.
    pub cells: usize,
    /// What is shown of the frame: columns and rows from the left and from the top.
    pub left: usize,
    /// The first row.
    pub top: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A part of a picture.
#[derive(Clone, Debug)]
pub struct Crop {
    /// What it shows.
    pub name: Cow<'static, str>,
    /// The part, not magnified.
    pub picture: Picture,
}

/// Returns the frame with the largest area, the first of several; `None` if nothing is disoccluded.
#[must_use]
pub fn largest(holes: &[Holes]) -> Option<Largest> {
    let areas = holes.iter().filter_map(|holes| Some((holes, holes.largest()?)));
    let (holes, (cells, area)) = areas.reduce(|best, next| if next.1.0 > best.1.0 { next } else { best })?;
    let side = (area.width.max(area.height) + 2 * MARGIN).clamp(SIDE[0], SIDE[1]);
    let Window { left, top, width, height } = area.resized([side; 2], [holes.truth.width, holes.truth.height]);
    Some(Largest { frame: holes.frame, cells, left, top, width, height })
}

/// Returns the part of a picture around the area.
#[must_use]
pub fn crop(name: impl Into<Cow<'static, str>>, picture: &Picture, at: &Largest) -> Crop {
    Crop { name: name.into(), picture: picture.crop(at.left, at.top, at.width, at.height) }
}

/// Returns the truth there, and what the warp left open.
#[must_use]
pub fn of_truth(holes: &[Holes], at: &Largest) -> Vec<Crop> {
    let frame = holes.iter().filter(|holes| holes.frame == at.frame);
    frame.flat_map(|holes| [crop("truth", &holes.truth, at), crop("warped", &holes.warped, at)]).collect()
}

/// Returns the parts as figures of a page, under a heading.
#[must_use]
pub fn html(source: &str, at: &Largest, crops: &[Crop]) -> Markup {
    html! {
        h3 { "The largest disocclusion: " (count(at.cells as u64)) " cells of frame " (at.frame) }
        div.crops { @for crop in crops { (crop.figure(source)) } }
    }
}

impl Crop {
    /// Returns the part as a figure of a page.
    #[must_use]
    pub fn figure(&self, source: &str) -> Markup {
        let magnified = self.magnified((SHOWN / self.picture.width.max(1)).clamp(1, 8));
        picture(&magnified, &format!("{source}: {}, magnified", self.name), &self.name)
    }

    /// Returns the part with each pixel as a square of `times` pixels.
    #[must_use]
    pub fn magnified(&self, times: usize) -> Picture {
        film::magnified(&self.picture, times)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_become_squares() {
        let picture = Picture { width: 2, height: 1, pixels: vec![[1; 3], [2; 3]] };
        let magnified = Crop { name: "".into(), picture }.magnified(2);
        assert_eq!((magnified.width, magnified.height), (4, 2));
        assert_eq!(magnified.pixels.iter().map(|pixel| pixel[0]).collect::<Vec<_>>(), [1, 1, 2, 2, 1, 1, 2, 2]);
    }
}
