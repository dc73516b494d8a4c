//! The depth discontinuity occlusion camera (DDOC): a camera that looks a little around each edge of what it sees.
//!
//! A depth image holds nothing of what is hidden behind an edge, so a view from another place has holes there. The DDOC
//! moves what is barely hidden to the visible side of the edge and squeezes what is visible there to make room. The
//! result is one image with one layer that holds both. A *distortion map*, made from the depths of the plain image,
//! says how far each sample is moved; one look-up in it projects any place of the scene (equation 1).
//!
//! 1. Find the cells that are on an edge, and the direction that each faces: the normal of a line through cells, by
//!    least squares (steps 2 and 3 of section 3.2).
//! 2. Find the cells that each of them distorts, its *splat* (steps 3 to 5).
//! 3. Look up how far a place is moved (step 6 and equation 1).
//!
//! After V. Popescu, D. Aliaga, "The Depth Discontinuity Occlusion Camera", 2006. `docs/notes/ddoc.md` says how the
//! paper was read.
//!
//! **Numbers.** Depths are words of up to 28 bits, 0 the nearest, linear in *inverse* distance (`1 - near / z`): what
//! the paper has linear in `1/z` is linear in them. Places and lengths are in units of 1 / [`ONE`] cell; the
//! multiples of [`ONE`] are the middles of cells. Nothing overflows, and nothing panics.
//!
//! *Cost:* multiplications, two of 64 bits for each cell of a window; two roots and two divisions for each edge cell,
//! and a root for each conflict; at most three divisions of 32 bits for a place that is looked up.
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
//! // Column 15 is the last of the near half. What is far and hidden two cells behind it is moved right by three
//! // cells, to where it is seen; what is near stays.
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
use crate::frame::edge;
use crate::map::grid::Grid;
use direction::along;
use edges::DepthImage;

pub use splat::Splat;

/// Fraction bits of places and lengths.
const FRACTION_BITS: u32 = 8;

/// One cell, in units of places and lengths.
pub const ONE: i32 = 1 << FRACTION_BITS;

/// The largest radius, in cells.
pub const MOST_RADIUS: u32 = 255;

/// The smallest asymmetry, 1 in sixteenths: the hidden band is as wide as the visible one.
pub const SYMMETRIC: u32 = 16;

/// The settings of a distortion map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// D of the paper: the largest distance behind an edge from which samples are moved, in cells, 1 to
    /// [`MOST_RADIUS`].
    pub radius: u32,
    /// a_f of the paper, in sixteenths ([`SYMMETRIC`] to 255): `radius` hidden cells are moved into the first half of
    /// `radius / a_f` cells on the visible side of the edge.
    pub asymmetry: u32,
    /// The second difference of depths above which a cell is on an edge, in units of the depth's last bit.
    pub threshold: u32,
    /// Cells to each side of an edge cell in the window to which the line that gives its direction is fitted, 1 to 15.
    pub window: u32,
    /// The largest cosine of the angle between two directions that conflict, in units of 2^-14. 0: they conflict from
    /// 90 degrees on; -2^15 or less: never.
    pub conflict: i32,
}

impl Settings {
    /// Returns settings for depths of `depth_bits` bits: a radius of 16 cells, symmetric.
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

    /// Returns the settings, each clamped to its range.
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
        // Beyond the product of any two unit vectors, which rounding may make larger than 1.
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

/// Counts of a distortion map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Cells on the near side of an edge.
    pub edges: u32,
    /// Of these, cells that became the centre of a splat.
    pub splats: u32,
    /// Of these, cells for whose splat no memory was provided.
    pub dropped: u32,
    /// Splats that a conflict made smaller.
    pub shrunk: u32,
    /// Cells whose distortion was deleted, because their splat had become too small for them.
    pub orphans: u32,
    /// Cells that are distorted.
    pub distorted: u32,
}

/// A distortion map in caller-provided buffers.
#[derive(Clone, Copy, Debug)]
pub struct DistortionMap<'m> {
    grid: Grid<'m>,
    /// The splat of each cell, counted from 1; 0 for none.
    owners: &'m [u32],
    splats: &'m [Splat],
    asymmetry: u32,
}

impl<'m> DistortionMap<'m> {
    /// Makes the distortion map of a picture with these depths, one for each cell of `grid`, row by row.
    ///
    /// `owners` holds one word for each cell; `splats` one splat for each cell on the near side of an edge. If there
    /// are more such cells than `splats` has room for, the last ones are left out and counted. Settings outside of
    /// their ranges are clamped.
    ///
    /// *Errors:* `depths` or `owners` has fewer words than the grid has cells.
    ///
    /// *Cost:* for each edge cell a window of `(2 window + 1)^2` cells, and two squares of `(2 radius + 1)^2` cells.
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
        let image = DepthImage { grid: &grid, depths, settings: &settings };
        let splats = image.gather(owners, splats, &mut tally);
        splat::cast(&grid, &settings, owners, splats);
        splat::shrink(&grid, &settings, owners, splats, &mut tally);
        splat::delete_orphans(&grid, &settings, owners, splats, &mut tally);
        Ok((Self { grid, owners, splats, asymmetry: settings.asymmetry }, tally))
    }

    /// Returns the splat that distorts the cell in which `place` lies, if any does.
    #[inline(always)]
    fn splat(&self, place: [i32; 2]) -> Option<&Splat> {
        let [x, y] = place.map(|coordinate| (coordinate >> (FRACTION_BITS - 1)).wrapping_add(1) >> 1);
        let owner = *self.owners.get(self.grid.cell(x, y)? as usize)?;
        self.splats.get(owner.wrapping_sub(1) as usize)
    }

    /// Returns by how much what is at `place` in the plain picture, at this depth, is moved: equation 1 without its
    /// last line. 0 outside of the map.
    ///
    /// Uses the splat of the cell in which the place lies, and the distance of the place itself, not of its cell, from
    /// the edge, so that the distortion is continuous within a splat. *Rounding:* down, by less than three units.
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

    /// Returns where the DDOC sees what the plain camera sees at `place`, at this depth: equation 1. Wraps for places
    /// beyond the range of `i32`.
    #[inline(always)]
    #[must_use]
    pub fn displaced(&self, place: [i32; 2], depth: u32) -> [i32; 2] {
        let [by_x, by_y] = self.displacement(place, depth);
        let [x, y] = place;
        [x.wrapping_add(by_x), y.wrapping_add(by_y)]
    }
}
