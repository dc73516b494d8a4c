//! Finishes a row: of many cells at a time it is found out which are on a silhouette.

use crate::format::Format;
use crate::source::Sources;
use crate::source::row::{Finish, finish_cell};

/// Cells that are looked at at a time.
const RUN: usize = 32;

/// Finishes a row, see [`crate::source::row::finish_row`].
pub(crate) fn finish<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, colours: &mut [u32]) {
    let width = finish.grid.width() as usize;
    let row = |y: i32| {
        finish.grid.row(y).map(|start| sources.visibility.cells_from(start, width).0).filter(|row| !row.is_empty())
    };
    let Some(own) = row(finish.y as i32) else { return };
    // Beyond the map the row itself takes the place of a row, from which it does not differ.
    let (above, below) = (row(finish.y as i32 - 1).unwrap_or(own), row(finish.y as i32 + 1).unwrap_or(own));
    // Keys of depths that differ by more than the threshold differ by more than twice as much.
    let near = (finish.threshold << 1) as u16;
    let Some(gathered) = finish.gathered[1].get(..width) else { return };
    for ((x, colours), gathered) in (0..).step_by(RUN).zip(colours.chunks_mut(RUN)).zip(gathered.chunks(RUN)) {
        colours.copy_from_slice(gathered);
        let own_run = run_at(own, x);
        let left = if x == 0 { shifted(&own_run) } else { run_at(own, x - 1) };
        let right = run_at(own, x + 1);
        let (above, below) = (run_at(above, x), run_at(below, x));
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

/// Returns the keys of a run. Beyond the end of the row its last key is repeated, from which that cell does not differ.
#[inline(always)]
fn run_at(row: &[u16], x: usize) -> [u16; RUN] {
    let from = row.get(x..).unwrap_or_default();
    if let Some(run) = from.first_chunk() {
        return *run;
    }
    let mut run = [row.last().copied().unwrap_or_default(); RUN];
    for (to, &key) in run.iter_mut().zip(from) {
        *to = key;
    }
    run
}

/// Returns the keys of the cells before those of the first run of a row. The first cell is before itself.
#[inline(always)]
fn shifted(run: &[u16; RUN]) -> [u16; RUN] {
    let mut before = *run;
    for (to, &key) in before.iter_mut().skip(1).zip(run) {
        *to = key;
    }
    before
}
