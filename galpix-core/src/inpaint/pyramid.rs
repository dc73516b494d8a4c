//! The cells of a pyramid, in lent memory.

use super::levels::Levels;
use super::push_pull::each;
use super::validity::FULL;
use crate::error::SetupError;

/// Bits of a depth in a pyramid. Deeper z-buffers drop their lowest bits.
pub const DEPTH_BITS: u32 = 25;

/// What is known of a cell, of the picture or of a level above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Known<V> {
    /// How much of it is known, 0 to [`FULL`].
    pub validity: u32,
    /// Its depth, below 2^[`DEPTH_BITS`], smaller is nearer. Of a coarse cell the farthest below it; 0 where there is none.
    pub depth: u32,
    /// The mean of what is known; anything where nothing is.
    pub value: V,
}

/// How far a cell has been worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum State {
    /// Not at all.
    Untouched = 0,
    /// From below.
    Pulled = 1,
    /// And from above.
    Completed = 2,
}

/// A cell of a level above the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Cell<V> {
    /// Validity above the depth.
    meta: u32,
    value: V,
}

const _: () = assert!(DEPTH_BITS + 5 <= u32::BITS && FULL < 1 << 5);

impl<V: Copy + Default> Cell<V> {
    /// A cell of which nothing is known: what memory is set up with.
    #[must_use]
    pub const fn unknown(value: V) -> Self {
        Self { meta: 0, value }
    }

    #[inline(always)]
    const fn new(known: Known<V>) -> Self {
        Self { meta: known.validity << DEPTH_BITS | known.depth, value: known.value }
    }

    #[inline(always)]
    const fn known(self) -> Known<V> {
        Known { validity: self.meta >> DEPTH_BITS, depth: self.meta & ((1 << DEPTH_BITS) - 1), value: self.value }
    }
}

/// Cells whose states share a word.
const STATES: u32 = u32::BITS / 2;

/// Words for the states of a pyramid of `cells` cells.
#[must_use]
pub const fn state_words(cells: usize) -> usize {
    cells.div_ceil(STATES as usize)
}

/// The levels above a picture.
#[derive(Debug)]
pub struct Pyramid<'s, V> {
    levels: Levels,
    cells: &'s mut [Cell<V>],
    /// Two bits for each cell, apart from it: so that all of them are soon forgotten.
    states: &'s mut [u32],
}

impl<'s, V: Copy + Default> Pyramid<'s, V> {
    /// A pyramid for a picture of `width` x `height` cells, over lent memory, whose surplus stays untouched.
    ///
    /// *Errors:* a side of 0 or over 32768; fewer cells than [`super::levels::cells`], fewer words of states than
    /// [`state_words`] of these.
    pub fn new(width: u32, height: u32, cells: &'s mut [Cell<V>], states: &'s mut [u32]) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << 15 || height > 1 << 15 {
            return Err(SetupError::Size { width, height });
        }
        let levels = Levels::new(width, height);
        let need = levels.cells();
        let too_short = |plane, need, have| SetupError::TooShort { plane, need, have };
        let (have, have_states) = (cells.len(), states.len());
        let cells = cells.get_mut(..need).ok_or(too_short("pyramid", need, have))?;
        let need = state_words(need);
        let states = states.get_mut(..need).ok_or(too_short("pyramid's states", need, have_states))?;
        let mut pyramid = Self { levels, cells, states };
        pyramid.forget();
        Ok(pyramid)
    }

    /// The sizes of its levels.
    #[inline(always)]
    #[must_use]
    pub const fn levels(&self) -> &Levels {
        &self.levels
    }

    /// Makes all cells untouched.
    pub fn forget(&mut self) {
        self.states.fill(0);
    }

    /// The index of a cell of a level from 1 on; beyond the memory for a place that the level does not have.
    #[inline(always)]
    #[must_use]
    pub fn index(&self, level: u32, x: u32, y: u32) -> usize {
        let level = self.levels.level(level);
        if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
    }

    /// The indices of four cells of a level, 0 to one above the topmost, as [`Self::index`] gives them.
    #[inline(always)]
    pub(super) fn indices(&self, level: u32, places: [(u32, u32); 4]) -> [usize; 4] {
        if level > self.levels.top() {
            return [usize::MAX; 4];
        }
        let level = self.levels.level(level);
        each(places, |(x, y)| {
            if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
        })
    }

    /// How far a cell has been worked out; a place that there is not is completed.
    #[inline(always)]
    #[must_use]
    pub fn state(&self, index: usize) -> State {
        let word = self.states.get(index / STATES as usize).copied().unwrap_or(u32::MAX);
        match word >> ((index as u32 % STATES) << 1) & 3 {
            0 => State::Untouched,
            1 => State::Pulled,
            _ => State::Completed,
        }
    }

    /// What is known of a cell; nothing of a place that there is not.
    #[inline(always)]
    #[must_use]
    pub fn known(&self, index: usize) -> Known<V> {
        self.cells.get(index).map_or(Known { validity: 0, depth: 0, value: V::default() }, |cell| cell.known())
    }

    /// Validity and depth of a cell, and its value where it lies; nothing of a place that there is not.
    #[inline(always)]
    pub(super) fn parts(&self, index: usize) -> Option<(u32, u32, &V)> {
        let cell = self.cells.get(index)?;
        Some((cell.meta >> DEPTH_BITS, cell.meta & ((1 << DEPTH_BITS) - 1), &cell.value))
    }

    /// [`Self::parts`] of `count` neighbours, as far as there are so many.
    #[inline(always)]
    pub(super) fn run(&self, index: usize, count: usize) -> impl Iterator<Item = (u32, u32, &V)> {
        let cells = self.cells.get(index..).unwrap_or_default();
        cells.iter().take(count).map(|cell| (cell.meta >> DEPTH_BITS, cell.meta & ((1 << DEPTH_BITS) - 1), &cell.value))
    }

    /// How much of a cell is known.
    #[inline(always)]
    pub(super) fn validity(&self, index: usize) -> u32 {
        self.parts(index).map_or(0, |(validity, ..)| validity)
    }

    /// Whether some neighbours, at most sixteen, are all untouched.
    #[inline(always)]
    pub(super) fn are_untouched(&self, index: usize, count: u32) -> bool {
        let word = |word: usize| u64::from(self.states.get(word).copied().unwrap_or(u32::MAX));
        let at = index / STATES as usize;
        let both = word(at) | word(at + 1) << u32::BITS;
        both >> ((index as u32 % STATES) << 1) & ((1 << (count << 1)) - 1) == 0
    }

    /// Sets untouched neighbours of which all is known as pulled.
    #[inline(always)]
    pub(super) fn set_run<const N: usize>(&mut self, index: usize, run: &[(u32, V); N]) {
        let Some(cells) = self.cells.get_mut(index..index + N) else { return };
        for (cell, &(depth, value)) in cells.iter_mut().zip(run) {
            *cell = Cell::new(Known { validity: FULL, depth, value });
        }
        const { assert!(N <= STATES as usize) }
        // State 1 in all of them: every other bit.
        let ones = (State::Pulled as u64 * 0x5555_5555) & ((1 << (2 * N)) - 1);
        let ones = ones << ((index as u32 % STATES) << 1);
        for (word, ones) in
            [(index / STATES as usize, ones as u32), (index / STATES as usize + 1, (ones >> u32::BITS) as u32)]
        {
            if let Some(word) = self.states.get_mut(word) {
                *word |= ones;
            }
        }
    }

    /// Says that a pulled cell needs nothing from above.
    #[inline(always)]
    pub(super) fn complete(&mut self, index: usize) {
        if let Some(word) = self.states.get_mut(index / STATES as usize) {
            *word |= (State::Completed as u32) << ((index as u32 % STATES) << 1);
        }
    }

    /// Sets an untouched cell as pulled, a pulled one as completed.
    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, state: State, known: Known<V>) {
        if let (Some(cell), Some(word)) = (self.cells.get_mut(index), self.states.get_mut(index / STATES as usize)) {
            *cell = Cell::new(known);
            *word |= (state as u32) << ((index as u32 % STATES) << 1);
        }
    }
}
