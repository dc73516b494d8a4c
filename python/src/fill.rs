//! Fills of a plain image by a fill mode of the core.

use fixed::types::I32F32;
use galpix_core::stages::{self, NO_WINNER};
use galpix_core::{Class, Dynamic, Format, Galpixel, Galpixmap, Grid, Margin, Scratch, Settings, SetupError, Tally};
use galpix_sim::engine::fill::Fill;
use numpy::{PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Floats, Numbers, optional, slice};
use crate::bits::{BudgetWidths, LayoutFields, format};
use crate::map::{Counts, counts};
use crate::names::{self, value_error};

/// The frame before, and what of it arrived: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Arrived<'py> {
    budget: BudgetWidths,
    layout: LayoutFields,
    fill: String,
    reach: u32,
    edge_threshold: Option<u32>,
    /// The image: (rows, columns, 3) bytes; the result is written here too.
    image: PyReadwriteArrayDyn<'py, u8>,
    mask: PyReadonlyArrayDyn<'py, u8>,
    depth: Option<Floats<'py>>,
    /// (rows, columns, 2), written too.
    velocity: Option<PyReadwriteArrayDyn<'py, f64>>,
}

/// Fills the holes of an image of galpixels that stand still for this frame by a fill mode of the core, in place.
#[pyfunction]
pub fn fill_mode(py: Python<'_>, arrived: Arrived<'_>) -> PyResult<Counts> {
    let Arrived { budget, layout, fill, reach, edge_threshold, mut image, mask, depth, mut velocity } = arrived;
    let format = format(&budget, &layout)?;
    let (height, width) = (image.shape()[0], image.shape()[1]);
    let cells = height * width;
    let mask = slice(&mask, cells)?;
    let depth = optional(depth.as_ref(), cells)?;
    let bytes = image.as_slice_mut()?;
    let velocity = velocity.as_mut().map(|velocity| velocity.as_slice_mut()).transpose()?;
    let Fill::Mode(fill_mode) = names::fill(&fill, None)? else {
        return Err(value_error(format!("`method` is '{fill}': it inpaints and is no fill mode")));
    };
    let depth_bits = u32::from(format.record().depth().bits);
    let usual = Settings::for_depth(depth_bits);
    let edge_threshold = edge_threshold.unwrap_or(usual.edge_threshold);
    let settings = Settings { fill_mode, reach, edge_threshold, ..usual };
    let tally = py.detach(|| filled(format, [width, height], &settings, Image { bytes, mask, depth, velocity }));
    Ok(counts(&tally.map_err(value_error)?))
}

/// What is filled.
struct Image<'a> {
    bytes: &'a mut [u8],
    mask: &'a [u8],
    depth: Option<Numbers<'a>>,
    velocity: Option<&'a mut [f64]>,
}

fn filled(
    format: Dynamic,
    [width, height]: [usize; 2],
    settings: &Settings,
    image: Image<'_>,
) -> Result<Tally, SetupError> {
    let Image { bytes, mask, depth, mut velocity } = image;
    let (columns, rows) = (u32::try_from(width).unwrap_or(u32::MAX), u32::try_from(height).unwrap_or(u32::MAX));
    let mut starts = vec![0; height];
    let grid = Grid::new(columns, rows, Margin::NONE, &mut starts)?;
    let words = Galpixmap::<Dynamic>::words(&grid, format);
    let (mut before, mut after) = (vec![0; words], vec![0; words]);
    let mut before = Galpixmap::new(grid, format, &mut before)?;
    let mut after = Galpixmap::new(grid, format, &mut after)?;
    let (mut winners, mut edges) = (vec![NO_WINNER; mask.len()], vec![0; stages::words(&grid)]);
    let place = |cell: usize| ((cell % width) as i32, (cell / width) as i32);
    for (cell, colour) in bytes.as_chunks::<3>().0.iter().enumerate() {
        let (x, y) = place(cell);
        let depth = depth.map_or(0.0, |depth| depth.at(cell));
        let [vx, vy] = velocity.as_deref().map_or([0.0; 2], |velocity| [velocity[2 * cell], velocity[2 * cell + 1]]);
        let known = depth.is_finite() && vx.is_finite() && vy.is_finite();
        let number = I32F32::saturating_from_num::<f64>;
        let galpixel = match known {
            true => Galpixel {
                colour: *colour,
                depth: number(depth),
                velocity: [number(vx), number(vy), I32F32::ZERO],
                ..Galpixel::default()
            },
            false => Galpixel { class: Class::Empty, colour: *colour, ..Galpixel::default() },
        };
        before.store(x, y, &galpixel);
        if mask[cell] == 0 && known {
            after.store(x, y, &galpixel);
            winners[cell] = cell as u32;
        }
    }
    let mut tally = Tally::default();
    if settings.fill_mode.uses_edges() {
        tally.edges = stages::mark(&before, settings.edge_threshold, &mut edges);
    }
    let mut scratch = Scratch { winners: &mut winners, edges: &mut edges };
    stages::fill(&before, &mut after, &mut scratch, settings, &mut tally);
    for (cell, &hole) in mask.iter().enumerate() {
        if hole == 0 {
            continue;
        }
        let (x, y) = place(cell);
        let galpixel = after.load(x, y).unwrap_or_default();
        bytes[3 * cell..][..3].copy_from_slice(&galpixel.colour);
        if let Some(velocity) = &mut velocity {
            let [vx, vy, _] = galpixel.velocity.map(|v| v.to_num::<f64>());
            velocity[2 * cell..][..2].copy_from_slice(&[vx, vy]);
        }
    }
    Ok(tally)
}
