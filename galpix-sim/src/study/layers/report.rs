//! What is reported, as it is written to JSON.

use schemars::JsonSchema;
use serde::Serialize;

use crate::metric::stats;
use crate::source::hidden::{HiddenReport, Strategy};
use crate::study::crops::{Crop, Largest};
use crate::study::timing::{Noise, Time};

/// The cells of a frame that the first layer alone leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct FrameCells {
    /// Frames since the update.
    pub frame: u32,
    /// Cells that no galpixel reached.
    pub missing: u64,
    /// Of these, those that are not connected with the border: what was hidden behind something.
    pub disoccluded: u64,
}

/// A strategy in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StrategyFrame {
    /// Frames since the update.
    pub frame: u32,
    /// Cells that no galpixel reached.
    pub missing: u64,
    /// Of the cells that are disoccluded with the first layer alone, those that no galpixel reached.
    pub disoccluded: u64,
    /// Of the whole picture, decibels; absent where it equals the truth.
    pub psnr_db: Option<f64>,
    /// FLIP of the whole picture.
    pub flip: Option<f64>,
    /// Over the cells that are disoccluded with the first layer alone, decibels.
    pub disoccluded_db: Option<f64>,
}

/// A strategy over all frames.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StrategyReport {
    /// Its name.
    pub name: String,
    /// What was handed over, where anything was.
    pub hidden: Option<HiddenReport>,
    /// The time of a frame, the fill included.
    pub time: Option<Time>,
    /// That time by the time of a frame of the first layer alone, in the same run.
    pub x_one: Option<f64>,
    /// Processor time of the disocclusion map, microseconds an update.
    pub update_us: Option<f64>,
    /// Missing cells of all frames.
    pub missing: u64,
    /// Of the disoccluded cells of all frames, those that are missing.
    pub disoccluded: u64,
    /// The mean over the frames, decibels.
    pub psnr_db: Option<f64>,
    /// The mean over the frames.
    pub flip: Option<f64>,
    /// Of the disoccluded cells of all frames together, decibels.
    pub disoccluded_db: Option<f64>,
    /// The frames with a truth.
    pub frames: Vec<StrategyFrame>,
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
    /// Frames extrapolated, which is the interval that is culled for.
    pub frames: u32,
    /// The frames with a truth, ascending.
    pub cells: Vec<FrameCells>,
    /// How noisy the machine was while times were taken.
    pub noise: Option<Noise>,
    /// The strategies; the first is that of the first layer alone.
    #[serde(rename = "ways")]
    pub strategies: Vec<StrategyReport>,
    /// The largest connected disoccluded area of all frames.
    pub largest: Largest,
    /// What was shown around it.
    #[serde(skip)]
    pub crops: Vec<Crop>,
    /// The update with its disocclusion map.
    #[serde(skip)]
    pub map: Option<Crop>,
}

impl StrategyReport {
    /// Creates the sums and means of its frames.
    #[must_use]
    pub fn of(strategy: Strategy, frames: Vec<StrategyFrame>) -> Self {
        let mean = |of: fn(&StrategyFrame) -> Option<f64>| stats::mean(frames.iter().filter_map(of));
        Self {
            name: strategy.name(),
            hidden: None,
            time: None,
            x_one: None,
            update_us: None,
            missing: frames.iter().map(|frame| frame.missing).sum(),
            disoccluded: frames.iter().map(|frame| frame.disoccluded).sum(),
            psnr_db: mean(|frame| frame.psnr_db),
            flip: mean(|frame| frame.flip),
            disoccluded_db: mean(|frame| frame.disoccluded_db),
            frames,
        }
    }
}

impl SourceReport {
    /// Returns the strategy with this name.
    #[must_use]
    pub fn strategy(&self, name: &str) -> Option<&StrategyReport> {
        self.strategies.iter().find(|strategy| strategy.name == name)
    }

    /// Returns the disoccluded cells of all frames, with the first layer alone.
    #[must_use]
    pub fn disoccluded(&self) -> u64 {
        self.cells.iter().map(|frame| frame.disoccluded).sum()
    }
}
