//! The memory of the base.

use galpix_core::edge;
use galpix_core::frame::{Controller, Scratch};
use galpix_core::galpixel::Chosen;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layout::Layout;

use super::EngineError;
use super::load::{core_wings, grid};
use crate::update::Update;

/// The memory of the base.
pub(super) struct Base {
    pub starts: Vec<u32>,
    front: Vec<u32>,
    back: Vec<u32>,
    winners: Vec<u32>,
    edges: Vec<u32>,
}

impl Base {
    pub fn new<L: Layout>(update: &Update, budget: Chosen<L>) -> Result<Self, EngineError> {
        let mut starts = vec![0; Grid::rows(update.display_height() as u32, core_wings(update.wings))];
        let grid = grid(update, &mut starts)?;
        let words = Galpixmap::<L, _>::words(&grid, budget);
        let (winners, edges) = (vec![0; grid.cells() as usize], vec![0; edge::words(&grid)]);
        Ok(Self { starts, front: vec![0; words], back: vec![0; words], winners, edges })
    }

    pub fn controller<'p, L: Layout>(
        &'p mut self,
        update: &Update,
        budget: Chosen<L>,
    ) -> Result<Controller<'p, L, Chosen<L>>, EngineError> {
        let grid = grid(update, &mut self.starts)?;
        Ok(Controller::new(
            Galpixmap::new(grid, budget, &mut self.front)?,
            Galpixmap::new(grid, budget, &mut self.back)?,
            Scratch { winners: &mut self.winners, edges: &mut self.edges },
        )?)
    }
}
