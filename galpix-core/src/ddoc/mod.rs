//! The depth discontinuity occlusion camera (DDOC): a camera that looks a little around each edge of what it sees.
//!
//! A depth image holds nothing of what is hidden behind an edge, so a view from beside it has holes there. The DDOC moves
//! what is barely hidden to the visible side of the edge and squeezes what is visible there to make room: one image, one
//! layer, that holds both. Where it moves what is a *distortion map*, made from the depths of the plain image, and any
//! place of the scene is projected by one look-up in it (equation 1).
//!
//! 1. [`edges`]: which cells are on an edge, and which way it faces (step 2)
//! 2. [`direction`]: the normal of a line through cells, by least squares (step 3)
//! 3. [`splat`]: which cells each of them is to distort (steps 3 to 5)
//! 4. [`splat::Splat::full`] and [`splat::Splat::share`]: how far (step 6 and equation 1)
//!
//! After V. Popescu, D. Aliaga, "The Depth Discontinuity Occlusion Camera", 2006. `docs/ddoc.md` tells how the paper was read.
//!
//! **Numbers.** Depths are words of up to 28 bits, 0 the nearest, linear in *inverse* distance (`1 - near / z`): what the
//! paper has linear in `1/z` is linear in them. Places and lengths have [`FRACTION_BITS`] fraction bits, whole numbers being
//! the middles of cells; directions [`direction::FRACTION_BITS`]. There are multiplications, and one division of 32 bits a
//! place that is moved; nothing overflows, and nothing panics.
//!
//! ```
//! use galpix_core::ddoc::{DistortionMap, ONE, Settings, Splat};
//! use galpix_core::{Grid, Margin};
//!
//! // The left half of a picture is near, the right half far.
//! let mut rows = [0; 16];
//! let grid = Grid::new(32, 16, Margin::NONE, &mut rows)?;
//! let depths: [u32; 32 * 16] = core::array::from_fn(|cell| if cell % 32 < 16 { 1000 } else { 9000 });
//!
//! let (mut owners, mut splats) = ([0; 32 * 16], [Splat::default(); 16]);
//! let settings = Settings { radius: 4, ..Settings::for_depth(16) };
//! let (map, tally) = DistortionMap::new(grid, &depths, &settings, &mut owners, &mut splats)?;
//! assert_eq!(tally.splats, 16);
//!
//! // Column 15 is the last of the near half. What is far and hidden two cells behind it is moved right by three, to where it
//! // is seen; what is near stays.
//! assert_eq!(map.displacement([13 * ONE, 8 * ONE], 9000), [3 * ONE, 0]);
//! assert_eq!(map.displacement([13 * ONE, 8 * ONE], 1000), [0, 0]);
//! # Ok::<(), galpix_core::SetupError>(())
//! ```

mod direction;
mod edges;
mod splat;

#[cfg(test)]
mod tests;

use crate::error::SetupError;
use crate::format::Format;
use crate::frame::edge;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::map::grid::Grid;
use direction::along;

pub use splat::Splat;

/// Fraction bits of places and lengths.
pub const FRACTION_BITS: u32 = 8;

/// One cell.
pub const ONE: i32 = 1 << FRACTION_BITS;

/// The largest radius, cells.
pub const MOST_RADIUS: u32 = 255;

/// An asymmetry of 1: the hidden band is as wide as the visible one.
pub const SYMMETRIC: u32 = 16;

/// What a distortion map is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// D of the paper: how far behind an edge samples are fetched, at most. Cells, 1 to [`MOST_RADIUS`].
    pub radius: u32,
    /// a_f of the paper, in sixteenths ([`SYMMETRIC`] to 255): `radius` cells of what is hidden are put into the first half of
    /// `radius / a_f` cells beside the edge.
    pub asymmetry: u32,
    /// From which second difference of the depths on there is an edge, in units of the depth's last bit.
    pub threshold: u32,
    /// Cells to each side of an edge's cell among which the line is laid that gives its direction, 1 to 15.
    pub window: u32,
    /// Directions conflict if the cosine of the angle between them is not above this, in units of 2^-14. 0: from 90 degrees
    /// on; -2^15 or less: never.
    pub conflict: i32,
}

impl Settings {
    /// Settings for depths of `depth_bits` bits: 16 cells, symmetric.
    #[must_use]
    pub const fn for_depth(depth_bits: u32) -> Self {
        Self {
            radius: 16,
            asymmetry: SYMMETRIC,
            threshold: edge::threshold_for_depth(depth_bits),
            window: 3,
            conflict: 0,
        }
    }

    /// The settings, each within its range.
    #[must_use]
    const fn clamped(self) -> Self {
        const fn clamp(value: u32, low: u32, high: u32) -> u32 {
            if value < low {
                low
            } else if value > high {
                high
            } else {
                value
            }
        }
        // A little beyond the longest unit vectors' product, which rounding may make larger than 1.
        const NEVER: i32 = 1 << (direction::FRACTION_BITS + 1);
        Self {
            radius: clamp(self.radius, 1, MOST_RADIUS),
            asymmetry: clamp(self.asymmetry, SYMMETRIC, 255),
            threshold: clamp(self.threshold, 0, i32::MAX as u32),
            window: clamp(self.window, 1, 15),
            conflict: if self.conflict < -NEVER {
                -NEVER
            } else if self.conflict > NEVER {
                NEVER
            } else {
                self.conflict
            },
        }
    }
}

/// What making a distortion map counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Cells on the near side of an edge.
    pub edges: u32,
    /// Of these, cells that became the centre of a splat.
    pub splats: u32,
    /// Of these, cells for whose splat no memory was lent.
    pub dropped: u32,
    /// Splats whose radius a conflict made smaller.
    pub shrunk: u32,
    /// Cells whose distortion was deleted again, because their splat had become too small for them.
    pub orphans: u32,
    /// Cells that are distorted.
    pub distorted: u32,
}

/// A distortion map over lent memory.
#[derive(Clone, Copy, Debug)]
pub struct DistortionMap<'m> {
    grid: Grid<'m>,
    /// The splat of each cell, counted from 1; 0 for none.
    owners: &'m [u32],
    splats: &'m [Splat],
    asymmetry: u32,
}

impl<'m> DistortionMap<'m> {
    /// The distortion map of a picture with these depths, one a cell of `grid`, row by row.
    ///
    /// `owners` is a word a cell; `splats` one a cell on the near side of an edge. Where there are more of these than `splats`
    /// has room for, the last ones are left out and counted. Settings outside of their ranges are clamped.
    ///
    /// *Errors:* `depths` or `owners` has fewer words than the grid cells.
    pub fn new(
        grid: Grid<'m>,
        depths: &[u32],
        settings: &Settings,
        owners: &'m mut [u32],
        splats: &'m mut [Splat],
    ) -> Result<(Self, Tally), SetupError> {
        let need = grid.cells() as usize;
        let have = depths.len();
        let Some(depths) = depths.get(..need) else {
            return Err(SetupError::TooShort { plane: "plane of depths", need, have });
        };
        let have = owners.len();
        let Some(owners) = owners.get_mut(..need) else {
            return Err(SetupError::TooShort { plane: "distortion map", need, have });
        };
        let settings = settings.clamped();
        let mut tally = Tally::default();
        let splats = edges::gather(&grid, depths, &settings, owners, splats, &mut tally);
        splat::cast(&grid, &settings, owners, splats);
        splat::shrink(&grid, &settings, owners, splats, &mut tally);
        splat::delete_orphans(&grid, &settings, owners, splats, &mut tally);
        Ok((Self { grid, owners, splats, asymmetry: settings.asymmetry }, tally))
    }

    /// The grid.
    #[must_use]
    pub const fn grid(&self) -> &Grid<'m> {
        &self.grid
    }

    /// The splat that distorts the cell in which `place` lies, if any does.
    #[inline(always)]
    #[must_use]
    pub fn splat(&self, place: [i32; 2]) -> Option<&Splat> {
        let [x, y] = place.map(|coordinate| (coordinate >> (FRACTION_BITS - 1)).wrapping_add(1) >> 1);
        let owner = *self.owners.get(self.grid.cell(x, y)? as usize)?;
        self.splats.get(owner.wrapping_sub(1) as usize)
    }

    /// By how much what is at `place` in the plain picture, at this depth, is moved: equation 1 without its last line.
    ///
    /// The splat is that of the cell in which the place lies; the distance from the edge is the place's own, not the cell's,
    /// so that the distortion is continuous within a splat. Nothing is moved outside of the map. *Rounding:* down by less than
    /// three units of the last of the [`FRACTION_BITS`].
    #[inline(always)]
    #[must_use]
    pub fn displacement(&self, place: [i32; 2], depth: u32) -> [i32; 2] {
        match self.splat(place) {
            Some(splat) => {
                let length = splat.share(depth, splat.full(splat.distance(place), self.asymmetry));
                splat.direction.map(|direction| along(i32::from(direction), length))
            }
            None => [0; 2],
        }
    }

    /// Where the DDOC sees what the plain camera sees at `place`, at this depth: equation 1.
    #[inline(always)]
    #[must_use]
    pub fn displaced(&self, place: [i32; 2], depth: u32) -> [i32; 2] {
        let [by_x, by_y] = self.displacement(place, depth);
        let [x, y] = place;
        [x.wrapping_add(by_x), y.wrapping_add(by_y)]
    }
}

/// Copies the depths of a map, for [`DistortionMap::new`]: cells without a fully-fledged galpixel count as `empty`. Further
/// words of `depths` stay as they are.
pub fn depths<F: Format>(map: &Galpixmap<'_, F>, empty: u32, depths: &mut [u32]) {
    let bits = map.record().depth().bits;
    for (to, key) in depths.iter_mut().zip(map.keys(0..map.grid().cells() as usize)) {
        // The class stands above the depth, and a galpixel's is 0.
        *to = if key >> bits == Class::Galpixel as u32 { key } else { empty };
    }
}
