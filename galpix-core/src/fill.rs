//! Stage 4: what is put where nothing arrived.
//!
//! A hole inside a surface is a **bullet hole**: it takes the mean of those neighbours whose origin was inside a surface,
//! motion included. A hole none of whose neighbours is such lies in an area that was **just unobscured**; the rung decides
//! what it holds. Both are decided for all holes of a round at once, from what arrived and from what earlier rounds filled,
//! so that the order of traversal does not matter: just-unobscured areas grow from their boundary inwards because nothing
//! at their boundary is inside a surface, and nothing within them ever becomes so.
//!
//! Means are taken of 1, 2 or 4 galpixels only, so that a shift divides. Of the four neighbours that share a side: all
//! four; else two that face each other; else the two there are; else the one there is. If all four are holes themselves, as
//! where a gap between rows crosses one between columns, the four that share a corner, by the same rule. A hole in the
//! corner of a just-unobscured area is none of these: its neighbours across a side are there, and on an edge.

use crate::colour::Colour;
use crate::edge::on_edge;
use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::record::{Record, Words};
use crate::resolve::NOBODY;
use crate::tally::Tally;

/// Neighbours that are looked at once.
const RUN: u32 = 32;

/// In a winner map after the fill: this cell holds a bullet fill of round `winner - FILLED`.
pub const FILLED: u32 = 1 << 31;

/// The rungs of the fill ladder, from cheap to rich.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Rung {
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
    #[default]
    Galdebris,
}

impl Rung {
    /// All of them, from cheap to rich.
    pub const ALL: [Self; 5] = [Self::None, Self::Hold, Self::Debris, Self::Bullet, Self::Galdebris];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Hold => "hold",
            Self::Debris => "debris",
            Self::Bullet => "bullet",
            Self::Galdebris => "galdebris",
        }
    }

    /// Whether this rung needs to know who won each cell, and the edge map.
    #[must_use]
    pub const fn tells_surfaces(self) -> bool {
        matches!(self, Self::Bullet | Self::Galdebris)
    }
}

/// Fills the holes of `back`, which was resolved from `front`; counts them into `tally`.
///
/// `winners` is the winner map of that resolution and `edges` the edge map of `front`; without them no hole is a bullet
/// hole. `reach` rounds of bullet filling close cracks of up to twice as many cells; at least one is done.
pub fn fill<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    back: &mut Galpixmap<'_, L, B>,
    winners: &mut [u32],
    edges: &[u32],
    rung: Rung,
    reach: u32,
    tally: &mut Tally,
) {
    let rounds = if rung.tells_surfaces() { reach.clamp(1, 16) } else { 1 };
    let mut filler = Filler { front, back, winners, edges, rung, tally };
    for round in 0..rounds {
        filler.round(round, round + 1 == rounds);
    }
}

struct Filler<'f, 'p, 'q, L, B> {
    front: &'f Galpixmap<'p, L, B>,
    back: &'f mut Galpixmap<'q, L, B>,
    winners: &'f mut [u32],
    edges: &'f [u32],
    rung: Rung,
    tally: &'f mut Tally,
}

impl<L: Layout, B: Budget<L>> Filler<'_, '_, '_, L, B> {
    /// Visits all holes; in the last round none is left undecided.
    fn round(&mut self, round: u32, last: bool) {
        let grid = *self.back.grid();
        for (y, &row) in grid.starts().iter().enumerate() {
            let mut x = 0;
            while x < grid.width() {
                let run = (grid.width() - x).min(RUN);
                let cells = (row + x) as usize..(row + x + run) as usize;
                // Most runs have no hole: look at all of a run before looking at any of its cells.
                let empty = |key| self.back.class_of(key) == Class::Empty as u32;
                if self.back.keys(cells).fold(false, |holes, key| holes | empty(key)) {
                    for x in x..x + run {
                        if self.back.class(row + x) == Class::Empty {
                            self.hole(row + x, x as i32, y as i32, round, last);
                        }
                    }
                }
                x += run;
            }
        }
    }

    fn hole(&mut self, cell: u32, x: i32, y: i32, round: u32, last: bool) {
        if self.rung.tells_surfaces()
            && let Some(words) = self.bullet(x, y, round)
        {
            self.back.put(cell, &words);
            if let Some(winner) = self.winners.get_mut(cell as usize) {
                *winner = FILLED + round;
            }
            self.tally.holes += 1;
            self.tally.bullets += 1;
        } else if last {
            let words = self.unobscured(cell);
            self.back.put(cell, &words);
            if let Some(winner) = self.winners.get_mut(cell as usize) {
                *winner = NOBODY;
            }
            self.tally.holes += 1;
        }
    }

    /// What the rung puts into a cell that is no bullet hole.
    fn unobscured(&mut self, cell: u32) -> Words {
        let record = self.front.record();
        let before = self.front.words_at(cell).unwrap_or_default();
        let mut words: Words = Default::default();
        let known = record.class().unsigned(&before) != Class::Empty as u32;
        if self.rung == Rung::Galdebris && known {
            words = before;
            record.class().set(&mut words, Class::JustUnobscured as u32);
            self.tally.galdebris += 1;
            return words;
        }
        if self.rung != Rung::None {
            record.colour().set(&mut words, record.colour().unsigned(&before));
        }
        if self.rung >= Rung::Debris && known {
            let class = if self.rung == Rung::Debris { Class::Debris } else { Class::JustUnobscured };
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
        let sides = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let corners = [(x - 1, y - 1), (x + 1, y + 1), (x + 1, y - 1), (x - 1, y + 1)];
        self.mean(sides, round).or_else(|| {
            let crossing = sides.iter().all(|&(x, y)| self.vacant(x, y, round));
            if crossing { self.mean(corners, round) } else { None }
        })
    }

    /// Whether there was nothing at a place when this round began.
    fn vacant(&self, x: i32, y: i32, round: u32) -> bool {
        let winner = self.back.grid().cell(x, y).and_then(|cell| self.winners.get(cell as usize));
        winner.is_none_or(|&winner| winner >= FILLED + round)
    }

    /// The mean of two pairs of neighbours that face each other: 0 and 1, 2 and 3.
    fn mean(&self, places: [(i32, i32); 4], round: u32) -> Option<Words> {
        let record = self.back.record();
        let inside = places.map(|(x, y)| self.inside(x, y, round));
        match inside {
            [Some(a), Some(b), Some(c), Some(d)] => Some(mean4::<L>(record, [a, b, c, d])),
            [Some(a), Some(b), _, _] | [_, _, Some(a), Some(b)] => Some(mean2::<L>(record, [a, b])),
            [a, b, c, d] => match (a.or(b), c.or(d)) {
                (Some(a), Some(c)) => Some(mean2::<L>(record, [a, c])),
                (one, other) => one.or(other),
            },
        }
    }

    /// The galpixel at a place, if it came from inside of a surface, or is a bullet fill of an earlier round.
    fn inside(&self, x: i32, y: i32, round: u32) -> Option<Words> {
        let cell = self.back.grid().cell(x, y)?;
        let winner = *self.winners.get(cell as usize)?;
        let inside = if winner >= FILLED { winner < FILLED + round } else { !on_edge(self.edges, winner) };
        let words = self.back.words_at(cell)?;
        let galpixel = self.back.record().class().unsigned(&words) == Class::Galpixel as u32;
        (inside && winner != NOBODY && galpixel).then_some(words)
    }
}

/// The mean of two galpixels, field by field, halves upwards; tag and fraction of the luminosity from the first.
fn mean2<L: Layout>(record: &Record, wordss: [Words; 2]) -> Words {
    let mut mean = wordss[0];
    for field in moving_fields(record) {
        let sum = field.signed(&wordss[0]) + field.signed(&wordss[1]);
        field.set(&mut mean, ((sum + 1) >> 1) as u32);
    }
    let [a, b] = wordss.map(|words| record.depth().unsigned(&words));
    record.depth().set(&mut mean, (a + b + 1) >> 1);
    let colours = wordss.map(|words| record.colour().unsigned(&words));
    record.colour().set(&mut mean, L::Colour::mean2(colours));
    mean
}

/// The mean of four galpixels, field by field, halves upwards; tag and fraction of the luminosity from the first.
fn mean4<L: Layout>(record: &Record, wordss: [Words; 4]) -> Words {
    let mut mean = wordss[0];
    for field in moving_fields(record) {
        let sum = wordss.iter().fold(2, |sum, words| sum + field.signed(words));
        field.set(&mut mean, (sum >> 2) as u32);
    }
    let sum = wordss.iter().fold(2, |sum, words| sum + record.depth().unsigned(words));
    record.depth().set(&mut mean, sum >> 2);
    let colours = wordss.map(|words| record.colour().unsigned(&words));
    record.colour().set(&mut mean, L::Colour::mean4(colours));
    mean
}

/// The signed fields that a mean is taken of. Absent ones read 0 and ignore writes.
fn moving_fields(record: &Record) -> [crate::record::Field; 9] {
    let [vx, vy, vz] = [record.velocity(0), record.velocity(1), record.velocity(2)];
    let [ax, ay, az] = [record.acceleration(0), record.acceleration(1), record.acceleration(2)];
    [record.offset_x(), record.offset_y(), vx, vy, vz, ax, ay, az, record.luminosity_rate()]
}
