//! Stage 4: fills the holes, which are the cells at which nothing arrived.
//!
//! A hole inside a surface is a **bullet hole**: it takes the mean of those neighbours that came from inside a surface,
//! their motion included. Such a **bullet** is debris: it moves on with its surface, but loses against any galpixel. A
//! hole without such a neighbour was **just unobscured**; the fill mode decides what it holds. Each round decides for
//! all holes from what arrived and from what earlier rounds filled, so that the order of traversal does not matter.
//! Bullet fills do not spread into just-unobscured areas, because the cells at the boundary of such an area came from
//! an edge.
//!
//! Means are taken of 1, 2 or 4 galpixels, so that a shift divides. The candidates are the four neighbours that share a
//! side with the hole: all four; else two that face each other; else the two there are; else the one there is. If all
//! four are holes themselves, as where a gap between rows crosses a gap between columns, the four neighbours that share
//! a corner are the candidates instead. This does not apply to a hole in the corner of a just-unobscured area, because
//! its neighbours outside of the area are no holes.

use crate::format::Format;
use crate::format::record::{Field, Record, Words};
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::map::Galpixmap;

/// The entry of a winner map, after the fill, for a cell that was filled as a bullet hole in round `r` is `FILLED + r`.
pub const FILLED: u32 = 1 << 31;

/// How holes are filled, from cheap to rich.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FillMode {
    /// Holes stay empty and black. For experiments.
    None,
    /// Holes stay empty and keep the colour of the frame before, so that the display does not change there.
    Hold,
    /// Holes hold debris: the colour of the frame before, without motion, at the farthest depth.
    Debris,
    /// Bullet holes are filled; just-unobscured holes hold debris without motion.
    Bullet,
    /// Bullet holes are filled; just-unobscured holes hold galdebris: the galpixel of the frame before, not propagated.
    /// It is late by one frame, and by one more each time that this is repeated.
    Galdebris,
    /// Bullet holes are filled; just-unobscured holes continue the farther of the two surfaces at the ends of the run
    /// of holes in their row, and move with it. A row that has nothing but holes gets galdebris. A hole of which the
    /// frame before knew nothing keeps its colour and stays empty, as with all fill modes.
    #[default]
    Extend,
}

impl FillMode {
    /// All fill modes, from cheap to rich.
    pub const ALL: [Self; 6] = [Self::None, Self::Hold, Self::Debris, Self::Bullet, Self::Galdebris, Self::Extend];

    /// Returns the name on the command line.
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

    /// Returns whether this fill mode needs the winner map and the edge map.
    #[must_use]
    pub const fn uses_edges(self) -> bool {
        matches!(self, Self::Bullet | Self::Galdebris | Self::Extend)
    }

    /// Returns the rounds of filling for a reach.
    pub(crate) fn rounds(self, reach: u32) -> u32 {
        if self.uses_edges() { reach.clamp(1, 16) } else { 1 }
    }
}

/// What a fill reads in addition to the map that it fills.
pub(crate) trait Around {
    /// Returns the stored form.
    fn record(&self) -> &Record;

    /// Returns what the frame before showed in a cell.
    fn before(&self, cell: u32) -> Option<Words>;

    /// Returns all ones if what the filled map holds in a cell came from another map, so that the winner map does not
    /// apply to it; else 0.
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

/// There was no frame before.
pub(crate) struct NoFrameBefore<'r>(pub &'r Record);

impl Around for NoFrameBefore<'_> {
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

/// Fills the holes of `back`, which was resolved from `front`, and adds their counts to `tally`.
///
/// `scratch` holds the winner map of that resolution and the edge map of `front`; without them no hole is a bullet
/// hole. Of `settings` only the fill mode and the reach are used: `reach` rounds of bullet filling (1 to 16) close
/// cracks that are up to twice as many cells wide.
pub fn fill<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    F::fill(front, back, scratch, settings, tally);
}

/// Returns the mean of four galpixels, field by field, halves upwards; tag and fraction of the luminosity are those of
/// the first. The sum of four fields of 30 bits fits in 32 bits.
///
/// With `p, q, p, q` it is `(2p + 2q + 2) >> 2 = (p + q + 1) >> 1`, the mean of two; with four times `p` it is
/// `(4p + 2) >> 2 = p`. So it serves where the number of galpixels must not matter.
#[inline(always)]
pub(crate) fn mean4(record: &Record, [a, b, c, d]: [&Words; 4]) -> Words {
    let (depth, colour) = (record.depth(), record.colour());
    let depths = depth.unsigned(a) + depth.unsigned(b) + depth.unsigned(c) + depth.unsigned(d);
    let colours = [colour.unsigned(a), colour.unsigned(b), colour.unsigned(c), colour.unsigned(d)];
    let sum = |field: Field| field.signed(a) + field.signed(b) + field.signed(c) + field.signed(d);
    mean_of::<2>(record, a, sum, (depths, record.colour_format().mean4(colours)))
}

/// Returns the mean of two galpixels, as [`mean4`] of `p, q, p, q`: half as many fields to read.
#[inline(always)]
pub(crate) fn mean2(record: &Record, [a, b]: [&Words; 2]) -> Words {
    let (depth, colour) = (record.depth(), record.colour());
    let colours = [colour.unsigned(a), colour.unsigned(b)];
    let sum = |field: Field| field.signed(a) + field.signed(b);
    mean_of::<1>(record, a, sum, (depth.unsigned(a) + depth.unsigned(b), record.colour_format().mean2(colours)))
}

/// Divides the sums of `2^LOG` galpixels, which are given for each moving field and for the depth, beside their mean
/// colour.
#[inline(always)]
fn mean_of<const LOG: u32>(
    record: &Record,
    first: &Words,
    sum: impl Fn(Field) -> i32,
    (depths, colour): (u32, u32),
) -> Words {
    let mut mean = *first;
    each_moving_field(record, |field| field.set(&mut mean, ((sum(field) + (1 << LOG >> 1)) >> LOG) as u32));
    record.depth().set(&mut mean, (depths + (1 << LOG >> 1)) >> LOG);
    record.colour().set(&mut mean, colour);
    mean
}

/// Calls `visit` with each signed field of which a mean is taken. Absent fields read as 0 and ignore writes.
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
