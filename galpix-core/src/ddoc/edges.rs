//! The cells of a picture's edges, which way they face, and what is near and far there: step 2 of section 3.2, and the first half of
//! step 3.
//!
//! Edge cells are those whose Laplacian (17) is *above* the threshold: their neighbours are farther. Those on the other
//! side of the same edge are as far below; they are no centres, or each edge would count twice, once from its wrong side.

use super::direction::{self, Window};
use super::splat::Splat;
use super::{FRACTION_BITS, Settings, Tally};
use crate::frame::edge::laplacian;
use crate::map::grid::Grid;

/// Steps 2 and the first half of 3: finds the cells of edges, their directions and depths. Afterwards no cell has an owner.
pub(super) fn gather<'s>(
    grid: &Grid<'_>,
    depths: &[u32],
    settings: &Settings,
    owners: &mut [u32],
    splats: &'s mut [Splat],
    tally: &mut Tally,
) -> &'s mut [Splat] {
    // The owners serve as the map of edges.
    mark(grid, depths, settings.threshold as i32, owners);
    let mut free = splats.iter_mut();
    for y in 0..grid.height() as i32 {
        for x in 0..grid.width() as i32 {
            if at(grid, owners, x, y) != Some(1) {
                continue;
            }
            tally.edges += 1;
            let Some(splat) = found(grid, depths, settings, owners, [x, y]) else { continue };
            match free.next() {
                Some(to) => {
                    *to = splat;
                    tally.splats += 1;
                }
                None => tally.dropped += 1,
            }
        }
    }
    owners.fill(0);
    splats.get_mut(..tally.splats as usize).unwrap_or_default()
}

/// The splat around an edge's cell, unless it faces nowhere.
fn found(grid: &Grid<'_>, depths: &[u32], settings: &Settings, edges: &[u32], [x, y]: [i32; 2]) -> Option<Splat> {
    let near = at(grid, depths, x, y)?;
    let (facing, far) = farthest(grid, depths, [x, y])?;
    let mut window = Window::default();
    let reach = settings.window as i32;
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let Some(depth) = at(grid, depths, x + dx, y + dy) else { continue };
            let step = i64::from(depth) - i64::from(near);
            window.slope[0] += step * i64::from(dx);
            window.slope[1] += step * i64::from(dy);
            // Other things have edges, too: those whose depth is beyond the middle of this step. And a thin thing has another
            // edge close by, which faces the other way.
            let same = step.unsigned_abs() * 2 < u64::from(far - near);
            if same && at(grid, edges, x + dx, y + dy) == Some(1) {
                let (other, _) = farthest(grid, depths, [x + dx, y + dy])?;
                if facing[0] * other[0] + facing[1] * other[1] >= 0 {
                    window.moments.add(dx, dy);
                }
            }
        }
    }
    let direction = direction::direction(&window)?;
    let radius = settings.radius << FRACTION_BITS;
    Some(Splat { cell: [x as u16, y as u16], direction, near, far, radius })
}

/// The farthest of the four neighbours of a cell, or the cell itself: the way to it, and its depth. Of neighbours as far, the first.
fn farthest(grid: &Grid<'_>, depths: &[u32], [x, y]: [i32; 2]) -> Option<([i32; 2], u32)> {
    let mut found = ([0, 0], at(grid, depths, x, y)?);
    for [dx, dy] in [[0, -1], [-1, 0], [1, 0], [0, 1]] {
        if let Some(depth) = at(grid, depths, x + dx, y + dy).filter(|&depth| depth > found.1) {
            found = ([dx, dy], depth);
        }
    }
    Some(found)
}

/// Writes 1 for the near side of an edge, 0 for all else. Beyond the border the depths go on.
fn mark(grid: &Grid<'_>, depths: &[u32], threshold: i32, edges: &mut [u32]) {
    let width = grid.width() as i32;
    let mut cells = edges.iter_mut();
    for y in 0..grid.height() as i32 {
        for x in 0..width {
            let Some(edge) = cells.next() else { return };
            let own = at(grid, depths, x, y).unwrap_or(0);
            let depth = |x, y| at(grid, depths, x, y).unwrap_or(own) as i32;
            let source = laplacian(own as i32, depth(x - 1, y), depth(x + 1, y), depth(x, y - 1), depth(x, y + 1));
            *edge = u32::from(source > threshold);
        }
    }
}

/// What a plane holds at a cell.
#[inline(always)]
fn at(grid: &Grid<'_>, plane: &[u32], x: i32, y: i32) -> Option<u32> {
    plane.get(grid.cell(x, y)? as usize).copied()
}
