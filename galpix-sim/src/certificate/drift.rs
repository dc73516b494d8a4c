//! The rounding drift, by complete enumeration.

use galpix_core::Rounding;
use galpix_core::record::Scale;
use rayon::prelude::*;

use super::Method;

/// Steps of a galpixel that are at most taken to enumerate: beyond, a coarser bound is stated.
const MOST_STEPS: u64 = 1 << 32;

/// Dropped bits beyond which there are more steps than that.
pub const MOST_DOWN: u32 = 10;

/// The worst drift over all states, in units of the last bit of `2v + a`.
pub struct Drift {
    /// After each of the frames 1 to `tau_prop`.
    pub by_frame: Vec<i64>,
    /// After any of them, from any phase of the frame counter.
    pub any_phase: i64,
    /// How it was found.
    pub method: Method,
    /// Residue classes of velocity and acceleration.
    pub classes: u64,
    /// Phases of the frame counter.
    pub phases: u64,
}

impl Drift {
    /// Creates the drift over some states only, from the first phase on: at most that of all of them.
    pub fn sampled(scale: &Scale, has_acceleration: bool, rounding: Rounding, prop: u32) -> Self {
        let down = scale.down;
        let accelerations = if has_acceleration { 1usize << down.saturating_sub(scale.acceleration_up) } else { 1 };
        let thresholds: Vec<i32> = (0..prop).map(|n| rounding.threshold(n, down)).collect();
        let some = (0..accelerations).step_by(accelerations.div_ceil(32));
        let runs = some.map(|a| worst_of(down, (a << scale.acceleration_up) as i32, &thresholds));
        let by_frame = runs.reduce(larger).unwrap_or_default();
        let any_phase = by_frame.iter().copied().max().unwrap_or(0);
        Self { by_frame, any_phase, method: Method::Enumerated, classes: 0, phases: 1 }
    }

    /// Creates the drift of a component over `prop` frames.
    pub fn of(scale: &Scale, has_acceleration: bool, rounding: Rounding, prop: u32) -> Self {
        let down = scale.down;
        // What an acceleration adds is a multiple of this; without one, 0 alone.
        let accelerations = if has_acceleration { 1u64 << down.saturating_sub(scale.acceleration_up) } else { 1 };
        let classes = accelerations << down.saturating_sub(1);
        let phases = match rounding {
            Rounding::Truncate | Rounding::Nearest => 1,
            Rounding::LowDiscrepancy | Rounding::Searched => 1u64 << down,
        };
        let steps = classes.saturating_mul(phases).saturating_mul(prop.into());
        if steps > MOST_STEPS {
            // Each frame is off by less than one step of the position.
            let by_frame: Vec<i64> = (1..=i64::from(prop)).map(|n| n * ((1 << down) - 1)).collect();
            let any_phase = by_frame.last().copied().unwrap_or(0);
            return Self { by_frame, any_phase, method: Method::Bounded, classes, phases };
        }
        let run = |phase: u64| -> Vec<i64> {
            let thresholds: Vec<i32> =
                (0..prop).map(|n| rounding.threshold((phase as u32).wrapping_add(n), down)).collect();
            (0..accelerations)
                .into_par_iter()
                .map(|a| worst_of(down, (a << scale.acceleration_up) as i32, &thresholds))
                .reduce(|| vec![0; prop as usize], larger)
        };
        // A searched table is certified from its first entry on.
        let aligned = run(0);
        let all = (1..phases).map(run).fold(aligned.clone(), larger);
        let any_phase = all.iter().copied().max().unwrap_or(0);
        let by_frame = if rounding == Rounding::Searched { aligned } else { all };
        Self { by_frame, any_phase, method: Method::Enumerated, classes, phases }
    }
}

fn larger(mut one: Vec<i64>, other: Vec<i64>) -> Vec<i64> {
    for (one, other) in one.iter_mut().zip(other) {
        *one = (*one).max(other);
    }
    one
}

/// Returns the worst drift after each frame for one acceleration over all residues of the velocity, side by side so
/// that the loop over them becomes vector code.
fn worst_of(down: u32, a: i32, thresholds: &[i32]) -> Vec<i64> {
    let mask = (1i32 << down) - 1;
    let velocities = 1i32 << down.saturating_sub(1);
    let mut u: Vec<i32> = (0..velocities).map(|v| (v << 1).wrapping_add(a)).collect();
    let mut drift = vec![0i32; u.len()];
    let step = thresholds.iter().map(|&threshold| {
        let mut worst = 0;
        for (u, drift) in u.iter_mut().zip(&mut drift) {
            *drift += threshold - ((*u + threshold) & mask);
            worst = worst.max(drift.abs());
            *u = (*u + (a << 1)) & mask;
        }
        i64::from(worst)
    });
    step.collect()
}
