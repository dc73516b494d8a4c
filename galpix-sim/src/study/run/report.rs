//! What a run reports, as it is written to JSON.

use std::collections::BTreeMap;

use galpix_core::{Bits, Demand, Record};
use schemars::JsonSchema;
use serde::Serialize;

use crate::certificate::Certificate;
use crate::engine::LoadTally;
use crate::metric::measures::Measures;
use crate::output::measures::Measured;
use crate::source::capture::Census;
use crate::source::hidden::HiddenReport;

/// The widths in use, as they are reported.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct BudgetReport {
    /// `D` in pixels.
    pub extent: u32,
    /// `tau_recog` in frames.
    pub recog: u32,
    /// `tau_prop` in frames.
    pub prop: u32,
    /// Equation (11).
    pub position_frac_bits: u32,
    /// Equation (8).
    pub velocity_int_bits: u32,
    /// Equation (13).
    pub velocity_frac_bits: u32,
    /// Equation (9).
    pub acceleration_int_bits: u32,
    /// Equation (12).
    pub acceleration_frac_bits: u32,
    /// Equation (14).
    pub motion_bits_per_component: u32,
    /// Of the components that move, in bytes.
    pub motion_bytes_per_galpixel: f64,
    /// With colour, depth and flags, in whole words.
    pub stored_bytes_per_galpixel: usize,
}

impl BudgetReport {
    /// Reports the widths of a stored form, and the design numbers that they come from.
    #[must_use]
    pub fn of(demand: Demand, bits: Bits, record: &Record) -> Self {
        let layout = record.layout();
        let moves = [(bits.x, layout.velocity), (bits.y, layout.velocity), (bits.z, layout.depth_motion)];
        let motion_bits: u32 = moves.iter().map(|(axis, moves)| if *moves { axis.motion_bits() } else { 0 }).sum();
        Self {
            extent: demand.extent,
            recog: demand.recog,
            prop: demand.prop,
            position_frac_bits: bits.x.position_frac,
            velocity_int_bits: bits.x.velocity_int,
            velocity_frac_bits: bits.x.velocity_frac,
            acceleration_int_bits: bits.x.acceleration_int,
            acceleration_frac_bits: bits.x.acceleration_frac,
            motion_bits_per_component: bits.x.motion_bits(),
            motion_bytes_per_galpixel: f64::from(motion_bits) / 8.0,
            stored_bytes_per_galpixel: record.bytes(),
        }
    }
}

/// What the comparison with a truth gave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TruthReport {
    /// Of the whole picture.
    pub psnr_db: Option<f64>,
    /// Of the unmoved picture of the update.
    pub psnr_hold_db: Option<f64>,
    /// Of the cells that a galpixel of the update reached.
    pub psnr_known_db: Option<f64>,
    /// Of the cells that are not missing in connection with the border: what enters there is known to nobody.
    pub psnr_inside_db: Option<f64>,
    /// Structural similarity.
    pub ssim: Option<f64>,
    /// Mean FLIP.
    pub flip: Option<f64>,
    /// Cells of the truth that no galpixel of the update reached, before anything was put there.
    pub missing: u64,
    /// The same, per cent of the cells that the truth counts.
    pub missing_percent: f64,
    /// Of the missing cells, how many are connected with the border: what enters the picture.
    pub missing_at_border: u64,
    /// Cells that `psnr_inside_db` is over: the same for all schemes and fills.
    pub inside: u64,
    /// Against the frame before, where its truth is known too.
    pub change: Option<ChangeReport>,
}

impl TruthReport {
    /// Returns what every table has of it.
    #[must_use]
    pub fn measures(&self) -> Measures {
        Measures {
            psnr_db: self.psnr_db,
            psnr_inside_db: self.psnr_inside_db,
            change_error: self.change.and_then(|change| change.error),
            judder_px: self.change.and_then(|change| change.judder_px),
            missing_percent: Some(self.missing_percent),
        }
    }
}

/// How a frame differs from the one before, against how the truths differ: over the cells that are inside in both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ChangeReport {
    /// Mean of |change shown - true change| of luma, in code values: the temporal error.
    pub error: Option<f64>,
    /// Mean of |true change| of luma.
    pub truth: Option<f64>,
    /// Root mean square change of the displacement of blocks of 16x16 cells against the truth, in pixels; not of the
    /// first frame.
    pub judder_px: Option<f64>,
}

/// How far galpixels of the update are from where they should be, in pixels, before the snap to a cell; of each
/// galpixel the larger of x and y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PositionReport {
    /// The worst, against the exact second-order path of the update's motion: what the certificate bounds.
    pub worst_px: f64,
    /// The mean, against the same path.
    pub mean_px: f64,
    /// The worst, against the true motion, where that is known: with what second order cannot know.
    pub truth_worst_px: Option<f64>,
    /// The mean, against the true motion.
    pub truth_mean_px: Option<f64>,
}

/// One frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FrameReport {
    /// Frames since the update.
    pub frame: u32,
    /// Cells that nothing reached in this frame.
    pub holes: u32,
    /// Of these, how many something was put into.
    pub filled: u32,
    /// Filled as bullet holes.
    pub bullets: u32,
    /// Just unobscured: filled with debris.
    pub debris: u32,
    /// Just unobscured: filled with a delayed galpixel.
    pub galdebris: u32,
    /// Left the map over its border.
    pub lost: u32,
    /// Discarded in collisions.
    pub collided: u32,
    /// Fields clamped to their range.
    pub saturated: u32,
    /// Cells on the edge of a surface.
    pub edges: u32,
    /// Time of the engine for each galpixel moved.
    pub ns_per_galpixel: f64,
    /// Of the galpixels of the update that are still on the map.
    pub position: Option<PositionReport>,
    /// The certificate for the first of these up to this frame; none beyond `tau_prop`.
    pub certified_px: Option<f64>,
    /// Cells of the display that show a galpixel of a layer behind the first, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_hidden: Option<u32>,
    /// Where a truth is known.
    pub truth: Option<TruthReport>,
}

impl Measured for FrameReport {
    fn measures(&self) -> Measures {
        self.truth.as_ref().map(TruthReport::measures).unwrap_or_default()
    }
}

/// A whole run.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RunReport {
    /// Scene or capture.
    pub source: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// The widths.
    pub budget: BudgetReport,
    /// Rounding of positions.
    pub rounding: &'static str,
    /// Fill mode.
    pub fill: &'static str,
    /// Laplacian threshold, in units of the depth's last bit.
    pub edge_threshold: u32,
    /// How galpixels moved.
    pub scheme: &'static str,
    /// How cells became pixels.
    pub scan_out: &'static str,
    /// Median over the frames.
    pub ns_per_galpixel: f64,
    /// What entered with the update.
    #[schemars(with = "BTreeMap<String, u32>")]
    pub loaded: LoadTally,
    /// Which hidden samples were handed over, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hidden: Option<HiddenReport>,
    /// What was known of a capture's cells.
    #[schemars(with = "Option<BTreeMap<String, serde_json::Value>>")]
    pub census: Option<Census>,
    /// The certificate in x and y.
    pub certificate: Certificate,
    /// The certificate's total, what scan-out adds, and what the steps of a coarse motion add: how far in x and in y a
    /// galpixel is shown at most from where it should be, in pixels.
    pub displayed_px: f64,
    /// The frames from 1 on.
    pub frames: Vec<FrameReport>,
}

impl RunReport {
    /// Returns whether SSIM and FLIP were worked out.
    #[must_use]
    pub fn perceptual(&self) -> bool {
        self.frames.iter().any(|frame| frame.truth.is_some_and(|truth| truth.flip.is_some()))
    }
}

impl Measured for RunReport {
    fn measures(&self) -> Measures {
        Measures::mean(self.frames.iter().map(FrameReport::measures))
    }
}
