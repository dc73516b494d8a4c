//! The extents of a cell, four bytes in a word, and the two operations on them that spreading is made of.
//!
//! Each extent counts cells, the cell itself included, as far as what is uncovered reaches to that side. A cell that nothing
//! uncovers holds 0; in a map that is spread every other cell has all four extents at 1 or above.

/// How far what may be uncovered reaches from a cell, the cell itself included; all 0 where nothing is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extents {
    /// Cells to the left; bits 0 to 7 of the word.
    pub left: u8,
    /// Cells to the right; bits 8 to 15.
    pub right: u8,
    /// Cells above; bits 16 to 23.
    pub above: u8,
    /// Cells below; bits 24 to 31.
    pub below: u8,
}

impl Extents {
    /// The extents that a word of the map holds.
    #[inline(always)]
    #[must_use]
    pub const fn of(word: u32) -> Self {
        let [left, right, above, below] = word.to_le_bytes();
        Self { left, right, above, below }
    }

    /// The word of the map.
    #[inline(always)]
    #[must_use]
    pub const fn word(self) -> u32 {
        u32::from_le_bytes([self.left, self.right, self.above, self.below])
    }

    /// Whether what is hidden in this cell may be uncovered.
    #[inline(always)]
    #[must_use]
    pub const fn covered(self) -> bool {
        self.word() != 0
    }
}

/// The word of a cell that is uncovered by itself: only the cell.
pub(crate) const ONLY_ITSELF: u32 = 0x0101_0101;

/// The way in which a scan goes: the lowest bit of the extent that moves with it, and of the one on the other side.
pub(crate) const TO_THE_LEFT: u32 = 0;
pub(crate) const TO_THE_RIGHT: u32 = 8;
pub(crate) const UPWARDS: u32 = 16;
pub(crate) const DOWNWARDS: u32 = 24;

/// The larger of each of four extents.
#[inline(always)]
pub(crate) const fn larger(one: u32, other: u32) -> u32 {
    const TOPS: u32 = 0x8080_8080;
    // The top bit of each byte tells whether the one is not smaller: by the top bits, and where these are alike by the rest.
    let rest = (one | TOPS).wrapping_sub(other & !TOPS);
    let not_smaller = (one & !other | !(one ^ other) & rest) & TOPS;
    let mask = not_smaller | (not_smaller.wrapping_sub(not_smaller >> 7));
    one & mask | other & !mask
}

/// What a cell says to the next one on the way `WAY` of a scan: its own extents, that one shorter, and nothing behind; 0 where it does
/// not reach so far.
#[inline(always)]
pub(crate) const fn handed_on<const WAY: u32>(word: u32) -> u32 {
    let reaches = (word >> WAY & 0xff >= 2) as u32;
    let shorter = word.wrapping_sub(reaches << WAY);
    let behind = WAY ^ 8;
    (shorter & !(0xff << behind) | 1 << behind) & 0u32.wrapping_sub(reaches)
}

#[cfg(test)]
mod tests {
    use super::{Extents, handed_on, larger};

    #[test]
    fn bytes_are_compared_each_for_itself() {
        for one in 0..=255 {
            for other in 0..=255 {
                let (low, high) = (larger(one, other), larger(one << 24 | 255 << 16 | other << 8, other << 24 | one));
                assert_eq!(low, one.max(other));
                assert_eq!(high, one.max(other) << 24 | 255 << 16 | other << 8 | one);
            }
        }
    }

    #[test]
    fn a_cell_hands_on_what_reaches_the_next() {
        let word = |left, right, above, below| Extents { left, right, above, below }.word();
        let from = word(3, 2, 7, 1);
        assert_eq!(handed_on::<{ super::TO_THE_LEFT }>(from), word(2, 1, 7, 1));
        assert_eq!(handed_on::<{ super::TO_THE_RIGHT }>(from), word(1, 1, 7, 1));
        assert_eq!(handed_on::<{ super::UPWARDS }>(from), word(3, 2, 6, 1));
        assert_eq!(handed_on::<{ super::DOWNWARDS }>(from), 0);
    }
}
