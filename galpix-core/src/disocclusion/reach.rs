//! A bound of how far one galpixel gets ahead of another within some frames, in whole cells.
//!
//! Both make the steps of [`crate::frame::step`] with the same thresholds. With `M = 2^down` the one gets ahead in a
//! step, by whatever threshold `t`, by
//!
//! ```text
//! floor((s + t) / M) - floor((s' + t) / M) <= ceil((s - s') / M) <= (s - s' + slack) / M
//! ```
//!
//! units of the position, where `slack = M - 1`. Without an acceleration `s - s'` is even, and `slack = M - 2`. So the
//! sum of `s - s' + slack` over the frames, divided by `M` and rounded down, bounds the units by which it gets ahead.
//! Together with the offsets in the cells, rounded up to whole cells, it bounds the cells, because
//! `floor(p) - floor(q) <= ceil(p - q)`.
//!
//! The sums are those of a parabola, until a velocity saturates.

use crate::fast::VECTORS;
use crate::format::record::Scale;

/// The motion of a galpixel along one component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Motion {
    /// Offset in the cell, in units of the position.
    pub offset: i32,
    pub velocity: i32,
    /// In units of the velocity, a frame.
    pub acceleration: i32,
}

/// Motion of one galpixel relative to another along one component.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    moving: bool,
    offset: i64,
    velocity: i64,
    acceleration: i64,
    /// Both motions, if the velocity of one of them leaves its field.
    saturating: Option<[Motion; 2]>,
}

/// The bounds along one component.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    scale: Scale,
    /// Frames, 0 to 255.
    frames: u32,
    /// The most that rounding can add in a frame, in units of `2v + a`.
    slack: i64,
}

/// Returns `x` times `n`, which is below 256; wraps.
#[inline(always)]
fn times(x: i64, n: u32) -> i64 {
    if VECTORS { x.wrapping_mul(i64::from(n)) } else { times_by_limbs(x, n) }
}

/// Returns the same by three products of 24 by 8 bits: rustc 1.95 makes a product of 64 bits a call of `__aeabi_lmul`
/// on thumbv6m-none-eabi.
#[inline(always)]
fn times_by_limbs(x: i64, n: u32) -> i64 {
    const LIMB: i64 = (1 << 24) - 1;
    // No product wraps.
    let n = n & 0xff;
    let limb = |down: u32| i64::from((x >> down & LIMB) as u32 * n);
    limb(0).wrapping_add(limb(24) << 24).wrapping_add(limb(48) << 48)
}

impl Bound {
    pub fn new(scale: &Scale, accelerates: bool, frames: u32) -> Self {
        let dropped = 1i64 << (scale.down & 31);
        let slack = if accelerates { dropped - 1 } else { (dropped - 2).max(0) };
        Self { scale: *scale, frames, slack }
    }

    /// Returns the motion of `one` relative to `other`.
    #[inline(always)]
    pub fn between(&self, one: Motion, other: Motion) -> Relative {
        let last = self.frames.saturating_sub(1);
        Relative {
            moving: self.frames > 0 && one != other,
            offset: i64::from(one.offset) - i64::from(other.offset),
            velocity: i64::from(one.velocity) - i64::from(other.velocity),
            acceleration: i64::from(one.acceleration) - i64::from(other.acceleration),
            saturating: if self.saturates(one, last) || self.saturates(other, last) {
                Some([one, other])
            } else {
                None
            },
        }
    }

    /// Returns the most cells by which the one gets ahead of the other in any of the frames: 0 to 2^30.
    #[inline(always)]
    pub fn cells(&self, of: &Relative) -> u32 {
        if !of.moving {
            return 0;
        }
        let Scale { down, up, position_frac, .. } = self.scale;
        let ahead = of.offset + ((self.most(of, self.slack) >> down) << up);
        let cells = ahead.wrapping_add((1i64 << position_frac) - 1) >> position_frac;
        cells.clamp(0, 1 << 30) as u32
    }

    /// Returns whether the one gets ahead of the other by a whole cell in any of the frames, without rounding and
    /// offsets.
    #[inline(always)]
    pub fn parts(&self, of: &Relative) -> bool {
        of.moving && self.most(of, 0) >= 2i64 << self.scale.velocity_frac
    }

    /// Returns limits for the differences of velocities and of accelerations, in their own units: within both, neither
    /// galpixel gets ahead of the other by a whole cell, as in [`Self::parts`]. Both are powers of two or 0.
    pub fn together(&self) -> [i32; 2] {
        // 2 |dv| n + |da| n² <= 2^velocity_frac + 2^(velocity_frac - 1) < 2^(velocity_frac + 1) for n <= 2^log frames.
        // Velocities that saturate get no farther apart than those that do not.
        let log = (0..8).filter(|log| self.frames > 1 << log).count() as u32;
        let velocity = self.scale.velocity_frac.checked_sub(1 + log);
        let acceleration = self.scale.velocity_frac.checked_sub(1 + 2 * log + self.scale.acceleration_up);
        [velocity, acceleration].map(|power| match power {
            Some(power) => 1 << (power & 31),
            None => 0,
        })
    }

    /// Returns the largest sum of `s - s' + slack` over the first 1 to `frames` frames.
    #[inline(always)]
    fn most(&self, of: &Relative, slack: i64) -> i64 {
        if let Some([one, other]) = of.saturating {
            return self.most_in_steps(one, other, slack);
        }
        // With a = acceleration the steps are first, first + 2a, first + 4a, ... The largest sum is the first or the
        // last, unless steps that go ahead are followed by steps that go back.
        let (acceleration, last) = (of.acceleration, self.frames - 1);
        let first = (of.velocity << 1) + acceleration + slack;
        let changed = times(acceleration, last);
        if first > 0 && first + (changed << 1) < 0 {
            return vertex(first, acceleration, self.frames);
        }
        first.max(times(first + changed, self.frames))
    }

    /// Returns whether a velocity leaves its field within `steps` frames.
    #[inline(always)]
    fn saturates(&self, of: Motion, steps: u32) -> bool {
        let velocity = i64::from(of.velocity) + times(i64::from(of.acceleration), steps);
        let unused = 64 - self.scale.velocity_bits.clamp(1, 32);
        velocity << unused >> unused != velocity
    }

    /// Returns the same as [`Self::most`], frame by frame, with clamped velocities.
    #[cold]
    #[inline(never)]
    fn most_in_steps(&self, mut one: Motion, mut other: Motion, slack: i64) -> i64 {
        use crate::frame::step::{clamp_velocity, step_velocity};
        // The accelerations are in units of the velocity already.
        let scale = Scale { acceleration_up: 0, ..self.scale };
        let (mut sum, mut most) = (0i64, i64::MIN);
        for _ in 0..self.frames {
            let step = |of: Motion| (i64::from(of.velocity) << 1) + i64::from(of.acceleration);
            sum += step(one) - step(other) + slack;
            most = most.max(sum);
            for of in [&mut one, &mut other] {
                of.velocity = clamp_velocity(&scale, step_velocity(&scale, of.velocity, of.acceleration));
            }
        }
        most
    }
}

/// Returns the largest sum of the first steps of `first`, `first + 2a`, ..., of which the first is above 0 and the last
/// below.
///
/// It is that of the steps that are above 0. The last of them is found bit by bit: rustc 1.95 makes a quotient of 64
/// bits a call of `__aeabi_ldivmod` on thumbv6m-none-eabi.
#[inline(always)]
fn vertex(first: i64, acceleration: i64, frames: u32) -> i64 {
    let mut last = 0;
    for power in (0..8).rev() {
        let later = last + (1 << power);
        if later < frames && first + (times(acceleration, later) << 1) > 0 {
            last = later;
        }
    }
    times(first + times(acceleration, last), last + 1)
}

#[cfg(test)]
mod tests;
