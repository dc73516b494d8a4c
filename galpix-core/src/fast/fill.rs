//! The fill of holes, hole by hole. Looks for holes in runs of cells and skips runs without any.

use crate::format::Format;
use crate::format::record::Words;
use crate::frame::edge::on_edge;
use crate::frame::fill::{Around, FILLED, FillMode, NoFrameBefore, mean2, mean4};
use crate::frame::resolve::NO_WINNER;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Cells that are searched for holes at once.
const RUN: u32 = 32;

/// A cell that no map has.
const NO_CELL: u32 = u32::MAX;

/// Fills the holes of `back`, see [`crate::frame::fill::fill`].
pub(crate) fn fill<F: Format>(
    around: &impl Around,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    let rounds = settings.fill_mode.rounds(settings.reach);
    let starts = back.grid().starts();
    let mut filler = Filler::new(around, back, scratch, settings.fill_mode, tally);
    for round in 0..rounds {
        for (y, &start) in (0..).zip(starts) {
            filler.row(Row { y, start, before: start, round, last: round + 1 == rounds });
        }
    }
}

/// Fills only the bullet holes; other holes stay empty and are not counted.
pub(crate) fn fill_bullets<F: Format>(
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    reach: u32,
    tally: &mut Tally,
) {
    let starts = back.grid().starts();
    let format = back.format();
    let around = NoFrameBefore(format.record());
    let mut filler = Filler::new(&around, back, scratch, FillMode::Bullet, tally);
    for round in 0..FillMode::Bullet.rounds(reach) {
        for (y, &start) in (0..).zip(starts) {
            filler.row(Row { y, start, before: start, round, last: false });
        }
    }
}

/// A round of [`fill`] for a single row, for maps whose rows are completed one after the other.
pub(crate) struct RowFill {
    /// How holes are filled.
    pub fill_mode: FillMode,
    /// The row.
    pub y: i32,
    /// The round.
    pub round: u32,
    /// Whether it is the last round, which fills all holes.
    pub last: bool,
}

impl RowFill {
    /// Fills the row, if there is one. The rows of `back` may have other first cells than those of `front`; the winner
    /// map contains cells of `front`.
    pub fn fill<F: Format>(
        &self,
        front: &Galpixmap<'_, F>,
        back: &mut Galpixmap<'_, F>,
        scratch: &mut Scratch<'_>,
        tally: &mut Tally,
    ) {
        let &Self { fill_mode, y, round, last } = self;
        let (Some(start), Some(before)) = (back.grid().row(y), front.grid().row(y)) else { return };
        let mut filler = Filler::new(front, back, scratch, fill_mode, tally);
        filler.row(Row { y, start, before, round, last });
    }
}

/// A row in a round of a fill.
#[derive(Clone, Copy)]
struct Row {
    y: i32,
    /// Its first cell.
    start: u32,
    /// Its first cell in the frame before.
    before: u32,
    round: u32,
    /// Whether this is the last round, which fills all holes.
    last: bool,
}

/// A fill in progress.
struct Filler<'f, 'q, A, F> {
    around: &'f A,
    back: &'f mut Galpixmap<'q, F>,
    winners: &'f mut [u32],
    edges: &'f [u32],
    fill_mode: FillMode,
    tally: &'f mut Tally,
}

/// The ends of the run of holes that the current column of a row belongs to.
struct Ends {
    /// The nearest cell to the left that was not empty when the round began; [`NO_CELL`] without one.
    left: u32,
    /// The column of the nearest such cell to the right, or the width; valid while it is greater than the current
    /// column.
    right: u32,
}

impl<'f, 'q, A: Around, F: Format> Filler<'f, 'q, A, F> {
    fn new(
        around: &'f A,
        back: &'f mut Galpixmap<'q, F>,
        scratch: &'f mut Scratch<'_>,
        fill_mode: FillMode,
        tally: &'f mut Tally,
    ) -> Self {
        let Scratch { winners, edges } = scratch;
        Self { around, back, winners, edges, fill_mode, tally }
    }

    /// Fills the bullet holes of a row; in the last round all of its holes.
    fn row(&mut self, row: Row) {
        let mut ends = Ends { left: NO_CELL, right: 0 };
        let width = self.back.grid().width();
        let mut x = 0;
        while x < width {
            let run = (width - x).min(RUN);
            // Most runs have no hole, so that a single test of the whole run pays.
            if !self.back.any_empty(row.start + x, run) {
                ends.left = row.start + x + run - 1;
            } else {
                for x in x..x + run {
                    if self.back.class(row.start + x) == Class::Empty {
                        self.hole(&row, x, &mut ends);
                    } else {
                        ends.left = row.start + x;
                    }
                }
            }
            x += run;
        }
    }

    /// Fills the hole in column `x` of a row, if it is a bullet hole or the round is the last.
    fn hole(&mut self, row: &Row, x: u32, ends: &mut Ends) {
        let cell = row.start + x;
        let bullet = if self.fill_mode.uses_edges() { self.bullet(x as i32, row.y, row.round) } else { None };
        let (words, winner) = match bullet {
            Some(mut words) => {
                // It loses against any galpixel.
                self.around.record().class().set(&mut words, Class::Debris as u32);
                (words, FILLED + row.round)
            }
            None if row.last => (self.unobscured(row, x, ends), NO_WINNER),
            None => return,
        };
        self.tally.holes += 1;
        self.tally.bullets += (winner != NO_WINNER) as u32;
        self.back.put(cell, &words);
        if let Some(to) = self.winners.get_mut(cell as usize) {
            *to = winner;
        }
    }

    /// Returns the farther of the two surfaces at the ends of the run of holes that column `x` of a row belongs to; the
    /// left one if they are equally far.
    fn farther_end(&self, row: &Row, x: u32, ends: &mut Ends) -> Option<Words> {
        let (row, width) = (row.start, self.back.grid().width());
        if ends.right <= x {
            ends.right = x + 1 + self.back.empties((row + x + 1) as usize..(row + width) as usize);
        }
        let left = self.back.words_at(ends.left);
        let right = if ends.right < width { self.back.words_at(row + ends.right) } else { None };
        let depth = |words: &Words| self.back.record().depth().unsigned(words);
        match (left, right) {
            (Some(left), Some(right)) => Some(if depth(&right) > depth(&left) { right } else { left }),
            (one, other) => one.or(other),
        }
    }

    /// Returns what a hole in column `x` of a row holds that is no bullet hole.
    fn unobscured(&mut self, row: &Row, x: u32, ends: &mut Ends) -> Words {
        // The record of `around`, because that of `back` cannot be borrowed while `self` is.
        let record = self.around.record();
        let before = self.around.before(row.before + x).unwrap_or_default();
        let known = record.class().unsigned(&before) != Class::Empty as u32;
        if self.fill_mode >= FillMode::Galdebris && known {
            let surface = if self.fill_mode == FillMode::Extend { self.farther_end(row, x, ends) } else { None };
            let mut words = surface.unwrap_or(before);
            record.class().set(&mut words, Class::JustUnobscured as u32);
            self.tally.galdebris += 1;
            return words;
        }
        let mut words: Words = Default::default();
        if self.fill_mode != FillMode::None {
            record.colour().set(&mut words, record.colour().unsigned(&before));
        }
        if self.fill_mode >= FillMode::Debris && known {
            let class = if self.fill_mode == FillMode::Debris { Class::Debris } else { Class::JustUnobscured };
            record.class().set(&mut words, class as u32);
            record.depth().set(&mut words, u32::MAX);
            self.tally.debris += 1;
        } else {
            record.class().set(&mut words, Class::Empty as u32);
            self.tally.empty += 1;
        }
        words
    }

    /// Returns the mean of the neighbours inside a surface, if there are any.
    fn bullet(&self, x: i32, y: i32, round: u32) -> Option<Words> {
        if self.winners.is_empty() {
            return None;
        }
        let inside = |dx: i32, dy: i32| self.inside(x + dx, y + dy, round);
        let vacant = |dx: i32, dy: i32| self.vacant(x + dx, y + dy, round);
        self.mean(inside(-1, 0), inside(1, 0), inside(0, -1), inside(0, 1)).or_else(|| {
            let crossing = vacant(-1, 0) && vacant(1, 0) && vacant(0, -1) && vacant(0, 1);
            let corners = || self.mean(inside(-1, -1), inside(1, 1), inside(1, -1), inside(-1, 1));
            if crossing { corners() } else { None }
        })
    }

    /// Returns whether a place was a hole when this round began; places beyond the map count as holes.
    #[inline(always)]
    fn vacant(&self, x: i32, y: i32, round: u32) -> bool {
        let Some(cell) = self.back.grid().cell(x, y) else { return true };
        let winner = self.winners.get(cell as usize);
        self.around.foreign(cell) == 0 && winner.is_none_or(|&winner| winner >= FILLED + round)
    }

    /// Returns the mean of two pairs of neighbours that face each other: `a` and `b`, `c` and `d`.
    #[inline(always)]
    fn mean(&self, a: Option<u32>, b: Option<u32>, c: Option<u32>, d: Option<u32>) -> Option<Words> {
        match (a, b, c, d) {
            (Some(a), Some(b), Some(c), Some(d)) => self.mean4(a, b, c, d),
            (Some(a), Some(b), _, _) | (_, _, Some(a), Some(b)) => self.mean2(a, b),
            _ => match (a.or(b), c.or(d)) {
                (Some(a), Some(c)) => self.mean2(a, c),
                (one, other) => self.back.words_at(one.or(other)?),
            },
        }
    }

    /// Returns the cell at a place, if its content came from inside a surface or is a bullet fill of an earlier round.
    #[inline(always)]
    fn inside(&self, x: i32, y: i32, round: u32) -> Option<u32> {
        let cell = self.back.grid().cell(x, y)?;
        let winner = *self.winners.get(cell as usize)?;
        let inside = if winner >= FILLED { winner < FILLED + round } else { !on_edge(self.edges, winner) };
        (inside && self.around.foreign(cell) == 0).then_some(cell)
    }

    /// Returns the mean of two cells.
    fn mean2(&self, a: u32, b: u32) -> Option<Words> {
        let (a, b) = (self.back.words_at(a)?, self.back.words_at(b)?);
        Some(mean2(self.back.record(), [&a, &b]))
    }

    /// Returns the mean of four cells.
    fn mean4(&self, a: u32, b: u32, c: u32, d: u32) -> Option<Words> {
        let back = &self.back;
        let (a, b, c, d) = (back.words_at(a)?, back.words_at(b)?, back.words_at(c)?, back.words_at(d)?);
        Some(mean4(back.record(), [&a, &b, &c, &d]))
    }
}
