//! How fast and how far the samples of an update go.

use schemars::JsonSchema;
use serde::Serialize;

use crate::update::{Known, Update};

/// Of one axis of the plane, over all samples whose motion is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Reach {
    /// The largest speed in any frame of the plan, in pixels per frame.
    pub speed: f64,
    /// The largest acceleration, in pixels per frame².
    pub acceleration: f64,
    /// The farthest that the acceleration alone carries a sample, in pixels.
    pub by_acceleration_px: f64,
    /// The farthest that a sample goes, in pixels.
    pub distance_px: f64,
}

/// What the motion of an update can come to within some frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Extremes {
    /// Along a row.
    pub x: Reach,
    /// Along a column.
    pub y: Reach,
    /// The farthest that a depth goes, as a part of its range.
    pub depth_change: f64,
    /// The most that a luminosity changes, in 8-bit code values.
    pub luminosity_gain: f64,
}

impl Extremes {
    /// Of an update, for `frames` frames.
    #[must_use]
    pub fn of(update: &Update, frames: u32) -> Self {
        let mut extremes = Self::default();
        let n = f64::from(frames);
        for sample in update.samples.iter().filter(|sample| sample.known == Known::Motion) {
            for (reach, axis) in [(&mut extremes.x, 0), (&mut extremes.y, 1)] {
                reach.add(sample.velocity[axis], sample.acceleration[axis], n);
            }
            let depth = farthest(sample.velocity[2], sample.acceleration[2], n);
            extremes.depth_change = extremes.depth_change.max(depth);
            extremes.luminosity_gain = extremes.luminosity_gain.max((sample.luminosity_rate * n).abs());
        }
        extremes
    }
}

impl Reach {
    fn add(&mut self, v: f64, a: f64, n: f64) {
        self.speed = self.speed.max(v.abs()).max((v + a * n).abs());
        self.acceleration = self.acceleration.max(a.abs());
        self.by_acceleration_px = self.by_acceleration_px.max(a.abs() * n * n / 2.0);
        self.distance_px = self.distance_px.max(farthest(v, a, n));
    }
}

/// Returns the largest of `|v t + a t²/2|` for t in 0 to n: at the end, or where it turns round.
fn farthest(v: f64, a: f64, n: f64) -> f64 {
    let at = |t: f64| (v * t + a * t * t / 2.0).abs();
    let turn = -v / a;
    if turn > 0.0 && turn < n { at(turn).max(at(n)) } else { at(n) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_farthest_is_where_it_turns_round_or_at_the_end() {
        assert_eq!(farthest(4.0, -1.0, 8.0), 8.0);
        assert_eq!(farthest(4.0, -1.0, 16.0), 64.0);
        assert_eq!(farthest(-2.0, 0.0, 5.0), 10.0);
        assert_eq!(farthest(0.0, 0.0, 5.0), 0.0);
    }
}
