//! How positions are rounded to their fraction bits.
//!
//! The step of a position has `velocity_frac + 1` fraction bits, of which the position keeps `position_frac`. Each
//! frame adds a threshold in `0 ..= 2^shift - 1` and drops `shift` bits. All galpixels of a frame share its threshold,
//! so that galpixels with the same motion are rounded in the same way and rigid patches stay rigid.

mod searched;

/// Selects the threshold that is added before bits are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rounding {
    /// 0: a plain right shift. A position drifts towards -infinity by up to one unit of its last bit in each frame.
    Truncate,
    /// One half: rounds to nearest, halves upwards.
    Nearest,
    /// The low bits of the frame counter in reverse order (van der Corput): any `2^shift` successive frames use each
    /// threshold once.
    #[default]
    LowDiscrepancy,
    /// A table found by search, for up to [`Rounding::MOST_SEARCHED`] dropped bits; as low-discrepancy for more. Its
    /// drift is smallest if updates enter at frame 0 of the counter, see [`crate::Controller::set_frame`].
    Searched,
}

impl Rounding {
    /// All roundings, from cheap to exact.
    pub const ALL: [Self; 4] = [Self::Truncate, Self::Nearest, Self::LowDiscrepancy, Self::Searched];

    /// The largest number of dropped bits for which there is a searched table.
    pub const MOST_SEARCHED: u32 = searched::MOST;

    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Truncate => "truncate",
            Self::Nearest => "nearest",
            Self::LowDiscrepancy => "low-discrepancy",
            Self::Searched => "searched",
        }
    }

    /// Returns the threshold of frame `frame` for `shift` dropped bits: `0 ..= 2^shift - 1`, and 0 if `shift` is 0 or
    /// more than 31.
    ///
    /// The frame counter may wrap: only its low `shift` bits are read.
    #[must_use]
    pub const fn threshold(self, frame: u32, shift: u32) -> i32 {
        if shift == 0 || shift > 31 {
            return 0;
        }
        match self {
            Self::Truncate => 0,
            Self::Nearest => 1 << (shift - 1),
            Self::Searched if shift <= Self::MOST_SEARCHED => searched::threshold(frame, shift),
            Self::LowDiscrepancy | Self::Searched => (frame.reverse_bits() >> (32 - shift)) as i32,
        }
    }
}
