//! Propagation and resolution, cell by cell in raster order. Every cell, even an empty one, challenges one cell.

use super::{below, beyond, cell_or_first, empty, is_empty, merge, merge_word};
use crate::format::Format;
use crate::format::record::Words;
use crate::format::rounding::Rounding;
use crate::frame::resolve::{self, NO_WINNER};
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Propagates `front` by one frame into `back` and resolves collisions, see [`crate::frame::resolve::sweep`].
///
/// Cells that nothing reached are empty and black, and their winner is [`NO_WINNER`].
pub fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    let grid = *front.grid();
    if grid != *back.grid() {
        return Tally::default();
    }
    clear(back, winners);
    let record = front.record();
    let thresholds = thresholds(record, rounding, frame);
    let mut tally = Tally::default();
    for (y, &start) in (0..).zip(grid.starts()) {
        for (x, source) in (0..grid.width() as i32).zip(start..) {
            let mut words = front.words_at(source).unwrap_or_default();
            let step = advance::<true>(record, &thresholds, &mut words);
            let there = !is_empty(record, &words);
            challenge(
                back,
                winners,
                &Challenger { words, source, place: [x + step.dx, y + step.dy], there },
                &mut tally,
            );
            tally.saturated += step.saturated() & there;
        }
    }
    tally
}

/// A galpixel that arrives at a cell.
pub(crate) struct Challenger {
    pub words: Words,
    /// The cell that it came from.
    pub source: u32,
    /// Column and row at which it arrives.
    pub place: [i32; 2],
    /// All ones if there is a galpixel, else 0.
    pub there: u32,
}

/// Stores a challenger if it arrives on the map and is nearer than what the cell holds. Reads and writes in any case.
#[inline(always)]
pub(crate) fn challenge<F: Format>(
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    challenger: &Challenger,
    tally: &mut Tally,
) {
    let Challenger { words, source, place, there } = challenger;
    let grid = *back.grid();
    let beyond = beyond(&grid, *place);
    let cell = cell_or_first(&grid, *place, beyond);
    let (key, incumbent) = (resolve::key(back.record(), words), back.key_at(cell).unwrap_or(0));
    let challenges = there & !beyond;
    // In raster order the incumbent has the smaller source, so that it wins if the keys are equal.
    let wins = challenges & below(key, incumbent);
    merge(back, cell, words, wins);
    merge_word(winners, cell, *source, wins);
    tally.moved += there & 1;
    tally.lost += there & beyond & 1;
    tally.collided += challenges & !empty(back.class_of(incumbent)) & 1;
}

/// Makes all cells empty and black, without a winner.
pub(crate) fn clear<F: Format>(back: &mut Galpixmap<'_, F>, winners: &mut [u32]) {
    let record = *back.record();
    let cells = back.grid().cells() as usize;
    let mut empty: Words = Default::default();
    record.class().set(&mut empty, Class::Empty as u32);
    for (plane, word) in back.planes_mut().iter_mut().zip(empty).take(record.words()) {
        plane.fill(word);
    }
    if let Some(winners) = winners.get_mut(..cells) {
        winners.fill(NO_WINNER);
    }
}
