//! Links: which neighbouring samples are of one surface.
//!
//! Two samples that share a side are *linked* if between them neither depth nor velocity steps. A value steps if its
//! difference is larger than a threshold, and no continuation of the slope on either side of the pair. So slanted and
//! turning surfaces stay whole, and a silhouette is cut. Where two samples are not linked, one bit says which of the
//! two is nearer, because that one's surface ends there.
//!
//! *Memory:* four bits a sample. *Cost:* once for each update.

use crate::format::record::{Field, Record};
use crate::map::grid::Grid;

/// Samples of a word.
pub(crate) const WORD: u32 = 8;

/// Two samples are linked.
pub(crate) const LINKED: u32 = 0b11;
/// The first of two samples, which is the left or the upper one, is nearer.
pub(crate) const FIRST: u32 = 0b01;
/// The second of two samples is nearer.
pub(crate) const SECOND: u32 = 0b10;

/// Returns the words of the links of a grid: those of the pairs, and one that says whether a renderer mixed the colours
/// at silhouettes.
#[must_use]
pub const fn words(grid: &Grid<'_>) -> usize {
    pair_words(grid) + 1
}

/// Returns the words of the links of a grid's pairs.
pub(crate) const fn pair_words(grid: &Grid<'_>) -> usize {
    grid.cells().div_ceil(WORD) as usize
}

/// Where a neighbour lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
    Above,
    Below,
}

impl Side {
    pub(crate) const ALL: [Self; 4] = [Self::Left, Self::Right, Self::Above, Self::Below];

    /// Returns column and row of the neighbour, relative to the cell.
    #[inline(always)]
    pub(crate) const fn towards(self) -> [i32; 2] {
        match self {
            Self::Left => [-1, 0],
            Self::Right => [1, 0],
            Self::Above => [0, -1],
            Self::Below => [0, 1],
        }
    }

    /// Returns the side as seen from the neighbour.
    pub(crate) const fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
            Self::Above => Self::Below,
            Self::Below => Self::Above,
        }
    }

    /// Returns the part of a place that points to this side.
    #[inline(always)]
    pub(crate) const fn along(self, [x, y]: [i32; 2]) -> i32 {
        match self {
            Self::Left => -x,
            Self::Right => x,
            Self::Above => -y,
            Self::Below => y,
        }
    }
}

/// The links of a grid's samples.
#[derive(Clone, Copy)]
pub(crate) struct Links<'l> {
    pub words: &'l [u32],
    /// Columns of the grid.
    pub width: u32,
}

impl Links<'_> {
    /// Returns the four bits of a cell: two for the pair with its right neighbour, two for that with the lower one.
    #[inline(always)]
    pub(crate) fn of(self, cell: u32) -> u32 {
        self.words.get((cell / WORD) as usize).map_or(0, |word| word >> ((cell % WORD) << 2) & 0b1111)
    }

    /// Returns whether a cell is linked with its right neighbour. Cells beyond the grid are not linked.
    #[inline(always)]
    pub(crate) fn right(self, cell: u32) -> bool {
        self.of(cell) & LINKED == LINKED
    }

    /// Returns whether a cell is linked with its lower neighbour.
    #[inline(always)]
    pub(crate) fn below(self, cell: u32) -> bool {
        self.of(cell) >> 2 == LINKED
    }

    /// Returns the cell at a side; beyond the border of the grid one that has no links with the cell.
    #[inline(always)]
    pub(crate) fn beyond(self, cell: u32, side: Side) -> u32 {
        match side {
            Side::Left => cell.wrapping_sub(1),
            Side::Right => cell + 1,
            Side::Above => cell.wrapping_sub(self.width),
            Side::Below => cell + self.width,
        }
    }

    /// Returns the neighbour of a cell, if the two are linked.
    #[inline(always)]
    pub(crate) fn neighbour(self, cell: u32, side: Side) -> Option<u32> {
        let neighbour = self.beyond(cell, side);
        let linked = match side {
            Side::Left => self.right(neighbour),
            Side::Right => self.right(cell),
            Side::Above => self.below(neighbour),
            Side::Below => self.below(cell),
        };
        linked.then_some(neighbour)
    }

    /// Returns whether the surface of a cell ends at this side, in front of that of the neighbour.
    #[inline(always)]
    pub(crate) fn ends(self, cell: u32, side: Side) -> bool {
        match side {
            Side::Left => self.of(cell.wrapping_sub(1)) & LINKED == SECOND,
            Side::Right => self.of(cell) & LINKED == FIRST,
            Side::Above => self.of(cell.wrapping_sub(self.width)) >> 2 == SECOND,
            Side::Below => self.of(cell) >> 2 == FIRST,
        }
    }

    /// Returns the bits of the eight cells from `cell` on; 0 for what is not in the grid.
    #[inline(always)]
    fn eight(self, cell: u32) -> u32 {
        let word = |index: u32| u64::from(self.words.get(index as usize).copied().unwrap_or(0));
        ((word(cell / WORD) | word(cell / WORD + 1) << 32) >> ((cell % WORD) << 2)) as u32
    }

    /// Returns whether all words that hold the links of some neighbouring cells have all bits.
    #[inline(always)]
    fn all_linked(self, cell: u32, count: u32) -> bool {
        let words = (cell / WORD) as usize..=(cell.wrapping_add(count) / WORD) as usize;
        self.words.get(words).is_some_and(|words| words.iter().fold(u32::MAX, |all, word| all & word) == u32::MAX)
    }

    /// Returns whether `count` neighbouring cells are all the first ones of quads, see [`Self::quad`], and none of
    /// their samples lies beside a nearer surface.
    #[inline(always)]
    pub(crate) fn quads_inside(self, cell: u32, count: u32) -> bool {
        const RIGHT: u32 = 0x3333_3333;
        const LOWER: u32 = 0x1111_1111;
        // The quad before the first sample lies outside of the grid.
        if (cell / WORD) as usize >= self.words.len() {
            return false;
        }
        let (above, below) = (cell.wrapping_sub(self.width), cell + self.width);
        // Inside of a surface all words around have all bits.
        if [above, cell, below].iter().all(|&row| self.all_linked(row.wrapping_sub(1), count + 2)) {
            return true;
        }
        let (mut missing, mut done) = (0, 0);
        while done <= count {
            let part = (count + 1 - done).min(WORD);
            let cells = u32::MAX >> ((WORD - part) << 2);
            // All but the column after the last quad must be linked with the next one.
            let inner = if done + part > count { cells >> 4 } else { cells };
            let (own, next) = (self.eight(cell + done), self.eight(below + done));
            missing |= !own & (cells & !RIGHT | inner & RIGHT) | !next & inner & RIGHT;
            // In a pair with the row above the first one is nearer, or in one with the row beyond the second one.
            let before = self.eight(above.wrapping_add(done)) >> 2;
            let after = next >> 2;
            missing |= (before & !(before >> 1) | !after & (after >> 1)) & LOWER & cells;
            done += part;
        }
        let nearer = |cell: u32, side: Side| self.ends(self.beyond(cell, side), side.opposite());
        let sides = nearer(cell, Side::Left) | nearer(below, Side::Left);
        missing == 0 && !sides && !nearer(cell + count, Side::Right) && !nearer(below + count, Side::Right)
    }

    /// Returns whether four samples are a quad: a cell, the ones right of it and below it, and the fourth.
    #[inline(always)]
    pub(crate) fn quad<const CONSTANT_TIME: bool>(self, cell: u32) -> bool {
        let linked = self.of(cell) == LINKED << 2 | LINKED;
        (CONSTANT_TIME || linked) && linked & self.below(cell + 1) & self.right(cell + self.width)
    }
}

/// A value that must not step between linked samples.
pub(crate) struct Value {
    pub field: Field,
    pub signed: bool,
    /// The largest difference that is no step.
    pub threshold: u32,
}

/// Returns the values that must not step: depth, of whose last bit `edge_threshold` is a number, and velocities, which
/// step by more than a quarter of a cell a frame.
#[inline(always)]
pub(crate) fn values(record: &Record, edge_threshold: u32) -> [Value; 3] {
    let quarter = |component: usize| 1 << record.scales[component].velocity_frac >> 2;
    [
        Value { field: record.depth(), signed: false, threshold: edge_threshold },
        Value { field: record.velocity(0), signed: true, threshold: quarter(0) },
        Value { field: record.velocity(1), signed: true, threshold: quarter(1) },
    ]
}
