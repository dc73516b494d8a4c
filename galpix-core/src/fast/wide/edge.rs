//! The edge map by runs of neighbours. Its work does not depend on the picture, so that it serves the constant-time step too.

use crate::format::Format;
use crate::frame::edge::{laplacian, set};
use crate::map::Galpixmap;

/// Neighbours that are looked at once.
const RUN: u32 = 32;

/// Marks the edges of a map; returns how many cells are on an edge.
///
/// `threshold` is in units of the depth's last bit. `edges` must have [`words`] words; further cells are not marked.
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
            // The first and the last column lack a neighbour; between them, runs of cells.
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

/// The flags of up to [`RUN`] cells, the first in the lowest bit, and how many are set. `places`: the first cell, and its neighbours to the
/// left, right, above and below.
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
        // Class 0 is a galpixel, and the class stands above the depth.
        let others = front.class_of(z0[lane] | left[lane] | right[lane] | up[lane] | down[lane]);
        let [z0, left, right, up, down] = [z0, left, right, up, down].map(|keys| keys[lane] as i32);
        let source = laplacian(z0, left, right, up, down);
        let flag = u32::from(others != 0 || source > threshold || source < -threshold) & mask;
        flags |= flag << lane;
        count += flag;
    }
    (flags, count)
}
