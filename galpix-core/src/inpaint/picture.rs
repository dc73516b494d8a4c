//! A plain picture with a mask, and a depth where there is one: for what is no galpixmap.

#[cfg(feature = "check")]
extern crate std;

use super::kernel::{Known, Value};
use super::mean::tie;
use super::paint::{Tint, TintOf};
use super::push_pull::{Holed, RUN};
use super::validity::FULL;
use crate::error::SetupError;
use crate::format::colour::Colour;

/// A plain picture with holes: colours, a bit for each of them that is known, and depths.
#[derive(Debug)]
pub struct Picture<'p> {
    width: u32,
    height: u32,
    format: Colour,
    tint_of: TintOf,
    colours: &'p mut [u32],
    known: &'p [u32],
    depths: &'p [u32],
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
        Ok(Self { width, height, format, tint_of: TintOf::new(&format), colours, known, depths: &[] })
    }

    /// Adds a depth of each cell, of the holes too: below 2^25, smaller is nearer.
    ///
    /// *Errors:* a slice that is too short.
    pub fn with_depths(self, depths: &'p [u32]) -> Result<Self, SetupError> {
        enough("depth", depths.len(), (self.width * self.height) as usize)?;
        Ok(Self { depths, ..self })
    }

    /// Returns the bits of the mask from `cell` on, up to the end of its word.
    #[inline(always)]
    fn bits(&self, cell: u32) -> u32 {
        self.known.get((cell / WORD) as usize).map_or(0, |word| word >> (cell % WORD))
    }

    /// Returns the colours.
    #[cfg(feature = "check")]
    pub(super) const fn colours(&self) -> &[u32] {
        self.colours
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

impl Holed for Picture<'_> {
    type Value = Tint;

    fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    #[inline(always)]
    fn known(&self, x: u32, y: u32) -> Known<Tint> {
        let cell = y * self.width + x;
        Known {
            validity: (self.bits(cell) & 1) * FULL,
            depth: self.depths.get(cell as usize).copied().unwrap_or_default(),
            value: self.tint_of.tint(self.colours.get(cell as usize).copied().unwrap_or_default()),
        }
    }

    #[inline(always)]
    fn block(&self, x: u32, y: u32) -> [Known<Tint>; 4] {
        let (left, top) = (x << 1, y << 1);
        if left + 1 >= self.width || top + 1 >= self.height {
            return self.cell_by_cell(x, y);
        }
        let two = |cell: u32| {
            let pair =
                |cells: &[u32]| cells.get(cell as usize..).and_then(<[u32]>::first_chunk).copied().unwrap_or([0; 2]);
            let (colours, depths) = (pair(self.colours), pair(self.depths));
            let bits = [self.bits(cell), self.bits(cell + 1)];
            [0, 1].map(|i: usize| Known {
                validity: (bits[i] & 1) * FULL,
                depth: depths[i],
                value: self.tint_of.tint(colours[i]),
            })
        };
        let cell = top * self.width + left;
        let ([a, b], [c, d]) = (two(cell), two(cell + self.width));
        [a, b, c, d]
    }

    #[inline(always)]
    fn even_run(&self, x: u32, y: u32, threshold: u32) -> Option<[(u32, Tint); RUN]> {
        const CELLS: usize = 2 * RUN;
        let (left, top) = (x << 1, y << 1);
        if left + CELLS as u32 > self.width || top + 1 >= self.height {
            return None;
        }
        let cell = top * self.width + left;
        let known = |cell: u32| {
            let next = self.known.get((cell / WORD + 1) as usize).map_or(0, |&word| u64::from(word));
            (u64::from(self.bits(cell)) | next << (WORD - cell % WORD)) as u32 & ((1 << CELLS) - 1) == (1 << CELLS) - 1
        };
        if !known(cell) || !known(cell + self.width) {
            return None;
        }
        let cells =
            |plane: &'_ [u32], cell: u32| plane.get(cell as usize..).and_then(<[u32]>::first_chunk::<CELLS>).copied();
        let mut run = [(0, Tint::default()); RUN];
        if !self.depths.is_empty() {
            let (upper, lower) = (cells(self.depths, cell)?, cells(self.depths, cell + self.width)?);
            let mut uneven = 0;
            for (i, (depth, _)) in run.iter_mut().enumerate() {
                let [a, b, c, d] =
                    [upper[2 * i], upper[2 * i + 1], lower[2 * i], lower[2 * i + 1]].map(|depth| depth as i32);
                let (farthest, nearest) = (a.max(b).max(c.max(d)), a.min(b).min(c.min(d)));
                uneven |= u32::from((farthest - nearest) as u32 > threshold);
                *depth = farthest as u32;
            }
            if uneven != 0 {
                return None;
            }
        }
        let (upper, lower) = (cells(self.colours, cell)?, cells(self.colours, cell + self.width)?);
        for (i, (_, value)) in run.iter_mut().enumerate() {
            let four = [upper[2 * i], upper[2 * i + 1], lower[2 * i], lower[2 * i + 1]]
                .map(|colour| self.tint_of.tint(colour));
            *value = Tint::plain_mean(&four, tie(x + i as u32, y, 1));
        }
        Some(run)
    }

    fn fill_holes(&mut self, mut value: impl FnMut(&Self, u32, u32) -> Option<Tint>) -> u32 {
        let mut filled = 0;
        for y in 0..self.height {
            let row = y * self.width;
            let mut x = 0;
            while x < self.width {
                let run = (self.width - x).min(WORD - (row + x) % WORD);
                let mut holes = !self.bits(row + x) & (u32::MAX >> (WORD - run));
                while holes != 0 {
                    let hole = x + holes.trailing_zeros();
                    holes &= holes - 1;
                    if let Some(tint) = value(self, hole, y)
                        && let Some(colour) = self.colours.get_mut((row + hole) as usize)
                    {
                        *colour = tint.colour(&self.format);
                        filled += 1;
                    }
                }
                x += run;
            }
        }
        filled
    }
}
