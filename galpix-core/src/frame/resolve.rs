//! Stage 2: resolves collisions of galpixels that arrive at the same cell.
//!
//! The winner is the smallest in a total order: by class (a fully-fledged galpixel before debris), then by depth with
//! its fraction (nearer first), then by source cell (smaller first). So what was filled, a bullet too, never displaces
//! a galpixel, and the result does not depend on the order of traversal: threads or a hardware pipeline give the same
//! bits.

use crate::format::Format;
use crate::format::record::{Record, Words};
use crate::format::rounding::Rounding;
use crate::frame::tally::Tally;
use crate::map::Galpixmap;

/// The entry of a winner map for a cell at which nothing arrived.
pub const NO_WINNER: u32 = u32::MAX;

/// What decides whether a galpixel wins the cell at which it arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Class and depth as one number: `class << depth bits | depth`.
    pub key: u32,
    /// The cell that the galpixel came from.
    pub source: u32,
}

/// Returns whether the challenger wins against the incumbent. A strict total order of candidates with different
/// sources.
#[inline(always)]
#[must_use]
pub const fn nearer(challenger: Candidate, incumbent: Candidate) -> bool {
    challenger.key < incumbent.key || challenger.key == incumbent.key && challenger.source < incumbent.source
}

/// Returns the key of a galpixel, which is its class and depth as one number: smaller is nearer.
#[inline(always)]
pub(crate) fn key(record: &Record, words: &Words) -> u32 {
    record.class().unsigned(words) << record.depth().bits | record.depth().unsigned(words)
}

/// Propagates `front` by one frame into `back` and resolves collisions: stages 1 and 2. Returns the counts of the pass.
///
/// `frame` is the frame counter of `front`; it may wrap. `winners` has a word for each cell, or is empty if no winner
/// map is needed. Cells that nothing reached have the class empty; their other fields and their winner are unspecified
/// until [`fill`](crate::stages::fill) has filled them. If the grids of the maps differ, nothing is done.
pub fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    F::sweep(front, back, winners, rounding, frame)
}
