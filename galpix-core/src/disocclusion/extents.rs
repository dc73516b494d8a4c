//! The extents of a cell, four bytes in a word, and the operations on them that spreading is made of.
//!
//! Each extent counts cells, the cell itself included, as far as what is uncovered reaches to that side. A cell that nothing
//! uncovers holds 0; in a map that is spread every other cell has all four extents at 1 or above.
//!
//! Until the map is spread the top bit of each byte says that the cell takes nothing from a scan on that way: it is *shut*.

/// How far what may be uncovered reaches from a cell, the cell itself included; all 0 where nothing is.
///
/// 0 to [`Self::NO_END`] each, which stands for that many cells and more.
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
    /// The extent that is handed on without becoming shorter: what reaches so far ends only where its surface does.
    pub const NO_END: u8 = 127;

    /// The extents that a word of the map holds.
    #[inline(always)]
    #[must_use]
    pub const fn of(word: u32) -> Self {
        let [left, right, above, below] = (word & EXTENTS).to_le_bytes();
        Self { left, right, above, below }
    }

    /// The word of the map. An extent above [`Self::NO_END`] counts as that.
    #[inline(always)]
    #[must_use]
    pub const fn word(self) -> u32 {
        const fn held(extent: u8) -> u8 {
            if extent > Extents::NO_END { Extents::NO_END } else { extent }
        }
        u32::from_le_bytes([held(self.left), held(self.right), held(self.above), held(self.below)])
    }

    /// Whether what is hidden in this cell may be uncovered.
    #[inline(always)]
    #[must_use]
    pub const fn covered(self) -> bool {
        self.word() != 0
    }
}

/// The bits of a word that are extents.
pub(crate) const EXTENTS: u32 = 0x7f7f_7f7f;

/// The word of a cell that is uncovered by itself: only the cell.
pub(crate) const ONLY_ITSELF: u32 = 0x0101_0101;

/// The way in which a scan goes: the lowest bit of the extent that moves with it. That of the opposite way differs in bit 3.
pub(crate) const TO_THE_LEFT: u32 = 0;
pub(crate) const TO_THE_RIGHT: u32 = 8;
pub(crate) const UPWARDS: u32 = 16;
pub(crate) const DOWNWARDS: u32 = 24;

/// The extent on the way `WAY`.
#[inline(always)]
pub(crate) const fn extent<const WAY: u32>(word: u32) -> u32 {
    word >> WAY & Extents::NO_END as u32
}

/// The bit of a cell that takes nothing on the way `WAY`.
#[inline(always)]
pub(crate) const fn shut<const WAY: u32>() -> u32 {
    0x80 << WAY
}

/// The first one with the larger of each of four extents.
#[inline(always)]
pub(crate) const fn larger(one: u32, other: u32) -> u32 {
    const TOPS: u32 = !EXTENTS;
    // No extent has the top bit of its byte: it stays set where the one is not smaller.
    let not_smaller = (one | TOPS).wrapping_sub(other & EXTENTS) & TOPS;
    let kept = not_smaller.wrapping_sub(not_smaller >> 7) | TOPS;
    other ^ (one ^ other) & kept
}

/// What a cell says to the next one on the way `WAY` of a scan: its own extents, that one shorter, and nothing behind; 0 where it does
/// not reach so far.
#[inline(always)]
pub(crate) const fn handed_on<const WAY: u32>(word: u32) -> u32 {
    let extents = word & EXTENTS & !(0xff << (WAY ^ 8)) | 1 << (WAY ^ 8);
    shorter::<WAY>(extents)
}

/// The same of what a cell without extents was handed.
#[inline(always)]
pub(crate) const fn shorter<const WAY: u32>(handed: u32) -> u32 {
    let reach = extent::<WAY>(handed);
    let ends = (reach != Extents::NO_END as u32) as u32;
    let reaches = (reach >= 2) as u32;
    handed.wrapping_sub(ends << WAY) & 0u32.wrapping_sub(reaches)
}

/// A cell with what one before it on the way `WAY` hands on.
#[inline(always)]
pub(crate) const fn taken<const WAY: u32>(word: u32, handed: u32) -> u32 {
    let open = (word & shut::<WAY>() == 0) as u32;
    larger(word, handed & 0u32.wrapping_sub(open))
}

#[cfg(test)]
mod tests {
    use super::{Extents, ONLY_ITSELF, TO_THE_LEFT, TO_THE_RIGHT, UPWARDS, handed_on, larger, shut, taken};

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
    fn a_cell_hands_on_what_reaches_the_next() {
        let word = |left, right, above, below| Extents { left, right, above, below }.word();
        let from = word(3, 2, 127, 1) | shut::<TO_THE_LEFT>() | shut::<UPWARDS>();
        assert_eq!(handed_on::<TO_THE_LEFT>(from), word(2, 1, 127, 1));
        assert_eq!(handed_on::<TO_THE_RIGHT>(from), word(1, 1, 127, 1));
        assert_eq!(handed_on::<UPWARDS>(from), word(3, 2, 127, 1));
        assert_eq!(handed_on::<{ super::DOWNWARDS }>(from), 0);
        assert_eq!(word(200, 0, 0, 0), 127);
    }

    #[test]
    fn a_cell_takes_nothing_on_a_way_that_is_shut() {
        let cell = shut::<TO_THE_RIGHT>();
        assert_eq!(taken::<TO_THE_RIGHT>(cell, ONLY_ITSELF), cell);
        assert_eq!(taken::<TO_THE_LEFT>(cell, ONLY_ITSELF), cell | ONLY_ITSELF);
    }
}
