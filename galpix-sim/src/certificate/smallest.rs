//! The inverse: the smallest budget whose certificate keeps a given error.

use std::collections::HashMap;

use galpix_core::Rounding;
use galpix_core::record::{Component, Scale};

use super::drift::{Drift, MOST_DOWN};
use super::{Certificate, quantisation};

/// Fraction bits of a position, and of a velocity, that are tried: what [`Component::checked`] can let pass.
const MOST_FRAC: u32 = 29;

/// No budget keeps the error.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "no budget certifies {asked} px for {prop} frames with {} rounding: the finest fields that the arithmetic carries do \
     not get below {best:.6} px; ask for a larger error or for fewer frames",
    rounding.name()
)]
pub struct Unreachable {
    /// The requested error, in pixels.
    pub asked: f64,
    /// For how many frames.
    pub prop: u32,
    /// With which rounding.
    pub rounding: Rounding,
    /// No candidate's certificate is smaller than this, in pixels.
    pub best: f64,
}

/// Returns the component of the fewest motion bits, with the integer bits of `ranges`, whose certificate for `prop`
/// frames is at most `max_error` pixels; of several, the one with the smallest error.
///
/// *Errors:* if there is none.
pub fn smallest(
    ranges: Component,
    rounding: Rounding,
    prop: u32,
    max_error: f64,
) -> Result<(Component, Certificate), Unreachable> {
    let has_acceleration = ranges.has_acceleration();
    let mut candidates: Vec<Component> = candidates(ranges).collect();
    candidates.sort_by_key(|component| component.motion_bits());
    let mut drifts: HashMap<(u32, u32), (Drift, Option<Drift>)> = HashMap::new();
    let mut found: Option<(Component, Certificate)> = None;
    let mut best = f64::INFINITY;
    for component in candidates {
        if found.as_ref().is_some_and(|(smaller, _)| smaller.motion_bits() < component.motion_bits()) {
            break;
        }
        let scale = Scale::new(component, component.position_frac);
        let quantised: f64 = quantisation(&scale, has_acceleration, prop).iter().sum();
        let goal = max_error.max(best);
        if quantised > goal || scale.down > MOST_DOWN {
            continue;
        }
        // The drift of some states excludes most candidates; all states are run for the rest.
        let (some, drift) = drifts
            .entry((scale.down, scale.acceleration_up))
            .or_insert_with(|| (Drift::sampled(&scale, has_acceleration, rounding, prop), None));
        let at_least = Certificate::with(&scale, has_acceleration, prop, some).total_px;
        best = best.min(at_least);
        if at_least > max_error {
            continue;
        }
        let drift = drift.get_or_insert_with(|| Drift::of(&scale, has_acceleration, rounding, prop));
        let certificate = Certificate::with(&scale, has_acceleration, prop, drift);
        let better = found.as_ref().is_none_or(|(_, other)| certificate.total_px < other.total_px);
        if certificate.total_px <= max_error && better {
            found = Some((component, certificate));
        }
    }
    found.ok_or(Unreachable { asked: max_error, prop, rounding, best })
}

/// Returns all components with these integer bits that can exist.
fn candidates(ranges: Component) -> impl Iterator<Item = Component> {
    let accelerations = move |velocity_frac| if ranges.has_acceleration() { 0..=velocity_frac } else { 0..=0 };
    (0..=16).flat_map(move |position_frac| {
        (0..=MOST_FRAC).flat_map(move |velocity_frac| {
            accelerations(velocity_frac).filter_map(move |acceleration_frac| {
                Component { position_frac, velocity_frac, acceleration_frac, ..ranges }.checked().ok()
            })
        })
    })
}
