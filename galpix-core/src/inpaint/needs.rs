//! Which cells of which levels are asked for: a bit for each, in tiles, so that what lies together comes together.

use super::levels::{Levels, MOST};
use crate::error::SetupError;

/// Columns and rows of a tile.
const SIDE: u32 = 16;

/// The bits of a tile, row by row.
pub type Tile = [u16; SIDE as usize];

/// The bits of levels 0 to the last one.
#[derive(Debug)]
pub struct Needs<'s> {
    levels: Levels,
    last: u32,
    /// The first tile of each level.
    starts: [usize; MOST + 1],
    tiles: &'s mut [Tile],
}

const fn columns(width: u32) -> u32 {
    width.div_ceil(SIDE)
}

/// Tiles for the levels up to `last` of a picture of `width` x `height` cells.
#[must_use]
pub const fn tiles(width: u32, height: u32, last: u32) -> usize {
    let (mut tiles, mut level, mut size) = (0, 0, (width, height));
    while level <= last {
        tiles += (columns(size.0) * columns(size.1)) as usize;
        size = (size.0.div_ceil(2), size.1.div_ceil(2));
        level += 1;
    }
    tiles
}

impl<'s> Needs<'s> {
    /// No cells, of the levels up to `last`.
    ///
    /// *Errors:* memory shorter than [`tiles`].
    pub fn new(levels: Levels, last: u32, memory: &'s mut [Tile]) -> Result<Self, SetupError> {
        let (need, have) = (tiles(levels.level(0).width, levels.level(0).height, last), memory.len());
        let Some(tiles) = memory.get_mut(..need) else {
            return Err(SetupError::TooShort { plane: "needs", need, have });
        };
        tiles.fill(Tile::default());
        let mut starts = [0; MOST + 1];
        let mut start = 0;
        for (level, to) in (0..).zip(&mut starts) {
            *to = start;
            let size = levels.level(level);
            start += (columns(size.width) * columns(size.height)) as usize;
        }
        Ok(Self { levels, last, starts, tiles })
    }

    #[inline(always)]
    fn start(&self, level: u32) -> usize {
        self.starts.get(level as usize).copied().unwrap_or(usize::MAX)
    }

    /// Asks for a cell of a level; for none beyond it.
    #[inline(always)]
    pub fn ask(&mut self, level: u32, x: u32, y: u32) {
        let size = self.levels.level(level);
        if level > self.last || x >= size.width || y >= size.height {
            return;
        }
        let tile = self.start(level) + (y / SIDE * columns(size.width) + x / SIDE) as usize;
        if let Some(row) = self.tiles.get_mut(tile).and_then(|tile| tile.get_mut((y % SIDE) as usize)) {
            *row |= 1 << (x % SIDE);
        }
    }

    /// The tiles of a level that have cells that are asked for: the first column and row of the next one from `from` on, its bits,
    /// and what comes after it.
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

    /// The bits of 8 x 8 cells of a level, row by row from the lowest one; `left` and `top` are multiples of 8.
    #[inline(always)]
    #[must_use]
    pub fn bits(&self, level: u32, left: u32, top: u32) -> u64 {
        let size = self.levels.level(level);
        if level > self.last || left >= size.width || top >= size.height {
            return 0;
        }
        let tile = self.start(level) + (top / SIDE * columns(size.width) + left / SIDE) as usize;
        let rows = self.tiles.get(tile).map_or(&[][..], |tile| tile.get((top % SIDE) as usize..).unwrap_or_default());
        rows.iter().take(8).rev().fold(0, |bits, row| bits << 8 | u64::from(row >> (left % SIDE) & 0xff))
    }

    /// Calls `each` for every cell of a level that is asked for, tile by tile.
    #[inline(always)]
    pub fn each(&self, level: u32, mut each: impl FnMut(u32, u32)) {
        let mut from = 0;
        while let Some((left, top, tile, next)) = self.next(level, from) {
            in_tile(left, top, tile, &mut each);
            from = next;
        }
    }
}

/// Calls `each` for every cell of a tile that is asked for.
#[inline(always)]
pub fn in_tile(left: u32, top: u32, tile: Tile, mut each: impl FnMut(u32, u32)) {
    for (y, mut bits) in (top..).zip(tile) {
        while bits != 0 {
            each(left + bits.trailing_zeros(), y);
            bits &= bits - 1;
        }
    }
}
