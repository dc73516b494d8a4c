//! The core's inpainting over memory of the host.

use galpix_core::inpaint::features::Workspace;
use galpix_core::inpaint::levels;
use galpix_core::inpaint::metamer::{self, Recipe};
use galpix_core::inpaint::needs;
use galpix_core::inpaint::noise::Tiles;
use galpix_core::inpaint::paint::Moving;
use galpix_core::inpaint::push_pull::Rule;
use galpix_core::inpaint::pyramid::{Cell, DEPTH_BITS, Pyramid, state_words};
use galpix_core::inpaint::statistics::Moments;
use galpix_core::inpaint::tone::Tone;
use galpix_core::{Format, Grid, Inpainting, Settings};

use super::{Inpaint, Kind, in_fovea};
use crate::engine::Show;

/// Inpaints maps of one grid, frame by frame.
pub struct Inpainter {
    inpaint: Inpaint,
    size: [u32; 2],
    memory: Memory,
    /// A bit for each cell that is worth it; empty for all.
    mask: Vec<u32>,
}

/// What is lent to the core.
enum Memory {
    PushPull {
        cells: Vec<Cell<Moving>>,
        states: Vec<u32>,
    },
    Metamer {
        recipe: Recipe,
        tones: Vec<Cell<Tone>>,
        moments: Vec<Cell<Moments>>,
        states: [Vec<u32>; 2],
        needs: Vec<needs::Tile>,
        workspace: Box<Workspace>,
        noise: Box<Tiles>,
    },
}

impl Memory {
    fn new(kind: Kind, [width, height]: [u32; 2]) -> Self {
        let count = levels::cells(width, height);
        let states = || vec![0; state_words(count)];
        match kind {
            Kind::PushPull => Self::PushPull { cells: vec![Cell::unknown(Moving::default()); count], states: states() },
            Kind::Metamer => {
                // Rule and age are the controller's.
                let recipe = Recipe::new(0, 0);
                Self::Metamer {
                    recipe,
                    tones: vec![Cell::unknown(Tone::default()); count],
                    moments: vec![Cell::unknown(Moments::default()); count],
                    states: [states(), states()],
                    needs: vec![needs::Tile::default(); needs::tiles(width, height, recipe.levels)],
                    workspace: Box::new(Workspace::new()),
                    noise: Box::default(),
                }
            }
        }
    }
}

impl Inpainter {
    /// For maps over this grid.
    #[must_use]
    pub fn new(grid: &Grid<'_>, inpaint: Inpaint) -> Self {
        let size = [grid.width(), grid.height()];
        let mask = inpaint.fovea.map_or_else(Vec::new, |radius| around(grid, radius));
        let memory = Memory::new(inpaint.kind, size);
        Self { inpaint, size, memory, mask }
    }

    /// Inpaints what the last step uncovered, which was made with `settings`.
    pub fn paint<'p, F: Format>(&mut self, show: &mut impl Show<'p, F>, settings: &Settings) {
        let depth_bits = u32::from(show.front().record().depth().bits);
        let inpainting = if self.inpaint.depth_aware {
            let threshold = settings.edge_threshold >> depth_bits.saturating_sub(DEPTH_BITS);
            let rule = Rule { gamma: self.inpaint.gamma, threshold };
            Inpainting { rule, quads: true, mask: &self.mask }
        } else {
            let classic = Inpainting::classic();
            Inpainting { rule: Rule { gamma: self.inpaint.gamma, ..classic.rule }, mask: &self.mask, ..classic }
        };
        // Memory of the grid's size is long enough.
        match &mut self.memory {
            Memory::PushPull { cells, states } => {
                if let Ok(mut pyramid) = Pyramid::new(self.size[0], self.size[1], cells, states) {
                    show.inpaint(settings, &inpainting, &mut pyramid);
                }
            }
            Memory::Metamer { recipe, tones, moments, states: [of_tones, of_moments], needs, workspace, noise } => {
                let states: [&mut [u32]; 2] = [of_tones, of_moments];
                let mut scratch = metamer::Scratch { tones, moments, states, needs, workspace, noise };
                let done = show.synthesise(settings, &inpainting, recipe, &mut scratch);
                debug_assert!(done.is_ok(), "{done:?}");
            }
        }
    }
}

/// A bit for each cell of a map that is on the display and outside of the fovea, or in the wings.
fn around(grid: &Grid<'_>, radius: u32) -> Vec<u32> {
    let margin = grid.margin();
    let (width, height) = (grid.display_width() as usize, grid.display_height() as usize);
    let mut mask = vec![u32::MAX; grid.cells().div_ceil(u32::BITS) as usize];
    for cell in (0..width * height).filter(|&cell| in_fovea(Some(radius), cell, width, height)) {
        let (x, y) = ((cell % width) as u32 + margin.left, (cell / width) as u32 + margin.top);
        if let Some(cell) = grid.cell(x as i32, y as i32) {
            mask[(cell / u32::BITS) as usize] &= !(1 << (cell % u32::BITS));
        }
    }
    mask
}

#[cfg(test)]
mod tests {
    use galpix_core::Margin;

    use super::*;

    #[test]
    fn only_the_fovea_is_left_out() {
        let margin = Margin { left: 3, right: 0, top: 1, bottom: 2 };
        let mut starts = [0; 8];
        let grid = Grid::new(5, 5, margin, &mut starts).unwrap();
        let mask = around(&grid, 1);
        let left_out: Vec<u32> =
            (0..grid.cells()).filter(|cell| mask[*cell as usize / 32] >> (cell % 32) & 1 == 0).collect();
        // Row 3 of the map is row 2 of the display, columns 3 + 1 .. 3 + 3.
        assert_eq!(left_out, [2 * 8 + 5, 3 * 8 + 4, 3 * 8 + 5, 3 * 8 + 6, 4 * 8 + 5]);
    }
}
