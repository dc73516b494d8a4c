//! The counts of a frame.

/// The counts of a frame. Each is at most the number of cells, or of samples in all layers; `saturated` counts fields,
/// at most four for each of them, and a displacement as two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Galpixels and debris that were propagated.
    pub moved: u32,
    /// Propagated galpixels and debris that left the map.
    pub lost: u32,
    /// Collisions: galpixels and debris that arrived at an occupied cell, so that one of the two was discarded.
    pub collided: u32,
    /// Fields that would have left their range and were clamped; no field wraps.
    pub saturated: u32,
    /// Cells on the edge of a surface, in the map before propagation.
    pub edges: u32,
    /// Cells at which nothing arrived.
    pub holes: u32,
    /// Holes that were filled as bullet holes, inside a surface.
    pub bullets: u32,
    /// Just-unobscured holes that hold debris without motion.
    pub debris: u32,
    /// Just-unobscured holes that hold a galpixel (galdebris).
    pub galdebris: u32,
    /// Holes that stay empty; what the display shows there depends on the fill mode.
    pub empty: u32,
}

impl Tally {
    /// Returns the holes that were filled.
    #[must_use]
    pub const fn filled(&self) -> u32 {
        self.bullets + self.debris + self.galdebris
    }
}
