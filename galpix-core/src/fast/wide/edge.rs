//! The edge map for processors with vector registers, by runs of cells. Its instructions do not depend on the picture,
//! so that the constant-time step uses it, too.

use core::ops::Range;

use crate::format::Format;
use crate::frame::edge::{laplacian, set};
use crate::map::Galpixmap;

/// Cells of a run.
const RUN: u32 = 32;

/// Marks the cells of a map that are on an edge, see [`crate::frame::edge::mark`].
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let grid = *front.grid();
    let threshold = threshold.min(i32::MAX as u32) as i32;
    let mut count = 0;
    let mut up = 0;
    let mut rows = grid.starts().iter().copied().peekable();
    while let Some(row) = rows.next() {
        let down = rows.peek().copied().unwrap_or(row);
        let mut x = 0;
        while x < grid.width() {
            let cells = (grid.width() - x).min(RUN);
            let (flags, marked) = flags(front, threshold, (x, cells), [row, up, down]);
            set(edges, row + x, flags);
            count += marked;
            x += cells;
        }
        up = row;
    }
    count
}

/// Returns the flags of `cells` cells of a row from column `x` on, at most [`RUN`], the first one in the lowest bit,
/// and how many are set. The rows are given by their first cells: the row itself, the one above and the one below.
#[inline(always)]
fn flags<F: Format>(
    front: &Galpixmap<'_, F>,
    threshold: i32,
    (x, cells): (u32, u32),
    [row, up, down]: [u32; 3],
) -> (u32, u32) {
    let read = |surfaces: &mut [u32], cells: Range<u32>| {
        for (to, surface) in surfaces.iter_mut().zip(front.surfaces(cells.start as usize..cells.end as usize)) {
            *to = surface;
        }
    };
    // The cells of the row with those before and after them.
    let mut here = [0; RUN as usize + 2];
    let (before, after) = (x.min(1), (front.grid().width() - (x + cells)).min(1));
    read(here.get_mut(1 - before as usize..).unwrap_or_default(), row + x - before..row + x + cells + after);
    // In the first and the last column the cell is its own neighbour.
    if before == 0 {
        here[0] = here[1];
    }
    if let (0, Some([last, beyond])) = (after, here.get_mut(cells as usize..cells as usize + 2)) {
        *beyond = *last;
    }
    let [mut above, mut below] = [[0; RUN as usize]; 2];
    read(&mut above, up + x..up + x + cells);
    read(&mut below, down + x..down + x + cells);
    let empty = 1 << front.record().depth().bits;
    let (mut flags, mut count) = (0, 0);
    for lane in 0..RUN {
        let mask = (lane < cells) as u32;
        let lane = lane as usize;
        let [left, z0, right] = [here[lane], here[lane + 1], here[lane + 2]];
        let (up, down) = (above[lane], below[lane]);
        let empty = (z0 | left | right | up | down) & empty;
        let source = laplacian(z0 as i32, left as i32, right as i32, up as i32, down as i32);
        let flag = u32::from(empty != 0 || source > threshold || source < -threshold) & mask;
        flags |= flag << lane;
        count += flag;
    }
    (flags, count)
}
