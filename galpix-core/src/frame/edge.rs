//! Stage 3: the edge map, a bit for each cell, set if the cell is on the edge of a surface.
//!
//! ```text
//!        up
//!  left  z0  right        laplacian = left + right + up + down - 4 z0        (17)
//!       down
//! ```
//!
//! The Laplacian of the depth vanishes on a plane, but not at a step. A cell is **inside a surface** if neither it nor
//! any of its four neighbours is empty and the absolute Laplacian does not exceed the threshold; else it is **on an
//! edge**. What was filled takes part by its depth, like a galpixel: the depth alone tells surfaces apart. A neighbour
//! outside of the map is taken to have the class and the depth of the cell itself.
//!
//! *Cost* per cell: 4 additions, 1 shift and 2 comparisons; five cells are read.

use crate::format::Format;
use crate::map::Galpixmap;
use crate::map::grid::Grid;

/// Returns the Laplacian of the depth, equation (17).
///
/// Exact for depths of up to 28 bits. With the bit of an empty cell above the depth it may wrap; such cells are on an
/// edge in any case.
#[inline(always)]
#[must_use]
pub const fn laplacian(z0: i32, left: i32, right: i32, up: i32, down: i32) -> i32 {
    left.wrapping_add(right).wrapping_add(up).wrapping_add(down).wrapping_sub(z0 << 2)
}

/// Returns a threshold for depths of `depth_bits` bits that are linear in inverse distance or in disparity: 1/64 of the
/// range.
///
/// Planes of any slant stay far below it. Surfaces whose depths differ by more are separated by edges.
#[must_use]
pub const fn threshold_for_depth(depth_bits: u32) -> u32 {
    if depth_bits > 6 { 1 << (depth_bits - 6) } else { 1 }
}

/// Returns a threshold for depths of `depth_bits` bits that are derived from speed ("faster is nearer"): 1/128 of the
/// range.
#[must_use]
pub const fn threshold_for_speed(depth_bits: u32) -> u32 {
    if depth_bits > 7 { 1 << (depth_bits - 7) } else { 1 }
}

/// Returns the words of the edge map of a grid. It has a bit for each cell: cell `c` is bit `c % 32` of word `c / 32`.
#[must_use]
pub const fn words(grid: &Grid<'_>) -> usize {
    grid.cells().div_ceil(32) as usize
}

/// Returns whether a cell is on the edge of a surface; `true` for cells outside of the edge map.
#[inline(always)]
#[must_use]
pub fn on_edge(edges: &[u32], cell: u32) -> bool {
    match edges.get((cell >> 5) as usize) {
        Some(word) => word >> (cell & 31) & 1 != 0,
        None => true,
    }
}

/// Marks the cells of a map that are on an edge; returns how many there are.
///
/// `threshold` is in units of the depth's last bit. `edges` should have [`words`] words; cells beyond its end are
/// counted but not marked.
pub fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    F::mark(front, threshold, edges)
}

/// Sets the bits of cells from `cell` on that are set in `flags`, whose lowest bit belongs to `cell`.
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
