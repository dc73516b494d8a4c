//! Constant work: a frame whose instructions do not depend on the picture.
//!
//! The passes of [`crate::fast::wide`] and [`crate::frame::fill`] skip what a picture does not need. Those here do the same for every
//! cell of every picture and decide by masks, all ones or 0, what of it is kept: the same words are read and written in every
//! frame of a grid, layout and budget with the same settings, whatever the map holds, only in another order. Both give the
//! same bits: map, winners, edges, tally. The edge map is made without looking for what is of one depth.
//!
//! What is out of place is read and written in place and masked out: a galpixel that leaves the map meets the first cell, a
//! neighbour beyond the border is the cell itself.
//!
//! Conditions are bits of numbers here, and the masks made of them are hidden from the optimiser, which else finds the condition
//! again and jumps. That the machine code does not is measured, see `docs/results.md`.

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

/// All ones for a negative number, else 0.
#[inline(always)]
pub(crate) const fn negative(number: i32) -> u32 {
    (number >> 31) as u32
}

/// All ones for a number that is not 0, else 0. At most 2^31.
#[inline(always)]
pub(crate) const fn not_zero(number: u32) -> u32 {
    negative(number.wrapping_neg() as i32)
}

/// All ones where `a < b`, else 0. Both below 2^31.
#[inline(always)]
pub(crate) const fn below(a: u32, b: u32) -> u32 {
    negative(a.wrapping_sub(b) as i32)
}

/// `a` where the mask has ones, else `b`.
#[inline(always)]
pub(crate) const fn choose(mask: u32, a: u32, b: u32) -> u32 {
    b ^ (a ^ b) & mask
}

/// All ones for a place that is not on the grid, else 0.
#[inline(always)]
pub(crate) fn beyond(grid: &Grid<'_>, [x, y]: [i32; 2]) -> u32 {
    negative(x) | negative(y) | !negative(x - grid.width() as i32) | !negative(y - grid.height() as i32)
}

/// The cell of a place; the first one where `beyond` has ones.
#[inline(always)]
pub(crate) fn cell_or_first(grid: &Grid<'_>, [x, y]: [i32; 2], beyond: u32) -> u32 {
    grid.row(y & !beyond as i32).unwrap_or(0) + (x & !beyond as i32) as u32
}

/// A mask of whose origin the optimiser knows nothing.
#[inline(always)]
pub(crate) fn opaque(mask: u32) -> u32 {
    core::hint::black_box(mask)
}

/// All ones for the class of an empty cell, else 0.
#[inline(always)]
pub(crate) fn empty(class: u32) -> u32 {
    const { assert!(Class::Empty as u32 == 3, "the only class with both bits set") }
    opaque((class & class >> 1 & 1).wrapping_neg())
}

/// All ones if these words are those of an empty cell, else 0.
#[inline(always)]
pub(crate) fn is_empty(record: &Record, words: &Words) -> u32 {
    empty(record.class().unsigned(words))
}

/// The words `a` where the mask has ones, else `b`.
#[inline(always)]
pub(crate) fn choose_words(record: &Record, mask: u32, a: &Words, b: &Words) -> Words {
    let mut chosen = *b;
    for (to, &from) in chosen.iter_mut().zip(a).take(record.words()) {
        *to = choose(mask, from, *to);
    }
    chosen
}

/// Writes the words of a cell where the mask has ones; reads and writes them in any case.
#[inline(always)]
pub(crate) fn merge<F: Format>(map: &mut Galpixmap<'_, F>, cell: u32, words: &Words, mask: u32) {
    let count = map.record().words();
    for (plane, &word) in map.planes_mut().iter_mut().zip(words).take(count) {
        merge_word(plane, cell, word, mask);
    }
}

/// Writes a word of a plane where the mask has ones; reads and writes it in any case.
#[inline(always)]
pub(crate) fn merge_word(plane: &mut [u32], cell: u32, word: u32, mask: u32) {
    if let Some(to) = plane.get_mut(cell as usize) {
        *to = choose(mask, word, *to);
    }
}
