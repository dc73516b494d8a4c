//! Spreading in raster order: propagates what a cell uncovers from neighbour to neighbour. Takes the place of Algorithm
//! 2 of the supplement.
//!
//! Four scans follow each other: along each row to the right, then to the left; down each column, then up each column.
//! In a scan each cell propagates its extents, the one in the direction of the scan shorter by one, and the next cell
//! takes the larger of these and its own. The order is that of the memory, and no memory but the map is needed. A cell
//! that is blocked in the direction of a scan takes nothing from it.

use super::extents::{
    DOWNWARDS, EXTENTS, Extents, LEFTWARDS, RIGHTWARDS, UPWARDS, extent, joined, propagated, shortened,
};
use crate::fast::VECTORS;
use crate::map::grid::Grid;

/// Cells that are skipped at once where nothing is uncovered.
const BLOCK: usize = 16;

/// Loads some words into the cache. All loads are issued before the first one is waited for.
#[inline(always)]
pub(crate) fn prefetch(words: &[u32]) {
    if VECTORS {
        core::hint::black_box(words.iter().step_by(BLOCK).fold(0, |any, word| any | word));
    }
}

/// Scans a row to the right and to the left. Of what is propagated, only the bits `carried` are kept.
#[inline(always)]
pub(crate) fn along(row: &mut [u32], carried: u32) {
    let (blocks, rest) = row.as_chunks_mut::<BLOCK>();
    let mut received = 0;
    let mut anything = any(rest);
    for block in &mut *blocks {
        let own = any(block);
        if own == 0 && passes_block::<RIGHTWARDS>(received) {
            received = fill::<RIGHTWARDS>(block.iter_mut(), received);
        } else if received | own & reaching::<RIGHTWARDS>() != 0 {
            received = rightwards(block, received, carried);
        }
        anything |= own;
    }
    rightwards(rest, received, carried);
    if anything & reaching::<LEFTWARDS>() == 0 {
        return;
    }
    received = leftwards(rest, 0, carried);
    for block in blocks.iter_mut().rev() {
        let own = any(block);
        if own == 0 && passes_block::<LEFTWARDS>(received) {
            received = fill::<LEFTWARDS>(block.iter_mut().rev(), received);
        } else if received | own & reaching::<LEFTWARDS>() != 0 {
            received = leftwards(block, received, carried);
        }
    }
}

/// Returns all bits that any of some cells has.
#[inline(always)]
fn any(block: &[u32]) -> u32 {
    block.iter().fold(0, |any, word| any | word)
}

/// Returns the bits of which a cell that propagates anything has at least one: those of an extent of 2 or more.
const fn reaching<const DIRECTION: u32>() -> u32 {
    0x7e << DIRECTION
}

/// Returns whether what is received reaches through a whole block and beyond.
#[inline(always)]
const fn passes_block<const DIRECTION: u32>(received: u32) -> bool {
    extent::<DIRECTION>(received) > BLOCK as u32
}

/// Propagates through a block without own extents, to all of whose cells `received` reaches; returns what the block
/// propagates. Equals [`along_by_one`] for each of its cells.
#[inline(always)]
fn fill<'b, const DIRECTION: u32>(block: impl Iterator<Item = &'b mut u32>, received: u32) -> u32 {
    let ends = if extent::<DIRECTION>(received) == Extents::NO_END as u32 { 0 } else { u32::MAX };
    for (word, cell) in block.zip(0u32..) {
        *word = received.wrapping_sub(cell << DIRECTION & ends);
    }
    received.wrapping_sub((BLOCK as u32) << DIRECTION & ends)
}

#[inline(always)]
fn rightwards(block: &mut [u32], mut received: u32, carried: u32) -> u32 {
    for word in block {
        received = along_by_one::<RIGHTWARDS>(word, received) & carried;
    }
    received
}

#[inline(always)]
fn leftwards(block: &mut [u32], mut received: u32, carried: u32) -> u32 {
    for word in block.iter_mut().rev() {
        received = along_by_one::<LEFTWARDS>(word, received) & carried;
    }
    received
}

/// Joins a cell with what it receives; returns what it propagates.
#[inline(always)]
fn along_by_one<const DIRECTION: u32>(word: &mut u32, received: u32) -> u32 {
    // Most cells have no extents of their own, or receive nothing.
    if *word == 0 {
        *word = received;
        shortened::<DIRECTION>(received)
    } else if received == 0 {
        propagated::<DIRECTION>(*word)
    } else {
        *word = joined::<DIRECTION>(*word, received);
        propagated::<DIRECTION>(*word)
    }
}

/// Joins a row with what the row before it in a scan across the rows propagates.
pub(crate) fn across<const DIRECTION: u32>(from: &[u32], to: &mut [u32]) {
    let (blocks, rest) = from.as_chunks::<BLOCK>();
    let (to_blocks, to_rest) = to.as_chunks_mut::<BLOCK>();
    for (from, to) in blocks.iter().zip(to_blocks) {
        if any(from) & reaching::<DIRECTION>() != 0 {
            join_all::<DIRECTION>(from, to);
        }
    }
    join_all::<DIRECTION>(rest, to_rest);
}

#[inline(always)]
fn join_all<const DIRECTION: u32>(from: &[u32], to: &mut [u32]) {
    for (&from, to) in from.iter().zip(to) {
        *to = joined::<DIRECTION>(*to, propagated::<DIRECTION>(from));
    }
}

/// Returns the row that begins at cell `start`, and the row below it.
#[inline(always)]
pub(crate) fn rows(extents: &mut [u32], start: u32, width: u32) -> Option<(&mut [u32], &mut [u32])> {
    let two = extents.get_mut(start as usize..(start + 2 * width) as usize)?;
    two.split_at_mut_checked(width as usize)
}

/// Makes the scans of the pass down for the row that begins at cell `start`: along it, and down from the row above it.
#[inline(always)]
pub(crate) fn down(extents: &mut [u32], start: u32, width: u32) {
    if let Some(row) = extents.get_mut(start as usize..(start + width) as usize) {
        along(row, u32::MAX);
    }
    if let Some(above) = start.checked_sub(width)
        && let Some((above, row)) = rows(extents, above, width)
    {
        across::<DOWNWARDS>(above, row);
    }
}

/// Scans up all columns, row by row from the last one, and clears the blocked bits; returns the number of covered
/// cells.
pub(crate) fn up(extents: &mut [u32], grid: &Grid<'_>) -> u32 {
    let width = grid.width();
    let mut covered = 0;
    for &start in grid.starts().iter().rev() {
        if let Some((row, below)) = rows(extents, start, width) {
            prefetch(row);
            across::<UPWARDS>(below, row);
        }
        let row = extents.get_mut(start as usize..(start + width) as usize).unwrap_or_default();
        let (blocks, rest) = row.as_chunks_mut::<BLOCK>();
        for block in blocks {
            let bits = any(block);
            if bits & !EXTENTS != 0 {
                covered += clear_blocked(block);
            } else if bits != 0 {
                covered += block.iter().map(|&word| u32::from(word != 0)).sum::<u32>();
            }
        }
        covered += clear_blocked(rest);
    }
    covered
}

/// Clears the blocked bits of some cells; returns the number of covered ones.
#[inline(always)]
fn clear_blocked(block: &mut [u32]) -> u32 {
    let mut covered = 0;
    for word in block {
        *word &= EXTENTS;
        covered += u32::from(*word != 0);
    }
    covered
}

/// Spreads a map that [`mark`](super::mark()) has marked; returns the number of covered cells.
///
/// `extents` holds one word for each cell of the grid; rows that it holds only in part or not at all are left out. Mark
/// anew before each spreading: only where every extent comes from a cell that is uncovered does spreading a spread map
/// leave it as it is.
pub fn spread(extents: &mut [u32], grid: &Grid<'_>) -> u32 {
    for &start in grid.starts() {
        down(extents, start, grid.width());
    }
    up(extents, grid)
}
