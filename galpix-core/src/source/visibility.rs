//! The visibility buffer: for each cell of the display which sample it shows, and where the cell's centre lies beside
//! that sample.
//!
//! An *entry* has a key of 16 bits and a word of 32 bits. The smaller entry wins, first by key, then by word. That is a
//! total order, so that samples may arrive in any order:
//!
//! ```text
//! key    depth, 15 bits | 1 for a point, 0 for a quad
//! word   sample, 22 bits | residual in x, 5 bits | residual in y, 5 bits
//! ```
//!
//! The residual is the place of the cell's centre minus that of the sample, in sixteenths of a cell, -16 to 15.
//!
//! *Memory:* 6 bytes a cell, and 16 bytes a column for [`cracks`](super::cracks).

use crate::error::SetupError;
use crate::frame::reference;
use crate::map::grid::Grid;

/// Bits of a sample's number, which is its cell, plus the cells of the map for each layer before its own.
const SAMPLE_BITS: u32 = 22;

/// The most samples of all layers together.
pub const MOST_SAMPLES: u32 = 1 << SAMPLE_BITS;

/// The base-2 logarithm of the parts of a cell in which residuals count.
pub(crate) const PARTS: u32 = 4;

/// Bits of a component of the residual.
pub(crate) const RESIDUAL_BITS: u32 = PARTS + 1;

/// Bits of the depth in a key.
pub(crate) const DEPTH_BITS: u32 = 15;

/// The key of a cell that shows no sample. Larger than every other key.
pub(crate) const EMPTY: u16 = u16::MAX;

/// The largest depth of an entry.
pub(crate) const FARTHEST: u32 = (1 << DEPTH_BITS) - 2;

/// Half-words of an entry that is postponed: column, key, and word.
const POSTPONED: usize = 4;

/// What a cell shows of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Entry {
    key: u16,
    word: u32,
}

/// Where an entry comes from: of equal depths a quad is before a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A cell within four samples of a stretched surface.
    Quad = 0,
    /// The cell nearest to a sample.
    Point = 1,
}

impl Entry {
    /// No sample.
    pub(crate) const NONE: Self = Self { key: EMPTY, word: u32::MAX };

    /// Makes an entry. The depth has [`DEPTH_BITS`] bits and is clamped to its range, as the residual.
    #[inline(always)]
    pub(crate) fn new(depth: u32, kind: Kind, sample: u32, residual: [i32; 2]) -> Self {
        Self {
            key: (depth.min(FARTHEST) << 1) as u16 | kind as u16,
            word: sample << (2 * RESIDUAL_BITS) | packed(residual),
        }
    }

    /// Returns whether there is a sample.
    #[inline(always)]
    pub(crate) const fn is_some(self) -> bool {
        self.key != EMPTY
    }

    /// Returns whether there is a sample that is seen in the cell nearest to it.
    #[cfg(any(test, feature = "check"))]
    pub(crate) const fn is_point(self) -> bool {
        self.is_some() && self.key & Kind::Point as u16 != 0
    }

    /// Returns the depth, [`DEPTH_BITS`] bits; behind everything if there is no sample.
    #[inline(always)]
    pub(crate) const fn depth(self) -> i32 {
        (self.key >> 1) as i32
    }

    /// Returns the number of the sample.
    #[inline(always)]
    pub(crate) const fn sample(self) -> u32 {
        self.word >> (2 * RESIDUAL_BITS)
    }

    /// Returns the residual, in sixteenths of a cell.
    #[inline(always)]
    pub(crate) const fn residual(self) -> [i32; 2] {
        const UNUSED: u32 = 32 - RESIDUAL_BITS;
        [(self.word << (UNUSED - RESIDUAL_BITS)) as i32 >> UNUSED, (self.word << UNUSED) as i32 >> UNUSED]
    }

    /// Returns key and word; `None` if there is no sample.
    pub(crate) const fn parts(self) -> Option<(u16, u32)> {
        if self.is_some() { Some((self.key, self.word)) } else { None }
    }

    /// Returns the same sample as seen from a cell whose residual is another one.
    #[inline(always)]
    pub(crate) fn seen_from(self, residual: [i32; 2]) -> Self {
        Self { word: self.sample() << (2 * RESIDUAL_BITS) | packed(residual), ..self }
    }

    /// Returns `self` where the mask has ones, else `other`.
    #[inline(always)]
    pub(crate) fn or(self, mask: u32, other: Self) -> Self {
        Self {
            key: reference::choose(mask, self.key.into(), other.key.into()) as u16,
            word: reference::choose(mask, self.word, other.word),
        }
    }

    #[cfg(test)]
    const fn is_before(self, other: Self) -> bool {
        self.key < other.key || self.key == other.key && self.word < other.word
    }
}

/// Returns the low bits of a word for a residual, each component clamped to its range.
#[inline(always)]
fn packed(residual: [i32; 2]) -> u32 {
    const MASK: u32 = (1 << RESIDUAL_BITS) - 1;
    let [x, y] = residual.map(|part| part.clamp(-(1 << PARTS), (1 << PARTS) - 1) as u32 & MASK);
    x << RESIDUAL_BITS | y
}

/// Returns a depth of `bits` bits with [`DEPTH_BITS`] bits; further bits are dropped.
#[inline(always)]
pub(crate) const fn depth(depth: u32, bits: u32) -> u32 {
    if bits > DEPTH_BITS { depth >> (bits - DEPTH_BITS) } else { depth << (DEPTH_BITS - bits) }
}

/// Returns a threshold of depths of `bits` bits for depths of [`DEPTH_BITS`] bits. No two depths differ by more than
/// the largest.
#[inline(always)]
pub(crate) const fn threshold(threshold: u32, bits: u32) -> i32 {
    let most = 1 << DEPTH_BITS;
    let threshold = if bits > DEPTH_BITS {
        threshold >> (bits - DEPTH_BITS)
    } else if threshold >= most {
        most
    } else {
        threshold << (DEPTH_BITS - bits)
    };
    if threshold < most { threshold as i32 } else { most as i32 }
}

/// The visibility buffer of a display, in caller-provided buffers.
#[derive(Debug)]
pub struct Visibility<'p> {
    grid: Grid<'p>,
    keys: &'p mut [u16],
    words: &'p mut [u32],
    /// Entries of two rows that are not shown yet, see [`Self::postpone`].
    line: &'p mut [u16],
}

impl<'p> Visibility<'p> {
    /// Returns the half-words of the third buffer of [`Self::new`].
    #[must_use]
    pub const fn line_half_words(grid: &Grid<'_>) -> usize {
        2 * POSTPONED * grid.width() as usize
    }

    /// Makes the buffer for a grid, of a half-word and a word for each cell and [`Self::line_half_words`] half-words.
    /// What they hold does not matter.
    ///
    /// *Errors:* a buffer that is too short.
    pub fn new(
        grid: &Grid<'p>,
        keys: &'p mut [u16],
        words: &'p mut [u32],
        line: &'p mut [u16],
    ) -> Result<Self, SetupError> {
        let cells = grid.cells() as usize;
        let short = |plane, need, have| SetupError::TooShort { plane, need, have };
        let (have_keys, have_words, have_line) = (keys.len(), words.len(), line.len());
        let need = Self::line_half_words(grid);
        Ok(Self {
            grid: *grid,
            keys: keys.get_mut(..cells).ok_or(short("plane of keys", cells, have_keys))?,
            words: words.get_mut(..cells).ok_or(short("plane of entries", cells, have_words))?,
            line: line.get_mut(..need).ok_or(short("line of entries", need, have_line))?,
        })
    }

    /// Returns the grid of the display.
    pub(crate) const fn grid(&self) -> Grid<'p> {
        self.grid
    }

    /// Makes all cells show no sample. What their words hold does then not matter.
    pub(crate) fn clear(&mut self) {
        self.keys.fill(EMPTY);
    }

    /// Returns what a cell shows; nothing outside of the map.
    #[inline(always)]
    pub(crate) fn at(&self, cell: u32) -> Entry {
        match (self.keys.get(cell as usize), self.words.get(cell as usize)) {
            (Some(&key), Some(&word)) if key != EMPTY => Entry { key, word },
            _ => Entry::NONE,
        }
    }

    /// Returns the key and the word of a cell, whatever they are; those of an empty cell outside of the map.
    #[inline(always)]
    fn stored(&self, cell: u32) -> Entry {
        match (self.keys.get(cell as usize), self.words.get(cell as usize)) {
            (Some(&key), Some(&word)) => Entry { key, word },
            _ => Entry::NONE,
        }
    }

    /// Returns all ones for a cell that shows no sample, else 0.
    #[inline(always)]
    pub(crate) fn is_empty(&self, cell: u32) -> u32 {
        reference::opaque(u32::from(self.stored(cell).key == EMPTY).wrapping_neg())
    }

    /// Returns what the cell of a place shows; nothing outside of the map. In constant time the word of nothing is any.
    #[inline(always)]
    pub(crate) fn at_place<const CONSTANT_TIME: bool>(&self, place: [i32; 2]) -> Entry {
        if !CONSTANT_TIME {
            return self.grid.cell(place[0], place[1]).map_or(Entry::NONE, |cell| self.at(cell));
        }
        let beyond = reference::beyond(&self.grid, place);
        let stored = self.stored(reference::cell_or_first(&self.grid, place, beyond));
        Entry { key: stored.key | beyond as u16, ..stored }
    }

    /// Returns keys and words of some cells; none if not all of them are in the buffer.
    #[inline(always)]
    pub(crate) fn cells_from(&self, cell: u32, count: usize) -> (&[u16], &[u32]) {
        let cells = cell as usize..cell as usize + count;
        (self.keys.get(cells.clone()).unwrap_or_default(), self.words.get(cells).unwrap_or_default())
    }

    /// Shows an entry in a cell if it is before what the cell shows.
    #[cfg(test)]
    pub(crate) fn challenge(&mut self, cell: u32, entry: Entry) {
        if let (Some(key), Some(word)) = (self.keys.get_mut(cell as usize), self.words.get_mut(cell as usize))
            && entry.is_before(Entry { key: *key, word: *word })
        {
            (*key, *word) = (entry.key, entry.word);
        }
    }

    /// Shows an entry at a place, if the mask has ones, the place is on the map, and the entry is before what its cell
    /// shows. Reads and writes in any case.
    #[inline(always)]
    pub(crate) fn challenge_where(&mut self, mask: u32, place: [i32; 2], entry: Entry) {
        let beyond = reference::beyond(&self.grid, place);
        let cell = reference::cell_or_first(&self.grid, place, beyond) as usize;
        if let (Some(key), Some(word)) = (self.keys.get_mut(cell), self.words.get_mut(cell)) {
            let order = |key: u16, word: u32| u64::from(key) << 32 | u64::from(word);
            let wins = u32::from(order(entry.key, entry.word) < order(*key, *word)).wrapping_neg();
            let mask = reference::opaque(mask & !beyond & wins);
            *key = reference::choose(mask, entry.key.into(), (*key).into()) as u16;
            *word = reference::choose(mask, entry.word, *word);
        }
    }

    /// Keeps column `x` in a list of row `y`, as its number `count`. The list of a row lies where the last entries of
    /// [`Self::postpone`] would: if as many are read as are postponed, each is read before it is written over.
    #[inline(always)]
    pub(crate) fn list(&mut self, y: usize, count: usize, x: usize) {
        let at = self.list_of(y) + count;
        if let Some(place) = self.line.get_mut(at) {
            *place = x as u16;
        }
    }

    /// Returns column number `count` of the list of row `y`.
    #[inline(always)]
    pub(crate) fn listed(&self, y: usize, count: usize) -> u32 {
        self.line.get(self.list_of(y) + count).copied().unwrap_or_default().into()
    }

    #[inline(always)]
    fn list_of(&self, y: usize) -> usize {
        let half = self.line.len() >> 1;
        (y & 1) * half + half - half / POSTPONED
    }

    /// Returns the keys and the words of all cells, and the line, for passes that take many cells at once.
    #[inline(always)]
    pub(crate) fn planes(&mut self) -> (&mut [u16], &mut [u32], &mut [u16]) {
        (self.keys, self.words, self.line)
    }

    /// Keeps an entry for column `x` of row `y` until [`Self::settle`], as number `count` of its row.
    #[inline(always)]
    pub(crate) fn postpone(&mut self, y: usize, count: usize, x: u32, entry: Entry) {
        let at = (y & 1) * (self.line.len() >> 1) + POSTPONED * count;
        if let Some(place) = self.line.get_mut(at..).and_then(|line| line.first_chunk_mut()) {
            *place = [x as u16, entry.key, entry.word as u16, (entry.word >> 16) as u16];
        }
    }

    /// Shows the `count` entries that were kept for row `y`, which begins with cell `start`, by instructions that
    /// depend on `most`, at least `count`, alone.
    #[inline(always)]
    pub(crate) fn settle_of(&mut self, y: usize, start: u32, count: usize, most: usize) {
        let at = (y & 1) * (self.line.len() >> 1);
        let kept = self.line.get(at..at + POSTPONED * most).unwrap_or_default();
        for (slot, &[x, new_key, low, high]) in (0..).zip(kept.as_chunks::<POSTPONED>().0) {
            let mask = reference::opaque(reference::below(slot, count as u32));
            let cell = (start + (u32::from(x) & mask)) as usize;
            if let (Some(key), Some(word)) = (self.keys.get_mut(cell), self.words.get_mut(cell)) {
                *key = reference::choose(mask, new_key.into(), (*key).into()) as u16;
                *word = reference::choose(mask, u32::from(high) << 16 | u32::from(low), *word);
            }
        }
    }

    /// Shows the `count` entries that were kept for row `y`, which begins with cell `start`.
    #[inline(always)]
    pub(crate) fn settle(&mut self, y: usize, start: u32, count: usize) {
        let at = (y & 1) * (self.line.len() >> 1);
        let kept = self.line.get(at..at + POSTPONED * count).unwrap_or_default();
        for &[x, new_key, low, high] in kept.as_chunks::<POSTPONED>().0 {
            let cell = (start + u32::from(x)) as usize;
            if let (Some(key), Some(word)) = (self.keys.get_mut(cell), self.words.get_mut(cell)) {
                (*key, *word) = (new_key, u32::from(high) << 16 | u32::from(low));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_holds_its_parts_and_orders_by_depth_then_kind_then_sample() {
        let numbers = [0, 1, 77, MOST_SAMPLES - 1];
        let entry = |depth, kind, sample| Entry::new(depth, kind, sample, [-16, 15]);
        let mut before = None;
        for depth in [0, 1, 500, FARTHEST] {
            for kind in [Kind::Quad, Kind::Point] {
                for sample in numbers {
                    let entry = entry(depth, kind, sample);
                    assert_eq!((entry.depth(), entry.sample(), entry.residual()), (depth as i32, sample, [-16, 15]));
                    assert!(entry.is_some() && entry.is_before(Entry::NONE));
                    assert!(before.is_none_or(|before: Entry| before.is_before(entry) && !entry.is_before(before)));
                    before = Some(entry);
                }
            }
        }
        assert_eq!(Entry::new(u32::MAX, Kind::Point, 0, [99, -99]), Entry::new(FARTHEST, Kind::Point, 0, [15, -16]));
        assert!(Entry::NONE.depth() > FARTHEST as i32);
    }

    #[test]
    fn depths_and_thresholds_have_fifteen_bits() {
        assert_eq!([depth(0xffff, 16), depth(0xff, 8), depth(0, 0), depth(1, 20)], [0x7fff, 0xff << 7, 0, 0]);
        assert_eq!([threshold(1024, 16), threshold(4, 8), threshold(u32::MAX, 0)], [512, 512, 1 << 15]);
        assert_eq!(threshold(u32::MAX, 28), 1 << 15);
    }
}
