//! Stage 3: the edge map, one bit a cell: on the edge of a surface, or inside one.
//!
//! ```text
//!        up
//!  left  z0  right        laplacian = left + right + up + down - 4 z0        (17)
//!       down
//! ```
//!
//! A plane's Laplacian vanishes, a step's does not. A cell is **inside a surface** if it and its neighbours are galpixels
//! and the Laplacian is within the threshold; anything else is **on the edge**. So a cell beside a hole or beside debris is
//! on the edge: what lies there is not known to continue the surface. A neighbour outside of the map counts as if it had
//! the depth of the cell itself, and so does not decide anything.
//!
//! **Cost** a cell: 4 additions, 1 shift, 2 comparisons; five cells read.

use crate::format::Format;
use crate::map::Galpixmap;
use crate::map::grid::Grid;

/// Equation (17). Exact for depths of up to 28 bits; with a class above them the sum may wrap, and then it does not count.
#[inline(always)]
#[must_use]
pub const fn laplacian(z0: i32, left: i32, right: i32, up: i32, down: i32) -> i32 {
    left.wrapping_add(right).wrapping_add(up).wrapping_add(down).wrapping_sub(z0 << 2)
}

/// A threshold for depths of `depth_bits` bits that are linear in inverse distance or in disparity: a 64th of the range.
/// Planes of any slant stay far below it; two surfaces that differ by more are told apart.
#[must_use]
pub const fn threshold_for_depth(depth_bits: u32) -> u32 {
    if depth_bits > 6 { 1 << (depth_bits - 6) } else { 1 }
}

/// A threshold for "the faster is nearer", where motion boundaries are all that is known: a 128th of the range.
#[must_use]
pub const fn threshold_for_speed(depth_bits: u32) -> u32 {
    if depth_bits > 7 { 1 << (depth_bits - 7) } else { 1 }
}

/// Words of the edge map of a grid: one bit a cell, cell `c` in bit `c % 32` of word `c / 32`.
#[must_use]
pub const fn words(grid: &Grid<'_>) -> usize {
    grid.cells().div_ceil(32) as usize
}

/// Whether a cell is on the edge of a surface. What is not in the map is.
#[inline(always)]
#[must_use]
pub fn on_edge(edges: &[u32], cell: u32) -> bool {
    match edges.get((cell >> 5) as usize) {
        Some(word) => word >> (cell & 31) & 1 != 0,
        None => true,
    }
}

/// Marks the edges of a map; returns how many cells are on an edge.
///
/// `threshold` is in units of the depth's last bit. `edges` must have [`words`] words; further cells are not marked.
pub fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    F::mark(front, threshold, edges)
}

/// Sets the bits of `flags` from `cell` on.
#[inline(always)]
pub(crate) fn set(edges: &mut [u32], cell: u32, flags: u32) {
    let (word, flags) = ((cell >> 5) as usize, u64::from(flags) << (cell & 31));
    if let Some(word) = edges.get_mut(word) {
        *word |= flags as u32;
    }
    if let Some(word) = edges.get_mut(word + 1) {
        *word |= (flags >> 32) as u32;
    }
}
