//! The core's inpainting over memory of the host.

use galpix_core::inpaint::{Inpainting, Metamer, MetamerWorkspace, Motion, Picture, PushPull, Recipe};
use galpix_core::{Grid, Maps, Settings};

use super::{Inpaint, Kind, in_fovea};

/// Inpaints maps of one grid, or pictures of all of its cells, frame by frame.
pub struct Inpainter {
    inpaint: Inpaint,
    size: [u32; 2],
    memory: Memory,
    /// A bit for each cell where to inpaint; empty for all.
    mask: Vec<u32>,
}

/// The buffers that the core works in.
enum Memory {
    PushPull(Vec<u32>),
    Metamer(Vec<u32>, Box<MetamerWorkspace>),
}

impl Memory {
    fn new(kind: Kind, [width, height]: [u32; 2]) -> Self {
        match kind {
            Kind::PushPull => Self::PushPull(vec![0; PushPull::words(width, height, Motion::Inpainted)]),
            Kind::Metamer => {
                let words = Metamer::words(width, height, Recipe::default().levels);
                Self::Metamer(vec![0; words], Box::default())
            }
        }
    }
}

impl Inpainter {
    /// Makes an inpainter for maps or pictures over this grid.
    #[must_use]
    pub fn new(grid: &Grid<'_>, inpaint: Inpaint) -> Self {
        let size = [grid.width(), grid.height()];
        let mask = inpaint.fovea.map_or_else(Vec::new, |radius| around(grid, radius));
        let memory = Memory::new(inpaint.kind, size);
        Self { inpaint, size, memory, mask }
    }

    /// Inpaints what the last step uncovered, which was made with `settings`.
    pub fn paint<'p>(&mut self, maps: &mut impl Maps<'p>, settings: &Settings) {
        let depth_bits = u32::from(maps.shown().record().depth().bits);
        let Self { inpaint, size: [width, height], memory, mask } = self;
        let inpainting = inpainting(*inpaint, [settings.edge_threshold, depth_bits], mask);
        let (width, height) = (*width, *height);
        // Memory of the grid's size is long enough.
        match memory {
            Memory::PushPull(words) => {
                if let Ok(mut push_pull) = PushPull::new(width, height, Motion::Inpainted, words) {
                    maps.inpaint(settings, &inpainting, &mut push_pull);
                }
            }
            Memory::Metamer(words, workspace) => {
                if let Ok(mut metamer) = Metamer::new(width, height, Recipe::default(), words, workspace) {
                    let done = maps.synthesise(settings, &inpainting, &mut metamer);
                    debug_assert!(done.is_ok(), "{done:?}");
                }
            }
        }
    }

    /// Inpaints the holes of a picture by an edge threshold for its depths of so many bits. `moved` is that of
    /// [`Metamer::fill_picture`].
    pub fn paint_picture(&mut self, picture: &mut Picture<'_>, threshold: [u32; 2], moved: &[u32]) {
        let Self { inpaint, size: [width, height], memory, mask } = self;
        let inpainting = inpainting(*inpaint, threshold, mask);
        match memory {
            Memory::PushPull(words) => {
                if let Ok(mut push_pull) = PushPull::new(*width, *height, Motion::Kept, words) {
                    push_pull.fill_picture(picture, &inpainting);
                }
            }
            Memory::Metamer(words, workspace) => {
                if let Ok(mut metamer) = Metamer::new(*width, *height, Recipe::default(), words, workspace) {
                    let done = metamer.fill_picture(picture, &inpainting, moved);
                    debug_assert!(done.is_ok(), "{done:?}");
                }
            }
        }
    }
}

/// Returns how to inpaint by an edge threshold for depths of so many bits.
const fn inpainting(inpaint: Inpaint, [edge_threshold, depth_bits]: [u32; 2], mask: &[u32]) -> Inpainting<'_> {
    let inpainting = if inpaint.depth_aware {
        Inpainting::for_edge_threshold(edge_threshold, depth_bits, inpaint.gamma)
    } else {
        Inpainting { gamma: inpaint.gamma, ..Inpainting::classic() }
    };
    Inpainting { mask, ..inpainting }
}

/// Returns a bit for each cell of a map that is on the display and outside of the fovea, or in the margin.
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
