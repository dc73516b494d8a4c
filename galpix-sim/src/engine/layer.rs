//! What is handed over beside an update, and the memory that it takes as layers of the core.

use galpix_core::layers::{Displacement, Layer, Stationary, composite_words, displacement_word};
use galpix_core::{Dynamic, Galpixmap, Grid, Scratch, SetupError, stages};

use super::{LoadTally, load_at};
use crate::update::Update;

/// A layer beside the update, over the same cells.
#[derive(Clone, Copy, Debug)]
pub enum Beside<'u> {
    /// Its samples are where they are seen, and move like the update's.
    Moving(&'u Update),
    /// Its samples are stored elsewhere, see [`Layer::stationary`].
    Anchored {
        /// The samples, where they are stored.
        update: &'u Update,
        /// From there to the cells in which they are seen.
        displacements: &'u [Displacement],
        /// Where in these cells they are, -1/2 to 1/2 of a cell.
        offsets: &'u [[f64; 2]],
    },
}

impl<'u> Beside<'u> {
    /// Its samples.
    #[must_use]
    pub const fn update(&self) -> &'u Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    /// Writes its samples into a map.
    pub(super) fn load(&self, map: &mut Galpixmap<'_, Dynamic>) -> LoadTally {
        let offset = |sample: usize| match self {
            Self::Moving(_) => [0.0; 2],
            Self::Anchored { offsets, .. } => offsets.get(sample).copied().unwrap_or_default(),
        };
        load_at(self.update(), offset, map)
    }
}

/// The memory of a layer.
pub(super) struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    /// For a layer over a grid.
    pub fn new(grid: &Grid<'_>, format: Dynamic, beside: &Beside<'_>) -> Self {
        let map = || vec![0; Galpixmap::words(grid, format)];
        let winners = vec![0; grid.cells() as usize];
        let seats = vec![0; composite_words(grid)];
        match beside {
            Beside::Moving(_) => {
                let edges = vec![0; stages::words(grid)];
                Self { maps: [map(), map(), Vec::new()], winners, edges, seats, displacements: Vec::new() }
            }
            Beside::Anchored { displacements, .. } => {
                let displacements = displacements.iter().map(|&place| displacement_word(place)).collect();
                Self { maps: [map(), map(), map()], winners, edges: Vec::new(), seats, displacements }
            }
        }
    }

    /// The layer over this memory, still empty.
    ///
    /// *Errors:* an anchored layer with fewer displacements than cells.
    pub fn layer<'p>(&'p mut self, grid: Grid<'p>, format: Dynamic) -> Result<Layer<'p, Dynamic>, SetupError> {
        let Self { maps: [front, back, stored], winners, edges, seats, displacements } = self;
        let (front, back) = (Galpixmap::new(grid, format, front)?, Galpixmap::new(grid, format, back)?);
        if stored.is_empty() {
            return Layer::new(front, back, Scratch { winners, edges }, seats);
        }
        let stored = Galpixmap::new(grid, format, stored)?;
        Layer::stationary(Stationary { stored, displacements }, front, back, winners, seats)
    }
}
