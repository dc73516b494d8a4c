//! The disocclusion map of an update, as a display controller would make it: of the quantised map.

use std::time::Duration;

use cpu_time::ThreadTime;
use galpix_core::disocclusion::{self, Reach, Tally};
use galpix_core::{Dynamic, Galpixmap, Grid};

use crate::engine::{EngineError, grid, load, margin};
use crate::update::Update;

/// A disocclusion map.
#[derive(Clone, Debug)]
pub struct Culling {
    /// For each cell, a word of extents, see [`disocclusion::Extents`].
    pub extents: Vec<u32>,
    /// What was counted.
    pub tally: Tally,
    /// Processor time that it took.
    pub time: Duration,
}

impl Culling {
    /// Returns whether what is hidden in a cell may be uncovered.
    #[must_use]
    pub fn covers(&self, cell: usize) -> bool {
        disocclusion::covered(&self.extents, cell as u32)
    }
}

/// Returns the disocclusion map of an update for `frames` frames; more than [`Reach::MOST_FRAMES`] count as that.
///
/// *Errors:* an update that cannot be laid out.
pub fn culling(update: &Update, format: Dynamic, frames: u32) -> Result<Culling, EngineError> {
    let mut starts = vec![0; Grid::rows(update.display_height() as u32, margin(update.margin))];
    let grid = grid(update, &mut starts)?;
    let mut memory = vec![0; Galpixmap::words(&grid, format)];
    let mut map = Galpixmap::new(grid, format, &mut memory)?;
    load(update, &mut map);
    let mut extents = vec![0; grid.cells() as usize];
    let reach = Reach { tears: false, ..Reach::new(frames, u32::from(map.record().depth().bits)) };
    let started = ThreadTime::now();
    let tally = disocclusion::map(&map, &mut extents, &reach);
    Ok(Culling { extents, tally, time: started.elapsed() })
}
