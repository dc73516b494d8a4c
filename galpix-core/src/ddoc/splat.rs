//! The splats of a distortion map: steps 3 to 6 of section 3.2.
//!
//! Each cell on the near side of an edge is the centre of a *splat*, a circle of cells that it may distort: on the hidden side
//! up to the radius `r`, on the visible side up to `r / a_f`. The cells store which splat is theirs, not a copy of it.
//!
//! - **Of two splats** the one whose centre is closer has a cell; of two as close the one that comes first, row by row.
//! - **A conflict** is a cell that a splat covers and another one owns whose direction is 90 degrees off or more. The splat
//!   shrinks until the closest such cell is just outside. Owners do not change in the meantime, so the order does not matter.
//! - **Orphans** are cells that have become too far for their owner; they are not distorted any more.

use super::direction;
use super::{FRACTION_BITS, ONE, Settings, Tally};
use crate::inpaint::root;
use crate::map::grid::Grid;

/// One cell of an edge, and what it distorts around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Splat {
    /// Column and row of the centre.
    pub cell: [u16; 2],
    /// Unit vector away from what is near, [`direction::FRACTION_BITS`] fraction bits.
    pub direction: [i16; 2],
    /// z_n: the depth of what is near; up to it nothing is moved.
    pub near: u32,
    /// z_f: the depth of what is far; from it on all is moved alike.
    pub far: u32,
    /// How far the hidden side reaches, [`FRACTION_BITS`] fraction bits.
    pub radius: u32,
}

impl Splat {
    /// The signed distance of `place` from the edge, [`FRACTION_BITS`] fraction bits: negative on the hidden side.
    ///
    /// Exact to the last bit for places within 256 cells of the centre; beyond, where nothing is asked, it may wrap.
    #[inline(always)]
    #[must_use]
    pub fn distance(&self, place: [i32; 2]) -> i32 {
        // No index that is known at run time only.
        let (([x, y], [column, row]), [towards_x, towards_y]) = ((place, self.cell), self.direction);
        let along = |coordinate: i32, centre: u16, towards: i16| {
            coordinate.wrapping_sub(i32::from(centre) << FRACTION_BITS).wrapping_mul(i32::from(towards))
        };
        let (x, y) = (along(x, column, towards_x), along(y, row, towards_y));
        x.wrapping_add(y) >> direction::FRACTION_BITS
    }

    /// d_f: how far what is `distance` from the edge is moved at full depth (figure 5, with the asymmetry `a`).
    ///
    /// ```text
    /// -r <= x <= 0:    [-r, 0]   -> [0, r/2a]        d = (x + r) / 2a - x
    ///  0 <= x <= r/a:  [0, r/a]  -> [r/2a, r/a]      d = (r/a - x) / 2
    /// ```
    ///
    /// Without asymmetry both are `(r - x) / 2`. What lies beyond counts as if it lay on the border. `asymmetry` is in
    /// sixteenths. *Rounding:* down, by less than two units.
    #[inline(always)]
    #[must_use]
    pub fn full(&self, distance: i32, asymmetry: u32) -> i32 {
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

    /// How far the visible side reaches: r / a.
    #[inline(always)]
    #[must_use]
    pub const fn room(&self, asymmetry: u32) -> u32 {
        match (self.radius << 4).checked_div(asymmetry) {
            Some(room) => room,
            None => 0,
        }
    }

    /// d(z): the share of `full` that is due at `depth`, a ramp from z_n to z_f. *Rounding:* towards 0; depths that differ by
    /// more than 16 bits count without their last ones.
    #[inline(always)]
    #[must_use]
    pub const fn share(&self, depth: u32, full: i32) -> i32 {
        if depth <= self.near {
            return 0;
        }
        if depth >= self.far {
            return full;
        }
        let (into, whole) = (depth - self.near, self.far - self.near);
        let shift = 16u32.saturating_sub(whole.leading_zeros());
        // Up to 16 bits, and a length of up to 255 cells: their product is a word.
        match ((into >> shift) * full as u32).checked_div(whole >> shift) {
            Some(share) => share as i32,
            None => full,
        }
    }

    /// Whether the splat covers the cell that is `x` and `y` away from its centre.
    #[inline(always)]
    #[must_use]
    pub(super) fn covers(&self, [x, y]: [i32; 2], asymmetry: u32) -> bool {
        let reach = if self.is_visible([x, y]) { self.room(asymmetry) } else { self.radius };
        (x * x + y * y) as u32 <= (reach * reach) >> (2 * FRACTION_BITS)
    }

    /// Whether the cell that is `x` and `y` away from the centre is on the visible side.
    #[inline(always)]
    pub(super) const fn is_visible(&self, [x, y]: [i32; 2]) -> bool {
        x * self.direction[0] as i32 + y * self.direction[1] as i32 > 0
    }

    /// The largest radius with which the cell that is `x` and `y` away is not covered.
    #[inline(always)]
    pub(super) fn outside(&self, [x, y]: [i32; 2], asymmetry: u32) -> u32 {
        // The largest root whose square is below that of the distance.
        let square = (((x * x + y * y) as u32) << (2 * FRACTION_BITS)).saturating_sub(1);
        let reach = root::floor(square);
        // floor(16 r / a) <= reach exactly up to this radius.
        if self.is_visible([x, y]) { ((reach + 1) * asymmetry - 1) >> 4 } else { reach }
    }
}

/// The cells of the square around a splat: how far they are from its centre, and their owner, which may be changed.
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

/// Step 3: each splat takes the cells that it covers and whose owner's centre, if they have one, is farther.
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

/// Step 4: shrinks splats until no cell that they cover is another's whose direction conflicts with theirs.
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

/// Step 5: no cell is distorted by a splat that does not reach it any more.
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
