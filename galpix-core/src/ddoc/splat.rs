//! The splats of a distortion map: steps 3 to 6 of section 3.2.
//!
//! Each cell on the near side of an edge is the centre of a *splat*, a circle of cells that it may distort: on the
//! hidden side up to the radius `r`, on the visible side up to `r / a_f`. A cell stores the number of its splat, not a
//! copy of it.
//!
//! - **Owner.** Of two splats that cover a cell, the one whose centre is closer owns it; of two equally close ones the
//!   first, row by row.
//! - **Conflict.** A splat conflicts with a cell that it covers and that a splat of another direction owns, 90 degrees
//!   off or more. It shrinks until the closest such cell is just outside of it. Owners do not change in the meantime,
//!   so the order does not matter.
//! - **Orphans** are cells that have become too far from the centre of their owner; they are not distorted any more.

use super::direction;
use super::{FRACTION_BITS, ONE, Settings, Tally};
use crate::inpaint::root;
use crate::map::grid::Grid;

/// One cell of an edge, and the circle that it distorts. The caller provides a buffer of these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Splat {
    /// Column and row of the centre.
    pub(super) cell: [u16; 2],
    /// Unit vector away from the near side, with [`direction::FRACTION_BITS`] fraction bits.
    pub(super) direction: [i16; 2],
    /// z_n: the depth of the near side; up to it nothing is moved.
    pub(super) near: u32,
    /// z_f: the depth of the far side; from it on everything is moved alike.
    pub(super) far: u32,
    /// Extent of the hidden side, with [`FRACTION_BITS`] fraction bits.
    pub(super) radius: u32,
}

impl Splat {
    /// Returns the signed distance of `place` from the edge, with [`FRACTION_BITS`] fraction bits: negative on the
    /// hidden side.
    ///
    /// Exact to the last bit for places within 256 cells of the centre; beyond, where no place is looked up, it may
    /// wrap.
    #[inline(always)]
    pub(super) fn distance(&self, place: [i32; 2]) -> i32 {
        let (([x, y], [column, row]), [towards_x, towards_y]) = ((place, self.cell), self.direction);
        let along = |coordinate: i32, centre: u16, towards: i16| {
            coordinate.wrapping_sub(i32::from(centre) << FRACTION_BITS).wrapping_mul(i32::from(towards))
        };
        let (x, y) = (along(x, column, towards_x), along(y, row, towards_y));
        x.wrapping_add(y) >> direction::FRACTION_BITS
    }

    /// Returns d_f: how far what is `distance` from the edge is moved at full depth (figure 5, with the asymmetry `a`).
    ///
    /// ```text
    /// -r <= x <= 0:    [-r, 0]   -> [0, r/2a]        d = (x + r) / 2a - x
    ///  0 <= x <= r/a:  [0, r/a]  -> [r/2a, r/a]      d = (r/a - x) / 2
    /// ```
    ///
    /// Without asymmetry both are `(r - x) / 2`. Places beyond the splat count as if they were on its border.
    /// `asymmetry` is in sixteenths. *Rounding:* down, by less than two units.
    #[inline(always)]
    pub(super) fn full(&self, distance: i32, asymmetry: u32) -> i32 {
        let radius = self.radius as i32;
        let room = self.room(asymmetry) as i32;
        if distance > 0 {
            let left = room - distance;
            if left > 0 { left >> 1 } else { 0 }
        } else {
            let x = if distance < -radius { -radius } else { distance };
            // (x + r) / 2a is (x + r) / r of half the room.
            ((x + radius) * 8).checked_div(asymmetry as i32).unwrap_or(0) - x
        }
    }

    /// Returns the extent of the visible side: r / a.
    #[inline(always)]
    pub(super) const fn room(&self, asymmetry: u32) -> u32 {
        match (self.radius << 4).checked_div(asymmetry) {
            Some(room) => room,
            None => 0,
        }
    }

    /// Returns d(z): the share of `full` at `depth`, a ramp from z_n to z_f. *Rounding:* towards 0; where the
    /// difference of depths has more than 16 bits, only its upper 16 count.
    #[inline(always)]
    pub(super) const fn share(&self, depth: u32, full: i32) -> i32 {
        if depth <= self.near {
            return 0;
        }
        if depth >= self.far {
            return full;
        }
        let (into, whole) = (depth - self.near, self.far - self.near);
        let shift = 16u32.saturating_sub(whole.leading_zeros());
        // 16 bits times a length of up to 255 cells: the product is a word.
        match ((into >> shift) * full as u32).checked_div(whole >> shift) {
            Some(share) => share as i32,
            None => full,
        }
    }

    /// Returns whether the splat covers the cell that is `x` and `y` away from its centre.
    #[inline(always)]
    pub(super) fn covers(&self, [x, y]: [i32; 2], asymmetry: u32) -> bool {
        let reach = if self.is_visible([x, y]) { self.room(asymmetry) } else { self.radius };
        (x * x + y * y) as u32 <= (reach * reach) >> (2 * FRACTION_BITS)
    }

    /// Returns whether the cell that is `x` and `y` away from the centre is on the visible side.
    #[inline(always)]
    pub(super) const fn is_visible(&self, [x, y]: [i32; 2]) -> bool {
        x * self.direction[0] as i32 + y * self.direction[1] as i32 > 0
    }

    /// Returns the largest radius with which the cell that is `x` and `y` away from the centre is not covered.
    #[inline(always)]
    pub(super) fn outside(&self, [x, y]: [i32; 2], asymmetry: u32) -> u32 {
        // The largest root whose square is below that of the distance.
        let square = (((x * x + y * y) as u32) << (2 * FRACTION_BITS)).saturating_sub(1);
        let reach = root::floor(square);
        // floor(16 r / a) <= reach exactly up to this radius.
        if self.is_visible([x, y]) { ((reach + 1) * asymmetry - 1) >> 4 } else { reach }
    }
}

/// Visits the cells of the square around a splat: their places from its centre, and their owners, which `visit` may
/// change.
#[inline(always)]
fn around(grid: &Grid<'_>, owners: &mut [u32], splat: &Splat, mut visit: impl FnMut([i32; 2], &mut u32)) {
    let reach = (splat.radius >> FRACTION_BITS) as i32;
    let [x, y] = splat.cell.map(i32::from);
    let left = (x - reach).max(0);
    let right = (x + reach + 1).min(grid.width() as i32);
    for dy in -reach..=reach {
        let Some(row) = grid.row(y + dy) else { continue };
        let cells = owners.get_mut((row + left as u32) as usize..(row + right as u32) as usize).unwrap_or_default();
        for (dx, owner) in (left - x..).zip(cells) {
            visit([dx, dy], owner);
        }
    }
}

/// Gives each splat the cells that it covers and that no splat with a closer centre owns (step 3).
pub(super) fn cast(grid: &Grid<'_>, settings: &Settings, owners: &mut [u32], splats: &[Splat]) {
    for (number, splat) in (1..).zip(splats) {
        around(grid, owners, splat, |[dx, dy], owner| {
            let closer = match splats.get(owner.wrapping_sub(1) as usize) {
                Some(other) => {
                    let ([x, y], [other_x, other_y]) = (splat.cell.map(i32::from), other.cell.map(i32::from));
                    let (x, y) = (x - other_x, y - other_y);
                    dx * dx + dy * dy < (x + dx) * (x + dx) + (y + dy) * (y + dy)
                }
                None => true,
            };
            if closer && splat.covers([dx, dy], settings.asymmetry) {
                *owner = number;
            }
        });
    }
}

/// Shrinks splats until none covers a cell of a splat whose direction conflicts with its own (step 4).
pub(super) fn shrink(
    grid: &Grid<'_>,
    settings: &Settings,
    owners: &mut [u32],
    splats: &mut [Splat],
    tally: &mut Tally,
) {
    for number in 0..splats.len() {
        let Some(&splat) = splats.get(number) else { return };
        let mut radius = splat.radius;
        around(grid, owners, &splat, |from, owner| {
            let Some(other) = splats.get(owner.wrapping_sub(1) as usize) else { return };
            let ([x, y], [other_x, other_y]) = (splat.direction.map(i32::from), other.direction.map(i32::from));
            let (x, y) = (x * other_x, y * other_y);
            if x + y <= settings.conflict << direction::FRACTION_BITS && splat.covers(from, settings.asymmetry) {
                radius = radius.min(splat.outside(from, settings.asymmetry));
            }
        });
        if radius < splat.radius {
            tally.shrunk += 1;
            if let Some(splat) = splats.get_mut(number) {
                splat.radius = radius;
            }
        }
    }
}

/// Takes the owner from cells that it does not cover any more (step 5).
pub(super) fn delete_orphans(
    grid: &Grid<'_>,
    settings: &Settings,
    owners: &mut [u32],
    splats: &[Splat],
    tally: &mut Tally,
) {
    let mut cells = owners.iter_mut();
    for y in 0..grid.height() as i32 {
        for x in 0..grid.width() as i32 {
            let Some(owner) = cells.next() else { return };
            let Some(splat) = splats.get(owner.wrapping_sub(1) as usize) else { continue };
            let [column, row] = splat.cell.map(i32::from);
            if splat.covers([x - column, y - row], settings.asymmetry) {
                tally.distorted += 1;
            } else {
                *owner = 0;
                tally.orphans += 1;
            }
        }
    }
}

const _: () = assert!(ONE == 1 << FRACTION_BITS && (255 << FRACTION_BITS) < 1 << 16);
