//! Arrays of an update as samples, and samples as arrays.

use galpix_sim::update::{DepthKind, Known, Margin, Sample, Update};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Floats, Numbers, optional, slice};
use crate::names::value_error;

/// Columns left and right of the display, rows above and below it.
pub type MarginCells = (usize, usize, usize, usize);

/// What an update has of each cell, row by row: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct UpdateArrays<'py> {
    /// Rows and columns, margin included.
    pub shape: (usize, usize),
    /// 3 bytes a cell.
    colour: PyReadonlyArrayDyn<'py, u8>,
    depth: Option<Floats<'py>>,
    /// 2 or 3 numbers a cell.
    velocity: Option<Floats<'py>>,
    velocity_components: usize,
    /// 2 or 3 numbers a cell.
    acceleration: Option<Floats<'py>>,
    acceleration_components: usize,
    luminosity_rate: Option<Floats<'py>>,
    tag: Option<PyReadonlyArrayDyn<'py, u32>>,
    /// Not 0 where depth and motion are known.
    known: Option<PyReadonlyArrayDyn<'py, u8>>,
}

/// What an update has of each cell, as slices.
pub struct Cells<'a> {
    colour: &'a [[u8; 3]],
    depth: Option<Numbers<'a>>,
    velocity: Option<(Numbers<'a>, usize)>,
    acceleration: Option<(Numbers<'a>, usize)>,
    luminosity_rate: Option<Numbers<'a>>,
    tag: Option<&'a [u32]>,
    known: Option<&'a [u8]>,
}

impl UpdateArrays<'_> {
    /// Returns how many cells there are.
    pub const fn count(&self) -> usize {
        self.shape.0 * self.shape.1
    }

    /// Returns the slices.
    pub fn cells(&self) -> PyResult<Cells<'_>> {
        let count = self.count();
        let with = |components: usize, array| {
            optional(array, components * count).map(|numbers| numbers.map(|numbers| (numbers, components)))
        };
        Ok(Cells {
            colour: slice(&self.colour, 3 * count)?.as_chunks().0,
            depth: optional(self.depth.as_ref(), count)?,
            velocity: with(self.velocity_components, self.velocity.as_ref())?,
            acceleration: with(self.acceleration_components, self.acceleration.as_ref())?,
            luminosity_rate: optional(self.luminosity_rate.as_ref(), count)?,
            tag: self.tag.as_ref().map(|tag| slice(tag, count)).transpose()?,
            known: self.known.as_ref().map(|known| slice(known, count)).transpose()?,
        })
    }
}

impl Cells<'_> {
    /// Returns how many there are.
    pub const fn len(&self) -> usize {
        self.colour.len()
    }

    /// Returns the tag of a cell.
    pub fn tag(&self, cell: usize) -> u32 {
        self.tag.map_or(0, |tag| tag[cell])
    }

    /// Returns a cell as a sample. What is not finite is not known.
    pub fn sample(&self, cell: usize) -> Sample {
        let vector = |array: &Option<(Numbers<'_>, usize)>| {
            let mut vector = [0.0; 3];
            if let Some((numbers, components)) = array {
                for (axis, value) in vector.iter_mut().enumerate().take(*components) {
                    *value = numbers.at(components * cell + axis);
                }
            }
            vector
        };
        let scalar = |array: &Option<Numbers<'_>>| array.map_or(0.0, |numbers| numbers.at(cell));
        let (depth, velocity, acceleration) = (scalar(&self.depth), vector(&self.velocity), vector(&self.acceleration));
        let luminosity_rate = scalar(&self.luminosity_rate);
        let finite = depth.is_finite()
            && luminosity_rate.is_finite()
            && velocity.iter().chain(&acceleration).all(|number| number.is_finite());
        let known = finite && self.known.is_none_or(|known| known[cell] != 0);
        if !known {
            return Sample { colour: self.colour[cell], known: Known::ColourOnly, ..Sample::default() };
        }
        let tag = self.tag(cell) as u8;
        Sample { colour: self.colour[cell], known: Known::Motion, depth, velocity, acceleration, luminosity_rate, tag }
    }
}

/// Returns the kind of a depth by its name.
pub fn depth_kind(name: &str) -> PyResult<DepthKind> {
    match name {
        "z" => Ok(DepthKind::Z),
        "disparity" => Ok(DepthKind::Disparity),
        "speed" => Ok(DepthKind::Speed),
        _ => Err(value_error(format!("`depth_kind` is '{name}': give one of z, disparity, speed"))),
    }
}

/// Returns arrays as an update of the simulator.
pub fn update(arrays: &UpdateArrays<'_>, margin: MarginCells, kind: &str) -> PyResult<Update> {
    let cells = arrays.cells()?;
    let (height, width) = arrays.shape;
    let (left, right, top, bottom) = margin;
    if left.saturating_add(right) >= width || top.saturating_add(bottom) >= height {
        return Err(value_error("`margin` leaves nothing of the picture: give fewer cells, or a larger picture"));
    }
    Ok(Update {
        width,
        height,
        margin: Margin { left, right, top, bottom },
        samples: (0..cells.len()).map(|cell| cells.sample(cell)).collect(),
        depth_kind: depth_kind(kind)?,
        overlay: None,
    })
}

/// Returns an update as arrays, by their names.
pub fn arrays<'py>(py: Python<'py>, update: &Update) -> PyResult<Bound<'py, PyDict>> {
    let (height, width) = (update.height, update.width);
    let samples = &update.samples;
    let dict = PyDict::new(py);
    let colour: Vec<u8> = samples.iter().flat_map(|sample| sample.colour).collect();
    dict.set_item("colour", PyArray1::from_vec(py, colour).reshape([height, width, 3])?)?;
    let plane = |value: &dyn Fn(&Sample) -> f64| {
        PyArray1::from_vec(py, samples.iter().map(value).collect()).reshape([height, width])
    };
    let vectors = |value: &dyn Fn(&Sample) -> [f64; 3]| {
        PyArray1::from_vec(py, samples.iter().flat_map(value).collect()).reshape([height, width, 3])
    };
    dict.set_item("depth", plane(&|sample| sample.depth)?)?;
    dict.set_item("velocity", vectors(&|sample| sample.velocity)?)?;
    dict.set_item("acceleration", vectors(&|sample| sample.acceleration)?)?;
    dict.set_item("luminosity_rate", plane(&|sample| sample.luminosity_rate)?)?;
    let tag: Vec<u8> = samples.iter().map(|sample| sample.tag).collect();
    dict.set_item("tag", PyArray1::from_vec(py, tag).reshape([height, width])?)?;
    let known: Vec<bool> = samples.iter().map(|sample| sample.known == Known::Motion).collect();
    dict.set_item("known", PyArray1::from_vec(py, known).reshape([height, width])?)?;
    let Margin { left, right, top, bottom } = update.margin;
    dict.set_item("margin", (left, right, top, bottom))?;
    let kind = match update.depth_kind {
        DepthKind::Z => "z",
        DepthKind::Disparity => "disparity",
        DepthKind::Speed => "speed",
    };
    dict.set_item("depth_kind", kind)?;
    Ok(dict)
}
