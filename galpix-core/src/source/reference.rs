//! The passes over stationary sources one sample or cell at a time, as section 21 of the specification has them: for
//! tests, and for the feature `check`.

use super::constant_time::{quads, samples};
use super::cracks::{Closed, best, each_row};
use super::links::{FIRST, LINKED, SECOND, Value, WORD, values};
use super::row::{Finish, finish_cell};
use super::visibility::Visibility;
use super::{Source, Sources};
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::tally::Tally;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

/// Links the samples of a map.
pub(crate) fn link<F: Format>(map: &Galpixmap<'_, F>, edge_threshold: u32, links: &mut [u32]) {
    links.fill(0);
    let values = values(map.record(), edge_threshold);
    let (grid, width) = (*map.grid(), map.grid().width());
    for (y, &start) in (0..).zip(grid.starts()) {
        for x in 0..width {
            let cell = start + x;
            let column = |x: u32| (x < width).then(|| start + x);
            let along = [x.checked_sub(1).and_then(column), Some(cell), column(x + 1), column(x + 2)];
            let row = |y: i32| grid.row(y).map(|row| row + x);
            let down = [row(y - 1), Some(cell), row(y + 1), row(y + 2)];
            let bits = pair(map, &values, along) | pair(map, &values, down) << 2;
            if let Some(word) = links.get_mut((cell / WORD) as usize) {
                *word |= bits << ((cell % WORD) << 2);
            }
        }
    }
}

/// Returns the two bits of a pair of neighbours, which are the second and the third of four cells in a row or column.
fn pair<F: Format>(map: &Galpixmap<'_, F>, values: &[Value; 3], cells: [Option<u32>; 4]) -> u32 {
    let galpixels = cells.map(|cell| cell.filter(|&cell| map.class(cell) == Class::Galpixel));
    let [before, Some(first), Some(second), after] = galpixels else { return 0 };
    let read = |value: &Value, cell: u32| {
        if value.signed { map.signed(value.field, cell) } else { map.unsigned(value.field, cell) as i32 }
    };
    let steps = values.iter().any(|value| {
        let (a, b) = (read(value, first), read(value, second));
        let slope = b - a;
        let bend = |beside: Option<i32>| beside.map_or(u32::MAX, |beside| slope.abs_diff(beside));
        let before = bend(before.map(|cell| a - read(value, cell)));
        let after = bend(after.map(|cell| read(value, cell) - b));
        slope.unsigned_abs().min(before).min(after) > value.threshold
    });
    let [a, b] = [first, second].map(|cell| map.unsigned(map.record().depth(), cell));
    match (steps, a.cmp(&b)) {
        (false, _) => LINKED,
        (true, core::cmp::Ordering::Less) => FIRST,
        (true, core::cmp::Ordering::Greater) => SECOND,
        (true, core::cmp::Ordering::Equal) => 0,
    }
}

/// Steps the samples of a layer, if a rounding and a frame counter are given, and shows them, then all stretched quads.
pub(crate) fn scatter<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let tally = samples(source, visibility, first, edge_threshold, step);
    quads(source, visibility, first, usize::MAX);
    tally
}

/// Closes cracks. `threshold` is the edge threshold for depths of an entry.
pub(crate) fn close<F: Format>(sources: &[Source<'_, F>], visibility: &mut Visibility<'_>, threshold: i32) -> Closed {
    let grid = visibility.grid();
    let width = grid.width();
    let mut closed = Closed::default();
    each_row(visibility, None, |visibility, y, start| {
        let mut count = 0;
        for x in 0..width {
            let own = visibility.at(start + x);
            let (closes, entry) = best::<F, true>(sources, visibility, [x as i32, y as i32], threshold);
            closed.points += u32::from(own.is_point());
            closed.holes += u32::from(!own.is_some() && closes != 0);
            closed.empty += u32::from(!own.is_some() && closes == 0);
            if closes != 0 {
                visibility.postpone(y, count, x, entry);
                count += 1;
            }
        }
        count
    });
    closed
}

/// Finishes a row, see [`Sources::finish`].
pub(crate) fn finish_row<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, colours: &mut [u32]) {
    for (to, x) in colours.iter_mut().zip(0..finish.grid.width()) {
        *to = finish_cell(sources, finish, x);
    }
}
