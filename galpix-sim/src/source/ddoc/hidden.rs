//! The DDOC image of a built-in scene, as galpixels: what an update would carry besides the plain picture.

use galpix_core::SetupError;
use galpix_core::ddoc::{Settings, Tally};

use super::distortion::{self, Memory, depth_word};
use super::raster::{Pin, Raster};
use super::sheet::{self, Lattice, Node};
use crate::source::scene::{self, Scene};
use crate::update::Sample;

/// One cell of a DDOC image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenSample {
    /// Column and row of the map, margin included, in which the DDOC image holds it: (u_d, v_d).
    pub cell: [i32; 2],
    /// Colour, depth and motion of the surface's point, exact at its own place.
    pub sample: Sample,
    /// Where it is in the plain picture, if it were visible there: (u_u, v_u), in cells of the same map.
    pub place: [f64; 2],
    /// Whether the plain picture does not show it.
    pub hidden: bool,
}

impl HiddenSample {
    /// From the cell where it is stored to the cell where it is drawn: whole cells.
    #[must_use]
    pub fn displacement(&self) -> [i32; 2] {
        [0, 1].map(|axis: usize| self.place[axis].round() as i32 - self.cell[axis])
    }

    /// Returns where in the cell in which it is drawn it is: -1/2 to 1/2.
    #[must_use]
    pub fn offset(&self) -> [f64; 2] {
        self.place.map(|coordinate| coordinate - coordinate.round())
    }

    /// [`Self::displacement`] as one word: x in the low, y in the high 16 bits, both signed.
    #[must_use]
    pub fn displacement_word(&self) -> u32 {
        let [x, y] = self.displacement().map(|cells| u32::from(cells as i16 as u16));
        x | y << 16
    }
}

/// Nodes of a mesh a pixel: denser than the picture, so that what is moved apart stays closed.
const DENSITY: usize = 2;

/// Returns the DDOC image of `scene` at its update, t = 0, over its whole map, margin included: one sample for each
/// cell in which it has anything, row by row. Depths of `settings` are words of [`distortion::DEPTH_BITS`].
///
/// *Errors:* a scene that is too large for a map.
pub fn hidden(scene: &dyn Scene, settings: &Settings) -> Result<(Vec<HiddenSample>, Tally), SetupError> {
    let update = scene::update(scene, 0.0);
    let (width, height) = (update.width, update.height);
    let depths: Vec<u32> = update.samples.iter().map(|sample| depth_word(1.0 - sample.depth)).collect();
    let mut memory = Memory::default();
    let (map, tally) = memory.map(width, &depths, settings)?;

    // From the display's places to the map's.
    let corner = [update.margin.left as f64, update.margin.top as f64];
    let size = [width, height].map(|cells| (cells - 1) * DENSITY + 1);
    let lattice = Lattice { first: corner.map(|wing| -wing), step: 1.0 / DENSITY as f64, size };
    // Carried: by how much a node was moved, its surface, its side.
    let mut raster = Raster::<4>::new(width, height);
    for (index, surface) in scene.surfaces().iter().enumerate() {
        sheet::triangles(*surface, &lattice, 0.0, |nodes| {
            let pin = |node: &Node| {
                let at = [node.at[0] + corner[0], node.at[1] + corner[1]];
                let [x, y] = distortion::displacement(&map, at, depth_word(1.0 - node.hit.depth));
                // Depth 1 is infinitely far, but still a surface.
                let nearness = (1.0 - node.hit.depth).max(1e-9);
                let carried = [x as f32, y as f32, index as f32, f32::from(u8::from(node.back))];
                Pin { at: [at[0] + x, at[1] + y], nearness, carried }
            };
            let [a, b, c] = nodes.map(pin);
            raster.draw([&a, &b, &c]);
        });
    }

    let mut samples = Vec::new();
    for (cell, (&nearness, carried)) in raster.nearness.iter().zip(&raster.carried).enumerate() {
        if nearness <= 0.0 {
            continue;
        }
        let cell = [(cell % width) as i32, (cell / width) as i32];
        let [x, y, index, back] = *carried;
        let place = [f64::from(cell[0]) - f64::from(x), f64::from(cell[1]) - f64::from(y)];
        let (index, back) = (index.round() as usize, back > 0.5);
        let on_display = [place[0] - corner[0], place[1] - corner[1]];
        // A rim between two nodes may miss its surface by a hair.
        let Some(sample) = scene::sample_of(scene, index, back, on_display, 0.0) else { continue };
        let seen = scene.sample(on_display[0], on_display[1], 0.0);
        let hidden = seen.tag != sample.tag || back;
        samples.push(HiddenSample { cell, sample, place, hidden });
    }
    Ok((samples, tally))
}
