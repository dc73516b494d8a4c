//! The fill ladder, asked of every cell in every round: what a hole would get, and whether it is one.

use super::bullet::Surroundings;
use super::{below, choose, choose_words, is_empty, merge_word, opaque};
use crate::format::Format;
use crate::format::record::Words;
use crate::frame::fill::{Around, FILLED, FillMode, Nothing};
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

/// Fills the bullet holes alone: other holes stay empty, and are not counted.
pub(crate) fn fill_bullets<F: Format>(
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    reach: u32,
    tally: &mut Tally,
) {
    let grid = *back.grid();
    let format = back.format();
    let Scratch { winners, edges } = scratch;
    let around = &Nothing(format.record());
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

/// The cells beside a run of holes, as far as a row has been gone through.
struct Beside {
    /// What the last cell holds that was not empty when the round began.
    left: Words,
    /// All ones if there was one.
    has_left: u32,
    /// How many such cells are still to come.
    to_come: u32,
}

impl<A: Around, F: Format> Filler<'_, '_, A, F> {
    /// Fills the holes of a row; in the last round none is left undecided.
    fn row(&mut self, row: u32, y: i32, round: u32, last: bool) {
        let mut beside = Beside { left: Default::default(), has_left: 0, to_come: 0 };
        if last && self.fill_mode == FillMode::Extend {
            beside.to_come = self.bring_right(row);
        }
        let width = self.back.grid().width();
        for (x, cell) in (0..width as i32).zip(row..) {
            let own = self.back.words_at(cell).unwrap_or_default();
            let hole = is_empty(self.back.record(), &own);
            beside.to_come = beside.to_come.wrapping_sub(!hole & 1);
            let (mean, bullet) = if self.fill_mode.uses_edges() {
                let (around, back, winners, edges) = (self.around, &*self.back, &*self.winners, self.edges);
                Surroundings { around, back, winners, edges, round }.mean(x, y, cell)
            } else {
                (Words::default(), 0)
            };
            let bullet = bullet & hole;
            let (mut words, mut winner, mut put) = (mean, FILLED + round, bullet);
            if last {
                let unobscured = self.unobscured(cell, &beside, &own, hole & !bullet);
                words = choose_words(self.back.record(), bullet, &mean, &unobscured);
                (winner, put) = (choose(bullet, winner, NO_WINNER), hole);
            }
            self.tally.holes += put & 1;
            self.tally.bullets += bullet & 1;
            self.back.put(cell, &choose_words(self.back.record(), put, &words, &own));
            merge_word(self.winners, cell, winner, put);
            beside.left = choose_words(self.back.record(), hole, &beside.left, &own);
            beside.has_left |= !hole;
        }
    }

    /// Brings what lies at the right end of each run of holes into the holes themselves, which stay empty; returns how many
    /// cells of the row are not.
    fn bring_right(&mut self, row: u32) -> u32 {
        let record = *self.back.record();
        let mut right: Words = Default::default();
        let mut taken = 0;
        for cell in (row..row + self.back.grid().width()).rev() {
            let own = self.back.words_at(cell).unwrap_or_default();
            let hole = is_empty(&record, &own);
            right = choose_words(&record, hole, &right, &own);
            let mut brought = right;
            record.class().set(&mut brought, record.class().unsigned(&own));
            self.back.put(cell, &brought);
            taken += !hole & 1;
        }
        taken
    }

    /// What the fill_mode puts into a cell that is no bullet hole; counted where `counts` has all ones. `right` holds what lies at
    /// the right end of the run of holes, if anything does.
    #[inline(always)]
    fn unobscured(&mut self, cell: u32, beside: &Beside, right: &Words, counts: u32) -> Words {
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
                let has_right = below(0, beside.to_come);
                let farther = below(depth.unsigned(&beside.left), depth.unsigned(right));
                let take_right = opaque(has_right & (!beside.has_left | farther));
                let surface = choose_words(record, take_right, right, &beside.left);
                left_behind = choose_words(record, has_right | beside.has_left, &surface, &before);
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
