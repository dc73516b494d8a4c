//! The core's distortion map with memory of its own, for places in floating point.

use galpix_core::ddoc::{self, DistortionMap, ONE, Settings, Splat, Tally};
use galpix_core::{Grid, Margin, SetupError};

/// Bits of a depth word.
pub const DEPTH_BITS: u32 = 24;

/// Memory for a distortion map.
#[derive(Debug, Default)]
pub struct Memory {
    rows: Vec<u32>,
    owners: Vec<u32>,
    splats: Vec<Splat>,
}

/// Returns the depth word of an inverse distance of 0 (infinitely far) to 1 (the nearest): `1 - nearness` of the whole
/// range.
#[must_use]
pub fn depth_word(nearness: f64) -> u32 {
    let top = f64::from((1 << DEPTH_BITS) - 1);
    // `as` saturates.
    ((1.0 - nearness) * top).round() as u32
}

impl Memory {
    /// Returns the distortion map of a picture of `width` columns with these depths, one per pixel.
    ///
    /// *Errors:* a picture without a pixel, or with more than a map can have.
    pub fn map(
        &mut self,
        width: usize,
        depths: &[u32],
        settings: &Settings,
    ) -> Result<(DistortionMap<'_>, Tally), SetupError> {
        let height = depths.len().checked_div(width).unwrap_or(0);
        self.rows.resize(height, 0);
        self.owners.resize(depths.len(), 0);
        self.splats.resize(depths.len(), Splat::default());
        let grid = Grid::new(width as u32, height as u32, Margin::NONE, &mut self.rows)?;
        DistortionMap::new(grid, depths, settings, &mut self.owners, &mut self.splats)
    }
}

/// By how much what is at `at` is moved, pixels.
#[must_use]
pub fn displacement(map: &DistortionMap<'_>, at: [f64; 2], depth: u32) -> [f64; 2] {
    let place = at.map(|coordinate| (coordinate * f64::from(ONE)).round() as i32);
    map.displacement(place, depth).map(|length| f64::from(length) / f64::from(ONE))
}

/// Returns the settings of a map of depth words.
#[must_use]
pub const fn settings() -> Settings {
    ddoc::Settings::for_depth(DEPTH_BITS)
}
