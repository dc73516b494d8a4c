//! The active tiles: which cells of which levels are requested. A bit for each cell, in tiles, so that what lies
//! together comes together.

use crate::inpaint::levels::{Levels, MOST};

/// Columns and rows of a tile.
const SIDE: u32 = 16;

/// Words of a tile.
pub const WORDS: usize = (SIDE * SIDE / u32::BITS) as usize;

/// The bits of a tile, row by row, two rows in a word.
pub type Tile = [u32; WORDS];

const ROWS_IN_A_WORD: u32 = u32::BITS / SIDE;

/// The bits of levels 0 to the last one.
#[derive(Debug)]
pub struct ActiveTiles<'s> {
    levels: Levels,
    last: u32,
    /// The first tile of each level.
    starts: [usize; MOST + 1],
    tiles: &'s mut [Tile],
}

const fn columns(width: u32) -> u32 {
    width.div_ceil(SIDE)
}

/// Returns the words of memory for the levels up to `last` of a picture of `width` x `height` cells.
#[must_use]
pub const fn words(width: u32, height: u32, last: u32) -> usize {
    let (mut tiles, mut level, mut size) = (0, 0, (width, height));
    while level <= last {
        tiles += (columns(size.0) * columns(size.1)) as usize;
        size = (size.0.div_ceil(2), size.1.div_ceil(2));
        level += 1;
    }
    tiles * WORDS
}

impl<'s> ActiveTiles<'s> {
    /// Requests nothing yet of the levels up to `last`. Returns nothing if the memory is shorter than [`words`].
    pub fn new(levels: Levels, last: u32, memory: &'s mut [u32]) -> Option<Self> {
        let base = levels.level(0);
        let memory = memory.get_mut(..words(base.width, base.height, last))?;
        memory.fill(0);
        let mut starts = [0; MOST + 1];
        let mut start = 0;
        for (level, to) in (0..).zip(&mut starts) {
            *to = start;
            let size = levels.level(level);
            start += (columns(size.width) * columns(size.height)) as usize;
        }
        Some(Self { levels, last, starts, tiles: memory.as_chunks_mut().0 })
    }

    #[inline(always)]
    fn start(&self, level: u32) -> usize {
        self.starts.get(level as usize).copied().unwrap_or(usize::MAX)
    }

    /// Requests a cell of a level; none beyond it.
    #[inline(always)]
    pub fn request(&mut self, level: u32, x: u32, y: u32) {
        let size = self.levels.level(level);
        if level > self.last || x >= size.width || y >= size.height {
            return;
        }
        let tile = self.start(level) + (y / SIDE * columns(size.width) + x / SIDE) as usize;
        let row = y % SIDE;
        let word = (row / ROWS_IN_A_WORD) as usize;
        if let Some(word) = self.tiles.get_mut(tile).and_then(|tile| tile.get_mut(word)) {
            *word |= 1 << (row % ROWS_IN_A_WORD * SIDE + x % SIDE);
        }
    }

    /// Returns the next active tile of a level from tile `from` on: its first column and row, its bits, and the tile to
    /// go on with.
    #[inline]
    #[must_use]
    pub fn next(&self, level: u32, from: usize) -> Option<(u32, u32, Tile, usize)> {
        let size = self.levels.level(level);
        let start = self.start(level);
        let count = (columns(size.width) * columns(size.height)) as usize;
        let of_level = self.tiles.get(start..start + count)?;
        let offset = of_level.get(from..)?.iter().position(|tile| *tile != Tile::default())?;
        let at = from + offset;
        let (column, row) = (at as u32 % columns(size.width), at as u32 / columns(size.width));
        Some((column * SIDE, row * SIDE, *of_level.get(at)?, at + 1))
    }

    /// Returns the bits of 8 x 8 cells of a level, row by row from the lowest one; `left` and `top` are multiples of 8.
    #[inline(always)]
    #[must_use]
    pub fn bits(&self, level: u32, left: u32, top: u32) -> u64 {
        let size = self.levels.level(level);
        if level > self.last || left >= size.width || top >= size.height {
            return 0;
        }
        let tile = self.start(level) + (top / SIDE * columns(size.width) + left / SIDE) as usize;
        let first = (top % SIDE / ROWS_IN_A_WORD) as usize;
        let words = self.tiles.get(tile).map_or(&[][..], |tile| tile.get(first..).unwrap_or_default());
        words.iter().take(4).rev().fold(0, |bits, word| {
            let word = word >> (left % SIDE);
            bits << 16 | u64::from(word & 0xff | word >> (SIDE - 8) & 0xff00)
        })
    }

    /// Calls `each` for every requested cell of a level, tile by tile.
    #[inline(always)]
    pub fn each(&self, level: u32, mut each: impl FnMut(u32, u32)) {
        let mut from = 0;
        while let Some((left, top, tile, next)) = self.next(level, from) {
            in_tile(left, top, tile, &mut each);
            from = next;
        }
    }
}

/// Calls `each` for every requested cell of a tile, row by row.
#[inline(always)]
pub fn in_tile(left: u32, top: u32, tile: Tile, mut each: impl FnMut(u32, u32)) {
    for (y, mut bits) in (top..).step_by(ROWS_IN_A_WORD as usize).zip(tile) {
        while bits != 0 {
            let at = bits.trailing_zeros();
            each(left + at % SIDE, y + at / SIDE);
            bits &= bits - 1;
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::vec;
    use std::vec::Vec;

    use super::*;

    #[test]
    fn what_is_requested_comes_back_tile_by_tile_and_row_by_row() {
        let (width, height) = (70, 37);
        let levels = Levels::new(width, height);
        let mut memory = vec![u32::MAX; words(width, height, 2)];
        let mut active = ActiveTiles::new(levels, 2, &mut memory).unwrap();
        let is_requested = |level: u32, x: u32, y: u32| (x * 7 + y * 13 + level).is_multiple_of(5);
        for level in 0..4 {
            for (x, y) in (0..40).flat_map(|y| (0..80).map(move |x| (x, y))) {
                if is_requested(level, x, y) {
                    active.request(level, x, y);
                }
            }
        }
        for level in 0..=2 {
            let size = levels.level(level);
            let mut expected: Vec<(u32, u32)> = (0..size.height)
                .flat_map(|y| (0..size.width).map(move |x| (x, y)))
                .filter(|&(x, y)| is_requested(level, x, y))
                .collect();
            expected.sort_by_key(|&(x, y)| (y / SIDE, x / SIDE, y, x));
            let mut seen = Vec::new();
            active.each(level, |x, y| seen.push((x, y)));
            assert_eq!(seen, expected);
            for (left, top) in (0..40).step_by(8).flat_map(|top| (0..80).step_by(8).map(move |left| (left, top))) {
                let bits = active.bits(level, left, top);
                for at in 0..64 {
                    let (x, y) = (left + at % 8, top + at / 8);
                    let inside = x < size.width && y < size.height;
                    assert_eq!(bits >> at & 1 == 1, inside && is_requested(level, x, y), "{level} {x} {y}");
                }
            }
        }
        assert!(active.next(3, 0).is_none());
        assert!(ActiveTiles::new(levels, 2, &mut vec![0; words(width, height, 2) - 1]).is_none());
    }
}
