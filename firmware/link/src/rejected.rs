//! Why a frame was refused. Every cause is counted apart.

use core::fmt;

/// Why a frame was refused. The numbers are the places in [`Rejections`] and on the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Rejected {
    /// More bytes before the 0 than a frame can have.
    TooLong = 0,
    /// The 0 came too early: no COBS, or fewer bytes than a kind and a checksum.
    CutShort = 1,
    /// The checksum is not that of the payload.
    WrongChecksum = 2,
    /// A kind that this end does not know, or a choice within it that does not exist.
    UnknownKind = 3,
    /// More or fewer bytes than the kind has; galpixels that are no whole ones.
    WrongLength = 4,
    /// Galpixels in another stored form, or for another display. Only the map's owner can tell.
    WrongFingerprint = 5,
    /// Galpixels outside of the map. Only the map's owner can tell.
    Outside = 6,
    /// Galpixels that were exact too many frames ago. Only the map's owner can tell.
    TooOld = 7,
}

impl Rejected {
    /// All causes, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::TooLong,
        Self::CutShort,
        Self::WrongChecksum,
        Self::UnknownKind,
        Self::WrongLength,
        Self::WrongFingerprint,
        Self::Outside,
        Self::TooOld,
    ];

    /// The cause in two or three words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::TooLong => "too long",
            Self::CutShort => "cut short",
            Self::WrongChecksum => "wrong checksum",
            Self::UnknownKind => "unknown kind",
            Self::WrongLength => "wrong length",
            Self::WrongFingerprint => "wrong fingerprint",
            Self::Outside => "outside of the map",
            Self::TooOld => "too old",
        }
    }
}

impl fmt::Display for Rejected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl core::error::Error for Rejected {}

/// How many causes there are.
pub const CAUSES: usize = Rejected::ALL.len();

/// How many frames were refused, by cause. Counters wrap: what counts is the difference between two of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rejections([u32; CAUSES]);

impl Rejections {
    /// None.
    #[must_use]
    pub const fn new() -> Self {
        Self([0; CAUSES])
    }

    /// From the counters in the order of [`Rejected::ALL`].
    #[must_use]
    pub const fn from_counts(counts: [u32; CAUSES]) -> Self {
        Self(counts)
    }

    /// The counters in the order of [`Rejected::ALL`].
    #[must_use]
    pub const fn counts(&self) -> [u32; CAUSES] {
        self.0
    }

    /// One more frame was refused.
    pub fn count(&mut self, cause: Rejected) {
        if let Some(counter) = self.0.get_mut(cause as usize) {
            *counter = counter.wrapping_add(1);
        }
    }

    /// How many were refused for this cause.
    #[must_use]
    pub fn of(&self, cause: Rejected) -> u32 {
        self.0.get(cause as usize).copied().unwrap_or(0)
    }

    /// How many were refused for any cause.
    #[must_use]
    pub fn total(&self) -> u32 {
        self.0.iter().fold(0, |total, &count| total.wrapping_add(count))
    }

    /// How many were refused since the earlier state `before`.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        let mut counts = self.0;
        for (count, before) in counts.iter_mut().zip(before.0) {
            *count = count.wrapping_sub(before);
        }
        Self(counts)
    }
}
