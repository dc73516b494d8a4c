//! Spreading in raster order: what a cell uncovers is handed on from neighbour to neighbour. What Algorithm 2 of the supplement is for.
//!
//! Four scans, one after the other: along each row to the right, to the left; down each column, up each column. In a scan a cell hands on its
//! extents, the one that moves with the scan shorter by one, and the next cell takes the larger of these and its own; the
//! order is that of the memory, and nothing is needed beside the map itself. A cell that is shut on the way of a scan takes nothing.

use super::extents::{
    DOWNWARDS, EXTENTS, Extents, TO_THE_LEFT, TO_THE_RIGHT, UPWARDS, extent, handed_on, shorter, taken,
};
use crate::fast::VECTORS;
use crate::map::grid::Grid;

/// Cells that are passed by at once where nothing is uncovered.
const BLOCK: usize = 16;

/// Brings some words into the cache: all are asked for at once, before the first of them is waited for.
#[inline(always)]
pub(crate) fn bring(words: &[u32]) {
    if VECTORS {
        core::hint::black_box(words.iter().step_by(BLOCK).fold(0, |any, word| any | word));
    }
}

/// Scans a row to the right and to the left. Only the bits `carried` of what is handed on are.
#[inline(always)]
pub(crate) fn along(row: &mut [u32], carried: u32) {
    let (blocks, rest) = row.as_chunks_mut::<BLOCK>();
    let mut handed = 0;
    let mut anything = any(rest);
    for block in &mut *blocks {
        let own = any(block);
        if own == 0 && goes_on::<TO_THE_RIGHT>(handed) {
            handed = fill::<TO_THE_RIGHT>(block.iter_mut(), handed);
        } else if handed | own & reaching::<TO_THE_RIGHT>() != 0 {
            handed = rightwards(block, handed, carried);
        }
        anything |= own;
    }
    rightwards(rest, handed, carried);
    if anything & reaching::<TO_THE_LEFT>() == 0 {
        return;
    }
    handed = leftwards(rest, 0, carried);
    for block in blocks.iter_mut().rev() {
        let own = any(block);
        if own == 0 && goes_on::<TO_THE_LEFT>(handed) {
            handed = fill::<TO_THE_LEFT>(block.iter_mut().rev(), handed);
        } else if handed | own & reaching::<TO_THE_LEFT>() != 0 {
            handed = leftwards(block, handed, carried);
        }
    }
}

/// All bits that any of some cells has.
#[inline(always)]
fn any(block: &[u32]) -> u32 {
    block.iter().fold(0, |any, word| any | word)
}

/// Bits of which a cell has one if it hands on anything.
const fn reaching<const WAY: u32>() -> u32 {
    0x7e << WAY
}

/// Whether what is handed on reaches through a whole block, and beyond.
#[inline(always)]
const fn goes_on<const WAY: u32>(handed: u32) -> bool {
    extent::<WAY>(handed) > BLOCK as u32
}

/// Hands on through a block without extents, all of which it reaches; what the block hands on. As [`along_by_one`], cell by cell.
#[inline(always)]
fn fill<'b, const WAY: u32>(block: impl Iterator<Item = &'b mut u32>, handed: u32) -> u32 {
    let ends = if extent::<WAY>(handed) == Extents::NO_END as u32 { 0 } else { u32::MAX };
    for (word, cell) in block.zip(0u32..) {
        *word = handed.wrapping_sub(cell << WAY & ends);
    }
    handed.wrapping_sub((BLOCK as u32) << WAY & ends)
}

#[inline(always)]
fn rightwards(block: &mut [u32], mut handed: u32, carried: u32) -> u32 {
    for word in block {
        handed = along_by_one::<TO_THE_RIGHT>(word, handed) & carried;
    }
    handed
}

#[inline(always)]
fn leftwards(block: &mut [u32], mut handed: u32, carried: u32) -> u32 {
    for word in block.iter_mut().rev() {
        handed = along_by_one::<TO_THE_LEFT>(word, handed) & carried;
    }
    handed
}

/// A cell takes what it is handed; what it hands on.
#[inline(always)]
fn along_by_one<const WAY: u32>(word: &mut u32, handed: u32) -> u32 {
    // Most cells have nothing of their own, or are handed nothing.
    if *word == 0 {
        *word = handed;
        shorter::<WAY>(handed)
    } else if handed == 0 {
        handed_on::<WAY>(*word)
    } else {
        *word = taken::<WAY>(*word, handed);
        handed_on::<WAY>(*word)
    }
}

/// A row takes what the one before it on the way `WAY` hands on.
pub(crate) fn across<const WAY: u32>(from: &[u32], to: &mut [u32]) {
    let (blocks, rest) = from.as_chunks::<BLOCK>();
    let (to_blocks, to_rest) = to.as_chunks_mut::<BLOCK>();
    for (from, to) in blocks.iter().zip(to_blocks) {
        if any(from) & reaching::<WAY>() != 0 {
            take::<WAY>(from, to);
        }
    }
    take::<WAY>(rest, to_rest);
}

#[inline(always)]
fn take<const WAY: u32>(from: &[u32], to: &mut [u32]) {
    for (&from, to) in from.iter().zip(to) {
        *to = taken::<WAY>(*to, handed_on::<WAY>(from));
    }
}

/// The row that begins at `start`, and the one after it.
#[inline(always)]
pub(crate) fn rows(extents: &mut [u32], start: u32, width: u32) -> Option<(&mut [u32], &mut [u32])> {
    let two = extents.get_mut(start as usize..(start + 2 * width) as usize)?;
    two.split_at_mut_checked(width as usize)
}

/// The scans of the way down for the row that begins at `start`: along it, and what the one above it hands on.
#[inline(always)]
pub(crate) fn down(extents: &mut [u32], start: u32, width: u32) {
    if let Some(row) = extents.get_mut(start as usize..(start + width) as usize) {
        along(row, u32::MAX);
    }
    downwards(extents, start, width);
}

/// The row that begins at `start` takes what the one above it hands on.
#[inline(always)]
fn downwards(extents: &mut [u32], start: u32, width: u32) {
    if let Some(above) = start.checked_sub(width)
        && let Some((above, row)) = rows(extents, above, width)
    {
        across::<DOWNWARDS>(above, row);
    }
}

/// All rows from the last up take what the one below them hands on, and are open again; returns how many cells are covered then.
pub(crate) fn upwards(extents: &mut [u32], grid: &Grid<'_>) -> u32 {
    let width = grid.width();
    let mut covered = 0;
    for &start in grid.starts().iter().rev() {
        if let Some((row, below)) = rows(extents, start, width) {
            bring(row);
            across::<UPWARDS>(below, row);
        }
        let row = extents.get_mut(start as usize..(start + width) as usize).unwrap_or_default();
        let (blocks, rest) = row.as_chunks_mut::<BLOCK>();
        for block in blocks {
            let bits = any(block);
            if bits & !EXTENTS != 0 {
                covered += opened(block);
            } else if bits != 0 {
                covered += block.iter().map(|&word| u32::from(word != 0)).sum::<u32>();
            }
        }
        covered += opened(rest);
    }
    covered
}

/// Opens some cells; returns how many are covered.
#[inline(always)]
fn opened(block: &mut [u32]) -> u32 {
    let mut covered = 0;
    for word in block {
        *word &= EXTENTS;
        covered += u32::from(*word != 0);
    }
    covered
}

/// Spreads a map that [`super::mark()`] has marked; returns how many cells are covered.
///
/// `extents` must have a word for each cell of the grid; rows that are not all there are left out. What is spread already stays
/// as it is where extents only come from cells that are uncovered; mark anew before each spreading.
pub fn spread(extents: &mut [u32], grid: &Grid<'_>) -> u32 {
    for &start in grid.starts() {
        down(extents, start, grid.width());
    }
    upwards(extents, grid)
}
