//! The cells of a pyramid, in lent memory.

use super::levels::Levels;
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
#[derive(Clone, Copy, Debug, Default)]
pub struct Cell<V> {
    /// State, validity and depth, from the highest bit.
    meta: u32,
    value: V,
}

const VALIDITY_BITS: u32 = 5;
const STATE_SHIFT: u32 = DEPTH_BITS + VALIDITY_BITS;
const _: () = assert!(STATE_SHIFT + 2 == 32 && FULL < 1 << VALIDITY_BITS);

impl<V: Copy + Default> Cell<V> {
    /// A cell of which nothing has been worked out: what memory is set up with.
    #[must_use]
    pub const fn untouched(value: V) -> Self {
        Self { meta: 0, value }
    }

    #[inline(always)]
    const fn new(state: State, known: Known<V>) -> Self {
        Self { meta: (state as u32) << STATE_SHIFT | known.validity << DEPTH_BITS | known.depth, value: known.value }
    }

    #[inline(always)]
    const fn known(self) -> Known<V> {
        Known {
            validity: self.meta >> DEPTH_BITS & ((1 << VALIDITY_BITS) - 1),
            depth: self.meta & ((1 << DEPTH_BITS) - 1),
            value: self.value,
        }
    }
}

/// The levels above a picture.
#[derive(Debug)]
pub struct Pyramid<'s, V> {
    levels: Levels,
    cells: &'s mut [Cell<V>],
}

impl<'s, V: Copy + Default> Pyramid<'s, V> {
    /// A pyramid for a picture of `width` x `height` cells, over lent memory, whose surplus stays untouched.
    ///
    /// *Errors:* a side of 0 or over 32768, memory shorter than [`super::levels::cells`].
    pub fn new(width: u32, height: u32, memory: &'s mut [Cell<V>]) -> Result<Self, SetupError> {
        if width == 0 || height == 0 || width > 1 << 15 || height > 1 << 15 {
            return Err(SetupError::Size { width, height });
        }
        let levels = Levels::new(width, height);
        let (need, have) = (levels.cells(), memory.len());
        let Some(cells) = memory.get_mut(..need) else {
            return Err(SetupError::TooShort { plane: "pyramid", need, have });
        };
        let mut pyramid = Self { levels, cells };
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
        for cell in self.cells.iter_mut() {
            cell.meta = 0;
        }
    }

    /// The index of a cell of a level from 1 on; beyond the memory for a place that the level does not have.
    #[inline(always)]
    #[must_use]
    pub fn index(&self, level: u32, x: u32, y: u32) -> usize {
        let level = self.levels.level(level);
        if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
    }

    /// How far a cell has been worked out; a place that there is not is completed.
    #[inline(always)]
    #[must_use]
    pub fn state(&self, index: usize) -> State {
        match self.cells.get(index).map(|cell| cell.meta >> STATE_SHIFT) {
            Some(0) => State::Untouched,
            Some(1) => State::Pulled,
            _ => State::Completed,
        }
    }

    /// What is known of a cell; nothing of a place that there is not.
    #[inline(always)]
    #[must_use]
    pub fn known(&self, index: usize) -> Known<V> {
        self.cells.get(index).map_or(Known { validity: 0, depth: 0, value: V::default() }, |cell| cell.known())
    }

    #[inline(always)]
    pub(super) fn set(&mut self, index: usize, state: State, known: Known<V>) {
        if let Some(cell) = self.cells.get_mut(index) {
            *cell = Cell::new(state, known);
        }
    }
}
