//! A plain picture with a mask, and a depth where there is one: for what is no galpixmap.

#[cfg(feature = "check")]
extern crate std;

use super::kernel::Known;
use super::mean::tie;
use super::paint::OfCell;
use super::push_pull::{Holed, RUN};
use super::pyramid::DEPTH_BITS;
use super::validity::FULL;
use crate::error::SetupError;
use crate::format::colour::Colour;

/// A plain picture with holes: colours, a bit for each of them that is known, and depths.
#[derive(Debug)]
pub struct Picture<'p> {
    width: u32,
    height: u32,
    format: Colour,
    pub(super) colours: &'p mut [u32],
    known: &'p [u32],
    pub(super) depths: &'p [u32],
}

/// Cells of a word of a mask.
const WORD: u32 = u32::BITS;

fn enough(plane: &'static str, have: usize, need: usize) -> Result<(), SetupError> {
    if have >= need { Ok(()) } else { Err(SetupError::TooShort { plane, need, have }) }
}

impl<'p> Picture<'p> {
    /// Takes a picture of `width` x `height` stored colours, row by row, without depth. Cell `c` is known if bit `c mod
    /// 32` of word `c / 32` of `known` is set, and else a hole.
    ///
    /// *Errors:* a side of 0 or over 32768, a slice that is too short.
    pub fn new(
        width: u32,
        height: u32,
        format: Colour,
        colours: &'p mut [u32],
        known: &'p [u32],
    ) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << 15 || height > 1 << 15 {
            return Err(SetupError::Size { width, height });
        }
        let cells = (width * height) as usize;
        enough("picture", colours.len(), cells)?;
        enough("mask", known.len(), cells.div_ceil(WORD as usize))?;
        Ok(Self { width, height, format, colours, known, depths: &[] })
    }

    /// Adds a depth of each cell, of the holes too: below 2^25, smaller is nearer. Of others the low 25 bits count.
    ///
    /// *Errors:* a slice that is too short.
    pub fn with_depths(self, depths: &'p [u32]) -> Result<Self, SetupError> {
        enough("depth", depths.len(), self.cells())?;
        Ok(Self { depths, ..self })
    }

    /// Returns the number of cells.
    const fn cells(&self) -> usize {
        (self.width * self.height) as usize
    }

    /// Checks that there is a displacement of each cell, or none at all.
    ///
    /// *Errors:* a slice that is too short.
    pub(super) fn check_moved(&self, moved: &[u32]) -> Result<(), SetupError> {
        if moved.is_empty() { Ok(()) } else { enough("plane of displacements", moved.len(), self.cells()) }
    }

    /// Returns the holes whose bit of `mask` is set, all of them if it is empty, in a picture that has moved by so much
    /// in each cell, see [`Holes::moved`].
    pub(super) fn holes<'h, V: OfCell>(&'h mut self, mask: &'h [u32], moved: &'h [u32]) -> Holes<'h, V> {
        let table = V::table(&self.format);
        Holes { picture: Picture { colours: &mut *self.colours, ..*self }, table, mask, moved }
    }

    /// Runs a pass over a copy of the picture; returns the colours that the copy has afterwards, and what the pass
    /// returned.
    #[cfg(feature = "check")]
    pub(super) fn on_copy<R>(&self, pass: impl FnOnce(&mut Picture<'_>) -> R) -> (std::vec::Vec<u32>, R) {
        let mut colours = self.colours.to_vec();
        let result = pass(&mut Picture { colours: &mut colours, ..*self });
        (colours, result)
    }
}

/// The holes of a picture, and what they are filled with.
#[derive(Debug)]
pub struct Holes<'p, V: OfCell> {
    pub(super) picture: Picture<'p>,
    /// The colour format, looked up.
    pub(super) table: V::Table,
    /// A bit for each cell; empty for all of them.
    mask: &'p [u32],
    /// A word for each cell of how far what it shows has moved; empty where nothing has.
    pub(super) moved: &'p [u32],
}

/// Returns the bits of a mask from `cell` on, up to the end of its word.
#[inline(always)]
fn bits(mask: &[u32], cell: u32) -> u32 {
    mask.get((cell / WORD) as usize).map_or(0, |word| word >> (cell % WORD))
}

/// Returns what of a depth a pyramid can hold.
#[inline(always)]
pub(super) fn pyramid_depth(depth: u32) -> u32 {
    depth & ((1 << DEPTH_BITS) - 1)
}

impl<V: OfCell> Holes<'_, V> {
    /// Returns the place of a cell in the planes.
    #[inline(always)]
    pub(super) const fn cell(&self, x: u32, y: u32) -> u32 {
        y * self.picture.width + x
    }

    /// Returns of a cell and the [`WORD`] - 1 after it whether they are known, a bit for each.
    #[inline(always)]
    pub(super) fn known_from(&self, cell: u32) -> u32 {
        let next = self.picture.known.get((cell / WORD + 1) as usize).map_or(0, |&word| u64::from(word));
        (u64::from(bits(self.picture.known, cell)) | next << (WORD - cell % WORD)) as u32
    }

    /// Returns what is known of a cell with this colour and this depth.
    #[inline(always)]
    fn known_of(&self, cell: u32, colour: u32, depth: u32) -> Known<V> {
        let validity = (bits(self.picture.known, cell) & 1) * FULL;
        Known { validity, depth: pyramid_depth(depth), value: V::looked_up(&self.table, colour, cell) }
    }

    /// Calls `hole` with column and row of each hole that is to be filled, row by row.
    #[inline(always)]
    pub(super) fn each_hole(&mut self, mut hole: impl FnMut(&mut Self, u32, u32)) {
        let [width, height] = self.size();
        for y in 0..height {
            let row = y * width;
            let mut x = 0;
            while x < width {
                let run = (width - x).min(WORD - (row + x) % WORD);
                let wanted = if self.mask.is_empty() { u32::MAX } else { bits(self.mask, row + x) };
                let mut holes = wanted & !bits(self.picture.known, row + x) & (u32::MAX >> (WORD - run));
                while holes != 0 {
                    hole(self, x + holes.trailing_zeros(), y);
                    holes &= holes - 1;
                }
                x += run;
            }
        }
    }

    /// Gives a hole a colour.
    #[inline(always)]
    pub(super) fn set(&mut self, x: u32, y: u32, value: V) {
        let cell = self.cell(x, y);
        if let Some(colour) = self.picture.colours.get_mut(cell as usize) {
            *colour = value.colour(&self.picture.format);
        }
    }
}

impl<V: OfCell> Holed for Holes<'_, V> {
    type Value = V;

    fn size(&self) -> [u32; 2] {
        [self.picture.width, self.picture.height]
    }

    #[inline(always)]
    fn known(&self, x: u32, y: u32) -> Known<V> {
        let cell = self.cell(x, y);
        let word = |plane: &[u32]| plane.get(cell as usize).copied().unwrap_or_default();
        self.known_of(cell, word(self.picture.colours), word(self.picture.depths))
    }

    #[inline(always)]
    fn block(&self, x: u32, y: u32) -> [Known<V>; 4] {
        let (left, top, [width, height]) = (x << 1, y << 1, self.size());
        if left + 1 >= width || top + 1 >= height {
            return self.cell_by_cell(x, y);
        }
        let two = |cell: u32| {
            let pair =
                |cells: &[u32]| cells.get(cell as usize..).and_then(<[u32]>::first_chunk).copied().unwrap_or([0; 2]);
            let (colours, depths) = (pair(self.picture.colours), pair(self.picture.depths));
            [self.known_of(cell, colours[0], depths[0]), self.known_of(cell + 1, colours[1], depths[1])]
        };
        let cell = self.cell(left, top);
        let ([a, b], [c, d]) = (two(cell), two(cell + width));
        [a, b, c, d]
    }

    #[inline(always)]
    fn even_run(&self, x: u32, y: u32, threshold: u32) -> Option<[(u32, V); RUN]> {
        const CELLS: usize = 2 * RUN;
        let (left, top, [width, height]) = (x << 1, y << 1, self.size());
        if left + CELLS as u32 > width || top + 1 >= height {
            return None;
        }
        let &Picture { ref colours, depths, .. } = &self.picture;
        let (upper, lower) = (self.cell(left, top), self.cell(left, top + 1));
        let is_known = |cell: u32| self.known_from(cell) & ((1 << CELLS) - 1) == (1 << CELLS) - 1;
        if !is_known(upper) || !is_known(lower) {
            return None;
        }
        let cells =
            |plane: &'_ [u32], cell: u32| plane.get(cell as usize..).and_then(<[u32]>::first_chunk::<CELLS>).copied();
        let mut run = [(0, V::default()); RUN];
        if !depths.is_empty() {
            let (upper, lower) = (cells(depths, upper)?, cells(depths, lower)?);
            let mut uneven = 0;
            for (i, (depth, _)) in run.iter_mut().enumerate() {
                let [a, b, c, d] = [upper[2 * i], upper[2 * i + 1], lower[2 * i], lower[2 * i + 1]]
                    .map(|depth| pyramid_depth(depth) as i32);
                let (farthest, nearest) = (a.max(b).max(c.max(d)), a.min(b).min(c.min(d)));
                uneven |= u32::from((farthest - nearest) as u32 > threshold);
                *depth = farthest as u32;
            }
            if uneven != 0 {
                return None;
            }
        }
        let (above, below) = (cells(colours, upper)?, cells(colours, lower)?);
        for (i, (_, value)) in run.iter_mut().enumerate() {
            let at = |row: &[u32; CELLS], cell: u32, x: usize| V::looked_up(&self.table, row[x], cell + x as u32);
            let (left, right) = (2 * i, 2 * i + 1);
            let four =
                [at(&above, upper, left), at(&above, upper, right), at(&below, lower, left), at(&below, lower, right)];
            *value = V::plain_mean(&four, tie(x + i as u32, y, 1));
        }
        Some(run)
    }

    fn fill_holes(&mut self, mut value: impl FnMut(&Self, u32, u32) -> Option<V>) -> u32 {
        let mut filled = 0;
        self.each_hole(|holes, x, y| {
            if let Some(value) = value(holes, x, y) {
                holes.set(x, y, value);
                filled += 1;
            }
        });
        filled
    }
}
