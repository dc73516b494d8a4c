//! An update brought to the size of a panel.
//!
//! The display's centre comes to the panel's centre, and what the panel's shape cannot show is cropped, alike on both
//! sides. A scene is sampled anew at the centre of each cell: exact in position and motion. Of a capture each cell
//! takes the sample that is nearest to its centre, and puts it there: at most half a pixel of the source from its
//! place.
//!
//! That half pixel could be kept in the galpixel's offset. It is not, because neighbours would then stand unevenly,
//! some less than a cell apart, and meet in one cell as soon as they move: of `captures/marbles` on a panel of 128 x
//! 64, 2613 of 8192 galpixels were left after 8 frames, against 6914 at the centres.
//!
//! *Units:* positions of the source in its pixels, (0, 0) the centre of the display's first pixel.

use galpix_core::Galpixel;
use rayon::prelude::*;

use crate::engine;
use crate::source::scene::Scene;
use crate::update::{Sample, Update};

#[cfg(test)]
mod tests;

/// How the cells of a panel lie over the pixels of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    source: [usize; 2],
    panel: [usize; 2],
    scale: f64,
}

impl Fit {
    /// Columns and rows of the source's display and of the panel. Nothing where one of them is 0.
    #[must_use]
    pub fn new(source: [usize; 2], panel: [usize; 2]) -> Option<Self> {
        if source.contains(&0) || panel.contains(&0) {
            return None;
        }
        let scale = (source[0] as f64 / panel[0] as f64).min(source[1] as f64 / panel[1] as f64);
        Some(Self { source, panel, scale })
    }

    /// Returns the pixels of the source in a cell of the panel, along a row or a column.
    #[must_use]
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns where the centre of a cell lies in the source.
    #[must_use]
    pub fn centre(&self, x: usize, y: usize) -> [f64; 2] {
        let along = |axis: usize, cell: usize| {
            let middle = |count: usize| (count as f64 - 1.0) / 2.0;
            middle(self.source[axis]) + (cell as f64 - middle(self.panel[axis])) * self.scale
        };
        [along(0, x), along(1, y)]
    }

    /// Returns the pixel of the source that is nearest to a cell's centre; of two equally near ones the left or upper
    /// one.
    #[must_use]
    pub fn nearest(&self, x: usize, y: usize) -> [usize; 2] {
        let centre = self.centre(x, y);
        [0, 1].map(|axis| ((centre[axis] - 0.5).ceil().max(0.0) as usize).min(self.source[axis] - 1))
    }
}

/// Returns the galpixels of an update on a panel of `width` x `height` cells, row by row; samples whose motion is
/// unknown become empty cells with their colour. No galpixel where the update or the panel is empty.
#[must_use]
pub fn update(update: &Update, width: usize, height: usize) -> Vec<Galpixel> {
    let Some(fit) = Fit::new([update.display_width(), update.display_height()], [width, height]) else {
        return Vec::new();
    };
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    cells
        .map(|(x, y)| {
            let [i, j] = fit.nearest(x, y);
            let index = (j + update.margin.top) * update.width + i + update.margin.left;
            update.samples.get(index).map_or_else(Galpixel::default, |sample| galpixel(sample, fit.scale))
        })
        .collect()
}

/// Returns the galpixels of a scene at time `t` on a panel of `width` x `height` cells, row by row. None where the
/// panel is empty.
#[must_use]
pub fn scene(scene: &dyn Scene, t: f64, width: usize, height: usize) -> Vec<Galpixel> {
    let Some(fit) = Fit::new([scene.width(), scene.height()], [width, height]) else {
        return Vec::new();
    };
    let cell = |x: usize, y: usize| {
        let [i, j] = fit.centre(x, y);
        galpixel(&scene.sample(i, j, t), fit.scale)
    };
    (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| cell(x, y))).collect()
}

/// Returns a sample at the centre of a cell, its motion in cells of `scale` pixels.
fn galpixel(sample: &Sample, scale: f64) -> Galpixel {
    let scaled = |[x, y, depth]: [f64; 3]| [x / scale, y / scale, depth];
    engine::galpixel(&Sample {
        velocity: scaled(sample.velocity),
        acceleration: scaled(sample.acceleration),
        ..*sample
    })
}
