//! The fill of holes: every round computes for every cell what it would get as a hole, and keeps it if the cell is one.

use super::bullet::Surroundings;
use super::{below, choose, choose_words, is_empty, merge_word, opaque};
use crate::format::Format;
use crate::format::record::Words;
use crate::frame::fill::{Around, FILLED, FillMode, NoFrameBefore};
use crate::frame::resolve::NO_WINNER;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Fills the holes of `back`, see [`crate::frame::fill::fill`].
pub(crate) fn fill<F: Format>(
    around: &impl Around,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    let grid = *back.grid();
    let rounds = settings.fill_mode.rounds(settings.reach);
    let Scratch { winners, edges } = scratch;
    let mut filler = Filler { around, back, winners, edges, fill_mode: settings.fill_mode, tally };
    for round in 0..rounds {
        for (y, &row) in (0..).zip(grid.starts()) {
            filler.row(row, y, round, round + 1 == rounds);
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
    let grid = *back.grid();
    let format = back.format();
    let Scratch { winners, edges } = scratch;
    let around = &NoFrameBefore(format.record());
    let mut filler = Filler { around, back, winners, edges, fill_mode: FillMode::Bullet, tally };
    for round in 0..FillMode::Bullet.rounds(reach) {
        for (y, &row) in (0..).zip(grid.starts()) {
            filler.row(row, y, round, false);
        }
    }
}

struct Filler<'f, 'q, A, F> {
    around: &'f A,
    back: &'f mut Galpixmap<'q, F>,
    winners: &'f mut [u32],
    edges: &'f [u32],
    fill_mode: FillMode,
    tally: &'f mut Tally,
}

/// The occupied cells on both sides of the current cell of a row; occupied when the round began.
struct Occupied {
    /// The words of the nearest one to the left.
    left: Words,
    /// All ones if there is one to the left, else 0.
    has_left: u32,
    /// How many there are to the right.
    to_right: u32,
}

impl<A: Around, F: Format> Filler<'_, '_, A, F> {
    /// Fills the bullet holes of a row; in the last round all of its holes.
    fn row(&mut self, row: u32, y: i32, round: u32, last: bool) {
        let mut occupied = Occupied { left: Default::default(), has_left: 0, to_right: 0 };
        if last && self.fill_mode == FillMode::Extend {
            occupied.to_right = self.store_right_ends(row);
        }
        let width = self.back.grid().width();
        for (x, cell) in (0..width as i32).zip(row..) {
            let own = self.back.words_at(cell).unwrap_or_default();
            let hole = is_empty(self.back.record(), &own);
            occupied.to_right = occupied.to_right.wrapping_sub(!hole & 1);
            let (mean, bullet) = if self.fill_mode.uses_edges() {
                let (around, back, winners, edges) = (self.around, &*self.back, &*self.winners, self.edges);
                Surroundings { around, back, winners, edges, round }.mean(x, y, cell)
            } else {
                (Words::default(), 0)
            };
            let bullet = bullet & hole;
            let (mut words, mut winner, mut put) = (mean, FILLED + round, bullet);
            if last {
                let unobscured = self.unobscured(cell, &occupied, &own, hole & !bullet);
                words = choose_words(self.back.record(), bullet, &mean, &unobscured);
                (winner, put) = (choose(bullet, winner, NO_WINNER), hole);
            }
            self.tally.holes += put & 1;
            self.tally.bullets += bullet & 1;
            self.back.put(cell, &choose_words(self.back.record(), put, &words, &own));
            merge_word(self.winners, cell, winner, put);
            occupied.left = choose_words(self.back.record(), hole, &occupied.left, &own);
            occupied.has_left |= !hole;
        }
    }

    /// Stores in each hole of a row what the next occupied cell to its right holds, except for the class: the holes
    /// stay empty. Returns the number of occupied cells.
    fn store_right_ends(&mut self, row: u32) -> u32 {
        let record = *self.back.record();
        let mut right: Words = Default::default();
        let mut occupied = 0;
        for cell in (row..row + self.back.grid().width()).rev() {
            let own = self.back.words_at(cell).unwrap_or_default();
            let hole = is_empty(&record, &own);
            right = choose_words(&record, hole, &right, &own);
            let mut stored = right;
            record.class().set(&mut stored, record.class().unsigned(&own));
            self.back.put(cell, &stored);
            occupied += !hole & 1;
        }
        occupied
    }

    /// Returns what a hole holds that is no bullet hole, and counts it if `counts` has all ones. `right` are the words
    /// of the nearest occupied cell to the right, if there is one.
    #[inline(always)]
    fn unobscured(&mut self, cell: u32, occupied: &Occupied, right: &Words, counts: u32) -> Words {
        let record = self.around.record();
        let before = self.around.before(cell).unwrap_or_default();
        let known = !is_empty(record, &before);
        let mut unknown: Words = Default::default();
        if self.fill_mode != FillMode::None {
            record.colour().set(&mut unknown, record.colour().unsigned(&before));
        }
        let mut left_behind = unknown;
        record.class().set(&mut unknown, Class::Empty as u32);
        let (debris, galdebris) = if self.fill_mode >= FillMode::Galdebris {
            left_behind = before;
            if self.fill_mode == FillMode::Extend {
                let depth = record.depth();
                let has_right = below(0, occupied.to_right);
                let farther = below(depth.unsigned(&occupied.left), depth.unsigned(right));
                let take_right = opaque(has_right & (!occupied.has_left | farther));
                let surface = choose_words(record, take_right, right, &occupied.left);
                left_behind = choose_words(record, has_right | occupied.has_left, &surface, &before);
            }
            record.class().set(&mut left_behind, Class::JustUnobscured as u32);
            (0, known)
        } else if self.fill_mode >= FillMode::Debris {
            let class = if self.fill_mode == FillMode::Debris { Class::Debris } else { Class::JustUnobscured };
            record.class().set(&mut left_behind, class as u32);
            record.depth().set(&mut left_behind, u32::MAX);
            (known, 0)
        } else {
            (0, 0)
        };
        self.tally.debris += debris & counts & 1;
        self.tally.galdebris += galdebris & counts & 1;
        self.tally.empty += !(debris | galdebris) & counts & 1;
        choose_words(record, debris | galdebris, &left_behind, &unknown)
    }
}
