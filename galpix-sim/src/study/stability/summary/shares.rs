//! The shares of an error: the largest of a path, and frame by frame.

use schemars::JsonSchema;
use serde::Serialize;

use super::super::causes::Row;
use super::super::exact::Px;
use super::super::setting::Law;

/// The largest error by cause, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Shares {
    /// What position, velocity and acceleration cannot know.
    pub taylor_px: f64,
    /// From storing them.
    pub quantisation_px: f64,
    /// From rounding in each frame.
    pub drift_px: f64,
    /// From showing a cell.
    pub snapping_px: f64,
    /// From clamped fields.
    pub saturation_px: f64,
    /// The cell shown from the true place.
    pub total_px: f64,
    /// Quantisation and drift together, where no field was clamped.
    pub arithmetic_px: f64,
    /// The law for these two in the last frame before an update.
    pub bound_px: f64,
    /// The largest part of its bound that is reached in any frame after an update.
    pub of_bound: f64,
    /// The same scheme in `f32`, from the exact path.
    pub f32_px: f64,
    /// The same scheme in `f64`, from the exact path.
    pub f64_px: f64,
}

/// One frame of a path, in pixels with their signs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[allow(missing_docs)] // as in `Shares`
pub struct SeriesRow {
    pub frame: u32,
    pub since_update: u32,
    pub true_px: f64,
    pub shown_px: f64,
    pub taylor_px: f64,
    pub quantisation_px: f64,
    pub drift_px: f64,
    pub snapping_px: f64,
    pub saturation_px: f64,
    pub bound_px: f64,
    pub certified: bool,
    pub f32_px: f64,
    pub f64_px: f64,
}

impl Shares {
    /// Creates the shares of one frame, without their signs.
    pub fn of(row: &Row, law: &Law, aligned: bool) -> Self {
        let causes = &row.causes;
        let px = |share: Px| share.abs().to_f64();
        let arithmetic_px = if row.saturated { 0.0 } else { px(causes.quantisation + causes.drift) };
        let bound_px = law.bound_px(row.since, aligned);
        Self {
            taylor_px: px(causes.taylor),
            quantisation_px: px(causes.quantisation),
            drift_px: px(causes.drift),
            snapping_px: px(causes.snapping),
            saturation_px: px(causes.saturation),
            total_px: px(row.place - row.shown),
            arithmetic_px,
            bound_px,
            of_bound: if row.since > 0 { arithmetic_px / bound_px } else { 0.0 },
            f32_px: row.f32_px.abs(),
            f64_px: row.f64_px.abs(),
        }
    }

    /// Returns the larger of both, share by share.
    pub fn with(self, other: Self) -> Self {
        Self {
            taylor_px: self.taylor_px.max(other.taylor_px),
            quantisation_px: self.quantisation_px.max(other.quantisation_px),
            drift_px: self.drift_px.max(other.drift_px),
            snapping_px: self.snapping_px.max(other.snapping_px),
            saturation_px: self.saturation_px.max(other.saturation_px),
            total_px: self.total_px.max(other.total_px),
            arithmetic_px: self.arithmetic_px.max(other.arithmetic_px),
            bound_px: self.bound_px.max(other.bound_px),
            of_bound: self.of_bound.max(other.of_bound),
            f32_px: self.f32_px.max(other.f32_px),
            f64_px: self.f64_px.max(other.f64_px),
        }
    }
}

/// Returns a frame of a path as it is reported.
pub fn series(row: &Row, law: &Law, aligned: bool) -> SeriesRow {
    let causes = &row.causes;
    SeriesRow {
        frame: row.frame,
        since_update: row.since,
        true_px: row.place.to_f64(),
        shown_px: row.shown.to_f64(),
        taylor_px: causes.taylor.to_f64(),
        quantisation_px: causes.quantisation.to_f64(),
        drift_px: causes.drift.to_f64(),
        snapping_px: causes.snapping.to_f64(),
        saturation_px: causes.saturation.to_f64(),
        bound_px: law.bound_px(row.since, aligned),
        certified: row.since <= law.certified && !row.saturated,
        f32_px: row.f32_px,
        f64_px: row.f64_px,
    }
}
