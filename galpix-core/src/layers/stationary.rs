//! Galpixels that stay where they are stored and know their displacement, so that any number of them may want one cell.
//!
//! In a map that moves, the losers of a collision are gone. Here a galpixel keeps its cell for as long as it lives; its words make
//! the same step as anywhere, the cells that it moved are added to its displacement, and it is drawn into another map at the
//! cell of its own plus its displacement, if it is the smallest by (class, depth, source) there. So an image whose samples do not
//! lie where they are seen, as that of a depth discontinuity occlusion camera, moves like any other.

use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::reference::{Challenger, below, challenge, merge, opaque};
use crate::frame::resolve::NO_WINNER;
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Whole cells along the row and along the column from where a galpixel is stored to where it is drawn, each -32768 to 32767: across any map.
pub type Displacement = [i32; 2];

/// The word of a displacement: x in the low 16 bits, y in the high ones, both clamped to their range.
#[inline(always)]
#[must_use]
pub fn displacement_word([x, y]: Displacement) -> u32 {
    let clamped = |cells: i32| cells.min(i32::from(i16::MAX)).max(i32::from(i16::MIN)) as u32 & 0xffff;
    clamped(x) | clamped(y) << 16
}

/// The displacement of a word.
#[inline(always)]
pub(super) const fn displacement(word: u32) -> Displacement {
    [(word << 16) as i32 >> 16, word as i32 >> 16]
}

/// Galpixels in the cells where they are stored, with a word of displacement for each.
#[derive(Debug)]
pub(super) struct Stationary<'p, F> {
    pub stored: Galpixmap<'p, F>,
    pub displacements: &'p mut [u32],
}

impl<F: Format> Stationary<'_, F> {
    /// Draws what is stored into `drawn`, by a step later where a rounding and a frame counter are given.
    ///
    /// Lost is what has no cell at the moment; it stays stored, and may come back.
    pub fn draw<const CONSTANT_TIME: bool>(
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
                let class = self.stored.class(source) as u32;
                let there = opaque(below(class, Class::Empty as u32));
                if !CONSTANT_TIME && there == 0 {
                    continue;
                }
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
