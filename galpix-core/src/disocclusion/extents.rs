//! The word of a cell in a disocclusion map, and the operations on it that spreading is made of.
//!
//! A word has four bytes, one for each side. The low 7 bits of a byte are the *extent*: the number of cells, the cell
//! itself included, that are uncovered to that side. A cell that nothing uncovers has extents of 0; in a spread map
//! every other cell has four extents of at least 1.
//!
//! Until the map is spread, the top bit of a byte says that the cell takes nothing from a scan in that direction: the
//! cell is *blocked*.

/// How far what may be uncovered extends from a cell, in cells, the cell itself included; all 0 where nothing is
/// uncovered.
///
/// Each extent is 0 to [`Self::NO_END`], which stands for that many cells and more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Extents {
    /// Cells to the left; bits 0 to 6 of the word.
    pub left: u8,
    /// Cells to the right; bits 8 to 14.
    pub right: u8,
    /// Cells above; bits 16 to 22.
    pub above: u8,
    /// Cells below; bits 24 to 30.
    pub below: u8,
}

impl Extents {
    /// The saturated extent: it is propagated without becoming shorter and ends only where its surface does.
    pub const NO_END: u8 = 127;

    /// Returns the extents in a word of the map.
    #[inline(always)]
    #[must_use]
    pub const fn of(word: u32) -> Self {
        let [left, right, above, below] = (word & EXTENTS).to_le_bytes();
        Self { left, right, above, below }
    }

    /// Returns the word of the map. Extents above [`Self::NO_END`] count as that.
    #[inline(always)]
    #[must_use]
    pub const fn word(self) -> u32 {
        const fn clamped(extent: u8) -> u8 {
            if extent > Extents::NO_END { Extents::NO_END } else { extent }
        }
        u32::from_le_bytes([clamped(self.left), clamped(self.right), clamped(self.above), clamped(self.below)])
    }

    /// Returns whether what is hidden in this cell may be uncovered.
    #[inline(always)]
    #[must_use]
    pub const fn covered(self) -> bool {
        self.word() != 0
    }
}

/// The bits of a word that are extents.
pub(crate) const EXTENTS: u32 = 0x7f7f_7f7f;

/// The word of a cell that uncovers only itself.
pub(crate) const ONLY_ITSELF: u32 = 0x0101_0101;

/// The directions of scans: the lowest bit of the extent that moves with the scan. Opposite directions differ in bit 3.
pub(crate) const LEFTWARDS: u32 = 0;
pub(crate) const RIGHTWARDS: u32 = 8;
pub(crate) const UPWARDS: u32 = 16;
pub(crate) const DOWNWARDS: u32 = 24;

/// Returns the extent in a direction.
#[inline(always)]
pub(crate) const fn extent<const DIRECTION: u32>(word: u32) -> u32 {
    word >> DIRECTION & Extents::NO_END as u32
}

/// Returns the bit of a cell that takes nothing from a scan in a direction.
#[inline(always)]
pub(crate) const fn blocked<const DIRECTION: u32>() -> u32 {
    0x80 << DIRECTION
}

/// Returns, for each of the four extents, the larger one of two words, and the top bits of the bytes of the first word.
#[inline(always)]
pub(crate) const fn larger(one: u32, other: u32) -> u32 {
    const TOPS: u32 = !EXTENTS;
    // Four subtractions at once: no extent has the top bit of its byte, which stays set where `one` is not smaller.
    let not_smaller = (one | TOPS).wrapping_sub(other & EXTENTS) & TOPS;
    let kept = not_smaller.wrapping_sub(not_smaller >> 7) | TOPS;
    other ^ (one ^ other) & kept
}

/// Returns what a cell propagates to the next one of a scan: its own extents, that in the direction of the scan shorter
/// by one and that in the opposite direction 1; 0 if its extent does not reach the next cell.
#[inline(always)]
pub(crate) const fn propagated<const DIRECTION: u32>(word: u32) -> u32 {
    let extents = word & EXTENTS & !(0xff << (DIRECTION ^ 8)) | 1 << (DIRECTION ^ 8);
    shortened::<DIRECTION>(extents)
}

/// Returns what a cell without own extents propagates of what it has received, as [`propagated`].
#[inline(always)]
pub(crate) const fn shortened<const DIRECTION: u32>(received: u32) -> u32 {
    let reach = extent::<DIRECTION>(received);
    let ends = (reach != Extents::NO_END as u32) as u32;
    let reaches = (reach >= 2) as u32;
    received.wrapping_sub(ends << DIRECTION) & 0u32.wrapping_sub(reaches)
}

/// Returns the word of a cell after it has received what the one before it in a scan propagates.
#[inline(always)]
pub(crate) const fn joined<const DIRECTION: u32>(word: u32, received: u32) -> u32 {
    let open = (word & blocked::<DIRECTION>() == 0) as u32;
    larger(word, received & 0u32.wrapping_sub(open))
}

#[cfg(test)]
mod tests {
    use super::{DOWNWARDS, Extents, LEFTWARDS, ONLY_ITSELF, RIGHTWARDS, UPWARDS, blocked, joined, larger, propagated};

    #[test]
    fn extents_are_compared_each_for_itself() {
        for one in 0..=255 {
            for other in 0..=255 {
                let larger_of = |one: u32, other: u32| one & 0x80 | (one & 0x7f).max(other & 0x7f);
                let (low, high) = (larger(one, other), larger(one << 24 | 255 << 16 | other << 8, other << 24 | one));
                assert_eq!(low, larger_of(one, other));
                assert_eq!(high, larger_of(one, other) << 24 | 255 << 16 | other << 8 | one & 0x7f);
            }
        }
    }

    #[test]
    fn a_cell_propagates_what_reaches_the_next() {
        let word = |left, right, above, below| Extents { left, right, above, below }.word();
        let from = word(3, 2, 127, 1) | blocked::<LEFTWARDS>() | blocked::<UPWARDS>();
        assert_eq!(propagated::<LEFTWARDS>(from), word(2, 1, 127, 1));
        assert_eq!(propagated::<RIGHTWARDS>(from), word(1, 1, 127, 1));
        assert_eq!(propagated::<UPWARDS>(from), word(3, 2, 127, 1));
        assert_eq!(propagated::<DOWNWARDS>(from), 0);
        assert_eq!(word(200, 0, 0, 0), 127);
    }

    #[test]
    fn a_cell_takes_nothing_from_a_blocked_direction() {
        let cell = blocked::<RIGHTWARDS>();
        assert_eq!(joined::<RIGHTWARDS>(cell, ONLY_ITSELF), cell);
        assert_eq!(joined::<LEFTWARDS>(cell, ONLY_ITSELF), cell | ONLY_ITSELF);
    }
}
