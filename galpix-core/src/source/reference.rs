//! The passes over stationary sources one sample or cell at a time, as section 21 of the specification has them: for
//! tests, and for the feature `check`.

use super::cracks::{Closed, best, each_row};
use super::layer::moved;
use super::links::{FIRST, LINKED, SECOND, Value, WORD, values};
use super::quads::draw_one;
use super::row::{Finish, finish_cell};
use super::visibility::{Entry, Kind, PARTS, Visibility, depth, threshold};
use super::{Source, Sources};
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::frame::step::{advance, parts, thresholds};
use crate::frame::tally::Tally;
use crate::layers::displacement;
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

/// Steps the samples of a layer, if a rounding and a frame counter are given, and shows them, then the stretched quads.
/// `first` is the number of the layer's first sample.
///
/// Points lie behind quads of the same surface by half of the edge threshold, which is in units of the depth's last
/// bit.
pub(crate) fn scatter<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    let format = source.map.format();
    let record = format.record();
    let (grid, display) = (*source.map.grid(), visibility.grid());
    let thresholds = step.map(|(rounding, frame)| thresholds(record, rounding, frame));
    let depth_bits = u32::from(record.depth().bits);
    let behind = threshold(edge_threshold, depth_bits) as u32 >> 1;
    let fracs = [record.offset_x().bits.into(), record.offset_y().bits.into()];
    let mut tally = Tally::default();
    for (y, &start) in (0..).zip(grid.starts()) {
        for (x, cell) in (0..grid.width() as i32).zip(start..) {
            let Some(mut words) = source.map.words_at(cell) else { continue };
            if record.class().unsigned(&words) != Class::Galpixel as u32 {
                continue;
            }
            let Some(place) = source.displacements.get_mut(cell as usize) else { continue };
            if let Some(thresholds) = &thresholds {
                let step = advance::<true>(record, thresholds, &mut words);
                let [dx, dy] = displacement(*place);
                let clamped;
                (*place, clamped) = moved([dx + step.dx, dy + step.dy]);
                tally.saturated += step.saturated() + clamped;
                source.map.put(cell, &words);
            }
            tally.moved += 1;
            let [dx, dy] = displacement(*place);
            let Some(target) = display.cell(x + dx, y + dy) else {
                tally.lost += 1;
                continue;
            };
            let offset = [record.offset_x().signed(&words), record.offset_y().signed(&words)];
            let depth = depth(record.depth().unsigned(&words), depth_bits) + behind;
            let entry = Entry::new(depth, Kind::Point, first + cell, residual(offset, fracs));
            visibility.challenge(target, entry);
        }
    }
    for (y, &start) in (0..).zip(grid.starts()) {
        for (x, cell) in (0..grid.width() as i32).zip(start..) {
            if source.links().quad(cell) {
                draw_one(source, visibility, first, [x, y], cell);
            }
        }
    }
    tally
}

/// Closes cracks. `threshold` is the edge threshold for depths of an entry.
pub(crate) fn close<F: Format>(sources: &[Source<'_, F>], visibility: &mut Visibility<'_>, threshold: i32) -> Closed {
    let grid = visibility.grid();
    let width = grid.width();
    let mut closed = Closed::default();
    each_row(&grid, visibility, |visibility, y, start| {
        let mut count = 0;
        for x in 0..width {
            let own = visibility.at(start + x);
            let best = best(sources, visibility, [x as i32, y as i32], threshold);
            closed.points += u32::from(own.is_point());
            closed.holes += u32::from(!own.is_some() && best.is_some());
            closed.empty += u32::from(!own.is_some() && best.is_none());
            if let Some(entry) = best {
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

/// Returns the residual of the cell that is nearest to a sample with these offsets, in sixteenths of a cell.
pub(crate) const fn residual(offset: [i32; 2], frac: [u32; 2]) -> [i32; 2] {
    [-parts::<PARTS>(offset[0], frac[0]), -parts::<PARTS>(offset[1], frac[1])]
}
