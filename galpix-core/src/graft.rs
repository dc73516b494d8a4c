//! Grafting: galpixels of an update that arrives late, and piece by piece, enter a map that has gone on moving.
//!
//! A galpixel of an update is exact at one frame, and reaches the map some frames later. Put where it was, the picture would
//! jump back. So it is first taken through the frames that it has missed, by the same steps with the same thresholds as if
//! it had been there, and then put where it is by now. A whole update that is a few frames late thus gives the cells that one
//! in time would have given, apart from what collides and what is filled on the way.
//!
//! What the update puts into a cell replaces what the map has there, whatever its depth: it is newer. Of several of its
//! galpixels that want one cell, the order of [`crate::resolve`] decides, without the source: of equal keys the first stays.
//! To tell the one from the other, an update marks the cells that it has reached, one bit a cell.

use crate::galpixel::{Budget, Class};
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;
use crate::propagate::{advance, thresholds};
use crate::record::MAX_WORDS;
use crate::resolve;
use crate::rounding::Rounding;

/// What became of a galpixel that was grafted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Grafted {
    /// It is in the map, in this cell.
    Put(u32),
    /// A nearer one of the same update has its cell.
    Behind,
    /// By now it has left the map, or it never was in it.
    Lost,
    /// It is empty: nothing was known there.
    Empty,
}

/// An update on its way into a map.
#[derive(Debug)]
pub struct Graft<'g> {
    reached: &'g mut [u32],
    rounding: Rounding,
}

impl<'g> Graft<'g> {
    /// An update of which nothing has arrived. `reached` is for its marks: [`crate::edge::words`] words; cells beyond are
    /// not marked, and there the last one wins.
    #[must_use]
    pub fn new(reached: &'g mut [u32], rounding: Rounding) -> Self {
        reached.fill(0);
        Self::again(reached, rounding)
    }

    /// An update of which a part has arrived already and is marked in `reached`.
    #[must_use]
    pub const fn again(reached: &'g mut [u32], rounding: Rounding) -> Self {
        Self { reached, rounding }
    }

    /// Grafts the galpixel with these words, which was at column `x`, row `y` of the map (wings included) when the frame
    /// counter was `stamp`, into a map whose frame counter is `now`. Words beyond the layout's are ignored, missing ones 0.
    ///
    /// *Cost:* a step for each frame between; the caller bounds how many that may be.
    pub fn put<L: Layout, B: Budget<L>>(
        &mut self,
        map: &mut Galpixmap<'_, L, B>,
        x: i32,
        y: i32,
        words: &[u32],
        stamp: u32,
        now: u32,
    ) -> Grafted {
        let mut galpixel = [0; MAX_WORDS];
        for (to, &from) in galpixel.iter_mut().zip(words).take(map.record().words()) {
            *to = from;
        }
        let class = map.record().class().unsigned(&galpixel);
        if class == Class::Empty as u32 {
            return Grafted::Empty;
        }
        let (mut x, mut y) = (x, y);
        let mut frame = stamp;
        while frame != now {
            let thresholds = thresholds(map.record(), self.rounding, frame);
            let step = advance::<L, true>(map.record(), &thresholds, &mut galpixel);
            (x, y) = (x + step.dx, y + step.dy);
            // Who has left the map does not come back: in the map it would have been lost too.
            if map.grid().cell(x, y).is_none() {
                return Grafted::Lost;
            }
            frame = frame.wrapping_add(1);
        }
        let Some(cell) = map.grid().cell(x, y) else { return Grafted::Lost };
        if self.mark(cell)
            && let Some(incumbent) = map.key_at(cell)
            && resolve::key(map.record(), &galpixel) >= incumbent
        {
            return Grafted::Behind;
        }
        map.put(cell, &galpixel);
        Grafted::Put(cell)
    }

    /// Marks a cell; whether it was marked.
    fn mark(&mut self, cell: u32) -> bool {
        let bit = 1 << (cell & 31);
        match self.reached.get_mut((cell >> 5) as usize) {
            Some(word) => {
                let was = *word & bit != 0;
                *word |= bit;
                was
            }
            None => false,
        }
    }
}
