//! Closes cracks: of many cells at a time it is found out which have nearer ones on opposite sides.

use super::{RUN, run_at, run_before};
use crate::format::Format;
use crate::frame::reference::{below, opaque};
use crate::source::Source;
use crate::source::cracks::{Closed, best, each_row};
use crate::source::visibility::{EMPTY, Kind, Visibility};

/// Closes cracks, see [`crate::source::cracks`].
pub(crate) fn close<F: Format>(sources: &[Source<'_, F>], visibility: &mut Visibility<'_>, threshold: i32) -> Closed {
    let (width, mut closed) = (visibility.grid().width() as usize, Closed::default());
    each_row(visibility, None, |visibility, y, start| {
        let mut count = 0;
        for x in (0..width).step_by(RUN) {
            let mut flags = [0; RUN];
            if flag(&Rows::around(visibility, y), x, near(threshold), &mut flags, &mut closed) == 0 {
                continue;
            }
            for (x, _) in (x..width).zip(&flags).filter(|(_, flag)| **flag != 0) {
                let (closes, entry) = best::<F, false>(sources, visibility, [x as i32, y as i32], threshold);
                if closes != 0 {
                    let hole = !visibility.at(start + x as u32).is_some();
                    closed.holes += u32::from(hole);
                    closed.empty -= u32::from(hole);
                    visibility.postpone(y, count, x as u32, entry);
                    count += 1;
                }
            }
        }
        count
    });
    closed
}

/// Closes cracks in constant time: looks at `most` cells of each row, from the left. Returns also how many are left
/// out.
pub(crate) fn close_constant_time<F: Format>(
    sources: &[Source<'_, F>],
    visibility: &mut Visibility<'_>,
    threshold: i32,
    most: usize,
) -> (Closed, u32) {
    let width = visibility.grid().width() as usize;
    let (most, mut closed, mut left_out) = (most.min(width), Closed::default(), 0);
    each_row(visibility, Some(most), |visibility, y, start| {
        let mut listed = 0;
        for x in (0..width).step_by(RUN) {
            let mut flags = [0; RUN];
            flag(&Rows::around(visibility, y), x, near(threshold), &mut flags, &mut closed);
            for (x, flag) in (x..width).zip(flags) {
                visibility.list(y, listed, x);
                listed += usize::from(flag);
            }
        }
        let mut count = 0;
        for slot in 0..most {
            let mask = opaque(below(slot as u32, listed as u32));
            let x = visibility.listed(y, slot) & mask;
            let (closes, entry) = best::<F, true>(sources, visibility, [x as i32, y as i32], threshold);
            let hole = closes & mask & visibility.is_empty(start + x) & 1;
            closed.holes += hole;
            closed.empty -= hole;
            visibility.postpone(y, count, x, entry);
            count += (closes & mask & 1) as usize;
        }
        left_out += listed.saturating_sub(most) as u32;
        count
    });
    (closed, left_out)
}

/// Keys of depths that differ by more than the threshold differ by more than twice as much.
fn near(threshold: i32) -> u16 {
    (threshold << 1).min(EMPTY.into()) as u16
}

/// The keys of a row and those around it; a row beyond the map is empty.
struct Rows<'v> {
    above: &'v [u16],
    row: &'v [u16],
    below: &'v [u16],
}

impl<'v> Rows<'v> {
    #[inline(always)]
    fn around(visibility: &'v Visibility<'_>, y: usize) -> Self {
        let grid = visibility.grid();
        let row = |y: i32| match grid.row(y) {
            Some(start) => visibility.cells_from(start, grid.width() as usize).0,
            None => &[],
        };
        let y = y as i32;
        Self { above: row(y - 1), row: row(y), below: row(y + 1) }
    }
}

/// Flags the cells of a run from column `x` on that may be cracks; returns a number that is not 0 if there are any.
/// Counts points and empty cells.
#[inline(always)]
fn flag(rows: &Rows<'_>, x: usize, near: u16, flags: &mut [u16; RUN], closed: &mut Closed) -> u16 {
    // Beyond the ends of a row nothing is shown.
    let of = |row: &[u16]| [run_before(row, x, EMPTY), run_at(row, x, EMPTY), run_at(row, x + 1, EMPTY)];
    let ([above_left, above, above_right], [below_left, below, below_right]) = (of(rows.above), of(rows.below));
    let [left, own, right] = of(rows.row);
    let (mut points, mut empties, mut any) = (0u16, 0u16, 0);
    for lane in 0..RUN {
        let key = own[lane];
        let empty = if key == EMPTY { EMPTY } else { 0 };
        points += key & !empty & Kind::Point as u16;
        empties += empty & 1;
        let sides = left[lane].max(right[lane]).min(above[lane].max(below[lane]));
        let corners = above_left[lane].max(below_right[lane]).min(above_right[lane].max(below_left[lane]));
        let limit = key.saturating_sub(near) | empty;
        let flag = u16::from(sides.min(corners) < limit);
        flags[lane] = flag;
        any |= flag;
    }
    // Beyond the end of a row the keys are those of empty cells.
    let beyond = (x + RUN).saturating_sub(rows.row.len());
    closed.points += u32::from(points);
    closed.empty += u32::from(empties) - beyond as u32;
    any
}
