//! Grafting: galpixels of an update that arrives late, and piece by piece, enter a map that has gone on moving.
//!
//! A galpixel of an update is exact at one frame, and reaches the map some frames later. Put where it was, the picture would
//! jump back. So it is first taken through the frames that it has missed, by the same steps with the same thresholds as if
//! it had been there, and then put where it is by now. An update that is some frames late thus gives the cells that one in
//! time would have given, apart from what collides and what is filled on the way.
//!
//! What comes in is newer than what is there, and replaces it whatever its depth: the object in front may have left. Only
//! what belongs to the same update is not replaced by what is farther. The tag tells: all galpixels of an update carry the
//! number of the update, or as many low bits of it as the layout has. It moves with them, so that an update may take
//! several frames to arrive. Without a tag the last one wins.

use crate::format::Format;
use crate::format::record::{MAX_WORDS, Words};
use crate::format::rounding::Rounding;
use crate::frame::resolve;
use crate::frame::step::{advance, thresholds};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// What became of a galpixel that was grafted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Grafted {
    /// It is in the map, in this cell.
    Put(u32),
    /// A nearer one of the same update has its cell; of two that are equally near the first.
    Behind,
    /// By now it has left the map, or it never was in it.
    Lost,
    /// It is empty: nothing was known there.
    Empty,
}

/// Grafts the galpixel with these words, which was at `place`, a column and a row of the map (margin included), when the frame counter
/// was `stamp`, into a map whose frame counter is `now`. Words beyond the layout's are ignored, missing ones are 0.
///
/// *Cost:* a step for each frame between; the caller bounds how many these may be.
pub fn graft<F: Format>(
    map: &mut Galpixmap<'_, F>,
    place: (i32, i32),
    words: &[u32],
    rounding: Rounding,
    stamp: u32,
    now: u32,
) -> Grafted {
    let mut galpixel = [0; MAX_WORDS];
    for (to, &from) in galpixel.iter_mut().zip(words).take(map.record().words()) {
        *to = from;
    }
    if map.record().class().unsigned(&galpixel) == Class::Empty as u32 {
        return Grafted::Empty;
    }
    let (reached, _) = caught_up(map, place, &mut galpixel, rounding, stamp, now);
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

/// Takes a galpixel through the frames from `stamp` to `now`: the cell that it has then, or nothing if it has left the map or
/// never was in it; and its fields that were clamped.
#[inline]
pub(crate) fn caught_up<F: Format>(
    map: &Galpixmap<'_, F>,
    (mut x, mut y): (i32, i32),
    galpixel: &mut Words,
    rounding: Rounding,
    stamp: u32,
    now: u32,
) -> (Option<u32>, u32) {
    let (mut cell, mut frame, mut saturated) = (map.grid().cell(x, y), stamp, 0);
    // Who has left the map does not come back: in the map it would have been lost too.
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
