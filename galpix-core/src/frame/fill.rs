//! Stage 4: what is put where nothing arrived.
//!
//! A hole inside a surface is a **bullet hole**: it takes the mean of those neighbours whose origin was inside a surface,
//! motion included. A hole none of whose neighbours is such lies in an area that was **just unobscured**; the fill_mode decides
//! what it holds. Both are decided for all holes of a round at once, from what arrived and from what earlier rounds filled,
//! so that the order of traversal does not matter: just-unobscured areas grow from their boundary inwards because nothing
//! at their boundary is inside a surface, and nothing within them ever becomes so.
//!
//! Means are taken of 1, 2 or 4 galpixels only, so that a shift divides. Of the four neighbours that share a side: all
//! four; else two that face each other; else the two there are; else the one there is. If all four are holes themselves, as
//! where a gap between rows crosses one between columns, the four that share a corner, by the same rule. A hole in the
//! corner of a just-unobscured area is none of these: its neighbours across a side are there, and on an edge.
use crate::format::Format;
use crate::format::record::{Field, Record, Words};
use crate::frame::edge::on_edge;
use crate::frame::resolve::NO_WINNER;
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Neighbours that are looked at once.
const RUN: u32 = 32;

/// In a winner map after the fill: this cell holds a bullet fill of round `winner - FILLED`.
pub const FILLED: u32 = 1 << 31;

/// The rungs of the fill ladder, from cheap to rich.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FillMode {
    /// Holes stay empty and black, for study.
    None,
    /// Holes stay empty; the display keeps showing what it showed there.
    Hold,
    /// What was there stays as debris: its colour, without motion, as far away as can be.
    Debris,
    /// Bullet holes are filled; what was just unobscured holds debris without motion.
    Bullet,
    /// Bullet holes are filled; what was just unobscured holds the galpixel that was there, not propagated: one frame
    /// late, and one more each time.
    Galdebris,
    /// Bullet holes are filled; what was just unobscured continues, along its row, the farther of the two surfaces beside
    /// it, and moves with it. Where a whole row is unobscured, as galdebris. A cell of which nothing was ever known keeps
    /// its colour, as with every fill_mode.
    #[default]
    Extend,
}

impl FillMode {
    /// All of them, from cheap to rich.
    pub const ALL: [Self; 6] = [Self::None, Self::Hold, Self::Debris, Self::Bullet, Self::Galdebris, Self::Extend];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Hold => "hold",
            Self::Debris => "debris",
            Self::Bullet => "bullet",
            Self::Galdebris => "galdebris",
            Self::Extend => "extend",
        }
    }

    /// Whether this fill_mode needs to know who won each cell, and the edge map.
    #[must_use]
    pub const fn uses_edges(self) -> bool {
        matches!(self, Self::Bullet | Self::Galdebris | Self::Extend)
    }

    /// Rounds of filling for a reach.
    pub(crate) fn rounds(self, reach: u32) -> u32 {
        if self.uses_edges() { reach.clamp(1, 16) } else { 1 }
    }
}

/// What a fill must know beside the map that it fills.
pub(crate) trait Around {
    /// The stored form.
    fn record(&self) -> &Record;

    /// What was shown in a cell in the frame before.
    fn before(&self, cell: u32) -> Option<Words>;

    /// All ones if what the filled map holds in a cell is not its own, so that its winner says nothing about it; else 0.
    fn foreign(&self, cell: u32) -> u32;
}

impl<F: Format> Around for Galpixmap<'_, F> {
    #[inline(always)]
    fn record(&self) -> &Record {
        Galpixmap::record(self)
    }

    #[inline(always)]
    fn before(&self, cell: u32) -> Option<Words> {
        self.words_at(cell)
    }

    #[inline(always)]
    fn foreign(&self, _cell: u32) -> u32 {
        0
    }
}

/// Nothing was shown before.
pub(crate) struct Nothing<'r>(pub &'r Record);

impl Around for Nothing<'_> {
    #[inline(always)]
    fn record(&self) -> &Record {
        self.0
    }

    #[inline(always)]
    fn before(&self, _cell: u32) -> Option<Words> {
        None
    }

    #[inline(always)]
    fn foreign(&self, _cell: u32) -> u32 {
        0
    }
}

/// Fills the holes of `back`, which was resolved from `front`; counts them into `tally`.
///
/// `winners` is the winner map of that resolution and `edges` the edge map of `front`; without them no hole is a bullet
/// hole. `reach` rounds of bullet filling close cracks of up to twice as many cells; at least one is done.
pub fn fill<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    edges: &[u32],
    fill_mode: FillMode,
    reach: u32,
    tally: &mut Tally,
) {
    F::fill(front, back, winners, edges, fill_mode, reach, tally);
}

/// [`fill`], whatever was shown before.
pub(crate) fn fill_around<F: Format>(
    around: &impl Around,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    edges: &[u32],
    fill_mode: FillMode,
    reach: u32,
    tally: &mut Tally,
) {
    let rounds = fill_mode.rounds(reach);
    let starts = back.grid().starts();
    let mut filler = Filler::new(around, back, winners, edges, fill_mode, tally);
    for round in 0..rounds {
        for (y, &row) in (0..).zip(starts) {
            filler.row(y, row, row, round, round + 1 == rounds);
        }
    }
}

/// The bullet holes alone: other holes stay empty, and are not counted.
pub(crate) fn fill_bullets<F: Format>(
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    edges: &[u32],
    reach: u32,
    tally: &mut Tally,
) {
    let starts = back.grid().starts();
    let format = back.format();
    let nothing = Nothing(format.record());
    let mut filler = Filler::new(&nothing, back, winners, edges, FillMode::Bullet, tally);
    for round in 0..FillMode::Bullet.rounds(reach) {
        for (y, &row) in (0..).zip(starts) {
            filler.row(y, row, row, round, false);
        }
    }
}

/// One round of [`fill`] for one row; in the last round none of its holes is left undecided. The rows of `back` may lie
/// elsewhere than those of `front`, whose cells `winners` counts in.
pub(crate) struct RowFill<'f> {
    /// The edge map of `front`.
    pub edges: &'f [u32],
    /// What holes are filled with.
    pub fill_mode: FillMode,
    /// The row.
    pub y: i32,
    /// The round.
    pub round: u32,
    /// Whether it is the last one.
    pub last: bool,
}

impl RowFill<'_> {
    /// Goes over the row.
    pub fn fill<F: Format>(
        &self,
        front: &Galpixmap<'_, F>,
        back: &mut Galpixmap<'_, F>,
        winners: &mut [u32],
        tally: &mut Tally,
    ) {
        let (Some(row), Some(before)) = (back.grid().row(self.y), front.grid().row(self.y)) else { return };
        let mut filler = Filler::new(front, back, winners, self.edges, self.fill_mode, tally);
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
        winners: &'f mut [u32],
        edges: &'f [u32],
        fill_mode: FillMode,
        tally: &'f mut Tally,
    ) -> Self {
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

/// The mean of four galpixels, field by field, halves upwards; tag and fraction of the luminosity from the first.
///
/// With `p, q, p, q` it is `(2p + 2q + 2) >> 2 = (p + q + 1) >> 1`, the mean of two; with four times `p` it is
/// `(4p + 2) >> 2 = p`. The sum of four fields of 30 bits stays within 32.
#[inline(always)]
pub(crate) fn mean(record: &Record, [a, b, c, d]: [&Words; 4]) -> Words {
    let mut mean = *a;
    each_moving_field(record, |field| {
        let sum = field.signed(a) + field.signed(b) + field.signed(c) + field.signed(d);
        field.set(&mut mean, ((sum + 2) >> 2) as u32);
    });
    let depth = record.depth();
    let sum = depth.unsigned(a) + depth.unsigned(b) + depth.unsigned(c) + depth.unsigned(d);
    depth.set(&mut mean, (sum + 2) >> 2);
    let colour = record.colour();
    let colours = [a, b, c, d].map(|words| colour.unsigned(words));
    colour.set(&mut mean, record.colour_format().mean4(colours));
    mean
}

/// The signed fields that a mean is taken of, one after the other. Absent ones read 0 and ignore writes.
#[inline(always)]
fn each_moving_field(record: &Record, mut visit: impl FnMut(Field)) {
    visit(record.offset_x());
    visit(record.offset_y());
    visit(record.velocity(0));
    visit(record.velocity(1));
    visit(record.velocity(2));
    visit(record.acceleration(0));
    visit(record.acceleration(1));
    visit(record.acceleration(2));
    visit(record.luminosity_rate());
}
