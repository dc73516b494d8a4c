//! Stage 2: who gets a cell that several galpixels want.
//!
//! The winner is the smallest by a total order: class first (a fully-fledged galpixel before debris), then depth (nearer
//! first, its fraction included), then the cell it came from (smaller first). So any order of traversal, any number of
//! threads and a hardware pipeline give the same bits.

use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::propagate::Arrival;
use crate::record::{Record, Words};
use crate::tally::Tally;

/// In a winner map: nothing arrived at this cell.
pub const NOBODY: u32 = u32::MAX;

/// What a galpixel has to show when it wants a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Class and depth as one number: `class << depth bits | depth`.
    pub key: u32,
    /// The cell it came from.
    pub source: u32,
}

/// Whether the challenger gets the cell. A strict total order on claims of different sources.
#[inline(always)]
#[must_use]
pub const fn nearer(challenger: Claim, incumbent: Claim) -> bool {
    challenger.key < incumbent.key || challenger.key == incumbent.key && challenger.source < incumbent.source
}

/// Class and depth as one number, the smaller the nearer.
#[inline(always)]
pub(crate) fn key(record: &Record, words: &Words) -> u32 {
    record.class().unsigned(words) << record.depth().bits | record.depth().unsigned(words)
}

/// Settles arrivals into an empty map, whatever order they come in.
///
/// `winners[cell]` becomes the source of the galpixel that got the cell, [`NOBODY`] where none did. Both `back` and
/// `winners` are cleared first. A winner map that is too short forgets: its cells then keep their first comer.
///
/// The engine's own passes do the same in raster order, with less work: see [`crate::sweep`].
pub fn settle<L: Layout, B: Budget<L>>(
    arrivals: impl IntoIterator<Item = Arrival>,
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
) -> Tally {
    back.clear();
    winners.fill(NOBODY);
    let mut tally = Tally::default();
    for arrival in arrivals {
        tally.moved += 1;
        tally.saturated += arrival.saturated;
        let Some(cell) = arrival.cell else {
            tally.lost += 1;
            continue;
        };
        let Some((incumbent, winner)) = back.words_at(cell).zip(winners.get_mut(cell as usize)) else {
            continue;
        };
        let incumbent = key(back.record(), &incumbent);
        let occupied = incumbent >> back.record().depth().bits != Class::Empty as u32;
        tally.collided += occupied as u32;
        let claim = Claim { key: key(back.record(), &arrival.words), source: arrival.source };
        if !occupied || nearer(claim, Claim { key: incumbent, source: *winner }) {
            *winner = arrival.source;
            back.put(cell, &arrival.words);
        }
    }
    tally
}
