//! The sources: cells beside which something opens, and how far. Algorithm 1 of the supplement.
//!
//! Most neighbours lie on one surface and move nearly alike. They are told by a few comparisons over a run of cells at once; what is
//! left goes pair by pair.

use core::ops::Range;

use super::extents::{EXTENTS, ONLY_ITSELF, larger};
use super::pair::{Body, FARTHEST, Rule, Uncovered};
use super::{Border, Reach, Tally};
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::sweep::VECTORS;

/// No pass whose extents stay in the rows.
pub(crate) const NO_PASS: u32 = u32::MAX;

/// Neighbours that are looked at once.
const RUN: usize = if VECTORS { 64 } else { 8 };

/// What decides whether neighbours go pair by pair, of a run and the cell after it.
struct Lanes {
    keys: [i32; RUN + 1],
    /// Velocity and acceleration, in x and in y.
    motion: [[[i32; RUN + 1]; 2]; 2],
}

/// The same of as many neighbours as are looked at once, along one component.
type Run<'l> = [&'l [i32; RUN]; 3];

impl Lanes {
    const EMPTY: Self = Self { keys: [0; RUN + 1], motion: [[[0; RUN + 1]; 2]; 2] };

    /// Takes some cells; stale ones stay behind them.
    #[inline(always)]
    fn take<L: Layout, B: Budget<L>>(&mut self, front: &Galpixmap<'_, L, B>, cells: Range<usize>) {
        for (to, key) in self.keys.iter_mut().zip(front.keys(cells.clone())) {
            let empty = front.class_of(key) == Class::Empty as u32;
            *to = if empty { FARTHEST } else { key as i32 };
        }
        let record = front.record();
        for (lanes, component) in self.motion.iter_mut().zip(0..) {
            let fields = [record.velocity(component), record.acceleration(component)];
            for (lanes, field) in lanes.iter_mut().zip(fields).take(motions::<L>()) {
                for (to, value) in lanes.iter_mut().zip(front.signed(field, cells.clone())) {
                    *to = value;
                }
            }
        }
    }

    /// The first lanes.
    #[inline(always)]
    fn first<const ALONG: usize>(&self) -> Option<Run<'_>> {
        let [v, a] = &self.motion[ALONG];
        Some([self.keys.first_chunk()?, v.first_chunk()?, a.first_chunk()?])
    }

    /// Of each of the first lanes the one after it.
    #[inline(always)]
    fn last<const ALONG: usize>(&self) -> Option<Run<'_>> {
        let [v, a] = &self.motion[ALONG];
        Some([self.keys.last_chunk()?, v.last_chunk()?, a.last_chunk()?])
    }
}

/// Fields of the motion along a component that a layout can have.
const fn motions<L: Layout>() -> usize {
    L::LANES.velocity as usize + L::LANES.acceleration as usize
}

/// Two rows, a run at a time. Made once for all.
pub(crate) struct Runs {
    upper: Lanes,
    lower: Lanes,
    /// Not 0 where a pair must be looked at.
    flags: [u32; RUN],
}

impl Runs {
    pub const EMPTY: Self = Self { upper: Lanes::EMPTY, lower: Lanes::EMPTY, flags: [0; RUN] };
}

/// What is done with each pair of a map.
pub(crate) struct Marker<'m, 'p, L, B> {
    front: &'m Galpixmap<'p, L, B>,
    rule: Rule,
    border: Border,
    /// By how much motions may differ, and the bits that then are 0.
    limits: [[(i32, u32); 2]; 2],
    /// The bits of a word that are marked.
    marked: u32,
    pub tally: Tally,
}

impl<'m, 'p, L: Layout, B: Budget<L>> Marker<'m, 'p, L, B> {
    pub fn new(front: &'m Galpixmap<'p, L, B>, reach: &Reach) -> Self {
        let rule = Rule::new(front.record(), reach);
        let beyond = |limit| if limit == 0 { u32::MAX } else { 0u32.wrapping_sub((limit as u32) << 1) };
        let limits = rule.bounds.map(|bound| bound.together().map(|limit| (limit, beyond(limit))));
        Self { front, rule, border: reach.border, limits, marked: u32::MAX, tally: Tally::default() }
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.front.grid().width()
    }

    /// Begins row `y`: nothing is uncovered but what is hidden in empty cells, for it is not hidden. Where a pass on the way `WAY` has left
    /// something in a cell, it stays; [`NO_PASS`] leaves nothing. The first cell of the row, if there is one.
    pub fn begin<const WAY: u32>(&mut self, y: u32, row: &mut [u32]) -> Option<u32> {
        let start = self.front.grid().row(y as i32)?;
        let kept = if WAY == NO_PASS { 0 } else { 0xff << (WAY ^ 8) };
        self.marked = !kept;
        let keys = self.front.keys(start as usize..(start + self.front.grid().width()) as usize);
        for (word, key) in row.iter_mut().zip(keys) {
            let empty = self.front.class_of(key) == Class::Empty as u32;
            *word = *word & kept | if empty { ONLY_ITSELF & !kept } else { 0 };
        }
        Some(start)
    }

    /// Marks what is uncovered in row `y`, which is `here`, and in row `y + 1`, which is `next`, by pairs of one cell in each; and in row `y` by pairs in
    /// it, if `IN_ROW`, and by what lies beyond the border. Both must have begun; an empty one is left out.
    pub fn rows<const IN_ROW: bool>(&mut self, runs: &mut Runs, y: u32, here: &mut [u32], next: &mut [u32]) {
        let grid = *self.front.grid();
        let Some(row) = grid.row(y as i32) else { return };
        let below = grid.row(y as i32 + 1);
        let Runs { upper, lower, flags } = runs;
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(RUN as u32);
            let with_next = (grid.width() - x).min(RUN as u32 + 1);
            upper.take(self.front, (row + x) as usize..(row + x + with_next) as usize);
            if IN_ROW {
                self.compare::<0>(upper.first::<0>(), upper.last::<0>(), flags);
                self.pairs_in_row(flags, row, x..x + with_next - 1, here);
            }
            if let Some(below) = below {
                lower.take(self.front, (below + x) as usize..(below + x + cells) as usize);
                self.compare::<1>(upper.first::<1>(), lower.first::<1>(), flags);
                self.pairs_between(flags, [row, below], x..x + cells, here, next);
            }
            x += cells;
        }
        if IN_ROW && self.border == Border::Still {
            self.beyond(y, row, here);
        }
    }

    /// Flags the lanes that must be looked at: those of two surfaces, and those that may part.
    #[inline(always)]
    fn compare<const ALONG: usize>(&self, one: Option<Run<'_>>, other: Option<Run<'_>>, flags: &mut [u32; RUN]) {
        let (Some([keys, motion @ ..]), Some([other_keys, other_motion @ ..])) = (one, other) else { return };
        let separation = self.rule.separation;
        for ((flag, &one), &other) in flags.iter_mut().zip(keys).zip(other_keys) {
            let farther = other.wrapping_sub(one);
            *flag = u32::from(farther >= separation) | u32::from(farther <= -separation);
        }
        let limits = self.limits[ALONG];
        for ((one, other), (limit, beyond)) in motion.into_iter().zip(other_motion).zip(limits).take(motions::<L>()) {
            for ((flag, &one), &other) in flags.iter_mut().zip(one).zip(other) {
                *flag |= other.wrapping_sub(one).wrapping_add(limit) as u32 & beyond;
            }
        }
    }

    /// Looks at the flagged pairs of neighbours in a row, of which the left ones are in the columns `columns`.
    fn pairs_in_row(&mut self, flags: &[u32; RUN], row: u32, columns: Range<u32>, here: &mut [u32]) {
        for x in flagged(flags, columns) {
            let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, row + x + 1));
            let uncovered = self.uncovered::<0>(&one, &other);
            self.raise(here, x, uncovered.first);
            self.raise(here, x + 1, uncovered.second);
        }
    }

    /// Looks at the flagged pairs of neighbours in two rows.
    fn pairs_between(
        &mut self,
        flags: &[u32; RUN],
        rows: [u32; 2],
        columns: Range<u32>,
        here: &mut [u32],
        next: &mut [u32],
    ) {
        let [row, below] = rows;
        for x in flagged(flags, columns) {
            let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, below + x));
            let uncovered = self.uncovered::<1>(&one, &other);
            self.raise(here, x, uncovered.first);
            self.raise(next, x, uncovered.second);
        }
    }

    /// Looks at the cells at the border of a row, beside something still and far away.
    fn beyond(&mut self, y: u32, row: u32, here: &mut [u32]) {
        let grid = *self.front.grid();
        self.beside_nothing::<0>(row, 0, true, here);
        self.beside_nothing::<0>(row, grid.width() - 1, false, here);
        for (at_end, before) in [(y == 0, true), (y + 1 == grid.height(), false)] {
            for x in 0..if at_end { grid.width() } else { 0 } {
                self.beside_nothing::<1>(row, x, before, here);
            }
        }
    }

    /// Looks at a cell and at what lies before it (to the left or above) or behind it, beyond the border.
    fn beside_nothing<const ALONG: usize>(&mut self, row: u32, x: u32, before: bool, here: &mut [u32]) {
        let body = Body::read(self.front, row + x);
        let [one, other] = if before { [Body::NOTHING, body] } else { [body, Body::NOTHING] };
        let uncovered = self.uncovered::<ALONG>(&one, &other);
        self.raise(here, x, if before { uncovered.second } else { uncovered.first });
    }

    /// What two neighbours uncover, counted.
    fn uncovered<const ALONG: usize>(&mut self, one: &Body, other: &Body) -> Uncovered {
        if one == other {
            return Uncovered::default();
        }
        let uncovered = self.rule.uncovered::<ALONG>(one, other);
        self.tally.edges += u32::from(uncovered.opens);
        self.tally.endless += u32::from(uncovered.endless);
        uncovered
    }

    fn raise(&self, row: &mut [u32], x: u32, to: u32) {
        if let Some(word) = row.get_mut(x as usize) {
            let to = to & self.marked;
            *word = larger(*word, to) | to & !EXTENTS;
        }
    }
}

/// The columns whose lane is flagged.
#[inline(always)]
fn flagged(flags: &[u32; RUN], columns: Range<u32>) -> impl Iterator<Item = u32> {
    let (eights, _) = flags.as_chunks::<8>();
    let starts = (columns.start..).zip(0..).map(|(first, block)| first + 7 * block);
    eights.iter().zip(starts).filter(|(flags, _)| flags.iter().fold(0, |any, flag| any | *flag) != 0).flat_map(
        move |(flags, start)| flags.iter().zip(start..columns.end).filter(|(flag, _)| **flag != 0).map(|(_, x)| x),
    )
}
