//! Grafting: galpixels of an update that arrives late, piece by piece, enter a map that has moved on.
//!
//! A galpixel of an update is exact at one frame and reaches the map some frames later. Stored at its old place it
//! would make the picture jump back. So it first makes the steps that it has missed, with the same thresholds as if it
//! had been in the map, and is then stored in the cell that it has reached. An update that is some frames late thus
//! gives the same cells as one in time, apart from what collides and what is filled in the meantime.
//!
//! A galpixel that comes in is newer than the one that is there, and replaces it whatever its depth, because the object
//! in front may have left. Only a galpixel of the same update is not replaced by a farther one. The tag decides: all
//! galpixels of an update carry the number of the update, or as many low bits of it as the layout has. The tag moves
//! with them, so an update may take several frames to arrive. Without a tag the last galpixel wins.

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve;
use crate::frame::step::{advance, thresholds};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// The result of grafting a galpixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Grafted {
    /// It is in the map, in this cell.
    Put(u32),
    /// Its cell holds a nearer galpixel of the same update; of two equally near ones the first stays.
    Behind,
    /// It has left the map by now, or was never in it.
    Lost,
    /// It is empty: nothing was known there.
    Empty,
}

/// The frames that a galpixel has missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Delay {
    /// The frame counter at which the galpixel is exact.
    pub stamp: u32,
    /// The frame counter of the map; not before `stamp`, modulo 2^32.
    pub now: u32,
    /// How the map rounds positions.
    pub rounding: Rounding,
}

/// Grafts a galpixel into a map.
///
/// `place` is its column and row at the frame of its stamp, margin included. Of `words`, those beyond the layout's are
/// ignored, and missing ones are 0.
///
/// *Cost:* one step for each frame of the delay; the caller bounds their number.
pub fn graft<F: Format>(map: &mut Galpixmap<'_, F>, place: (i32, i32), words: &[u32], delay: Delay) -> Grafted {
    let mut galpixel = [0; MAX_WORDS];
    for (to, &from) in galpixel.iter_mut().zip(words).take(map.record().words()) {
        *to = from;
    }
    if map.record().class().unsigned(&galpixel) == Class::Empty as u32 {
        return Grafted::Empty;
    }
    let (reached, _) = catch_up(map, place, &mut galpixel, delay);
    let Some(cell) = reached else { return Grafted::Lost };
    let Some(incumbent) = map.words_at(cell) else { return Grafted::Lost };
    let (record, tag) = (map.record(), map.record().tag());
    let same_update = tag.present() && tag.unsigned(&incumbent) == tag.unsigned(&galpixel);
    if same_update && resolve::key(record, &galpixel) >= resolve::key(record, &incumbent) {
        return Grafted::Behind;
    }
    map.put(cell, &galpixel);
    Grafted::Put(cell)
}

/// Moves a galpixel through the frames that it has missed. Returns the cell that it reaches, `None` if it has left the
/// map or was never in it; and how many of its fields were clamped.
#[inline]
pub(crate) fn catch_up<F: Format>(
    map: &Galpixmap<'_, F>,
    (mut x, mut y): (i32, i32),
    galpixel: &mut Words,
    Delay { stamp, now, rounding }: Delay,
) -> (Option<u32>, u32) {
    let (mut cell, mut frame, mut saturated) = (map.grid().cell(x, y), stamp, 0);
    // A galpixel that has left the map does not come back: in the map it would have been lost too.
    while frame != now && cell.is_some() {
        let thresholds = thresholds(map.record(), rounding, frame);
        let step = advance::<true>(map.record(), &thresholds, galpixel);
        saturated += step.saturated();
        (x, y) = (x + step.dx, y + step.dy);
        cell = map.grid().cell(x, y);
        frame = frame.wrapping_add(1);
    }
    (cell, saturated)
}
