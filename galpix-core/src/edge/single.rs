//! The edge map for processors without vector registers: cell by cell, each key of a row read once.

use super::{laplacian, set};
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;

/// Cells of a word of the edge map.
const WORD: u32 = 32;

/// No Laplacian is larger.
const LARGEST: u32 = 1 << 30;

/// [`super::mark`] for processors without vector registers: the same arguments, the same bits.
pub fn mark<L: Layout, B: Budget<L>>(front: &Galpixmap<'_, L, B>, threshold: u32, edges: &mut [u32]) -> u32 {
    edges.fill(0);
    let mut count = 0;
    let mut up = 0;
    let mut rows = front.grid().starts().iter().copied().peekable();
    while let Some(row) = rows.next() {
        let down = rows.peek().copied().unwrap_or(row);
        count += mark_row(front, threshold.min(LARGEST), [up, row, down], edges);
        up = row;
    }
    count
}

/// Marks the edges of the row that starts at the second of `rows`, which lies between those that start at the others.
#[inline(never)]
fn mark_row<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    threshold: u32,
    [up, row, down]: [u32; 3],
    edges: &mut [u32],
) -> u32 {
    let width = front.grid().width();
    let Some(mut z0) = front.key_at(row) else { return 0 };
    let (mut left, mut count, mut x) = (z0, 0, 0);
    // Class 0 is a galpixel, and the class stands above the depth.
    let flag = |z0: u32, left: u32, right: u32, up: u32, down: u32| {
        let others = front.class_of(z0 | left | right | up | down) != 0;
        let source = laplacian(z0 as i32, left as i32, right as i32, up as i32, down as i32);
        (others | ((source as u32).wrapping_add(threshold) > threshold << 1)) as u32
    };
    while x < width {
        let cells = (WORD - ((row + x) & (WORD - 1))).min(width - x);
        // The last column has no neighbour to the right: it is its own.
        let paired = cells.min(width - 1 - x);
        let keys = |start: u32| front.keys((start + x) as usize..(start + x + paired) as usize);
        let mut flags = 0;
        for ((right, up), down) in keys(row + 1).zip(keys(up)).zip(keys(down)) {
            let flag = flag(z0, left, right, up, down);
            count += flag;
            flags = flags >> 1 | flag << (WORD - 1);
            (left, z0) = (z0, right);
        }
        if paired < cells
            && let (Some(up), Some(down)) = (front.key_at(up + width - 1), front.key_at(down + width - 1))
        {
            let flag = flag(z0, left, z0, up, down);
            count += flag;
            flags = flags >> 1 | flag << (WORD - 1);
        }
        set(edges, row + x, flags >> (WORD - cells));
        x += cells;
    }
    count
}
