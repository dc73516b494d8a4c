//! The roundings of a position to its fraction bits.
//!
//! The step of a position has `velocity_frac + 1` fraction bits, the position keeps `position_frac` of them: `shift` bits
//! are dropped in each frame, after a threshold in `0 ..= 2^shift - 1` was added. All galpixels share the threshold of
//! their frame, so that what moves alike is rounded alike and rigid patches stay rigid.

mod searched;

/// Which threshold is added before the dropped bits are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rounding {
    /// 0: the plain right shift. Drifts towards -infinity by up to a step of the position in each frame.
    Truncate,
    /// One half: to nearest, halves upwards.
    Nearest,
    /// The frame counter read backwards (van der Corput): over any `2^shift` successive frames each threshold comes once.
    #[default]
    LowDiscrepancy,
    /// A table found by search, for up to [`Rounding::MOST_SEARCHED`] dropped bits; beyond, as low-discrepancy. Its drift is
    /// the smallest where updates enter at frame 0 of the counter, see [`crate::frame::Controller::set_frame`].
    Searched,
}

impl Rounding {
    /// All of them, from cheap to exact.
    pub const ALL: [Self; 4] = [Self::Truncate, Self::Nearest, Self::LowDiscrepancy, Self::Searched];

    /// The most dropped bits that there is a searched table for.
    pub const MOST_SEARCHED: u32 = searched::MOST;

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Truncate => "truncate",
            Self::Nearest => "nearest",
            Self::LowDiscrepancy => "low-discrepancy",
            Self::Searched => "searched",
        }
    }

    /// The threshold of frame `frame` where `shift` bits are dropped, `0 ..= 2^shift - 1`; 0 where none are.
    ///
    /// The frame counter may wrap: only its low `shift` bits are read. `shift` is at most 31.
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
