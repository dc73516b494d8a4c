//! The equations in exact arithmetic: numbers are multiples of `2^-64` in an `i128`, and nothing is rounded unless the
//! equation says so.

use galpix_core::Rounding;
use galpix_core::record::Component;

/// Fraction bits of [`Exact`].
const FRAC: u32 = 64;

/// An exact number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Exact(i128);

impl Exact {
    /// Returns `raw / 2^frac`.
    #[must_use]
    pub fn of(raw: i64, frac: u32) -> Self {
        Self(i128::from(raw) << (FRAC - frac))
    }

    /// Returns the sum.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    /// Returns the half. Panics if it is no multiple of `2^-64`.
    #[must_use]
    pub fn half(self) -> Self {
        assert_eq!(self.0 % 2, 0);
        Self(self.0 / 2)
    }

    /// Returns `floor(self * 2^frac)`.
    #[must_use]
    pub fn floor(self, frac: u32) -> i64 {
        i64::try_from(self.0.div_euclid(1 << (FRAC - frac))).unwrap()
    }

    /// Returns `self * 2^frac`. Panics if that is no whole number.
    #[must_use]
    pub fn whole(self, frac: u32) -> i64 {
        assert_eq!(self.0.rem_euclid(1 << (FRAC - frac)), 0, "{self:?} is no multiple of 2^-{frac}");
        self.floor(frac)
    }
}

/// Returns what a frame adds to a position before the bits beyond `2^-frac` are cut off, in steps of `2^-frac`.
///
/// The van der Corput sequence is the sum over the bits `b_i` of the frame counter of `b_i / 2^(i+1)`. A searched table
/// is data: its entry for `dropped` bits, in units of the last of them.
#[must_use]
pub fn offset_of_frame(rounding: Rounding, frame: u32, dropped: u32, frac: u32) -> Exact {
    let part = match rounding {
        Rounding::Searched if dropped <= Rounding::MOST_SEARCHED => {
            Exact::of(rounding.threshold(frame, dropped).into(), dropped)
        }
        Rounding::Truncate => Exact(0),
        Rounding::Nearest => Exact::of(1, 1),
        Rounding::LowDiscrepancy | Rounding::Searched => {
            (0..32).filter(|bit| frame >> bit & 1 == 1).fold(Exact(0), |sum, bit| sum.plus(Exact::of(1, bit + 1)))
        }
    };
    Exact(part.0 >> frac)
}

/// Equation (6): `r + v + a/2`, cut off to `frac` fraction bits after the frame's offset was added; as raw number.
/// `v_frac` are the fraction bits of `v`, and one more those of the sum.
#[must_use]
#[expect(clippy::too_many_arguments, reason = "one for each term of the equation")]
pub fn position(r: Exact, v: Exact, a: Exact, rounding: Rounding, frame: u32, v_frac: u32, frac: u32) -> i64 {
    let dropped = (v_frac + 1).saturating_sub(frac);
    r.plus(v).plus(a.half()).plus(offset_of_frame(rounding, frame, dropped, frac)).floor(frac)
}

/// Equation (7): `v + a`, as raw number.
#[must_use]
pub fn velocity(v: Exact, a: Exact, component: &Component) -> i64 {
    v.plus(a).whole(component.velocity_frac)
}

/// Returns the nearest number that a two's complement field of `bits` bits holds.
#[must_use]
pub fn saturated(value: i64, bits: u32) -> i64 {
    let end = 1i64 << (bits - 1);
    value.clamp(-end, end - 1)
}

/// Returns the nearest cell to a position, halves towards +infinity.
#[must_use]
pub fn nearest_cell(r: Exact) -> i64 {
    r.plus(Exact::of(1, 1)).floor(0)
}

/// Returns all numbers of a two's complement field of `bits` bits; 0 alone for an absent field.
pub fn signed(bits: u32) -> impl Iterator<Item = i64> + Clone {
    let end = if bits == 0 { 0 } else { 1i64 << (bits - 1) };
    -end..end.max(1)
}
