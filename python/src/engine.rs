//! An update of arrays, extrapolated by the simulator's engine in either scheme.

use galpix_core::{Dynamic, Format, Layout};
use galpix_sim::engine::Engine;
use galpix_sim::study::job::{Request, finer};
use numpy::{PyArray1, PyArray3, PyArray4, PyArrayMethods};
use pyo3::prelude::*;

use crate::bits::{BudgetWidths, LayoutFields, format};
use crate::map::{Counts, counts};
use crate::names::{self, value_error};
use crate::update::{MarginCells, UpdateArrays, update};

/// What is asked for: attributes of an object of the package. What is absent is as the simulator has it by default.
#[derive(FromPyObject)]
pub struct Wanted {
    frames: Option<u32>,
    extent: Option<u32>,
    recog: Option<u32>,
    prop: Option<u32>,
    position_frac: u32,
    rounding: String,
    fill: Option<String>,
    gamma: Option<String>,
    reach: u32,
    edge_threshold: Option<f64>,
    scheme: String,
    scan_out: Option<String>,
    perceptual: bool,
    hidden: String,
}

impl Wanted {
    /// Returns the request of the simulator.
    pub fn request(&self) -> PyResult<Request> {
        let scheme = names::scheme(&self.scheme)?;
        let gamma = self.gamma.as_deref();
        let fill = match &self.fill {
            Some(fill) => names::fill(fill, gamma)?,
            None => names::fill(scheme.fill().name(), gamma)?,
        };
        if !scheme.takes(fill) {
            return Err(value_error(format!(
                "`fill` is '{}', which stationary sources do not have: give none, hold, extend, push-pull or metamer, \
                 or scheme='map'",
                fill.name()
            )));
        }
        let scan_out = self.scan_out.as_deref().map_or(Ok(scheme.scan_out()), names::scan_out)?;
        Ok(Request {
            frames: self.frames,
            extent: self.extent,
            recog: self.recog,
            prop: self.prop,
            position_frac: self.position_frac,
            rounding: names::rounding(&self.rounding)?,
            fill,
            reach: self.reach,
            edge_threshold: self.edge_threshold,
            scheme,
            scan_out,
            perceptual: self.perceptual,
            strategy: names::hidden(&self.hidden, scheme)?,
        })
    }
}

/// Pictures, what the update reached of them, and counts: (frames, rows, columns, 3), (frames, rows, columns), a tuple
/// for each frame.
pub type Extrapolated<'py> = (Bound<'py, PyArray4<u8>>, Bound<'py, PyArray3<bool>>, Vec<Counts>);

/// What a run leaves.
#[derive(Default)]
pub struct Taken {
    pictures: Vec<u8>,
    reached: Vec<bool>,
    counts: Vec<Counts>,
}

impl Taken {
    /// Takes what a frame shows.
    pub fn take(&mut self, frame: &galpix_sim::engine::Frame<'_>) {
        self.pictures.extend_from_slice(frame.picture().bytes());
        self.reached.extend(frame.reached());
        self.counts.push(counts(&frame.tally));
    }

    /// Returns it as arrays.
    pub fn arrays(self, py: Python<'_>, [height, width]: [usize; 2]) -> PyResult<Extrapolated<'_>> {
        let frames = self.counts.len();
        Ok((
            PyArray1::from_vec(py, self.pictures).reshape([frames, height, width, 3])?,
            PyArray1::from_vec(py, self.reached).reshape([frames, height, width])?,
            self.counts,
        ))
    }
}

/// Extrapolates an update by so many frames.
#[pyfunction]
pub fn extrapolate<'py>(
    py: Python<'py>,
    arrays: UpdateArrays<'_>,
    margin: MarginCells,
    depth_kind: &str,
    wanted: (Wanted, Option<(BudgetWidths, LayoutFields)>),
) -> PyResult<Extrapolated<'py>> {
    let update = update(&arrays, margin, depth_kind)?;
    let (wanted, form) = wanted;
    let request = wanted.request()?;
    let frames = request.frames.unwrap_or(16);
    let form = form.map(|(budget, layout)| format(&budget, &layout)).transpose()?;
    let taken = py.detach(|| {
        let format = match form {
            Some(format) => format,
            None => {
                let demand = request.demand(&update, frames);
                let bits = galpix_core::Bits::derive(demand).map_err(|error| error.to_string())?;
                Dynamic::new(finer(bits, request.position_frac), Layout::FULL).map_err(|error| error.to_string())?
            }
        };
        let settings = request.settings(format.record(), update.depth_kind);
        let engine =
            Engine::new(format, settings).inpainting(request.fill.inpaint()).showing(request.scheme, request.scan_out);
        let mut taken = Taken::default();
        engine
            .run(&update, frames, |frame| {
                if frame.number > 0 {
                    taken.take(frame);
                }
            })
            .map_err(|error| error.to_string())?;
        Ok::<_, String>(taken)
    });
    taken.map_err(value_error)?.arrays(py, [update.display_height(), update.display_width()])
}
