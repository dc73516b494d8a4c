//! The fill of holes, hole by hole: what is no hole is looked at in runs and left out.

use crate::format::Format;
use crate::format::record::Words;
use crate::frame::edge::on_edge;
use crate::frame::fill::{Around, FILLED, FillMode, Nothing, mean};
use crate::frame::resolve::NO_WINNER;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Neighbours that are looked at once.
const RUN: u32 = 32;

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
        for (y, &row) in (0..).zip(starts) {
            filler.row(y, row, row, round, round + 1 == rounds);
        }
    }
}

/// Fills the bullet holes alone: other holes stay empty, and are not counted.
pub(crate) fn fill_bullets<F: Format>(
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    reach: u32,
    tally: &mut Tally,
) {
    let starts = back.grid().starts();
    let format = back.format();
    let nothing = Nothing(format.record());
    let mut filler = Filler::new(&nothing, back, scratch, FillMode::Bullet, tally);
    for round in 0..FillMode::Bullet.rounds(reach) {
        for (y, &row) in (0..).zip(starts) {
            filler.row(y, row, row, round, false);
        }
    }
}

/// One round of [`fill`] for one row; in the last round none of its holes is left undecided. The rows of `back` may lie
/// elsewhere than those of `front`, whose cells `winners` counts in.
pub(crate) struct RowFill {
    /// What holes are filled with.
    pub fill_mode: FillMode,
    /// The row.
    pub y: i32,
    /// The round.
    pub round: u32,
    /// Whether it is the last one.
    pub last: bool,
}

impl RowFill {
    /// Goes over the row.
    pub fn fill<F: Format>(
        &self,
        front: &Galpixmap<'_, F>,
        back: &mut Galpixmap<'_, F>,
        scratch: &mut Scratch<'_>,
        tally: &mut Tally,
    ) {
        let (Some(row), Some(before)) = (back.grid().row(self.y), front.grid().row(self.y)) else { return };
        let mut filler = Filler::new(front, back, scratch, self.fill_mode, tally);
        filler.row(self.y, row, before, self.round, self.last);
    }
}

struct Filler<'f, 'q, A, F> {
    around: &'f A,
    back: &'f mut Galpixmap<'q, F>,
    winners: &'f mut [u32],
    edges: &'f [u32],
    fill_mode: FillMode,
    tally: &'f mut Tally,
    /// The first cell of the row that is visited, in the map before.
    before: u32,
    /// The last cell of this row, left of the one that is visited, that was not empty when the round began.
    left: Option<u32>,
    /// The column of the first such cell to the right, as far as it is known.
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
        Self { around, back, winners, edges, fill_mode, tally, before: 0, left: None, right: 0 }
    }

    /// Visits the holes of row `y`, which starts at cell `row`, and at cell `before` of the map before.
    fn row(&mut self, y: i32, row: u32, before: u32, round: u32, last: bool) {
        (self.before, self.left, self.right) = (before, None, 0);
        let width = self.back.grid().width();
        let mut x = 0;
        while x < width {
            let run = (width - x).min(RUN);
            // Most runs have no hole: look at all of a run before looking at any of its cells.
            if !self.back.any_empty(row + x, run) {
                self.left = Some(row + x + run - 1);
            } else {
                for x in x..x + run {
                    if self.back.class(row + x) == Class::Empty {
                        self.hole(row, x, y, round, last);
                    } else {
                        self.left = Some(row + x);
                    }
                }
            }
            x += run;
        }
    }

    fn hole(&mut self, row: u32, x: u32, y: i32, round: u32, last: bool) {
        let cell = row + x;
        let bullet = if self.fill_mode.uses_edges() { self.bullet(x as i32, y, round) } else { None };
        let (words, winner) = match bullet {
            Some(words) => (words, FILLED + round),
            None if last => (self.unobscured(row, x), NO_WINNER),
            None => return,
        };
        self.tally.holes += 1;
        self.tally.bullets += (winner != NO_WINNER) as u32;
        self.back.put(cell, &words);
        if let Some(to) = self.winners.get_mut(cell as usize) {
            *to = winner;
        }
    }

    /// The farther of the two surfaces at the ends of the run of holes that column `x` of a row lies in; the left one of
    /// two that are equally far.
    fn beside(&mut self, row: u32, x: u32) -> Option<Words> {
        let width = self.back.grid().width();
        if self.right <= x {
            self.right = x + 1 + self.back.empties((row + x + 1) as usize..(row + width) as usize);
        }
        let left = self.left.and_then(|cell| self.back.words_at(cell));
        let right = if self.right < width { self.back.words_at(row + self.right) } else { None };
        let depth = |words: &Words| self.back.record().depth().unsigned(words);
        match (left, right) {
            (Some(left), Some(right)) => Some(if depth(&right) > depth(&left) { right } else { left }),
            (one, other) => one.or(other),
        }
    }

    /// What the fill_mode puts into a cell that is no bullet hole.
    fn unobscured(&mut self, row: u32, x: u32) -> Words {
        // Not that of the map that is filled: this one does not change under a compiler's eyes.
        let record = self.around.record();
        let before = self.around.before(self.before + x).unwrap_or_default();
        let known = record.class().unsigned(&before) != Class::Empty as u32;
        if self.fill_mode >= FillMode::Galdebris && known {
            let beside = if self.fill_mode == FillMode::Extend { self.beside(row, x) } else { None };
            let mut words = beside.unwrap_or(before);
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

    /// The mean of the neighbours that lie inside a surface, if there are any.
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

    /// Whether there was nothing at a place when this round began.
    #[inline(always)]
    fn vacant(&self, x: i32, y: i32, round: u32) -> bool {
        let Some(cell) = self.back.grid().cell(x, y) else { return true };
        let winner = self.winners.get(cell as usize);
        self.around.foreign(cell) == 0 && winner.is_none_or(|&winner| winner >= FILLED + round)
    }

    /// The mean of two pairs of neighbours that face each other: `a` and `b`, `c` and `d`.
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

    /// The cell at a place, if what it holds came from inside of a surface, or is a bullet fill of an earlier round.
    #[inline(always)]
    fn inside(&self, x: i32, y: i32, round: u32) -> Option<u32> {
        let cell = self.back.grid().cell(x, y)?;
        let winner = *self.winners.get(cell as usize)?;
        let inside = if winner >= FILLED { winner < FILLED + round } else { !on_edge(self.edges, winner) };
        let own = self.around.foreign(cell) == 0;
        (inside && own && self.back.class(cell) == Class::Galpixel).then_some(cell)
    }

    /// The mean of two cells.
    fn mean2(&self, a: u32, b: u32) -> Option<Words> {
        let (a, b) = (self.back.words_at(a)?, self.back.words_at(b)?);
        Some(mean(self.back.record(), [&a, &b, &a, &b]))
    }

    /// The mean of four cells.
    fn mean4(&self, a: u32, b: u32, c: u32, d: u32) -> Option<Words> {
        let back = &self.back;
        let (a, b, c, d) = (back.words_at(a)?, back.words_at(b)?, back.words_at(c)?, back.words_at(d)?);
        Some(mean(back.record(), [&a, &b, &c, &d]))
    }
}
