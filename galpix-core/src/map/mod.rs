//! A galpixmap: a grid of galpixels over memory that the caller lends.
//!
//! The memory is one slice of 32-bit words. Word `k` of all cells forms a plane, and the planes follow each other, so that
//! neighbours lie side by side: `memory[k * cells + cell]`. What is in a map survives the map; lend the memory again to go on.

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
    /// Words of memory that a map over `grid` needs.
    #[must_use]
    pub fn words(grid: &Grid<'_>, format: F) -> usize {
        format.record().words() * grid.cells() as usize
    }

    /// Bytes of memory for one galpixel.
    #[must_use]
    pub fn bytes_per_galpixel(format: F) -> usize {
        format.record().bytes()
    }

    /// Lays an empty map over `memory`, whose surplus stays untouched.
    ///
    /// *Errors:* memory shorter than [`Self::words`]; then it is left as it was.
    pub fn new(grid: Grid<'p>, format: F, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let mut map = Self::over(grid, format, memory)?;
        map.clear();
        Ok(map)
    }

    /// Lays a map over `memory` that already holds one of the same grid, layout and budget.
    ///
    /// Any content is a map: bits that make no sense together are at worst ugly.
    ///
    /// *Errors:* memory shorter than [`Self::words`].
    pub fn over(grid: Grid<'p>, format: F, memory: &'p mut [u32]) -> Result<Self, SetupError> {
        let need = Self::words(&grid, format);
        let have = memory.len();
        let too_short = SetupError::TooShort { plane: "galpixmap", need, have };
        let mut rest = memory;
        let mut planes: [&'p mut [u32]; MAX_WORDS] = Default::default();
        for plane in planes.iter_mut().take(format.record().words()) {
            let Some((head, tail)) = rest.split_at_mut_checked(grid.cells() as usize) else {
                return Err(too_short);
            };
            *plane = head;
            rest = tail;
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

    /// The grid.
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

    /// The stored form.
    #[inline(always)]
    #[must_use]
    pub fn record(&self) -> &Record {
        self.format.record()
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
        let (words, saturated) = galpixel.stored(self.format.record());
        self.put(cell, &words);
        Some(saturated)
    }

    /// The words in which this map stores a galpixel, and how many of its fields had to be clamped. Those beyond the record's
    /// are 0.
    #[must_use]
    pub fn stored(&self, galpixel: &Galpixel) -> ([u32; MAX_WORDS], u32) {
        galpixel.stored(self.record())
    }

    /// The same words with another colour word: for many galpixels that differ in their colour only.
    #[must_use]
    pub fn recoloured(&self, mut words: [u32; MAX_WORDS], colour: u32) -> [u32; MAX_WORDS] {
        self.record().colour().set(&mut words, colour);
        words
    }

    /// Reads the galpixel at column `x`, row `y` of the map (margin included).
    #[must_use]
    pub fn load(&self, x: i32, y: i32) -> Option<Galpixel> {
        let words = self.words_at(self.grid.cell(x, y)?)?;
        Some(Galpixel::read(self.record(), &words))
    }

    /// What a cell holds; empty outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn class(&self, cell: u32) -> Class {
        let (word, _) = self.record().class().words();
        match self.planes[word].get(cell as usize) {
            Some(&word) => Class::from_bits(self.record().class().extract().unsigned(word, word)),
            None => Class::Empty,
        }
    }

    /// The words of a cell, or nothing outside of the map.
    #[inline(always)]
    pub(crate) fn words_at(&self, cell: u32) -> Option<Words> {
        let mut words = [0; MAX_WORDS];
        for (word, plane) in words.iter_mut().zip(&self.planes).take(self.format.record().words()) {
            *word = *plane.get(cell as usize)?;
        }
        Some(words)
    }

    /// Writes the words of a cell; nothing outside of the map.
    #[inline(always)]
    pub(crate) fn put(&mut self, cell: u32, words: &Words) {
        for (plane, word) in self.planes.iter_mut().zip(words).take(self.format.record().words()) {
            if let Some(to) = plane.get_mut(cell as usize) {
                *to = *word;
            }
        }
    }

    /// Class and depth of a cell as one number, the smaller the nearer, or nothing outside of the map.
    #[inline(always)]
    pub(crate) fn key_at(&self, cell: u32) -> Option<u32> {
        self.keys(cell as usize..cell as usize + 1).next()
    }

    /// Class and depth of some cells as one number each, the smaller the nearer; nothing if they are not all in the map.
    #[inline(always)]
    pub(crate) fn keys(&self, cells: Range<usize>) -> impl Iterator<Item = u32> {
        let record = self.record();
        let plane = |word: usize| self.planes[word].get(cells.clone()).unwrap_or_default();
        let (class_word, _) = record.class().words();
        let (depth_word, spill_word) = record.depth().words();
        let (class, depth, depth_bits) = (record.class().extract(), record.depth().extract(), record.depth().bits);
        let joined = record.key_field().map(Field::extract);
        plane(class_word).iter().zip(plane(depth_word)).zip(plane(spill_word)).map(move |((&top, &word), &spill)| {
            match joined {
                Some(key) if F::FIXED => key.unsigned(word, word),
                _ => class.unsigned(top, top) << depth_bits | depth.unsigned(word, spill),
            }
        })
    }

    /// A field of a cell as a two's complement number; 0 outside of the map.
    #[inline(always)]
    pub(crate) fn signed(&self, field: Field, cell: u32) -> i32 {
        let ((upper, lower), cell) = (field.words(), cell as usize);
        match (self.planes[upper].get(cell), self.planes[lower].get(cell)) {
            (Some(&upper), Some(&lower)) => field.extract().signed(upper, lower),
            _ => 0,
        }
    }

    /// Whether some cells are all empty.
    #[inline(always)]
    pub(crate) fn all_empty(&self, cells: Range<usize>) -> bool {
        let (word, _) = self.record().class().words();
        let class = self.record().class().extract();
        let cells = self.planes[word].get(cells).unwrap_or_default();
        // Empty is the class with all its bits set.
        let common = cells.iter().fold(u32::MAX, |common, &word| common & word);
        class.unsigned(common, common) == Class::Empty as u32
    }

    /// Whether any of `count` cells from `cell` on is empty.
    #[inline(always)]
    pub(crate) fn any_empty(&self, cell: u32, count: u32) -> bool {
        let (word, _) = self.record().class().words();
        let cells = self.planes[word].get(cell as usize..(cell + count) as usize).unwrap_or_default();
        // Empty is the class with both its bits set: there the upper one stays when it meets the lower one.
        let any = cells.iter().fold(0, |any, word| any | word & word << 1);
        any >> self.record().class().shift >> 1 & 1 != 0
    }

    /// Whether any of `count` cells from `cell` on was just unobscured.
    #[inline(always)]
    pub(crate) fn any_just_unobscured(&self, cell: u32, count: u32) -> bool {
        const { assert!(Class::JustUnobscured as u32 == 1, "the only class with the lower bit alone") }
        let (word, _) = self.record().class().words();
        let cells = self.planes[word].get(cell as usize..(cell + count) as usize).unwrap_or_default();
        let any = cells.iter().fold(0, |any, word| any | word & !(word >> 1));
        any >> self.record().class().shift & 1 != 0
    }

    /// How many of some cells are empty, from the first on up to one that is not.
    #[inline(never)]
    pub(crate) fn empties(&self, cells: Range<usize>) -> u32 {
        let (word, _) = self.record().class().words();
        let class = self.record().class().extract();
        let cells = self.planes[word].get(cells).unwrap_or_default();
        cells.iter().take_while(|&&word| class.unsigned(word, word) == Class::Empty as u32).count() as u32
    }

    /// The class that a key holds.
    #[inline(always)]
    pub(crate) fn class_of(&self, key: u32) -> u32 {
        key >> self.record().depth().bits
    }

    /// The colour that the display shows at a cell, as a stored colour word; 0 outside of the map.
    #[inline(always)]
    #[must_use]
    pub fn colour(&self, cell: u32) -> u32 {
        self.colours(cell as usize..cell as usize + 1).next().unwrap_or_default()
    }

    /// The colour words of some cells; nothing if they are not all in the map.
    #[inline(always)]
    pub(crate) fn colours(&self, cells: Range<usize>) -> impl ExactSizeIterator<Item = u32> {
        let field = self.record().colour();
        let plane = |word: usize| self.planes[word].get(cells.clone()).unwrap_or_default();
        let ((upper, lower), extract) = (field.words(), field.extract());
        plane(upper).iter().zip(plane(lower)).map(move |(&upper, &lower)| extract.unsigned(upper, lower))
    }

    /// The colour at column `x`, row `y` as 8-bit red, green and blue.
    #[must_use]
    pub fn rgb888(&self, x: i32, y: i32) -> Option<[u8; 3]> {
        Some(self.record().colour_format().to_rgb888(self.colour(self.grid.cell(x, y)?)))
    }
}
