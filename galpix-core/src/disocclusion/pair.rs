//! Which of two neighbours leaves the other, and what it uncovers.

use super::Reach;
use super::extents::{DOWNWARDS, Extents, TO_THE_LEFT, TO_THE_RIGHT, UPWARDS, shut};
use super::reach::{Bound, Motion};
use crate::format::Format;
use crate::format::record::Record;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// The key of what nothing is behind: empty cells, and what lies beyond the border.
const FARTHEST: i32 = i32::MAX;

/// The largest separation: even the last key is nearer than [`FARTHEST`] by as much.
pub(crate) const WIDEST_SEPARATION: u32 = 1 << 30;

/// Cells by which two surfaces get apart so far that they do not belong together. A power of two.
const APART: u32 = 2;

/// What is asked of a galpixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Body {
    /// Class and depth, the smaller the nearer.
    key: i32,
    /// In x and y.
    motion: [Motion; 2],
}

impl Body {
    /// Nothing, infinitely far away, and still.
    pub const NOTHING: Self = Self { key: FARTHEST, motion: [Motion { offset: 0, velocity: 0, acceleration: 0 }; 2] };

    /// What is in a cell.
    #[inline(always)]
    pub fn read<F: Format>(front: &Galpixmap<'_, F>, cell: u32) -> Self {
        let Some(key) = front.key_at(cell) else { return Self::NOTHING };
        if front.class_of(key) == Class::Empty as u32 {
            return Self::NOTHING;
        }
        // Words that hold nothing of this are not read: they would not be in the cache.
        Self { key: key as i32, motion: [motion::<F, 0>(front, cell), motion::<F, 1>(front, cell)] }
    }
}

/// The motion of what is in a cell along a component.
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

/// What two neighbours uncover, and where one shuts the other off, as words of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Uncovered {
    /// By the left or upper one, in itself and behind it.
    pub first: u32,
    /// By the right or lower one.
    pub second: u32,
    /// Whether anything is uncovered.
    pub opens: bool,
    /// Whether an extent has no end.
    pub endless: bool,
}

/// The rule for all pairs of a map.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rule {
    /// In x and y.
    pub bounds: [Bound; 2],
    pub separation: i32,
    /// Whether neighbours of one surface count that part by a whole cell.
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

    /// What is uncovered by two neighbours in a row (`ALONG` 0: left and right) or in a column (1: upper and lower).
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
        let aside = across.between(second_across, first_across);
        let gap = along.cells(&ahead);
        let opens = gap > 0 && (!one_surface || self.tears && along.parts(&ahead));
        let may_end = self.ends && !one_surface && farther != 0;
        if !opens && !may_end {
            return uncovered;
        }
        // Of the second one against the first: to the right of its way in a column, below it in a row, and the opposite.
        let (onwards, backwards) = (across.cells(&aside), across.cells(&aside.reversed()));
        // What the nearer one uncovers is behind itself: it is not handed on to a farther one that moves apart from it.
        if may_end && ((gap | onwards | backwards) >= APART || along.cells(&ahead.reversed()) >= APART) {
            let (behind_second, behind_first) = if ALONG == 0 {
                (shut::<TO_THE_RIGHT>(), shut::<TO_THE_LEFT>())
            } else {
                (shut::<DOWNWARDS>(), shut::<UPWARDS>())
            };
            if farther > 0 { uncovered.second = behind_second } else { uncovered.first = behind_first }
        }
        if !opens {
            return uncovered;
        }
        uncovered.opens = true;
        let (onwards, backwards) = (onwards + 1, backwards + 1);
        const NO_END: u32 = Extents::NO_END as u32;
        uncovered.endless = gap >= NO_END || onwards >= NO_END || backwards >= NO_END;
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
        // The nearer one leaves; two of one surface, or as near, both.
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
