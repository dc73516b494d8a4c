//! The error of frames: of each that was looked at, and of all of them in one.

use schemars::JsonSchema;
use serde::Serialize;

use crate::metric::measures::Measures;
use crate::metric::stats;
use crate::study::run::TruthReport;

/// A frame that was looked at. Positions are those of galpixels of the update, before the snap to a cell, the worse of
/// x and y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FrameError {
    /// Frames since the update.
    pub frame: u32,
    /// Galpixels of the update that are still on the map.
    pub galpixels: u32,
    /// Of these, those that a range had to stop: outside of the certificate.
    pub saturated_galpixels: u32,
    /// The worst of the others, against the exact path of the fields that are kept: at most `certified_px`.
    pub kept_worst_px: Option<f64>,
    /// The certificate for this frame; none for floats and beyond `tau_prop`.
    pub certified_px: Option<f64>,
    /// What the fields that are left out would at most have moved a galpixel by.
    pub left_out_px: f64,
    /// The worst of all, against the exact second-order path.
    pub worst_px: Option<f64>,
    /// The mean of all, against the same path.
    pub mean_px: Option<f64>,
    /// The worst of all, against the true motion, where that is known.
    pub truth_worst_px: Option<f64>,
    /// The mean of all, against the true motion.
    pub truth_mean_px: Option<f64>,
    /// Where a true picture was compared with.
    pub picture: Option<TruthReport>,
}

impl FrameError {
    /// Creates a frame of which nothing is known yet.
    #[must_use]
    pub const fn at(frame: u32) -> Self {
        Self {
            frame,
            galpixels: 0,
            saturated_galpixels: 0,
            kept_worst_px: None,
            certified_px: None,
            left_out_px: 0.0,
            worst_px: None,
            mean_px: None,
            truth_worst_px: None,
            truth_mean_px: None,
            picture: None,
        }
    }
}

/// All frames of a point in one figure each: worst positions and bounds are the largest, the others means over the
/// frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Summary {
    /// See [`FrameError::worst_px`].
    pub worst_px: Option<f64>,
    /// See [`FrameError::mean_px`].
    pub mean_px: Option<f64>,
    /// See [`FrameError::truth_worst_px`].
    pub truth_worst_px: Option<f64>,
    /// See [`FrameError::truth_mean_px`].
    pub truth_mean_px: Option<f64>,
    /// What `worst_px` can at most be where nothing saturates: the certificate and what was left out, together.
    pub bound_px: Option<f64>,
    /// The certificate alone.
    pub certified_px: Option<f64>,
    /// What every table has of the pictures.
    #[serde(flatten)]
    pub measures: Measures,
    /// PSNR over the cells that a galpixel reached.
    pub psnr_known_db: Option<f64>,
    /// Structural similarity.
    pub ssim: Option<f64>,
    /// Mean FLIP.
    pub flip: Option<f64>,
}

impl Summary {
    /// Of some frames.
    #[must_use]
    pub fn of(frames: &[FrameError]) -> Self {
        let worst = |column: &dyn Fn(&FrameError) -> Option<f64>| frames.iter().filter_map(column).reduce(f64::max);
        let mean = |column: &dyn Fn(&FrameError) -> Option<f64>| stats::mean(frames.iter().filter_map(column));
        let of_pictures = |column: &dyn Fn(&TruthReport) -> Option<f64>| mean(&|frame| column(&frame.picture?));
        let pictures = frames.iter().filter_map(|frame| frame.picture.as_ref());
        // A bound that is missing in one frame is none.
        let bound = |column: &dyn Fn(&FrameError) -> Option<f64>| {
            frames.iter().map(column).try_fold(0.0, |most: f64, bound| Some(most.max(bound?)))
        };
        Self {
            worst_px: worst(&|frame| frame.worst_px),
            mean_px: mean(&|frame| frame.mean_px),
            truth_worst_px: worst(&|frame| frame.truth_worst_px),
            truth_mean_px: mean(&|frame| frame.truth_mean_px),
            bound_px: bound(&|frame| Some(frame.certified_px? + frame.left_out_px)),
            certified_px: bound(&|frame| frame.certified_px),
            measures: Measures::mean(pictures.map(TruthReport::measures)),
            psnr_known_db: of_pictures(&|picture| picture.psnr_known_db),
            ssim: of_pictures(&|picture| picture.ssim),
            flip: of_pictures(&|picture| picture.flip),
        }
    }
}
