//! The edge map for processors with vector registers, by runs of cells. Its instructions do not depend on the picture,
//! so that the constant-time step uses it, too.

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
            // In the first and the last column the cell is its own neighbour; between them are runs of cells.
            let last = grid.width() - 1;
            let cells = if x == 0 || x == last { 1 } else { (last - x).min(RUN) };
            let (left, right) = (x.saturating_sub(1), (x + 1).min(last));
            let (flags, marked) = flags(front, threshold, cells, [row + x, row + left, row + right, up + x, down + x]);
            set(edges, row + x, flags);
            count += marked;
            x += cells;
        }
        up = row;
    }
    count
}

/// Returns the flags of up to [`RUN`] cells, the first one in the lowest bit, and how many are set.
///
/// `places` are the first cell and its neighbours to the left, to the right, above and below.
#[inline(always)]
fn flags<F: Format>(front: &Galpixmap<'_, F>, threshold: i32, cells: u32, places: [u32; 5]) -> (u32, u32) {
    let mut keys = [[0; RUN as usize]; 5];
    for (keys, place) in keys.iter_mut().zip(places) {
        for (to, key) in keys.iter_mut().zip(front.keys(place as usize..(place + cells) as usize)) {
            *to = key;
        }
    }
    let [z0, left, right, up, down] = &keys;
    let (mut flags, mut count) = (0, 0);
    for lane in 0..RUN {
        let mask = (lane < cells) as u32;
        let lane = lane as usize;
        // The class of a galpixel is 0, and the class is above the depth.
        let others = front.class_of(z0[lane] | left[lane] | right[lane] | up[lane] | down[lane]);
        let [z0, left, right, up, down] = [z0, left, right, up, down].map(|keys| keys[lane] as i32);
        let source = laplacian(z0, left, right, up, down);
        let flag = u32::from(others != 0 || source > threshold || source < -threshold) & mask;
        flags |= flag << lane;
        count += flag;
    }
    (flags, count)
}
