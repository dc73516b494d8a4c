//! The distortion map of a depth discontinuity occlusion camera, from a plane of depths.

use galpix_sim::source::ddoc::distortion::{self as plane, Memory, depth_word};
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::Floats;
use crate::names::value_error;

/// The settings: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Camera {
    radius: u32,
    asymmetry: u32,
    threshold: Option<u32>,
    window: u32,
}

/// (edges, splats, dropped, shrunk, orphans, distorted).
type Counted = (u32, u32, u32, u32, u32, u32);

/// Returns by how much what is hidden at each pixel is moved in x and y, (rows, columns, 2), and what was counted.
#[pyfunction]
pub fn distortion<'py>(
    py: Python<'py>,
    depth: Floats<'_>,
    shape: (usize, usize),
    camera: Camera,
) -> PyResult<(Bound<'py, PyArray3<f64>>, Counted)> {
    let (height, width) = shape;
    let cells = height * width;
    let depth = depth.numbers(cells)?;
    let usual = plane::settings();
    let Camera { radius, asymmetry, threshold, window } = camera;
    let threshold = threshold.unwrap_or(usual.threshold);
    let settings = galpix_core::ddoc::Settings { radius, asymmetry, threshold, window, ..usual };
    let made = py.detach(|| {
        // What is not finite is infinitely far.
        let nearness = |cell: usize| if depth.at(cell).is_finite() { 1.0 - depth.at(cell) } else { 0.0 };
        let depths: Vec<u32> = (0..cells).map(|cell| depth_word(nearness(cell))).collect();
        let mut memory = Memory::default();
        let (map, tally) = memory.map(width, &depths, &settings)?;
        // What is hidden is farther than anything that is seen.
        let moved =
            |cell: usize| plane::displacement(&map, [(cell % width) as f64, (cell / width) as f64], u32::MAX >> 4);
        Ok::<_, galpix_core::SetupError>(((0..cells).flat_map(moved).collect::<Vec<f64>>(), tally))
    });
    let (moved, tally) = made.map_err(value_error)?;
    let galpix_core::ddoc::Tally { edges, splats, dropped, shrunk, orphans, distorted } = tally;
    let moved = PyArray1::from_vec(py, moved).reshape([height, width, 2])?;
    Ok((moved, (edges, splats, dropped, shrunk, orphans, distorted)))
}
