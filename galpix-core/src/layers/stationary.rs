//! Stationary sources: galpixels that stay where they are stored and know their displacement, so that any number of
//! them may be candidates for one cell.
//!
//! In a map that moves, the losers of a collision are gone. Here a galpixel keeps its cell for as long as it lives. Its
//! words make the same step as in any map, and the cells that it moved are added to its displacement. It is drawn into
//! another map, at its own cell plus its displacement, if it is the smallest by (class, depth, source) there. So an
//! image whose samples do not lie where they are seen, as that of a depth discontinuity occlusion camera, moves like
//! any other.

use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::reference::{Challenger, below, challenge, merge, opaque};
use crate::frame::resolve::NO_WINNER;
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// A displacement from the cell where a galpixel is stored to the cell where it is drawn: whole cells along the row and
/// along the column, each -32768 to 32767, which spans any map.
pub type Displacement = [i32; 2];

/// Returns the word of a displacement: x in the low 16 bits, y in the high ones, both clamped to their range.
#[inline(always)]
#[must_use]
pub fn displacement_word([x, y]: Displacement) -> u32 {
    let clamped = |cells: i32| cells.min(i32::from(i16::MAX)).max(i32::from(i16::MIN)) as u32 & 0xffff;
    clamped(x) | clamped(y) << 16
}

/// Returns the displacement of a word.
#[inline(always)]
pub(crate) const fn displacement(word: u32) -> Displacement {
    [(word << 16) as i32 >> 16, word as i32 >> 16]
}

/// The sources of a stationary-source layer, in caller-provided buffers.
#[derive(Debug)]
pub struct Stationary<'p, F> {
    /// The galpixels, in the cells where they are stored.
    pub stored: Galpixmap<'p, F>,
    /// One word for each cell, see [`displacement_word`].
    pub displacements: &'p mut [u32],
}

impl<F: Format> Stationary<'_, F> {
    /// Draws the stored galpixels into `drawn`. With a rounding and a frame counter they make the step of that frame
    /// first.
    ///
    /// A galpixel that has no cell at the moment counts as lost; it stays stored, and may come back.
    pub(super) fn draw<const CONSTANT_TIME: bool>(
        &mut self,
        drawn: &mut Galpixmap<'_, F>,
        winners: &mut [u32],
        step: Option<(Rounding, u32)>,
    ) -> Tally {
        drawn.clear();
        winners.fill(NO_WINNER);
        let grid = *self.stored.grid();
        let format = self.stored.format();
        let record = format.record();
        let thresholds = step.map(|(rounding, frame)| thresholds(record, rounding, frame));
        let mut tally = Tally::default();
        for (y, &start) in (0..).zip(grid.starts()) {
            let row = start as usize..(start + grid.width()) as usize;
            if !CONSTANT_TIME && self.stored.all_empty(row) {
                continue;
            }
            for (x, source) in (0..grid.width() as i32).zip(start..) {
                let there = below(self.stored.class(source) as u32, Class::Empty as u32);
                if !CONSTANT_TIME && there == 0 {
                    continue;
                }
                let there = if CONSTANT_TIME { opaque(there) } else { there };
                let mut words = self.stored.words_at(source).unwrap_or_default();
                let Some(place) = self.displacements.get_mut(source as usize) else { return tally };
                if let Some(thresholds) = &thresholds {
                    let step = advance::<true>(record, thresholds, &mut words);
                    let [dx, dy] = displacement(*place);
                    let moved = displacement_word([dx + step.dx, dy + step.dy]);
                    *place = *place & !there | moved & there;
                    tally.saturated += step.saturated() & there;
                    merge(&mut self.stored, source, &words, there);
                }
                let [dx, dy] = displacement(*place);
                let challenger = Challenger { words, source, place: [x + dx, y + dy], there };
                challenge(drawn, winners, &challenger, &mut tally);
            }
        }
        tally
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displacement_survives_its_word_and_is_clamped_to_it() {
        for place in [[0, 0], [1, -1], [-32768, 32767], [32767, -32768], [-7, 300]] {
            assert_eq!(displacement(displacement_word(place)), place);
        }
        assert_eq!(displacement(displacement_word([32768, -32769])), [32767, -32768]);
        assert_eq!(displacement(displacement_word([i32::MIN, i32::MAX])), [-32768, 32767]);
        assert_eq!(displacement_word([1, 2]), 0x0002_0001);
    }
}
