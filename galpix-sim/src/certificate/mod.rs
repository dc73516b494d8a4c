//! The certificate of a budget: the worst-case position error of a galpixel, in pixels, over all states.
//!
//! The error after `n` frames has two parts. **Quantisation**: position, velocity and acceleration were stored to
//! nearest, each at most half of its last bit off, which grows with 1, n and n²/2. **Drift**: each frame drops `down`
//! bits of `2v + a` after adding a threshold `t`; with `u` the low bits of `2v + a`, the frame's error is `t - (u + t)
//! mod 2^down` of those bits. That depends on `v mod 2^(down-1)` and `a mod 2^down` only, and so do all later frames,
//! because `v += a`: these residue classes, times the phases of the frame counter, are enumerated completely. The lemma
//! is proved in `docs/error-bounds.md`.
//!
//! What scan-out adds, [`shown_off_px`], is not included: it does not accumulate. A galpixel that saturates is counted,
//! and not covered by the certificate.

mod drift;
mod smallest;
#[cfg(test)]
mod tests;

use galpix_core::Rounding;
use galpix_core::record::Scale;
use schemars::JsonSchema;
use serde::Serialize;

use crate::engine::ScanOut;
use drift::Drift;
pub use smallest::{Unreachable, smallest};

/// The worst case after one frame, in pixels, by cause.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FrameBound {
    /// Frames since the update.
    pub frame: u32,
    /// From storing the position.
    pub position_px: f64,
    /// From storing the velocity.
    pub velocity_px: f64,
    /// From storing the acceleration.
    pub acceleration_px: f64,
    /// From storing all three: their sum.
    pub quantisation_px: f64,
    /// From rounding in each frame.
    pub drift_px: f64,
}

impl FrameBound {
    /// Returns the quantisation and drift.
    #[must_use]
    pub fn total_px(&self) -> f64 {
        self.quantisation_px + self.drift_px
    }
}

/// How a drift was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Every residue class was run from every phase: the bound is reached by a state.
    Enumerated,
    /// There are too many classes: each frame is off by less than a step of the position, which is no tight bound.
    Bounded,
}

/// The worst case over all states of a component, for all frames up to `tau_prop`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Certificate {
    /// Quantisation after `tau_prop` frames, in pixels.
    pub quantisation_px: f64,
    /// The largest drift after any frame up to `tau_prop`, in pixels.
    pub drift_px: f64,
    /// The largest sum of both after any frame up to `tau_prop`.
    pub total_px: f64,
    /// The largest drift if the update enters at any frame of the counter. Differs from `drift_px` for searched tables
    /// only, which are certified for updates that enter at frame 0.
    pub drift_any_phase_px: f64,
    /// How the drift was found.
    pub method: Method,
    /// Residue classes of velocity and acceleration.
    pub classes: u64,
    /// Phases of the frame counter.
    pub phases: u64,
    /// Frame by frame.
    pub frames: Vec<FrameBound>,
}

impl Certificate {
    /// Creates the certificate of one component for `prop` frames.
    #[must_use]
    pub fn of(scale: &Scale, has_acceleration: bool, rounding: Rounding, prop: u32) -> Self {
        let drift = Drift::of(scale, has_acceleration, rounding, prop);
        Self::with(scale, has_acceleration, prop, &drift)
    }

    fn with(scale: &Scale, has_acceleration: bool, prop: u32, drift: &Drift) -> Self {
        let unit = 0.5f64.powi((scale.position_frac + scale.down) as i32);
        let frames: Vec<FrameBound> = (1..=prop)
            .zip(&drift.by_frame)
            .map(|(frame, &drift)| {
                let [position_px, velocity_px, acceleration_px] = quantisation(scale, has_acceleration, frame);
                FrameBound {
                    frame,
                    position_px,
                    velocity_px,
                    acceleration_px,
                    quantisation_px: position_px + velocity_px + acceleration_px,
                    drift_px: drift as f64 * unit,
                }
            })
            .collect();
        let quantisation_px = frames.last().map_or(0.0, |frame| frame.quantisation_px);
        let drift_px = frames.iter().map(|frame| frame.drift_px).fold(0.0, f64::max);
        Self {
            quantisation_px,
            drift_px,
            total_px: frames.iter().map(FrameBound::total_px).fold(0.0, f64::max),
            drift_any_phase_px: drift.any_phase as f64 * unit,
            method: drift.method,
            classes: drift.classes,
            phases: drift.phases,
            frames,
        }
    }

    /// Returns whether the paper's promise holds: a galpixel is within one pixel of its true place for `tau_prop`
    /// frames.
    #[must_use]
    pub fn keeps_one_pixel(&self) -> bool {
        self.total_px <= 1.0
    }

    /// Returns the bound after `frame` frames, in pixels; beyond `tau_prop` nothing is certified.
    #[must_use]
    pub fn after(&self, frame: u32) -> Option<f64> {
        Some(self.frames.get(frame.checked_sub(1)? as usize)?.total_px())
    }
}

/// Returns by how much the place where a galpixel is shown differs at most from its position, in pixels and in each
/// component. Nearest shows it in the middle of a cell; sub-cell to the nearest 16th of a cell.
#[must_use]
pub fn shown_off_px(scan_out: ScanOut, position_frac: u32) -> f64 {
    let step: f64 = match scan_out {
        ScanOut::Nearest => 1.0,
        ScanOut::SubCell => 1.0 / 16.0,
    };
    if 0.5f64.powi(position_frac as i32) < step { step / 2.0 } else { 0.0 }
}

/// Returns the largest errors after `frame` frames from storing position, velocity and acceleration to nearest, in
/// pixels.
fn quantisation(scale: &Scale, has_acceleration: bool, frame: u32) -> [f64; 3] {
    let half_of_last_bit = |frac: u32| 0.5f64.powi(frac as i32 + 1);
    let n = f64::from(frame);
    let acceleration = if has_acceleration { n * n / 2.0 * half_of_last_bit(scale.acceleration_frac) } else { 0.0 };
    [half_of_last_bit(scale.position_frac), n * half_of_last_bit(scale.velocity_frac), acceleration]
}
