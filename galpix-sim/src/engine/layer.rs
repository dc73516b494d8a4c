//! Hidden layers of an update, and the memory that they take as layers of the core.

use galpix_core::layers::{Displacement, Layer, Stationary, composite_words, displacement_word};
use galpix_core::{Dynamic, Galpixmap, Grid, Scratch, SetupError, stages};

use super::{LoadTally, load_at};
use crate::update::Update;

/// A hidden layer of an update, over the same cells.
#[derive(Clone, Copy, Debug)]
pub enum HiddenLayer<'u> {
    /// Its samples are where they are seen, and move like the update's.
    Moving(&'u Update),
    /// Its samples are stored elsewhere, see [`Layer::stationary`].
    Stationary {
        /// The samples, where they are stored.
        update: &'u Update,
        /// From there to the cells in which they are seen.
        displacements: &'u [Displacement],
        /// Where in these cells they are, -1/2 to 1/2 of a cell.
        offsets: &'u [[f64; 2]],
    },
}

impl<'u> HiddenLayer<'u> {
    /// Returns its samples.
    #[must_use]
    pub const fn update(&self) -> &'u Update {
        match self {
            Self::Moving(update) | Self::Stationary { update, .. } => update,
        }
    }

    /// Writes its samples into a map.
    pub(super) fn load(&self, map: &mut Galpixmap<'_, Dynamic>) -> LoadTally {
        let offset = |sample: usize| match self {
            Self::Moving(_) => [0.0; 2],
            Self::Stationary { offsets, .. } => offsets.get(sample).copied().unwrap_or_default(),
        };
        load_at(self.update(), offset, map)
    }
}

/// The memory of a layer.
pub(super) struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    composited: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    /// For a layer over a grid.
    pub fn new(grid: &Grid<'_>, format: Dynamic, hidden: &HiddenLayer<'_>) -> Self {
        let map = || vec![0; Galpixmap::words(grid, format)];
        let winners = vec![0; grid.cells() as usize];
        let composited = vec![0; composite_words(grid)];
        match hidden {
            HiddenLayer::Moving(_) => {
                let edges = vec![0; stages::words(grid)];
                Self { maps: [map(), map(), Vec::new()], winners, edges, composited, displacements: Vec::new() }
            }
            HiddenLayer::Stationary { displacements, .. } => {
                let displacements = displacements.iter().map(|&place| displacement_word(place)).collect();
                Self { maps: [map(), map(), map()], winners, edges: Vec::new(), composited, displacements }
            }
        }
    }

    /// Returns the layer over this memory, still empty.
    ///
    /// *Errors:* a stationary-source layer with fewer displacements than cells.
    pub fn layer<'p>(&'p mut self, grid: Grid<'p>, format: Dynamic) -> Result<Layer<'p, Dynamic>, SetupError> {
        let Self { maps: [front, back, stored], winners, edges, composited, displacements } = self;
        let (front, back) = (Galpixmap::new(grid, format, front)?, Galpixmap::new(grid, format, back)?);
        if stored.is_empty() {
            return Layer::new(front, back, Scratch { winners, edges }, composited);
        }
        let stored = Galpixmap::new(grid, format, stored)?;
        Layer::stationary(Stationary { stored, displacements }, front, back, winners, composited)
    }
}
