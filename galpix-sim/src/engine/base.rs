//! The memory of the base.

use galpix_core::{Controller, Dynamic, Galpixmap, Grid, Scratch, stages};

use super::EngineError;
use super::load::{grid, margin};
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
    pub fn new(update: &Update, format: Dynamic) -> Result<Self, EngineError> {
        let mut starts = vec![0; Grid::rows(update.display_height() as u32, margin(update.margin))];
        let grid = grid(update, &mut starts)?;
        let words = Galpixmap::words(&grid, format);
        let (winners, edges) = (vec![0; grid.cells() as usize], vec![0; stages::words(&grid)]);
        Ok(Self { starts, front: vec![0; words], back: vec![0; words], winners, edges })
    }

    pub fn controller<'p>(
        &'p mut self,
        update: &Update,
        format: Dynamic,
    ) -> Result<Controller<'p, Dynamic>, EngineError> {
        let grid = grid(update, &mut self.starts)?;
        Ok(Controller::new(
            Galpixmap::new(grid, format, &mut self.front)?,
            Galpixmap::new(grid, format, &mut self.back)?,
            Scratch { winners: &mut self.winners, edges: &mut self.edges },
        )?)
    }
}
