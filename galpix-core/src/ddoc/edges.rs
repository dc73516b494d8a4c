//! The cells of a picture's edges, the directions that they face, and the depths on both sides: step 2 of section 3.2,
//! and the first half of step 3.
//!
//! Edge cells are those whose Laplacian, equation (17), is *above* the threshold: their neighbours are farther. The
//! cells on the other side of the same edge are as far below it. They are no centres of splats, or each edge would
//! count twice, once from its wrong side.

use super::direction::{self, Window};
use super::splat::Splat;
use super::{FRACTION_BITS, Settings, Tally};
use crate::frame::edge::laplacian;
use crate::map::grid::Grid;

/// A depth image, and the settings for its distortion map.
pub(super) struct DepthImage<'d> {
    pub grid: &'d Grid<'d>,
    /// One depth a cell.
    pub depths: &'d [u32],
    pub settings: &'d Settings,
}

impl DepthImage<'_> {
    /// Fills `splats` with those of the edge cells, row by row, with their directions and depths; returns them.
    /// Afterwards no cell has an owner.
    pub fn gather<'s>(&self, owners: &mut [u32], splats: &'s mut [Splat], tally: &mut Tally) -> &'s mut [Splat] {
        // In the meantime the owners hold the edge map.
        self.mark(owners);
        let mut free = splats.iter_mut();
        for y in 0..self.grid.height() as i32 {
            for x in 0..self.grid.width() as i32 {
                if self.at(owners, x, y) != Some(1) {
                    continue;
                }
                tally.edges += 1;
                let Some(splat) = self.splat(owners, [x, y]) else { continue };
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

    /// Returns the splat around an edge cell, `None` if the cell faces no direction.
    fn splat(&self, edges: &[u32], [x, y]: [i32; 2]) -> Option<Splat> {
        let near = self.depth(x, y)?;
        let (facing, far) = self.farthest([x, y])?;
        let mut window = Window::default();
        let reach = self.settings.window as i32;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let Some(depth) = self.depth(x + dx, y + dy) else { continue };
                let step = i64::from(depth) - i64::from(near);
                window.slope[0] += step * i64::from(dx);
                window.slope[1] += step * i64::from(dy);
                // Cells of other objects' edges are left out: their depth is beyond the middle of this step. So are
                // those of the other edge of a thin object, which faces the opposite direction.
                let same = step.unsigned_abs() * 2 < u64::from(far - near);
                if same && self.at(edges, x + dx, y + dy) == Some(1) {
                    let (other, _) = self.farthest([x + dx, y + dy])?;
                    if facing[0] * other[0] + facing[1] * other[1] >= 0 {
                        window.moments.add(dx, dy);
                    }
                }
            }
        }
        let direction = direction::direction(&window)?;
        let radius = self.settings.radius << FRACTION_BITS;
        Some(Splat { cell: [x as u16, y as u16], direction, near, far, radius })
    }

    /// Returns the direction and the depth of the farthest of a cell's four neighbours and the cell itself; of equally
    /// far ones the first, in the order cell, above, left, right, below.
    fn farthest(&self, [x, y]: [i32; 2]) -> Option<([i32; 2], u32)> {
        let mut found = ([0, 0], self.depth(x, y)?);
        for [dx, dy] in [[0, -1], [-1, 0], [1, 0], [0, 1]] {
            if let Some(depth) = self.depth(x + dx, y + dy).filter(|&depth| depth > found.1) {
                found = ([dx, dy], depth);
            }
        }
        Some(found)
    }

    /// Writes 1 for the cells on the near side of an edge, 0 for all others. A neighbour beyond the border counts as
    /// having the depth of the cell.
    fn mark(&self, edges: &mut [u32]) {
        let mut cells = edges.iter_mut();
        for y in 0..self.grid.height() as i32 {
            for x in 0..self.grid.width() as i32 {
                let Some(edge) = cells.next() else { return };
                let own = self.depth(x, y).unwrap_or(0);
                let depth = |x, y| self.depth(x, y).unwrap_or(own) as i32;
                let source = laplacian(own as i32, depth(x - 1, y), depth(x + 1, y), depth(x, y - 1), depth(x, y + 1));
                *edge = u32::from(source > self.settings.threshold as i32);
            }
        }
    }

    /// Returns the depth of a cell.
    #[inline(always)]
    fn depth(&self, x: i32, y: i32) -> Option<u32> {
        self.at(self.depths, x, y)
    }

    /// Returns the word of a plane at a cell.
    #[inline(always)]
    fn at(&self, plane: &[u32], x: i32, y: i32) -> Option<u32> {
        plane.get(self.grid.cell(x, y)? as usize).copied()
    }
}
