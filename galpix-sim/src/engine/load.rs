//! An update as galpixels of a map.

use fixed::types::I32F32;
use galpix_core::{Class, Format, Galpixel, Galpixmap, Grid, Margin, SetupError};

use crate::update::{self, Known, Sample, Update};

/// What entered with the update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct LoadTally {
    /// Cells with a galpixel.
    pub galpixels: u32,
    /// Cells that start empty because depth or motion is unknown.
    pub empty: u32,
    /// Fields that had to be clamped to their range.
    pub saturated: u32,
}

/// Writes the samples of an update into a map, quantised to its budget.
pub fn load<F: Format>(update: &Update, map: &mut Galpixmap<'_, F>) -> LoadTally {
    load_at(update, |_| [0.0; 2], map)
}

/// Returns the same with samples that are not in the middle of their cells.
pub(super) fn load_at<F: Format>(
    update: &Update,
    offset: impl Fn(usize) -> [f64; 2],
    map: &mut Galpixmap<'_, F>,
) -> LoadTally {
    let mut tally = LoadTally::default();
    let width = update.width.max(1);
    for (cell, sample) in update.samples.iter().enumerate() {
        match sample.known {
            Known::Motion => tally.galpixels += 1,
            Known::ColourOnly => tally.empty += 1,
        }
        let offset = offset(cell).map(I32F32::saturating_from_num);
        let galpixel = Galpixel { offset, ..galpixel(sample) };
        tally.saturated += map.store((cell % width) as i32, (cell / width) as i32, &galpixel).unwrap_or(0);
    }
    tally
}

/// Returns a sample as a galpixel in fixed point: 32 fraction bits, so that the rounding that counts is the budget's.
#[must_use]
pub fn galpixel(sample: &Sample) -> Galpixel {
    if sample.known == Known::ColourOnly {
        return Galpixel { class: Class::Empty, colour: sample.colour, ..Galpixel::default() };
    }
    Galpixel {
        class: Class::Galpixel,
        colour: sample.colour,
        offset: [I32F32::ZERO; 2],
        depth: I32F32::saturating_from_num(sample.depth),
        velocity: sample.velocity.map(I32F32::saturating_from_num),
        acceleration: sample.acceleration.map(I32F32::saturating_from_num),
        luminosity_rate: I32F32::saturating_from_num(sample.luminosity_rate),
        tag: u32::from(sample.tag),
    }
}

/// Converts the margin of an update to that of a grid.
pub(crate) fn margin(margin: update::Margin) -> Margin {
    let cells = |cells: usize| u32::try_from(cells).unwrap_or(u32::MAX);
    Margin {
        left: cells(margin.left),
        right: cells(margin.right),
        top: cells(margin.top),
        bottom: cells(margin.bottom),
    }
}

/// Returns the grid of an update.
pub(crate) fn grid<'g>(update: &Update, starts: &'g mut [u32]) -> Result<Grid<'g>, SetupError> {
    let (width, height) = (update.display_width() as u32, update.display_height() as u32);
    Grid::new(width, height, margin(update.margin), starts)
}
