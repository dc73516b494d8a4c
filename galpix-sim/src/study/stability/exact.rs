//! Positions in exact arithmetic: whole multiples of 2^-40 of a cell.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Sub, SubAssign};

use fixed::types::I32F32;

/// Fraction bits: those of a stored number, one more for the half of an acceleration, and room.
const FRAC: u32 = 40;

/// A length in cells (in depth: bins), exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Px(i128);

impl Px {
    /// Returns `raw / 2^frac`; `frac` is at most 40.
    #[must_use]
    pub fn of(raw: i64, frac: u32) -> Self {
        Self(i128::from(raw) << (FRAC - frac))
    }

    /// Creates a number of an update, in a unit of `2^unit` cells.
    #[must_use]
    pub fn given(value: I32F32, unit: u32) -> Self {
        Self((i128::from(value.to_bits()) << (FRAC - 32)) << unit)
    }

    /// Creates the nearest multiple to a floating-point number; 0 for what is none.
    #[must_use]
    pub fn near(value: f64) -> Self {
        Self((value * (1u64 << FRAC) as f64).round() as i128)
    }

    /// Returns the nearest floating-point number.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.0 as f64 / (1u64 << FRAC) as f64
    }

    /// To the nearest multiple of `2^-frac`, halves upwards, as its number.
    #[must_use]
    pub fn nearest(self, frac: u32) -> i64 {
        let shift = FRAC - frac;
        let half = 1i128 << shift >> 1;
        ((self.0 + half) >> shift) as i64
    }

    /// Returns the size without the sign.
    #[must_use]
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// Returns the distance of a velocity of `self` over `frames` frames.
    #[must_use]
    pub fn times(self, frames: u32) -> Self {
        Self(self.0 * i128::from(frames))
    }

    /// Returns `self * frames² / 2`: what an acceleration moves in that time.
    #[must_use]
    pub fn accelerated(self, frames: u32) -> Self {
        Self(self.0 / 2 * i128::from(frames) * i128::from(frames))
    }
}

impl Add for Px {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl AddAssign for Px {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl Sub for Px {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl SubAssign for Px {
    fn sub_assign(&mut self, other: Self) {
        self.0 -= other.0;
    }
}

impl Sum for Px {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), Add::add)
    }
}
