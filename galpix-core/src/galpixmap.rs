//! A galpixmap: a grid of galpixels over memory that the caller lends.
//!
//! The memory is one slice of 32-bit words. Word `k` of all cells forms a plane, and the planes follow each other, so that
//! neighbours lie side by side: `memory[k * cells + cell]`. What is in a map survives the map; lend the memory again to go on.

use core::marker::PhantomData;

use crate::colour::Colour;
use crate::error::SetupError;
use crate::galpixel::{Budget, Class, Galpixel};
use crate::grid::Grid;
use crate::layout::Layout;
use crate::record::{Block, MAX_WORDS, Record};

/// A map of galpixels of layout `L` under budget `B`, over borrowed memory.
#[derive(Debug)]
pub struct Galpixmap<'p, L, B> {
    grid: Grid<'p>,
    budget: B,
    planes: [&'p mut [u32]; MAX_WORDS],
    layout: PhantomData<L>,
}

impl<'p, L: Layout, B: Budget<L>> Galpixmap<'p, L, B> {
    /// Words of memory that a map over `grid` needs.
    #[must_use]
    pub fn words(grid: &Grid<'_>, budget: B) -> usize {
        budget.record().words() * grid.cells() as usize
    }

    /// Bytes of memory for one galpixel.
    #[must_use]
    pub fn bytes_per_galpixel(budget: B) -> usize {
        budget.record().bytes()
    }

    /// Lays an empty map over `memory`, whose surplus stays untouched.
    ///
    /// *Errors:* memory shorter than [`Self::words`]; then it is left as it was.
    pub fn new(grid: Grid<'p>, budget: B, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let mut map = Self::over(grid, budget, memory)?;
        map.clear();
        Ok(map)
    }

    /// Lays a map over `memory` that already holds one of the same grid, layout and budget.
    ///
    /// Any content is a map: bits that make no sense together are at worst ugly.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn over(grid: Grid<'p>, budget: B, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let need = Self::words(&grid, budget);
        let have = memory.len();
        let too_short = SetupError::TooShort { plane: "galpixmap", need, have };
        let mut rest = memory;
        let mut planes: [&'p mut [u32]; MAX_WORDS] = Default::default();
        for plane in planes.iter_mut().take(budget.record().words()) {
            let Some((head, tail)) = rest.split_at_mut_checked(grid.cells() as usize) else {
                return Err(too_short);
            };
            *plane = head;
            rest = tail;
        }
        Ok(Self { grid, budget, planes, layout: PhantomData })
    }

    /// Makes every cell empty and black.
    pub fn clear(&mut self) {
        let (empty, _) =
            Galpixel { class: Class::Empty, ..Galpixel::default() }.stored::<L::Colour>(self.budget.record());
        for (plane, [word]) in self.planes.iter_mut().zip(empty) {
            plane.fill(word);
        }
    }

    /// The grid.
    #[inline(always)]
    #[must_use]
    pub const fn grid(&self) -> &Grid<'p> {
        &self.grid
    }

    /// The budget.
    #[must_use]
    pub const fn budget(&self) -> B {
        self.budget
    }

    /// The stored form.
    #[inline(always)]
    #[must_use]
    pub fn record(&self) -> &Record {
        self.budget.record()
    }

    /// The words of a plane, one a cell.
    #[must_use]
    pub fn plane(&self, word: usize) -> Option<&[u32]> {
        self.planes.get(word).filter(|plane| !plane.is_empty()).map(|plane| &**plane)
    }

    #[inline(always)]
    pub(crate) fn planes(&self) -> &[&'p mut [u32]; MAX_WORDS] {
        &self.planes
    }

    #[inline(always)]
    pub(crate) fn planes_mut(&mut self) -> &mut [&'p mut [u32]; MAX_WORDS] {
        &mut self.planes
    }

    /// Stores a galpixel; returns how many of its fields had to be clamped, or `None` outside of the map.
    pub fn store(&mut self, x: i32, y: i32, galpixel: &Galpixel) -> Option<u32> {
        let cell = self.grid.cell(x, y)?;
        let (block, saturated) = galpixel.stored::<L::Colour>(self.budget.record());
        self.put(cell, &block);
        Some(saturated)
    }

    /// Reads the galpixel at column `x`, row `y` of the map (wings included).
    #[must_use]
    pub fn load(&self, x: i32, y: i32) -> Option<Galpixel> {
        let block = self.block::<1>(self.grid.cell(x, y)?)?;
        Some(Galpixel::read::<L::Colour>(self.record(), &block))
    }

    /// What a cell holds; empty outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn class(&self, cell: u32) -> Class {
        match self.block::<1>(cell) {
            Some(block) => Class::from_bits(self.record().class().unsigned(&block)[0]),
            None => Class::Empty,
        }
    }

    /// The words of `N` neighbours from `cell` on, or nothing if they are not all in the map.
    #[inline(always)]
    pub(crate) fn block<const N: usize>(&self, cell: u32) -> Option<Block<N>> {
        let mut block = [[0; N]; MAX_WORDS];
        for (words, plane) in block.iter_mut().zip(&self.planes).take(self.budget.record().words()) {
            *words = *plane.get(cell as usize..)?.first_chunk::<N>()?;
        }
        Some(block)
    }

    /// Class and depth of `N` cells as one number a cell, the smaller the nearer; reads no other words.
    #[inline(always)]
    pub(crate) fn keys<const N: usize>(&self, cell: u32) -> Option<[u32; N]> {
        let record = self.record();
        let mut block = [[0; N]; MAX_WORDS];
        for field in [record.class(), record.depth()] {
            for word in [field.word, field.word + (field.spill > 0) as u8] {
                let word = word as usize & (MAX_WORDS - 1);
                block[word] = *self.planes[word].get(cell as usize..)?.first_chunk::<N>()?;
            }
        }
        Some(crate::resolve::keys(record, &block))
    }

    /// Writes the words of one cell; nothing outside of the map.
    #[inline(always)]
    pub(crate) fn put(&mut self, cell: u32, block: &Block<1>) {
        self.put_lane(cell, block, 0);
    }

    /// Writes one lane of a block to one cell; nothing outside of the map.
    #[inline(always)]
    pub(crate) fn put_lane<const N: usize>(&mut self, cell: u32, block: &Block<N>, lane: usize) {
        let words = self.budget.record().words();
        for (plane, lanes) in self.planes.iter_mut().zip(block).take(words) {
            if let (Some(word), Some(value)) = (plane.get_mut(cell as usize), lanes.get(lane)) {
                *word = *value;
            }
        }
    }

    /// Writes `N` neighbours from `cell` on; nothing if they are not all in the map.
    #[inline(always)]
    pub(crate) fn put_block<const N: usize>(&mut self, cell: u32, block: &Block<N>) {
        let words = self.budget.record().words();
        for (plane, lanes) in self.planes.iter_mut().zip(block).take(words) {
            if let Some(target) = plane.get_mut(cell as usize..).and_then(|rest| rest.first_chunk_mut::<N>()) {
                *target = *lanes;
            }
        }
    }

    /// The colour that the display shows at a cell, as a stored colour word; 0 outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn colour(&self, cell: u32) -> u32 {
        let field = self.record().colour();
        match self.block::<1>(cell) {
            Some(block) => field.unsigned(&block)[0],
            None => 0,
        }
    }

    /// The colour at column `x`, row `y` as 8-bit red, green and blue.
    #[must_use]
    pub fn rgb888(&self, x: i32, y: i32) -> Option<[u8; 3]> {
        Some(L::Colour::to_rgb888(self.colour(self.grid.cell(x, y)?)))
    }
}
