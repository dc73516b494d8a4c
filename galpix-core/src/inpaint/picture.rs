//! A plain picture with a mask, and a depth where there is one: for what is no galpixmap.

use core::marker::PhantomData;

use super::paint::Tint;
use super::push_pull::Picture;
use super::pyramid::Known;
use super::validity::FULL;
use crate::colour::Colour;
use crate::error::SetupError;

/// Colours, a bit for each of them that is known, and depths.
#[derive(Debug)]
pub struct Masked<'p, C> {
    width: u32,
    height: u32,
    colours: &'p mut [u32],
    known: &'p [u32],
    depths: &'p [u32],
    format: PhantomData<C>,
}

/// Cells of a word of a mask.
const WORD: u32 = u32::BITS;

impl<'p, C: Colour> Masked<'p, C> {
    /// `width` x `height` stored colours, row by row; cell `c` is known if bit `c mod 32` of word `c / 32` of `known` is set.
    /// `depths` below 2^25, smaller is nearer, of the holes too; empty for a picture without depth.
    ///
    /// *Errors:* a side of 0 or over 32768, a slice that is too short.
    pub fn new(
        width: u32,
        height: u32,
        colours: &'p mut [u32],
        known: &'p [u32],
        depths: &'p [u32],
    ) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << 15 || height > 1 << 15 {
            return Err(SetupError::Size { width, height });
        }
        let cells = (width * height) as usize;
        let enough = |plane, have, need| {
            if have >= need { Ok(()) } else { Err(SetupError::TooShort { plane, need, have }) }
        };
        enough("picture", colours.len(), cells)?;
        enough("mask", known.len(), cells.div_ceil(WORD as usize))?;
        if !depths.is_empty() {
            enough("depth", depths.len(), cells)?;
        }
        Ok(Self { width, height, colours, known, depths, format: PhantomData })
    }

    /// The bits of the mask from `cell` on, up to the end of its word.
    #[inline(always)]
    fn bits(&self, cell: u32) -> u32 {
        self.known.get((cell / WORD) as usize).map_or(0, |word| word >> (cell % WORD))
    }
}

impl<C: Colour> Picture for Masked<'_, C> {
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
            value: Tint::of::<C>(self.colours.get(cell as usize).copied().unwrap_or_default()),
        }
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
                        *colour = tint.colour::<C>();
                        filled += 1;
                    }
                }
                x += run;
            }
        }
        filled
    }
}
