//! How far one galpixel gets from another within some frames, at most and in whole cells.
//!
//! Both make the steps of [`crate::frame::step`] by the same thresholds. In a step the one gets ahead of the other by
//! `floor((s + t) / M) - floor((s' + t) / M) <= ceil((s - s') / M) <= (s - s' + slack) / M` units of the position, whatever the threshold `t`, where
//! `M = 2^down` and `slack = M - 1`; without an acceleration `s - s'` is even, and `slack = M - 2`. So the sum over the frames of
//! `s - s' + slack`, divided by `M` and rounded down, bounds what it gets ahead; with the places in the cells, rounded up to whole
//! cells, it bounds the cells (`floor(p) - floor(q) <= ceil(p - q)`).
//!
//! The sums are those of a parabola, until a velocity saturates.

use crate::fast::VECTORS;
use crate::format::record::Scale;

/// The motion of a galpixel along one component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Motion {
    /// Place in the cell, in units of the position.
    pub offset: i32,
    pub velocity: i32,
    /// In units of the velocity.
    pub acceleration: i32,
}

/// How one galpixel moves against another along one component.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative {
    moving: bool,
    offset: i64,
    velocity: i64,
    change: i64,
    /// Both, if the velocity of any of them leaves its field.
    saturating: Option<[Motion; 2]>,
}

impl Relative {
    /// How the other moves against the one.
    #[inline(always)]
    pub fn reversed(&self) -> Self {
        Self {
            moving: self.moving,
            offset: -self.offset,
            velocity: -self.velocity,
            change: -self.change,
            saturating: self.saturating.map(|[one, other]| [other, one]),
        }
    }
}

/// What bounds of one component are made with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    scale: Scale,
    /// Frames, 0 to 255.
    frames: u32,
    /// What rounding can add in a frame, in units of `2v + a`.
    slack: i64,
}

/// Returns `x` times `n`, of which 8 bits count; it may wrap.
#[inline(always)]
fn times(x: i64, n: u32) -> i64 {
    if VECTORS {
        return x.wrapping_mul(i64::from(n));
    }
    // On thumbv6m (rustc 1.95) a product of 64 bits is a call of `__aeabi_lmul`. Three products of 24 by 8 bits are not.
    const LIMB: i64 = (1 << 24) - 1;
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

    /// How `one` moves against `other`.
    #[inline(always)]
    pub fn between(&self, one: Motion, other: Motion) -> Relative {
        let last = self.frames.saturating_sub(1);
        Relative {
            moving: self.frames > 0 && one != other,
            offset: i64::from(one.offset) - i64::from(other.offset),
            velocity: i64::from(one.velocity) - i64::from(other.velocity),
            change: i64::from(one.acceleration) - i64::from(other.acceleration),
            saturating: if self.saturates(one, last) || self.saturates(other, last) {
                Some([one, other])
            } else {
                None
            },
        }
    }

    /// Cells by which the one gets ahead of the other at most in any of the frames, 0 or more.
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

    /// Whether the one gets ahead of the other by a whole cell in any of the frames, were it not for rounding and places.
    #[inline(always)]
    pub fn parts(&self, of: &Relative) -> bool {
        of.moving && self.most(of, 0) >= 2i64 << self.scale.velocity_frac
    }

    /// Neither gets ahead of the other by a whole cell, as in [`Self::parts`], if velocities differ by at most the first and
    /// accelerations, in their own units, by at most the second of these. Both are powers of two or 0.
    pub fn together(&self) -> [i32; 2] {
        // 2 |dv| n + |da| n² <= 2^velocity_frac + 2^(velocity_frac - 1) < 2^(velocity_frac + 1) for n <= 2^log; and velocities that
        // saturate come no farther apart than those that do not.
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
        // The steps are first, first + 2 change, first + 4 change, ... The largest sum is the first or the last, unless steps that went
        // ahead go back at the end.
        let (change, last) = (of.change, self.frames - 1);
        let first = (of.velocity << 1) + change + slack;
        let changed = times(change, last);
        if first > 0 && first + (changed << 1) < 0 {
            return vertex(first, change, self.frames);
        }
        first.max(times(first + changed, self.frames))
    }

    /// Whether a velocity leaves its field within `steps` frames.
    #[inline(always)]
    fn saturates(&self, of: Motion, steps: u32) -> bool {
        let velocity = i64::from(of.velocity) + times(i64::from(of.acceleration), steps);
        let unused = 64 - self.scale.velocity_bits.clamp(1, 32);
        velocity << unused >> unused != velocity
    }

    /// As [`Self::most`], frame by frame, with clamped velocities.
    #[cold]
    #[inline(never)]
    fn most_in_steps(&self, mut one: Motion, mut other: Motion, slack: i64) -> i64 {
        use crate::frame::step::{clamp_velocity, step_velocity};
        // Accelerations are in units of the velocity already.
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

/// The sum of the steps `first`, `first + 2 change`, ... up to the last one above 0, which comes before the last frame.
#[inline(always)]
fn vertex(first: i64, change: i64, frames: u32) -> i64 {
    let (mut sum, mut step, mut left) = (0i64, first, frames);
    for power in (0..8).rev() {
        // 2^power steps more, if they are there and the last of them goes ahead.
        let last = step - (change << 1) + (change << (power + 1));
        if left >> power != 0 && last > 0 {
            sum += ((step - change) << power) + (change << (power << 1));
            step += change << (power + 1);
            left -= 1 << power;
        }
    }
    sum
}

#[cfg(test)]
mod tests;
