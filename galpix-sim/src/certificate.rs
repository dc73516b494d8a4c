//! The certificate of a budget: the worst-case position error of a galpixel, in pixels, over all states.
//!
//! The error after `n` frames has two parts. **Quantisation**: position, velocity and acceleration were stored to nearest,
//! each at most half of its last bit off, which grows with 1, n and n²/2. **Drift**: each frame drops `down` bits of
//! `2v + a` after adding a threshold `t`; with `u` the low bits of `2v + a`, the frame's error is `t - (u + t) mod 2^down`
//! of those bits. That depends on `v mod 2^(down-1)` and `a mod 2^down` only, and so do all later frames, because
//! `v += a`: these residue classes, times the phases of the frame counter, are enumerated completely.
//!
//! The snap to a cell, at most half a pixel, is the same for any method and stands apart. A galpixel that saturates is
//! counted, and outside of the certificate.

use galpix_core::record::Scale;
use galpix_core::rounding::Rounding;
use serde::Serialize;

/// The worst case after one frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameBound {
    /// Frames since the update.
    pub frame: u32,
    /// From storing position, velocity and acceleration, in pixels.
    pub quantisation_px: f64,
    /// From rounding in each frame, in pixels.
    pub drift_px: f64,
}

/// The worst case over all states of a component, for all frames up to `tau_prop`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certificate {
    /// Quantisation after `tau_prop` frames, in pixels.
    pub quantisation_px: f64,
    /// The largest drift after any frame up to `tau_prop`, in pixels.
    pub drift_px: f64,
    /// Their sum.
    pub total_px: f64,
    /// Frame by frame.
    pub frames: Vec<FrameBound>,
}

/// Beyond this many dropped bits the phases are too many to enumerate, and a coarser bound is stated.
const ENUMERATED_DOWN: u32 = 8;

impl Certificate {
    /// The certificate of one component for `prop` frames.
    #[must_use]
    pub fn of(scale: &Scale, has_acceleration: bool, rounding: Rounding, prop: u32) -> Self {
        let last_bit = |frac: u32| 0.5f64.powi(frac as i32);
        let drift = drift_by_frame(scale, has_acceleration, rounding, prop);
        let frames: Vec<FrameBound> = (1..=prop)
            .zip(&drift)
            .map(|(frame, &drift_px)| {
                let n = f64::from(frame);
                let acceleration =
                    if has_acceleration { n * n / 2.0 * last_bit(scale.acceleration_frac + 1) } else { 0.0 };
                FrameBound {
                    frame,
                    quantisation_px: last_bit(scale.position_frac + 1)
                        + n * last_bit(scale.velocity_frac + 1)
                        + acceleration,
                    drift_px,
                }
            })
            .collect();
        let quantisation_px = frames.last().map_or(0.0, |frame| frame.quantisation_px);
        let drift_px = frames.iter().map(|frame| frame.drift_px).fold(0.0, f64::max);
        Self { quantisation_px, drift_px, total_px: quantisation_px + drift_px, frames }
    }

    /// Whether the paper's promise holds: a galpixel is within one pixel of its true place for `tau_prop` frames.
    #[must_use]
    pub fn keeps_one_pixel(&self) -> bool {
        self.total_px <= 1.0
    }

    /// The bound after `frame` frames, in pixels; beyond `tau_prop` nothing is certified.
    #[must_use]
    pub fn after(&self, frame: u32) -> Option<f64> {
        let bound = self.frames.get(frame.checked_sub(1)? as usize)?;
        Some(bound.quantisation_px + bound.drift_px)
    }
}

/// The largest drift after each of the frames 1 to `prop`, in pixels.
fn drift_by_frame(scale: &Scale, has_acceleration: bool, rounding: Rounding, prop: u32) -> Vec<f64> {
    let down = scale.down;
    let unit = 0.5f64.powi((scale.position_frac + down) as i32);
    if down == 0 {
        return vec![0.0; prop as usize];
    }
    if down > ENUMERATED_DOWN {
        // Each frame is off by less than one step of the position.
        return (1..=prop).map(|n| f64::from(n) * unit * f64::from((1u32 << down) - 1)).collect();
    }
    let modulus = 1i64 << down;
    let phases = if rounding == Rounding::LowDiscrepancy { 1u32 << down } else { 1 };
    let accelerations = if has_acceleration { modulus } else { 1 };
    let mut worst = vec![0i64; prop as usize];
    for phase in 0..phases {
        let thresholds: Vec<i64> =
            (0..prop).map(|n| i64::from(rounding.threshold(phase.wrapping_add(n), down))).collect();
        for a in 0..accelerations {
            let a = (a << scale.acceleration_up) & (modulus - 1);
            for v in 0..modulus / 2 {
                let (mut u, mut drift) = (2 * v + a, 0);
                for (worst, &threshold) in worst.iter_mut().zip(&thresholds) {
                    drift += threshold - ((u + threshold) & (modulus - 1));
                    *worst = (*worst).max(drift.abs());
                    u += 2 * a;
                }
            }
        }
    }
    worst.into_iter().map(|drift| drift as f64 * unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use galpix_core::budget::{Bits, Demand};
    use galpix_core::layout::Lanes;
    use galpix_core::record::Record;

    fn certificate(prop: u32, rounding: Rounding) -> Certificate {
        let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop }).unwrap();
        let record = Record::plan(bits, Lanes::FULL, 24).unwrap();
        Certificate::of(&record.scales[0], true, rounding, prop)
    }

    /// (tau_prop, rounding, quantisation, drift, total), worked out by hand from the lemma.
    #[test]
    fn the_papers_widths() {
        use Rounding::{LowDiscrepancy, Nearest, Truncate};
        for (prop, rounding, quantisation, drift) in [
            (8, Truncate, 0.6875, 0.75),
            (8, Nearest, 0.6875, 0.5),
            (8, LowDiscrepancy, 0.6875, 0.25),
            (16, Truncate, 0.59375, 0.875),
            (16, Nearest, 0.59375, 0.5),
            (16, LowDiscrepancy, 0.59375, 0.25),
            (32, Truncate, 0.546875, 0.9375),
            (32, Nearest, 0.546875, 0.5),
            (32, LowDiscrepancy, 0.546875, 0.25),
        ] {
            let certificate = certificate(prop, rounding);
            assert_eq!(
                (certificate.quantisation_px, certificate.drift_px),
                (quantisation, drift),
                "{prop} {rounding:?}"
            );
            assert_eq!(certificate.keeps_one_pixel(), rounding == LowDiscrepancy, "{prop} {rounding:?}");
        }
    }
}
