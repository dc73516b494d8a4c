//! What everything is measured on.

use galpix_core::{Grid, Scratch};

use crate::clock::Clock;
use crate::sources;

/// A clock, and memory for the largest layout.
pub struct Bench {
    /// What counts.
    pub clock: Clock,
    /// The grid of all maps.
    pub grid: Grid<'static>,
    /// A smaller one, as wide, for constant time, which takes long and is the same for every row.
    pub band: Grid<'static>,
    /// Two maps that take turns.
    pub maps: [&'static mut [u32]; 2],
    /// Winner map and edge map.
    pub scratch: Scratch<'static>,
    /// The picture as it was painted.
    pub painted: &'static mut [u32],
    /// A map and its winners between sweep and fill.
    pub swept: [&'static mut [u32]; 2],
    /// Memory for push-pull.
    pub push_pull: &'static mut [u32],
    /// Memory for sources.
    pub sources: sources::Memory,
    /// Row starts of a window.
    pub window_rows: &'static mut [u32],
}
