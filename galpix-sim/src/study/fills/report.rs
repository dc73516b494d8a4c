//! What is reported, as it is written to JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::figures::{Figures, TruthFigures};
use crate::metric::measures::Measures;
use crate::study::crops::{Crop, Largest};
use crate::study::run::TruthReport;
use crate::study::timing::{Noise, Time};

/// The cells of a frame as the warp of the map leaves them, the same for all schemes and fills: those of `none`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FrameCells {
    /// Frames since the update.
    pub frame: u32,
    /// Cells that no galpixel of the update reached.
    pub missing: u64,
    /// Of these, those connected with the border.
    pub at_border: u64,
    /// Those that are judged: not connected with the border, and outside of the fovea.
    pub disoccluded: u64,
}

/// A fill in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FrameFigures {
    /// Frames since the update.
    pub frame: u32,
    /// Its figures.
    #[serde(flatten)]
    pub figures: Figures,
    /// The same over all cells that the warp leaves open, those connected with the border too.
    pub open: Figures,
    /// The whole picture, as `galpix run` compares it; without SSIM and FLIP.
    pub truth: TruthReport,
}

/// A fill over all frames.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FillReport {
    /// Its name.
    pub name: &'static str,
    /// The name of its files and marks.
    #[serde(skip)]
    pub label: String,
    /// How galpixels moved.
    pub scheme: &'static str,
    /// The power of partial validity, where it inpaints.
    pub gamma: Option<&'static str>,
    /// Whether what is nearer is kept out, where it inpaints.
    pub depth_aware: Option<bool>,
    /// The time of a frame, the fill included.
    pub time: Option<Time>,
    /// Means over the frames, by disoccluded cells.
    pub summary: Figures,
    /// The same over all cells that the warp leaves open, by their number.
    pub open: Figures,
    /// Means over the frames, each of them of the whole picture.
    pub measures: Measures,
    /// The frames with a truth.
    pub frames: Vec<FrameFigures>,
}

/// A source.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SourceReport {
    /// Scene or capture.
    pub source: String,
    /// What it shows.
    pub about: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// Frames extrapolated.
    pub frames: u32,
    /// How noisy the machine was while times were taken.
    pub noise: Option<Noise>,
    /// The frames with a truth, ascending.
    pub cells: Vec<FrameCells>,
    /// The truth's own figures at the same cells.
    pub truth: TruthFigures,
    /// The fills, from cheap to rich.
    pub fills: Vec<FillReport>,
    /// The largest connected disoccluded area of all frames.
    pub largest: Largest,
    /// What was shown around it.
    #[serde(skip)]
    pub crops: Vec<Crop>,
}

impl SourceReport {
    /// Returns the cells of all frames that the warp leaves open.
    #[must_use]
    pub fn missing(&self) -> u64 {
        self.cells.iter().map(|frame| frame.missing).sum()
    }

    /// Returns the disoccluded cells of all frames.
    #[must_use]
    pub fn disoccluded(&self) -> u64 {
        self.cells.iter().map(|frame| frame.disoccluded).sum()
    }
}
