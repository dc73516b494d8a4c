//! The cells of a pyramid, in a caller-provided buffer of words.

use super::kernel::{Known, Value, each};
use super::levels::Levels;
use super::validity::FULL;

/// Bits of a depth in a pyramid. Deeper z-buffers drop their lowest bits.
pub const DEPTH_BITS: u32 = 25;

const _: () = assert!(DEPTH_BITS + 5 <= u32::BITS && FULL < 1 << 5);

/// A value that can be stored in words.
pub trait Stored: Value {
    /// The words of a cell: that of its validity and depth, and those of its value.
    type Cell: Copy + core::fmt::Debug;

    /// How many words they are.
    const WORDS: usize;

    /// Splits memory into cells, without what is left of it.
    fn cells(memory: &mut [u32]) -> &mut [Self::Cell];

    /// Stores the word of validity and depth, and a value.
    fn encode(self, meta: u32) -> Self::Cell;

    /// Returns the word of validity and depth, and the value.
    fn decode(cell: &Self::Cell) -> (u32, Self);
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

/// Cells whose states share a word.
const STATES: u32 = u32::BITS / 2;

/// The levels above a picture.
#[derive(Debug)]
pub struct Pyramid<'s, V: Stored> {
    levels: Levels,
    cells: &'s mut [V::Cell],
    /// Two bits for each cell, apart from it: so that all of them are soon forgotten.
    states: &'s mut [u32],
}

#[inline(always)]
fn decoded<V: Stored>(cell: &V::Cell) -> Known<V> {
    let (meta, value) = V::decode(cell);
    Known { validity: meta >> DEPTH_BITS, depth: meta & ((1 << DEPTH_BITS) - 1), value }
}

#[inline(always)]
fn encoded<V: Stored>(known: Known<V>) -> V::Cell {
    known.value.encode(known.validity << DEPTH_BITS | known.depth)
}

impl<'s, V: Stored> Pyramid<'s, V> {
    /// Returns the words of memory for a pyramid of so many cells.
    #[must_use]
    pub const fn words(cells: usize) -> usize {
        cells.saturating_mul(V::WORDS).saturating_add(cells.div_ceil(STATES as usize))
    }

    /// Lays a pyramid over memory, whose surplus stays untouched, and makes all cells untouched. Returns nothing if the
    /// memory is shorter than [`Self::words`].
    pub fn over(levels: Levels, memory: &'s mut [u32]) -> Option<Self> {
        let cells = levels.cells();
        // More cannot be addressed. Without the bound rustc 1.95 divides the length of the memory on thumbv6m, by
        // `__aeabi_uidiv`: it does not know that the product of cells and words did not wrap.
        if cells > usize::MAX / 16 {
            return None;
        }
        let (values, rest) = memory.split_at_mut_checked(cells * V::WORDS)?;
        let states = rest.get_mut(..cells.div_ceil(STATES as usize))?;
        states.fill(0);
        Some(Self { levels, cells: V::cells(values), states })
    }

    /// Returns the sizes of its levels.
    #[inline(always)]
    #[must_use]
    pub const fn levels(&self) -> &Levels {
        &self.levels
    }

    /// Returns the index of a cell of a level from 1 on; one beyond the memory for a place that the level does not
    /// have.
    #[inline(always)]
    #[must_use]
    pub fn index(&self, level: u32, x: u32, y: u32) -> usize {
        let level = self.levels.level(level);
        if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
    }

    /// Returns the indices of four cells of a level, 0 to one above the topmost, as [`Self::index`] gives them.
    #[inline(always)]
    pub fn indices(&self, level: u32, places: [(u32, u32); 4]) -> [usize; 4] {
        if level > self.levels.top() {
            return [usize::MAX; 4];
        }
        let level = self.levels.level(level);
        each(places, |(x, y)| {
            if x < level.width && y < level.height { (level.start + y * level.width + x) as usize } else { usize::MAX }
        })
    }

    /// Returns how far a cell has been worked out; a place that does not exist is completed.
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

    /// Returns what is known of a cell; nothing of a place that does not exist.
    #[inline(always)]
    #[must_use]
    pub fn known(&self, index: usize) -> Known<V> {
        self.cells.get(index).map_or(Known { validity: 0, depth: 0, value: V::default() }, decoded)
    }

    /// Returns what is known of four cells.
    #[inline(always)]
    #[must_use]
    pub fn four(&self, indices: [usize; 4]) -> [Known<V>; 4] {
        each(indices, |index| self.known(index))
    }

    /// Returns what is known of `count` neighbours, as far as there are so many.
    #[inline(always)]
    pub fn run(&self, index: usize, count: usize) -> impl Iterator<Item = Known<V>> {
        self.cells.get(index..).unwrap_or_default().iter().take(count).map(decoded)
    }

    /// Returns how much of a cell is known.
    #[inline(always)]
    #[must_use]
    pub fn validity(&self, index: usize) -> u32 {
        self.cells.get(index).map_or(0, |cell| V::decode(cell).0 >> DEPTH_BITS)
    }

    /// Whether some neighbours, at most sixteen, are all untouched.
    #[inline(always)]
    #[must_use]
    pub fn are_untouched(&self, index: usize, count: u32) -> bool {
        let word = |word: usize| u64::from(self.states.get(word).copied().unwrap_or(u32::MAX));
        let at = index / STATES as usize;
        let both = word(at) | word(at + 1) << u32::BITS;
        both >> ((index as u32 % STATES) << 1) & ((1 << (count << 1)) - 1) == 0
    }

    /// Sets untouched neighbours of which all is known as pulled.
    #[inline(always)]
    pub fn set_run<const N: usize>(&mut self, index: usize, run: &[(u32, V); N]) {
        let Some(cells) = self.cells.get_mut(index..index + N) else { return };
        for (cell, &(depth, value)) in cells.iter_mut().zip(run) {
            *cell = encoded(Known { validity: FULL, depth, value });
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

    /// Marks a pulled cell as completed that takes nothing from above.
    #[inline(always)]
    pub fn complete(&mut self, index: usize) {
        if let Some(word) = self.states.get_mut(index / STATES as usize) {
            *word |= (State::Completed as u32) << ((index as u32 % STATES) << 1);
        }
    }

    /// Sets an untouched cell as pulled, a pulled one as completed.
    #[inline(always)]
    pub fn set(&mut self, index: usize, state: State, known: Known<V>) {
        if let (Some(cell), Some(word)) = (self.cells.get_mut(index), self.states.get_mut(index / STATES as usize)) {
            *cell = encoded(known);
            *word |= (state as u32) << ((index as u32 % STATES) << 1);
        }
    }
}
