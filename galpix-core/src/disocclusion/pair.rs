//! The rule for two neighbours: which of them leaves the other, and what it uncovers.

use super::Reach;
use super::extents::{DOWNWARDS, Extents, LEFTWARDS, RIGHTWARDS, UPWARDS, blocked};
use super::reach::{Bound, Motion};
use crate::format::Format;
use crate::format::record::Record;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// The key of empty cells and of what lies beyond the border: nothing is behind them.
const FARTHEST: i32 = i32::MAX;

/// The largest separation. By this much even the last key is nearer than [`FARTHEST`].
pub(crate) const WIDEST_SEPARATION: u32 = 1 << 30;

/// Two surfaces that get apart by this many cells do not belong together. A power of two, so that an `|` of counts
/// compares all of them.
const APART: u32 = 2;

/// Key and motion of a galpixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Body {
    /// Class and depth; the smaller, the nearer.
    key: i32,
    /// In x and y.
    motion: [Motion; 2],
}

impl Body {
    /// Nothing: infinitely far away and still.
    pub const NOTHING: Self = Self { key: FARTHEST, motion: [Motion { offset: 0, velocity: 0, acceleration: 0 }; 2] };

    /// Reads the body in a cell.
    #[inline(always)]
    pub fn read<F: Format>(front: &Galpixmap<'_, F>, cell: u32) -> Self {
        let Some(key) = front.key_at(cell) else { return Self::NOTHING };
        if front.class_of(key) == Class::Empty as u32 {
            return Self::NOTHING;
        }
        // Only the words that hold these fields are read: the others are not in the cache.
        Self { key: key as i32, motion: [motion::<F, 0>(front, cell), motion::<F, 1>(front, cell)] }
    }
}

/// Returns the motion in a cell along a component.
#[inline(always)]
fn motion<F: Format, const ALONG: usize>(front: &Galpixmap<'_, F>, cell: u32) -> Motion {
    let record = front.record();
    let acceleration = front.signed(record.acceleration(ALONG), cell);
    Motion {
        offset: front.signed(record.offset(ALONG), cell),
        velocity: front.signed(record.velocity(ALONG), cell),
        acceleration: acceleration << record.scales[ALONG].acceleration_up,
    }
}

/// What two neighbours uncover, and which of them is blocked, as words of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Uncovered {
    /// The word for the left or upper neighbour.
    pub first: u32,
    /// The word for the right or lower neighbour.
    pub second: u32,
    /// Whether anything is uncovered.
    pub opens: bool,
    /// Whether an extent is [`Extents::NO_END`].
    pub saturated: bool,
}

/// The rule for all pairs of a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rule {
    /// In x and y.
    pub bounds: [Bound; 2],
    pub separation: i32,
    /// Whether neighbours of one surface that part by a whole cell count.
    pub tears: bool,
    /// Whether what is uncovered ends where its surface does.
    pub ends: bool,
}

impl Rule {
    pub fn new(record: &Record, reach: &Reach) -> Self {
        let frames = reach.frames.min(Reach::MOST_FRAMES);
        let [x, y, _] = &record.scales;
        let bound = |scale, component| Bound::new(scale, record.acceleration(component).present(), frames);
        Self {
            bounds: [bound(x, 0), bound(y, 1)],
            separation: reach.separation.min(WIDEST_SEPARATION) as i32,
            tears: reach.tears,
            ends: !reach.through,
        }
    }

    /// Returns what two neighbours in a row (`ALONG` 0: left and right) or in a column (`ALONG` 1: upper and lower)
    /// uncover.
    #[inline(never)]
    pub fn uncovered<const ALONG: usize>(&self, first: &Body, second: &Body) -> Uncovered {
        let ([x, y], [first_x, first_y], [second_x, second_y]) = (&self.bounds, first.motion, second.motion);
        let (along, across) = if ALONG == 0 { (x, y) } else { (y, x) };
        let (first_along, first_across) = if ALONG == 0 { (first_x, first_y) } else { (first_y, first_x) };
        let (second_along, second_across) = if ALONG == 0 { (second_x, second_y) } else { (second_y, second_x) };
        let farther = second.key.wrapping_sub(first.key);
        let one_surface = farther < self.separation && farther > -self.separation;
        let mut uncovered = Uncovered::default();
        let ahead = along.between(second_along, first_along);
        let gap = along.cells(&ahead);
        let opens = gap > 0 && (!one_surface || self.tears && along.parts(&ahead));
        let may_end = self.ends && !one_surface && farther != 0;
        if !opens && !may_end {
            return uncovered;
        }
        // Cells by which the second one gets ahead of the first across the pair (below in a row, to the right in a
        // column), and the first one of the second. The reverse motion is not the negated one: rustc 1.95 makes a
        // negated velocity, shifted left by 1, a product by -2, and that a call of `__aeabi_lmul` on
        // thumbv6m-none-eabi.
        let onwards = across.cells(&across.between(second_across, first_across));
        let backwards = across.cells(&across.between(first_across, second_across));
        // The nearer one uncovers what is behind itself. That is not propagated to a farther one that moves apart from
        // it.
        let behind = || along.cells(&along.between(first_along, second_along));
        if may_end && ((gap | onwards | backwards) >= APART || behind() >= APART) {
            let (to_second, to_first) = if ALONG == 0 {
                (blocked::<RIGHTWARDS>(), blocked::<LEFTWARDS>())
            } else {
                (blocked::<DOWNWARDS>(), blocked::<UPWARDS>())
            };
            if farther > 0 { uncovered.second = to_second } else { uncovered.first = to_first }
        }
        if !opens {
            return uncovered;
        }
        uncovered.opens = true;
        let (onwards, backwards) = (onwards + 1, backwards + 1);
        const NO_END: u32 = Extents::NO_END as u32;
        uncovered.saturated = gap >= NO_END || onwards >= NO_END || backwards >= NO_END;
        let [gap, onwards, backwards] = [gap, onwards, backwards].map(|cells| cells.min(NO_END) as u8);
        let (one, other) = if ALONG == 0 {
            (
                Extents { left: gap, right: 1, above: onwards, below: backwards },
                Extents { left: 1, right: gap, above: backwards, below: onwards },
            )
        } else {
            (
                Extents { left: onwards, right: backwards, above: gap, below: 1 },
                Extents { left: backwards, right: onwards, above: 1, below: gap },
            )
        };
        // The nearer one leaves; both leave if they are of one surface or equally near.
        let both = one_surface || farther == 0;
        if both || farther > 0 {
            uncovered.first |= one.word();
        }
        if both || farther < 0 {
            uncovered.second |= other.word();
        }
        uncovered
    }
}
