//! How far a picture is from the truth, by the simulator's metrics.

use galpix_sim::metric;
use galpix_sim::picture::Picture;
use numpy::{PyReadonlyArray3, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::names::value_error;

/// A picture of (rows, columns, 3) bytes.
type Bytes<'py> = PyReadonlyArray3<'py, u8>;
/// A byte for each pixel, row by row: not 0 where it counts.
type Counted<'py> = PyReadonlyArrayDyn<'py, u8>;

type Metric = fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>;

/// Copies a picture, which the simulator owns.
pub fn picture(array: &Bytes<'_>) -> PyResult<Picture> {
    let (height, width) = (array.shape()[0], array.shape()[1]);
    let pixels = array.as_slice()?.as_chunks().0.to_vec();
    Ok(Picture { width, height, pixels })
}

fn measured(
    py: Python<'_>,
    metric: Metric,
    [shown, truth]: [&Bytes<'_>; 2],
    counted: Option<Counted<'_>>,
) -> PyResult<f64> {
    let (shown, truth) = (picture(shown)?, picture(truth)?);
    let counted: Option<Vec<bool>> = match &counted {
        Some(mask) => Some(mask.as_slice()?.iter().map(|&byte| byte != 0).collect()),
        None => None,
    };
    let value = py.detach(|| metric(&shown, &truth, counted.as_deref()));
    value.ok_or_else(|| value_error("no pixel counts: give pictures with a pixel, and a mask that is true for one"))
}

/// Peak signal-to-noise ratio, dB.
#[pyfunction]
pub fn psnr(py: Python<'_>, shown: Bytes<'_>, truth: Bytes<'_>, counted: Option<Counted<'_>>) -> PyResult<f64> {
    measured(py, metric::psnr_db, [&shown, &truth], counted)
}

/// Structural similarity.
#[pyfunction]
pub fn ssim(py: Python<'_>, shown: Bytes<'_>, truth: Bytes<'_>, counted: Option<Counted<'_>>) -> PyResult<f64> {
    measured(py, metric::ssim, [&shown, &truth], counted)
}

/// Mean FLIP.
#[pyfunction]
pub fn flip(py: Python<'_>, shown: Bytes<'_>, truth: Bytes<'_>, counted: Option<Counted<'_>>) -> PyResult<f64> {
    measured(py, metric::flip, [&shown, &truth], counted)
}

/// SSIMULACRA2 of whole pictures.
#[pyfunction]
pub fn ssimulacra2(py: Python<'_>, shown: Bytes<'_>, truth: Bytes<'_>) -> PyResult<f64> {
    let (shown, truth) = (picture(&shown)?, picture(&truth)?);
    let value = py.detach(|| metric::ssimulacra2(&shown, &truth));
    value.ok_or_else(|| value_error("SSIMULACRA2 needs sides of at least 8 pixels: give larger pictures"))
}

/// PSNR of several pictures taken together, dB.
#[pyfunction]
pub fn pooled_db(decibels: Vec<f64>) -> f64 {
    metric::pooled_db(&decibels)
}
