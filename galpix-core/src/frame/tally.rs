//! What a frame counted.

/// Counts of one frame. Each is at most the number of cells (`saturated`: fields, six times that).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally {
    /// Galpixels and debris that were propagated.
    pub moved: u32,
    /// Of these, how many left the map over its border.
    pub lost: u32,
    /// Of these, how many met another in the same cell and lost, or won over it: one for each that was discarded.
    pub collided: u32,
    /// Fields that would have left their range and were clamped instead: nothing wraps.
    pub saturated: u32,
    /// Cells on the edge of a surface, in the map before propagation.
    pub edges: u32,
    /// Cells that nothing reached.
    pub holes: u32,
    /// Holes inside a surface, filled as bullet holes.
    pub bullets: u32,
    /// Holes that were just unobscured, and hold debris without motion.
    pub debris: u32,
    /// Holes that were just unobscured, and hold a delayed galpixel.
    pub galdebris: u32,
    /// Holes that stay empty; the display shows there what the fill_mode says.
    pub empty: u32,
}

impl Tally {
    /// Holes that something was put into.
    #[must_use]
    pub const fn filled(&self) -> u32 {
        self.bullets + self.debris + self.galdebris
    }
}
