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
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings};
use crate::map::Galpixmap;

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
/// `scratch` holds the winner map of that resolution and the edge map of `front`; without them no hole is a bullet hole.
/// Of `settings` the fill mode and the reach count: `reach` rounds of bullet filling close cracks of up to twice as many
/// cells; at least one is done.
pub fn fill<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    F::fill(front, back, scratch, settings, tally);
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
