//! What is reported, as it is written to JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::causes::FrameCauses;
use super::frames::{FrameError, Summary};
use super::rates::{Age, Rate};
use crate::engine;
use crate::study::timing::{Effort, Noise, Time};

/// What a point is run by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// galpix.
    Galpix,
    /// The same scheme in 32-bit floats.
    F32,
    /// galpix as stationary sources.
    Source,
}

impl Scheme {
    /// Returns what runs a scheme of the engine.
    #[must_use]
    pub const fn of(scheme: engine::Scheme) -> Self {
        match scheme {
            engine::Scheme::Map => Self::Galpix,
            engine::Scheme::Source => Self::Source,
        }
    }
}

/// One configuration: a point of the plots.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Point {
    /// Its number, from 1.
    pub id: usize,
    /// galpix or floats.
    pub scheme: Scheme,
    /// Fields kept.
    #[serde(rename = "lanes")]
    pub fields: &'static str,
    /// The budget, by how it departs from the derived one.
    pub budget: String,
    /// The widths in x: position's fraction, velocity's integer and fraction, acceleration's integer and fraction.
    pub bits: Option<[u32; 5]>,
    /// Rounding of positions.
    pub rounding: Option<&'static str>,
    /// What is put into holes.
    #[serde(rename = "rung")]
    pub fill: &'static str,
    /// Bytes a stored galpixel takes.
    pub bytes: usize,
    /// Bits of them in use.
    pub used_bits: u32,
    /// Fields clamped with the update and in all frames.
    pub saturated: u64,
    /// The time with the budget chosen at run time, as the simulator runs it; none for floats.
    pub run_time: Option<Time>,
    /// The time in the form of a product: with the budget fixed at compile time; none for fields without a stand-in,
    /// and for stationary sources.
    pub compile_time: Option<Time>,
    /// The compile-time budget that `compile_time` was measured with; none for fields that have none, and for floats,
    /// which are themselves.
    pub stand_in: Option<String>,
    /// All frames together.
    pub summary: Summary,
    /// The frames that were looked at.
    pub frames: Vec<FrameError>,
}

impl Point {
    /// Returns what its position error can be at most: the bound, or more where that was measured, for galpixels that a
    /// range stopped are outside of it.
    #[must_use]
    pub fn at_most_px(&self) -> Option<f64> {
        self.summary.bound_px.map(|bound| bound.max(self.summary.worst_px.unwrap_or(0.0)))
    }

    /// Returns what it is, in a few words.
    #[must_use]
    pub fn name(&self) -> String {
        match self.rounding {
            Some(rounding) => {
                let sources = if self.scheme == Scheme::Source { ", stationary sources" } else { "" };
                format!("{}, {}, {}, {}{sources}", self.fields, self.budget, rounding, self.fill)
            }
            None => format!("f32, {}, {}", self.fields, self.fill),
        }
    }
}

/// The points that nothing beats, by number, from quick to slow (from small to large).
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct Fronts {
    /// Compile-time form against what the position error can be at most.
    pub position: Vec<usize>,
    /// Compile-time form against FLIP.
    pub picture: Vec<usize>,
    /// Bytes per galpixel against what the position error can be at most.
    pub bytes: Vec<usize>,
    /// Neighbours on `position` whose times are not told apart.
    pub position_not_told_apart: Vec<[usize; 2]>,
    /// The same of `picture`.
    pub picture_not_told_apart: Vec<[usize; 2]>,
}

/// The design numbers of the derived budget.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct DemandReport {
    /// `D` in pixels.
    pub extent: u32,
    /// `tau_recog` in frames.
    pub recog: u32,
    /// `tau_prop` in frames.
    pub prop: u32,
}

/// Everything about one source.
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
    /// Cells of the map, margin included.
    pub cells: usize,
    /// Frames extrapolated.
    pub frames: u32,
    /// The derived budget's design numbers.
    pub demand: DemandReport,
    /// The frames that were looked at.
    pub looked_at: Vec<u32>,
    /// The frames whose pictures were compared.
    pub pictures: Vec<u32>,
    /// How often frames were timed.
    pub effort: Effort,
    /// How noisy the machine was while times were taken.
    pub noise: Option<Noise>,
    /// galpix and floats.
    pub points: Vec<Point>,
    /// What nothing beats.
    pub fronts: Fronts,
    /// Sample-and-hold over the same frames.
    pub hold: Summary,
    /// The first point's error, frame by frame, by cause.
    pub causes: Vec<FrameCauses>,
    /// Updates every N frames; only where a scene can be rendered anew.
    pub rates: Vec<Rate>,
    /// galpix and sample-and-hold by the age of the update, where a true picture is known.
    pub ages: Vec<Age>,
    /// What was left out and what cannot be known, a sentence each.
    pub left_out: Vec<String>,
}
