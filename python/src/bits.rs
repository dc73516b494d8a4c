//! Budgets, records and certificates.

use galpix_core::record::Component;
use galpix_core::{Bits, Demand, Dynamic, Format, Layout};
use galpix_sim::certificate::{self, Certificate, Method};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::names::{self, value_error};

/// The widths of a component: fraction bits of the position, integer and fraction bits of velocity and acceleration.
pub type Widths = (u32, u32, u32, u32, u32);

/// The attributes of `galpix.Budget` that say how wide fields are.
#[derive(FromPyObject)]
pub struct BudgetWidths {
    x: Widths,
    y: Widths,
    z: Widths,
    depth_int: u32,
    luminosity_int: u32,
    luminosity_frac: u32,
}

/// The attributes of `galpix.Layout`.
#[derive(FromPyObject)]
pub struct LayoutFields {
    colour: String,
    depth_bits: u32,
    velocity: bool,
    acceleration: bool,
    depth_motion: bool,
    luminosity: bool,
    tag_bits: u32,
}

fn component((position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac): Widths) -> Component {
    Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac }
}

fn widths(component: Component) -> Widths {
    let Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = component;
    (position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac)
}

impl BudgetWidths {
    /// Returns the widths as the core takes them.
    pub fn bits(&self) -> Bits {
        let Self { x, y, z, depth_int, luminosity_int, luminosity_frac } = *self;
        Bits { x: component(x), y: component(y), z: component(z), depth_int, luminosity_int, luminosity_frac }
    }
}

impl LayoutFields {
    /// Returns the layout as the core takes it.
    pub fn layout(&self) -> PyResult<Layout> {
        let Self { depth_bits, velocity, acceleration, depth_motion, luminosity, tag_bits, .. } = *self;
        let colour = names::colour(&self.colour)?;
        Ok(Layout { colour, depth_bits, velocity, acceleration, depth_motion, luminosity, tag_bits })
    }
}

/// Returns the stored form of a layout under a budget.
pub fn format(budget: &BudgetWidths, layout: &LayoutFields) -> PyResult<Dynamic> {
    Dynamic::new(budget.bits(), layout.layout()?).map_err(value_error)
}

/// Returns the widths that the equations give: those of a component, depth_int, luminosity_int, luminosity_frac.
#[pyfunction]
pub fn derive(extent: u32, recog: u32, prop: u32, acceleration: bool) -> PyResult<(Widths, u32, u32, u32)> {
    let demand = Demand { extent, recog, prop };
    let bits = if acceleration { Bits::derive(demand) } else { Bits::derive_without_acceleration(demand) };
    let bits = bits.map_err(value_error)?;
    Ok((widths(bits.x), bits.depth_int, bits.luminosity_int, bits.luminosity_frac))
}

/// Returns the words of a galpixel, its bits, and each field as (name, bits, word, shift, spill).
#[pyfunction]
pub fn record(budget: BudgetWidths, layout: LayoutFields) -> PyResult<(usize, u32)> {
    let format = format(&budget, &layout)?;
    Ok((format.record().words(), format.record().bits()))
}

fn as_dict<'py>(py: Python<'py>, certificate: &Certificate) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("quantisation_px", certificate.quantisation_px)?;
    dict.set_item("drift_px", certificate.drift_px)?;
    dict.set_item("total_px", certificate.total_px)?;
    dict.set_item("drift_any_phase_px", certificate.drift_any_phase_px)?;
    let method = match certificate.method {
        Method::Enumerated => "enumerated",
        Method::Bounded => "bounded",
    };
    dict.set_item("method", method)?;
    dict.set_item("classes", certificate.classes)?;
    dict.set_item("phases", certificate.phases)?;
    let quantisation: Vec<f64> = certificate.frames.iter().map(|frame| frame.quantisation_px).collect();
    let drift: Vec<f64> = certificate.frames.iter().map(|frame| frame.drift_px).collect();
    dict.set_item("quantisation", numpy::PyArray1::from_vec(py, quantisation))?;
    dict.set_item("drift", numpy::PyArray1::from_vec(py, drift))?;
    Ok(dict)
}

/// Returns the certificate of a component for `prop` frames.
#[pyfunction]
pub fn certify<'py>(py: Python<'py>, given: Widths, rounding: &str, prop: u32) -> PyResult<Bound<'py, PyDict>> {
    let rounding = names::rounding(rounding)?;
    let component = component(given).checked().map_err(value_error)?;
    let scale = galpix_core::record::Scale::new(component, component.position_frac);
    let has_acceleration = component.has_acceleration();
    let certificate = py.detach(|| Certificate::of(&scale, has_acceleration, rounding, prop));
    as_dict(py, &certificate)
}

/// Returns the component of the fewest bits, with the integer bits of `ranges`, that keeps an error, and its
/// certificate.
#[pyfunction]
pub fn smallest<'py>(
    py: Python<'py>,
    ranges: Widths,
    rounding: &str,
    prop: u32,
    max_error: f64,
) -> PyResult<(Widths, Bound<'py, PyDict>)> {
    let rounding = names::rounding(rounding)?;
    let ranges = component(ranges).checked().map_err(value_error)?;
    let found = py.detach(|| certificate::smallest(ranges, rounding, prop, max_error));
    let (component, certificate) = found.map_err(value_error)?;
    Ok((widths(component), as_dict(py, &certificate)?))
}

/// Returns by how much what is shown differs at most from a position, in pixels.
#[pyfunction]
pub fn shown_off_px(scan_out: &str, position_frac: u32) -> PyResult<f64> {
    Ok(certificate::shown_off_px(names::scan_out(scan_out)?, position_frac))
}
