//! The sources: cells beside which something opens, and how far. Algorithm 1 of the supplement.
//!
//! Most neighbours lie on one surface and move nearly alike. They are told by a few comparisons over a run of cells at once; what is
//! left goes pair by pair.

use core::ops::Range;

use super::extents::{EXTENTS, ONLY_ITSELF, larger};
use super::pair::{Body, Rule, Uncovered};
use super::{Border, Reach, Tally};
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::record::{Extract, Field, Record};
use crate::sweep::VECTORS;

/// No pass whose extents stay in the rows.
pub(crate) const NO_PASS: u32 = u32::MAX;

/// Neighbours that are looked at once. A power of two.
const RUN: usize = if VECTORS { 64 } else { 8 };

/// The words of a run of cells that decide whether neighbours go pair by pair: of each field the word of its upper part, and of what spills.
struct Lanes<'l> {
    class: &'l [u32; RUN],
    depth: [&'l [u32; RUN]; 2],
    v: [&'l [u32; RUN]; 2],
    a: [&'l [u32; RUN]; 2],
}

impl<'l> Lanes<'l> {
    /// The cells from `cell` on, if there are as many in the map.
    #[inline(always)]
    fn at<L: Layout, B: Budget<L>, const ALONG: usize>(front: &'l Galpixmap<'_, L, B>, cell: u32) -> Option<Self> {
        let record = front.record();
        let word = |word: usize| front.planes()[word].get(cell as usize..)?.first_chunk();
        let field = |field: Field| {
            let (upper, lower) = field.words();
            Some([word(upper)?, word(lower)?])
        };
        let [class, _] = field(record.class())?;
        Some(Self {
            class,
            depth: field(record.depth())?,
            v: field(record.velocity(ALONG))?,
            a: field(record.acceleration(ALONG))?,
        })
    }

    /// Class and depth of a cell as one number, as [`Galpixmap::keys`] has it.
    #[inline(always)]
    fn key<L: Layout, B: Budget<L>>(&self, record: &Record, lane: usize) -> u32 {
        let ([depth, spill], lane) = (self.depth, lane & (RUN - 1));
        match record.key_field() {
            Some(key) if B::FIXED => key.extract().unsigned(depth[lane], depth[lane]),
            _ => {
                let class = record.class().extract().unsigned(self.class[lane], self.class[lane]);
                class << record.depth().bits | record.depth().extract().unsigned(depth[lane], spill[lane])
            }
        }
    }
}

/// A field of a lane.
#[inline(always)]
fn signed(field: Extract, [upper, lower]: [&[u32; RUN]; 2], lane: usize) -> i32 {
    let lane = lane & (RUN - 1);
    field.signed(upper[lane], lower[lane])
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
        let cells = start as usize..(start + self.front.grid().width()) as usize;
        if !self.front.any_empty(start, self.front.grid().width()) {
            for word in row.iter_mut() {
                *word &= kept;
            }
            return Some(start);
        }
        for (word, key) in row.iter_mut().zip(self.front.keys(cells)) {
            let empty = self.front.class_of(key) == Class::Empty as u32;
            *word = *word & kept | if empty { ONLY_ITSELF & !kept } else { 0 };
        }
        Some(start)
    }

    /// Marks what is uncovered in row `y`, which is `here`, and in row `y + 1`, which is `next`, by pairs of one cell in each; and in row `y` by pairs in
    /// it, if `IN_ROW`, and by what lies beyond the border. Both must have begun; an empty one is left out.
    pub fn rows<const IN_ROW: bool>(&mut self, y: u32, here: &mut [u32], next: &mut [u32]) {
        let grid = *self.front.grid();
        let Some(row) = grid.row(y as i32) else { return };
        let below = grid.row(y as i32 + 1);
        let (mut in_row, mut between) = ([0; RUN], [0; RUN]);
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(RUN as u32);
            // All that the pairs are made of is in the cache after these.
            if let Some(below) = below {
                self.compare::<1>(row + x, below + x, &mut between);
            }
            if IN_ROW {
                self.compare::<0>(row + x, row + x + 1, &mut in_row);
                self.pairs_in_row(&in_row, row, x..(x + cells).min(grid.width() - 1), here);
            }
            if let Some(below) = below {
                self.pairs_between(&between, [row, below], x..x + cells, here, next);
            }
            x += cells;
        }
        if IN_ROW && self.border == Border::Still {
            self.beyond(y, row, here);
        }
    }

    /// Flags the lanes that must be looked at: those of two surfaces, and those that may part. The pairs are those of the cells from
    /// `one` and from `other` on; all are flagged where the map ends before the run does.
    #[inline(always)]
    fn compare<const ALONG: usize>(&self, one: u32, other: u32, flags: &mut [u32; RUN]) {
        let one = Lanes::at::<L, B, ALONG>(self.front, one);
        let (Some(one), Some(other)) = (one, Lanes::at::<L, B, ALONG>(self.front, other)) else {
            *flags = [1; RUN];
            return;
        };
        let record = self.front.record();
        let (separation, [(v_limit, v_beyond), (a_limit, a_beyond)]) = (self.rule.separation, self.limits[ALONG]);
        let (v, a) = (record.velocity(ALONG).extract(), record.acceleration(ALONG).extract());
        let depth_bits = record.depth().bits;
        // The sign is set where the difference is the separation or more.
        let within = separation.wrapping_sub(1);
        for (lane, flag) in flags.iter_mut().enumerate() {
            let (key, other_key) = (one.key::<L, B>(record, lane), other.key::<L, B>(record, lane));
            let farther = other_key.wrapping_sub(key) as i32;
            let apart = within.wrapping_sub(farther) | within.wrapping_add(farther);
            // Keys of empty cells say nothing.
            let mut look = apart as u32 & 1 << 31 | (key ^ other_key) >> depth_bits;
            if L::LANES.velocity {
                let (one, other) = (signed(v, one.v, lane), signed(v, other.v, lane));
                look |= other.wrapping_sub(one).wrapping_add(v_limit) as u32 & v_beyond;
            }
            if L::LANES.acceleration {
                let (one, other) = (signed(a, one.a, lane), signed(a, other.a, lane));
                look |= other.wrapping_sub(one).wrapping_add(a_limit) as u32 & a_beyond;
            }
            *flag = look;
        }
    }

    /// Looks at the flagged pairs of neighbours in a row, of which the left ones are in the columns `columns`.
    fn pairs_in_row(&mut self, flags: &[u32; RUN], row: u32, columns: Range<u32>, here: &mut [u32]) {
        let mut start = columns.start;
        for eight in flags.as_chunks::<8>().0 {
            if any(eight) {
                for (_, x) in eight.iter().zip(start..columns.end).filter(|(flag, _)| **flag != 0) {
                    let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, row + x + 1));
                    let uncovered = self.uncovered::<0>(&one, &other);
                    self.raise(here, x, uncovered.first);
                    self.raise(here, x + 1, uncovered.second);
                }
            }
            start += 8;
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
        let mut start = columns.start;
        for eight in flags.as_chunks::<8>().0 {
            if any(eight) {
                for (_, x) in eight.iter().zip(start..columns.end).filter(|(flag, _)| **flag != 0) {
                    let (one, other) = (Body::read(self.front, row + x), Body::read(self.front, below + x));
                    let uncovered = self.uncovered::<1>(&one, &other);
                    self.raise(here, x, uncovered.first);
                    self.raise(next, x, uncovered.second);
                }
            }
            start += 8;
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

/// Whether any lane is flagged.
#[inline(always)]
fn any(flags: &[u32; 8]) -> bool {
    flags.iter().fold(0, |any, flag| any | flag) != 0
}
