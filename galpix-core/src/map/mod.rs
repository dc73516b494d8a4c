//! A galpixmap: a grid of galpixels over a caller-provided buffer.
//!
//! The buffer is a slice of 32-bit words. Word `k` of all cells forms a plane, and the planes follow each other, so
//! that neighbours are adjacent: word `k` of cell `cell` is `memory[k * cells + cell]`. The content outlives the map: a
//! new map over the same buffer continues with it.

pub mod galpixel;
pub mod grid;

use crate::error::SetupError;
use crate::format::Format;
use crate::format::record::{Field, MAX_WORDS, Record, Words};
use core::ops::Range;
use galpixel::{Class, Galpixel};
use grid::Grid;

/// A map of galpixels of format `F` over a caller-provided buffer.
#[derive(Debug)]
pub struct Galpixmap<'p, F> {
    grid: Grid<'p>,
    format: F,
    planes: [&'p mut [u32]; MAX_WORDS],
}

impl<'p, F: Format> Galpixmap<'p, F> {
    /// Returns the words of the buffer that a map over `grid` needs.
    #[must_use]
    pub fn words(grid: &Grid<'_>, format: F) -> usize {
        format.record().words() * grid.cells() as usize
    }

    /// Returns the bytes of the buffer for each galpixel.
    #[must_use]
    pub fn bytes_per_galpixel(format: F) -> usize {
        format.record().bytes()
    }

    /// Makes an empty map over the first words of `memory`; surplus words are not changed.
    ///
    /// *Errors:* memory shorter than [`Self::words`], which is then not changed.
    pub fn new(grid: Grid<'p>, format: F, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let mut map = Self::over(grid, format, memory)?;
        map.clear();
        Ok(map)
    }

    /// Makes a map over `memory` that already holds a map of the same grid and format.
    ///
    /// Any content is valid: arbitrary bits give an arbitrary picture, but no panic.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn over(grid: Grid<'p>, format: F, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let need = Self::words(&grid, format);
        let have = memory.len();
        let too_short = SetupError::TooShort { plane: "galpixmap", need, have };
        let mut remaining = memory;
        let mut planes: [&'p mut [u32]; MAX_WORDS] = Default::default();
        for plane in planes.iter_mut().take(format.record().words()) {
            let Some((head, tail)) = remaining.split_at_mut_checked(grid.cells() as usize) else {
                return Err(too_short);
            };
            *plane = head;
            remaining = tail;
        }
        Ok(Self { grid, format, planes })
    }

    /// Makes every cell empty and black.
    pub fn clear(&mut self) {
        let (empty, _) = Galpixel { class: Class::Empty, ..Galpixel::default() }.stored(self.format.record());
        for (plane, word) in self.planes.iter_mut().zip(empty) {
            plane.fill(word);
        }
    }

    /// Returns the grid.
    #[inline(always)]
    #[must_use]
    pub const fn grid(&self) -> &Grid<'p> {
        &self.grid
    }

    /// Returns the format.
    #[must_use]
    pub const fn format(&self) -> F {
        self.format
    }

    /// Returns the stored form of a galpixel.
    #[inline(always)]
    #[must_use]
    pub fn record(&self) -> &Record {
        self.format.record()
    }

    /// Returns word `word` of all cells, if the record has such a word.
    #[must_use]
    pub fn plane(&self, word: usize) -> Option<&[u32]> {
        self.planes.get(word).filter(|plane| !plane.is_empty()).map(|plane| &**plane)
    }

    /// Returns all planes; those of words that the record lacks are empty.
    #[inline(always)]
    pub(crate) fn planes(&self) -> &[&'p mut [u32]; MAX_WORDS] {
        &self.planes
    }

    /// Returns all planes; those of words that the record lacks are empty.
    #[inline(always)]
    pub(crate) fn planes_mut(&mut self) -> &mut [&'p mut [u32]; MAX_WORDS] {
        &mut self.planes
    }

    /// Stores a galpixel at column `x`, row `y` of the map (margin included). Returns how many of the fields velocity,
    /// acceleration and luminosity rate were clamped to their range, or `None` outside of the map.
    ///
    /// *Rounding:* to nearest, halves upwards; colours by dropping low bits.
    pub fn store(&mut self, x: i32, y: i32, galpixel: &Galpixel) -> Option<u32> {
        let cell = self.grid.cell(x, y)?;
        let (words, saturated) = galpixel.stored(self.format.record());
        self.put(cell, &words);
        Some(saturated)
    }

    /// Returns the words in which this map stores a galpixel, and how many fields were clamped, as [`Self::store`].
    /// Words that the record does not use are 0.
    #[must_use]
    pub fn stored(&self, galpixel: &Galpixel) -> ([u32; MAX_WORDS], u32) {
        galpixel.stored(self.record())
    }

    /// Replaces the colour word of a stored galpixel, for many galpixels that differ in their colour only.
    #[must_use]
    pub fn recoloured(&self, mut words: [u32; MAX_WORDS], colour: u32) -> [u32; MAX_WORDS] {
        self.record().colour().set(&mut words, colour);
        words
    }

    /// Reads the galpixel at column `x`, row `y` of the map (margin included), or `None` outside of the map.
    #[must_use]
    pub fn load(&self, x: i32, y: i32) -> Option<Galpixel> {
        let words = self.words_at(self.grid.cell(x, y)?)?;
        Some(Galpixel::read(self.record(), &words))
    }

    /// Returns the class of a cell; empty outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn class(&self, cell: u32) -> Class {
        let (word, _) = self.record().class().words();
        match self.planes[word].get(cell as usize) {
            Some(&word) => Class::from_bits(self.record().class().extract().unsigned(word, word)),
            None => Class::Empty,
        }
    }

    /// Returns the words of a cell, or `None` outside of the map.
    #[inline(always)]
    pub(crate) fn words_at(&self, cell: u32) -> Option<Words> {
        let mut words = [0; MAX_WORDS];
        for (word, plane) in words.iter_mut().zip(&self.planes).take(self.format.record().words()) {
            *word = *plane.get(cell as usize)?;
        }
        Some(words)
    }

    /// Writes the words of a cell; does nothing outside of the map.
    #[inline(always)]
    pub(crate) fn put(&mut self, cell: u32, words: &Words) {
        for (plane, word) in self.planes.iter_mut().zip(words).take(self.format.record().words()) {
            if let Some(to) = plane.get_mut(cell as usize) {
                *to = *word;
            }
        }
    }

    /// Returns the key of a cell, which is its class and depth as one number: smaller is nearer. `None` outside of the
    /// map.
    #[inline(always)]
    pub(crate) fn key_at(&self, cell: u32) -> Option<u32> {
        self.keys(cell as usize..cell as usize + 1).next()
    }

    /// Returns the keys of some cells, as [`Self::key_at`]; none if not all cells are in the map.
    #[inline(always)]
    pub(crate) fn keys(&self, cells: Range<usize>) -> impl Iterator<Item = u32> {
        self.keys_with(self.record().class(), cells)
    }

    /// Returns the depths of some cells, and above each the lower bit of the class, which galpixels and debris lack;
    /// none if not all cells are in the map.
    #[inline(always)]
    pub(crate) fn half_keys(&self, cells: Range<usize>) -> impl Iterator<Item = u32> {
        self.keys_with(self.record().lower_class(), cells)
    }

    /// Returns keys with `class`, which is the field of the class or its lower bit, above the depth.
    #[inline(always)]
    fn keys_with(&self, class: Field, cells: Range<usize>) -> impl Iterator<Item = u32> {
        let record = self.record();
        let plane = |word: usize| self.planes[word].get(cells.clone()).unwrap_or_default();
        let (class_word, _) = class.words();
        let (depth_word, spill_word) = record.depth().words();
        let depth_bits = record.depth().bits;
        let joined = record.key_field().map(|key| Field { bits: depth_bits + class.bits, ..key }.extract());
        let (class, depth) = (class.extract(), record.depth().extract());
        plane(class_word).iter().zip(plane(depth_word)).zip(plane(spill_word)).map(move |((&top, &word), &spill)| {
            match joined {
                Some(key) if F::FIXED => key.unsigned(word, word),
                _ => class.unsigned(top, top) << depth_bits | depth.unsigned(word, spill),
            }
        })
    }

    /// Returns what tells surfaces apart in a cell: its depth, and above it a bit that is set if the cell is empty.
    /// `None` outside of the map.
    #[inline(always)]
    pub(crate) fn surface_at(&self, cell: u32) -> Option<u32> {
        self.surfaces(cell as usize..cell as usize + 1).next()
    }

    /// Returns the surfaces of some cells, as [`Self::surface_at`]; none if not all cells are in the map.
    #[inline(always)]
    pub(crate) fn surfaces(&self, cells: Range<usize>) -> impl Iterator<Item = u32> {
        let record = self.record();
        let plane = |word: usize| self.planes[word].get(cells.clone()).unwrap_or_default();
        let (class_word, _) = record.class().words();
        let (depth_word, spill_word) = record.depth().words();
        let surface = record.surface(F::FIXED);
        let words = plane(class_word).iter().zip(plane(depth_word)).zip(plane(spill_word));
        words.map(move |((&class, &depth), &spill)| surface.of(class, depth, spill))
    }

    /// Returns a field of a cell as a two's complement number; 0 outside of the map.
    #[inline(always)]
    pub(crate) fn signed(&self, field: Field, cell: u32) -> i32 {
        let ((upper, lower), cell) = (field.words(), cell as usize);
        match (self.planes[upper].get(cell), self.planes[lower].get(cell)) {
            (Some(&upper), Some(&lower)) => field.extract().signed(upper, lower),
            _ => 0,
        }
    }

    /// Returns a field of a cell as an unsigned number; 0 outside of the map.
    #[inline(always)]
    pub(crate) fn unsigned(&self, field: Field, cell: u32) -> u32 {
        let ((upper, lower), cell) = (field.words(), cell as usize);
        match (self.planes[upper].get(cell), self.planes[lower].get(cell)) {
            (Some(&upper), Some(&lower)) => field.extract().unsigned(upper, lower),
            _ => 0,
        }
    }

    /// Returns whether some cells are all empty.
    #[inline(always)]
    pub(crate) fn all_empty(&self, cells: Range<usize>) -> bool {
        let (word, _) = self.record().class().words();
        let class = self.record().class().extract();
        let cells = self.planes[word].get(cells).unwrap_or_default();
        // The class of an empty cell has all its bits set.
        let common = cells.iter().fold(u32::MAX, |common, &word| common & word);
        class.unsigned(common, common) == Class::Empty as u32
    }

    /// Returns whether any of `count` cells from `cell` on is empty.
    #[inline(always)]
    pub(crate) fn any_empty(&self, cell: u32, count: u32) -> bool {
        let (word, _) = self.record().class().words();
        let cells = self.planes[word].get(cell as usize..(cell + count) as usize).unwrap_or_default();
        // Only the class of an empty cell has both bits set.
        let any = cells.iter().fold(0, |any, word| any | word & word << 1);
        any >> self.record().class().shift >> 1 & 1 != 0
    }

    /// Returns whether any of `count` cells from `cell` on was just unobscured.
    #[inline(always)]
    pub(crate) fn any_just_unobscured(&self, cell: u32, count: u32) -> bool {
        let (word, _) = self.record().class().words();
        let cells = self.planes[word].get(cell as usize..(cell + count) as usize).unwrap_or_default();
        self.hold_just_unobscured(cells)
    }

    /// Returns whether any of some words that have the class is that of a just-unobscured cell.
    #[inline(always)]
    fn hold_just_unobscured(&self, words: &[u32]) -> bool {
        const { assert!(Class::JustUnobscured as u32 == 1, "the only class with the lower bit alone") }
        let any = words.iter().fold(0, |any, word| any | word & !(word >> 1));
        any >> self.record().class().shift & 1 != 0
    }

    /// Returns how many of some cells come before the first run of `RUN` cells of which one was just unobscured; all if
    /// there is none.
    ///
    /// Not inlined: most runs have none, and so the loop over them has all registers.
    #[inline(never)]
    pub(crate) fn cells_before_just_unobscured<const RUN: usize>(&self, cells: Range<u32>) -> u32 {
        let (word, _) = self.record().class().words();
        let words = self.planes[word].get(cells.start as usize..cells.end as usize).unwrap_or_default();
        let before = words.chunks(RUN).take_while(|words| !self.hold_just_unobscured(words));
        ((before.count() * RUN) as u32).min(cells.end - cells.start)
    }

    /// Returns how many of some cells are empty, counted from the first up to one that is not.
    ///
    /// Not inlined: called for few holes, from the middle of a hot loop.
    #[inline(never)]
    pub(crate) fn empties(&self, cells: Range<usize>) -> u32 {
        let (word, _) = self.record().class().words();
        let class = self.record().class().extract();
        let cells = self.planes[word].get(cells).unwrap_or_default();
        cells.iter().take_while(|&&word| class.unsigned(word, word) == Class::Empty as u32).count() as u32
    }

    /// Returns the class that a key holds.
    #[inline(always)]
    pub(crate) fn class_of(&self, key: u32) -> u32 {
        key >> self.record().depth().bits
    }

    /// Returns the colour word of a cell, which is what a display shows; 0 outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn colour(&self, cell: u32) -> u32 {
        self.colours(cell as usize..cell as usize + 1).next().unwrap_or_default()
    }

    /// Returns the colour words of some cells; none if not all cells are in the map.
    #[inline(always)]
    pub(crate) fn colours(&self, cells: Range<usize>) -> impl ExactSizeIterator<Item = u32> {
        let field = self.record().colour();
        let plane = |word: usize| self.planes[word].get(cells.clone()).unwrap_or_default();
        let ((upper, lower), extract) = (field.words(), field.extract());
        plane(upper).iter().zip(plane(lower)).map(move |(&upper, &lower)| extract.unsigned(upper, lower))
    }

    /// Returns the colour at column `x`, row `y` of the map as 8-bit red, green and blue, or `None` outside of the map.
    #[must_use]
    pub fn rgb888(&self, x: i32, y: i32) -> Option<[u8; 3]> {
        Some(self.record().colour_format().to_rgb888(self.colour(self.grid.cell(x, y)?)))
    }
}
