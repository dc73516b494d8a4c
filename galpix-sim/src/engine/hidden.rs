//! What is handed over beside an update, and the memory that it takes as layers of the core.

use galpix_core::edge;
use galpix_core::error::SetupError;
use galpix_core::frame::Scratch;
use galpix_core::galpixel::{Budget, Chosen};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layers::{Displacement, Layer, displacement_word, seat_words};
use galpix_core::layout::Layout;

use super::{LoadTally, load_at};
use crate::update::Update;

/// A layer beside the update, over the same cells.
#[derive(Clone, Copy, Debug)]
pub enum Beside<'u> {
    /// Its samples are where they are seen, and move like the update's.
    Moving(&'u Update),
    /// Its samples are stored elsewhere, see [`Layer::anchored`].
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
    pub(super) fn load<L: Layout, B: Budget<L>>(&self, map: &mut Galpixmap<'_, L, B>) -> LoadTally {
        let offset = |sample: usize| match self {
            Self::Moving(_) => [0.0; 2],
            Self::Anchored { offsets, .. } => offsets.get(sample).copied().unwrap_or_default(),
        };
        load_at(self.update(), offset, map)
    }
}

/// The memory of a layer.
#[derive(Default)]
pub(super) struct Memory {
    maps: [Vec<u32>; 3],
    winners: Vec<u32>,
    edges: Vec<u32>,
    seats: Vec<u32>,
    displacements: Vec<u32>,
}

impl Memory {
    /// For a layer over a grid; for one that is not there too.
    pub fn new<L: Layout, B: Budget<L>>(grid: &Grid<'_>, budget: B, beside: Option<&Beside<'_>>) -> Self {
        let map = || vec![0; Galpixmap::<L, B>::words(grid, budget)];
        let winners = vec![0; grid.cells() as usize];
        let seats = vec![0; seat_words(grid)];
        match beside {
            None => Self { maps: [map(), map(), Vec::new()], seats, ..Self::default() },
            Some(Beside::Moving(_)) => {
                let edges = vec![0; edge::words(grid)];
                Self { maps: [map(), map(), Vec::new()], winners, edges, seats, displacements: Vec::new() }
            }
            Some(Beside::Anchored { displacements, .. }) => {
                let displacements = displacements.iter().map(|&place| displacement_word(place)).collect();
                Self { maps: [map(), map(), map()], winners, edges: Vec::new(), seats, displacements }
            }
        }
    }

    /// The layer over this memory, still empty.
    ///
    /// *Errors:* an anchored layer with fewer displacements than cells.
    pub fn layer<'p, L: Layout>(
        &'p mut self,
        grid: Grid<'p>,
        budget: Chosen<L>,
    ) -> Result<Layer<'p, L, Chosen<L>>, SetupError> {
        let Self { maps: [front, back, stored], winners, edges, seats, displacements } = self;
        let (front, back) = (Galpixmap::new(grid, budget, front)?, Galpixmap::new(grid, budget, back)?);
        if stored.is_empty() {
            return Layer::new(front, back, Scratch { winners, edges }, seats);
        }
        Layer::anchored(Galpixmap::new(grid, budget, stored)?, displacements, front, back, winners, seats)
    }
}
