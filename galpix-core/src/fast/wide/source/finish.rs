//! Finishes a row: of many cells at a time it is found out which are on a silhouette.

use super::{RUN, run_at, run_before};
use crate::format::Format;
use crate::source::Sources;
use crate::source::row::{Finish, finish_cell};

/// Finishes a row, see [`Sources::finish`].
pub(crate) fn finish<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, colours: &mut [u32]) {
    let width = finish.grid.width() as usize;
    let row = |y: i32| {
        finish.grid.row(y).map(|start| sources.visibility.cells_from(start, width).0).filter(|row| !row.is_empty())
    };
    let Some(own) = row(finish.y as i32) else { return };
    let (Some(&first), Some(&last)) = (own.first(), own.last()) else { return };
    // Beyond the map the row itself takes the place of a row, from which it does not differ.
    let (above, below) = (row(finish.y as i32 - 1).unwrap_or(own), row(finish.y as i32 + 1).unwrap_or(own));
    // Keys of depths that differ by more than the threshold differ by more than twice as much.
    let near = (finish.threshold << 1) as u16;
    let Some(gathered) = finish.gathered[1].get(..width) else { return };
    for (to, &colour) in colours.iter_mut().zip(gathered) {
        *to = colour;
    }
    for x in (0..width).step_by(RUN) {
        let end = (x + RUN).min(width);
        let Some(colours) = colours.get_mut(x..end) else { return };
        // Beyond the ends of the row a cell is its own neighbour, from which it does not differ.
        let own_run = run_at(own, x, last);
        let (left, right) = (run_before(own, x, first), run_at(own, x + 1, last));
        let (above, below) = (run_at(above, x, last), run_at(below, x, last));
        let mut flags = [0u16; RUN];
        let mut any = 0;
        for lane in 0..RUN {
            let key = own_run[lane];
            let apart = |other: u16| (key.saturating_sub(other) | other.saturating_sub(key)).saturating_sub(near);
            let flag = apart(left[lane]) | apart(right[lane]) | apart(above[lane]) | apart(below[lane]);
            flags[lane] = flag;
            any |= flag;
        }
        if any != 0 {
            for ((lane, to), &flag) in (x..).zip(colours).zip(&flags) {
                if flag != 0 {
                    *to = finish_cell(sources, finish, lane as u32);
                }
            }
        }
    }
}
