//! Propagation and resolution, cell by cell in raster order: every galpixel, also one that is not there, challenges one cell.

use super::{below, beyond, cell_or_first, empty, merge, merge_word};
use crate::format::Format;
use crate::format::record::Words;
use crate::format::rounding::Rounding;
use crate::frame::resolve::{self, NO_WINNER};
use crate::frame::step::{advance, thresholds};
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// [`crate::fast::wide::sweep`] with constant work: the same arguments, the same bits.
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
            let key = resolve::key(record, &words);
            let there = !empty(front.class_of(key));
            let place = [x + step.dx, y + step.dy];
            let beyond = beyond(&grid, place);
            // In raster order the incumbent has the smaller source: of equal keys it stays.
            let cell = cell_or_first(&grid, place, beyond);
            let incumbent = back.key_at(cell).unwrap_or(0);
            let challenges = there & !beyond;
            let wins = challenges & below(key, incumbent);
            merge(back, cell, &words, wins);
            merge_word(winners, cell, source, wins);
            tally.moved += there & 1;
            tally.lost += there & beyond & 1;
            tally.collided += challenges & !empty(back.class_of(incumbent)) & 1;
            tally.saturated += step.saturated() & there;
        }
    }
    tally
}

/// Makes all cells empty and nobody their winner.
fn clear<F: Format>(back: &mut Galpixmap<'_, F>, winners: &mut [u32]) {
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
