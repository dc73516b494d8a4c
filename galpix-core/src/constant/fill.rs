//! The fill ladder, asked of every cell in every round: what a hole would get, and whether it is one.

use super::bullet::Surroundings;
use super::{below, choose, choose_words, is_empty, merge_word, opaque};
use crate::fill::{Around, FILLED, Nothing, Rung};
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::record::Words;
use crate::resolve::NOBODY;
use crate::tally::Tally;

/// [`crate::fill::fill`] with constant work: the same arguments, the same bits.
pub fn fill<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
    edges: &[u32],
    rung: Rung,
    reach: u32,
    tally: &mut Tally,
) {
    fill_around(front, back, winners, edges, rung, reach, tally);
}

/// [`fill`], whatever was shown before.
pub(crate) fn fill_around<L: Layout, B: Budget<L>>(
    around: &impl Around,
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
    edges: &[u32],
    rung: Rung,
    reach: u32,
    tally: &mut Tally,
) {
    let grid = *back.grid();
    let rounds = rung.rounds(reach);
    let mut filler = Filler { around, back, winners, edges, rung, tally };
    for round in 0..rounds {
        for (y, &row) in (0..).zip(grid.starts()) {
            filler.row(row, y, round, round + 1 == rounds);
        }
    }
}

/// [`crate::fill::fill_bullets`] with constant work.
pub(crate) fn fill_bullets<L: Layout, B: Budget<L>>(
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
    edges: &[u32],
    reach: u32,
    tally: &mut Tally,
) {
    let grid = *back.grid();
    let budget = back.budget();
    let mut filler = Filler { around: &Nothing(budget.record()), back, winners, edges, rung: Rung::Bullet, tally };
    for round in 0..Rung::Bullet.rounds(reach) {
        for (y, &row) in (0..).zip(grid.starts()) {
            filler.row(row, y, round, false);
        }
    }
}

struct Filler<'f, 'q, A, L, B> {
    around: &'f A,
    back: &'f mut Galpixmap<'q, L, B>,
    winners: &'f mut [u32],
    edges: &'f [u32],
    rung: Rung,
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

impl<A: Around, L: Layout, B: Budget<L>> Filler<'_, '_, A, L, B> {
    /// Fills the holes of a row; in the last round none is left undecided.
    fn row(&mut self, row: u32, y: i32, round: u32, last: bool) {
        let mut beside = Beside { left: Default::default(), has_left: 0, to_come: 0 };
        if last && self.rung == Rung::Extend {
            beside.to_come = self.bring_right(row);
        }
        let width = self.back.grid().width();
        for (x, cell) in (0..width as i32).zip(row..) {
            let own = self.back.words_at(cell).unwrap_or_default();
            let hole = is_empty(self.back.record(), &own);
            beside.to_come = beside.to_come.wrapping_sub(!hole & 1);
            let (mean, bullet) = if self.rung.tells_surfaces() {
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
                (winner, put) = (choose(bullet, winner, NOBODY), hole);
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

    /// What the rung puts into a cell that is no bullet hole; counted where `counts` has all ones. `right` holds what lies at
    /// the right end of the run of holes, if anything does.
    #[inline(always)]
    fn unobscured(&mut self, cell: u32, beside: &Beside, right: &Words, counts: u32) -> Words {
        let record = self.around.record();
        let before = self.around.before(cell).unwrap_or_default();
        let known = !is_empty(record, &before);
        let mut unknown: Words = Default::default();
        if self.rung != Rung::None {
            record.colour().set(&mut unknown, record.colour().unsigned(&before));
        }
        let mut left_behind = unknown;
        record.class().set(&mut unknown, Class::Empty as u32);
        let (debris, galdebris) = if self.rung >= Rung::Galdebris {
            left_behind = before;
            if self.rung == Rung::Extend {
                let depth = record.depth();
                let has_right = below(0, beside.to_come);
                let farther = below(depth.unsigned(&beside.left), depth.unsigned(right));
                let take_right = opaque(has_right & (!beside.has_left | farther));
                let surface = choose_words(record, take_right, right, &beside.left);
                left_behind = choose_words(record, has_right | beside.has_left, &surface, &before);
            }
            record.class().set(&mut left_behind, Class::JustUnobscured as u32);
            (0, known)
        } else if self.rung >= Rung::Debris {
            let class = if self.rung == Rung::Debris { Class::Debris } else { Class::JustUnobscured };
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
