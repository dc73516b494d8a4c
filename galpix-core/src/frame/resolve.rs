//! Stage 2: who gets a cell that several galpixels want.
//!
//! The winner is the smallest by a total order: class first (a fully-fledged galpixel before debris), then depth (nearer
//! first, its fraction included), then the cell it came from (smaller first). So any order of traversal, any number of
//! threads and a hardware pipeline give the same bits.

use crate::format::Format;
use crate::format::record::{Record, Words};
use crate::format::rounding::Rounding;
use crate::frame::tally::Tally;
use crate::map::Galpixmap;

/// In a winner map: nothing arrived at this cell.
pub const NO_WINNER: u32 = u32::MAX;

/// What a galpixel has to show when it wants a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Class and depth as one number: `class << depth bits | depth`.
    pub key: u32,
    /// The cell it came from.
    pub source: u32,
}

/// Whether the challenger gets the cell. A strict total order on claims of different sources.
#[inline(always)]
#[must_use]
pub const fn nearer(challenger: Candidate, incumbent: Candidate) -> bool {
    challenger.key < incumbent.key || challenger.key == incumbent.key && challenger.source < incumbent.source
}

/// Class and depth as one number, the smaller the nearer.
#[inline(always)]
pub(crate) fn key(record: &Record, words: &Words) -> u32 {
    record.class().unsigned(words) << record.depth().bits | record.depth().unsigned(words)
}

/// Propagates `front` by one frame into `back` and resolves collisions.
///
/// `frame` is the frame counter of `front`; it may wrap. `winners` is either empty, and then nobody's origin is kept, or
/// has a word for each cell. Cells that nothing reached are of class empty; their other fields and their winner are
/// not defined before [`crate::frame::fill`] has gone over them. Both maps must have the same grid, else nothing is done.
pub fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    F::sweep(front, back, winners, rounding, frame)
}
