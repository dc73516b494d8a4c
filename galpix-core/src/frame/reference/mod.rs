//! The reference passes of a frame, which are also the constant-time (data-oblivious) ones.
//!
//! These passes do the same work for every cell of every picture, and use masks (all ones or 0) to select what is kept.
//! For a given grid, format and settings, every frame executes the same instructions and reads and writes the same
//! words, only in another order. The fast passes of [`crate::fast`] give the same results, bit by bit: map, winner map,
//! edge map, tally.
//!
//! Accesses outside of the map are redirected and masked out: a galpixel that leaves the map is compared with the first
//! cell, and a neighbour beyond the border is replaced by the cell itself.
//!
//! Conditions are computed as bits of numbers, and [`opaque`] hides masks from the optimiser where it would turn them
//! into jumps. `docs/results.md` has the measurement that the machine code does not depend on the picture.

mod bullet;
pub(crate) mod edge;
mod fill;
mod sweep;

pub(crate) use fill::{fill, fill_bullets};
pub(crate) use sweep::{Challenger, challenge, sweep};

use crate::format::Format;
use crate::format::record::{Record, Words};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::map::grid::Grid;

/// Returns all ones for a negative number, else 0.
#[inline(always)]
pub(crate) const fn negative(number: i32) -> u32 {
    (number >> 31) as u32
}

/// Returns all ones for a number that is not 0, else 0. The number is at most 2^31.
#[inline(always)]
pub(crate) const fn not_zero(number: u32) -> u32 {
    negative(number.wrapping_neg() as i32)
}

/// Returns all ones if `a < b`, else 0. Both are below 2^31.
#[inline(always)]
pub(crate) const fn below(a: u32, b: u32) -> u32 {
    negative(a.wrapping_sub(b) as i32)
}

/// Returns `a` where the mask has ones, else `b`.
#[inline(always)]
pub(crate) const fn choose(mask: u32, a: u32, b: u32) -> u32 {
    b ^ (a ^ b) & mask
}

/// Returns all ones for a place (column, row) that is not on the grid, else 0.
#[inline(always)]
pub(crate) fn beyond(grid: &Grid<'_>, [x, y]: [i32; 2]) -> u32 {
    negative(x) | negative(y) | !negative(x - grid.width() as i32) | !negative(y - grid.height() as i32)
}

/// Returns the cell of a place; the first cell if `beyond` has ones.
#[inline(always)]
pub(crate) fn cell_or_first(grid: &Grid<'_>, [x, y]: [i32; 2], beyond: u32) -> u32 {
    grid.row(y & !beyond as i32).unwrap_or(0) + (x & !beyond as i32) as u32
}

/// A mask of whose origin the optimiser knows nothing.
#[inline(always)]
pub(crate) fn opaque(mask: u32) -> u32 {
    core::hint::black_box(mask)
}

/// Returns all ones for the class of an empty cell, else 0.
#[inline(always)]
pub(crate) fn empty(class: u32) -> u32 {
    const { assert!(Class::Empty as u32 == 3, "the only class with both bits set") }
    opaque((class & class >> 1 & 1).wrapping_neg())
}

/// Returns all ones for the words of an empty cell, else 0.
#[inline(always)]
pub(crate) fn is_empty(record: &Record, words: &Words) -> u32 {
    empty(record.class().unsigned(words))
}

/// Returns the words `a` where the mask has ones, else `b`.
#[inline(always)]
pub(crate) fn choose_words(record: &Record, mask: u32, a: &Words, b: &Words) -> Words {
    let mut chosen = *b;
    for (to, &from) in chosen.iter_mut().zip(a).take(record.words()) {
        *to = choose(mask, from, *to);
    }
    chosen
}

/// Replaces the words of a cell where the mask has ones; reads and writes them in any case.
#[inline(always)]
pub(crate) fn merge<F: Format>(map: &mut Galpixmap<'_, F>, cell: u32, words: &Words, mask: u32) {
    let count = map.record().words();
    for (plane, &word) in map.planes_mut().iter_mut().zip(words).take(count) {
        merge_word(plane, cell, word, mask);
    }
}

/// Replaces a word of a plane where the mask has ones; reads and writes it in any case.
#[inline(always)]
pub(crate) fn merge_word(plane: &mut [u32], cell: u32, word: u32, mask: u32) {
    if let Some(to) = plane.get_mut(cell as usize) {
        *to = choose(mask, word, *to);
    }
}
