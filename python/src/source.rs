//! Built-in scenes and captures, and runs of them that are compared with their truth.

use std::path::PathBuf;

use galpix_sim::source::capture::{AccelerationPolicy, ImportOptions};
use galpix_sim::source::{self, scene};
use galpix_sim::study::error::design::Kept;
use galpix_sim::study::job::Job;
use galpix_sim::study::run;
use galpix_sim::vectors;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::engine::{Extrapolated, Taken, Wanted};
use crate::names::value_error;
use crate::update::arrays;

/// A built-in scene or a capture.
#[pyclass(frozen, module = "galpix._galpix")]
pub struct Source(source::Source);

/// A true picture, (rows, columns, 3), and where it counts, (rows, columns), if not everywhere.
type Truth<'py> = (Bound<'py, PyArray3<u8>>, Option<Bound<'py, PyArray2<bool>>>);

#[pymethods]
impl Source {
    #[new]
    fn open(py: Python<'_>, name: &str, acceleration: &str) -> PyResult<Self> {
        let acceleration = match acceleration {
            "given" => AccelerationPolicy::AsGiven,
            "off" => AccelerationPolicy::Off,
            "clamp" => AccelerationPolicy::Clamp,
            "smooth" => AccelerationPolicy::Smooth,
            _ => {
                return Err(value_error(format!(
                    "`acceleration` is '{acceleration}': give one of given, off, clamp, smooth"
                )));
            }
        };
        let opened = py.detach(|| source::Source::open(name, &ImportOptions { acceleration }));
        opened.map(Self).map_err(value_error)
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    #[getter]
    fn about(&self) -> &str {
        self.0.about()
    }

    #[getter]
    fn frames(&self) -> u32 {
        self.0.frames()
    }

    /// Whether velocity and acceleration say all of the motion; not known of a capture.
    #[getter]
    fn second_order(&self) -> Option<bool> {
        match &self.0 {
            source::Source::Scene(scene) => Some(scene.second_order()),
            source::Source::Capture(_) => None,
        }
    }

    /// Returns the arrays of the update.
    fn update<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let update = py.detach(|| self.0.update());
        arrays(py, &update)
    }

    /// Returns the frames up to `frames` whose truth is known.
    fn truth_frames(&self, frames: u32) -> Vec<u32> {
        self.0.truth_frames(frames)
    }

    /// Returns the true picture of a frame, where it is known.
    fn truth<'py>(&self, py: Python<'py>, frame: u32) -> PyResult<Option<Truth<'py>>> {
        let Some(truth) = py.detach(|| self.0.truth(frame)) else { return Ok(None) };
        let (height, width) = (truth.picture.height, truth.picture.width);
        let picture = PyArray1::from_slice(py, truth.picture.bytes()).reshape([height, width, 3])?;
        let mask = truth.mask.map(|mask| PyArray1::from_vec(py, mask).reshape([height, width])).transpose()?;
        Ok(Some((picture, mask)))
    }

    /// Runs the source and compares it with its truth: the report of `galpix run --json` as text. `fields` are those of
    /// `galpix error --lanes`.
    fn report(&self, py: Python<'_>, wanted: Wanted, fields: Option<&str>) -> PyResult<String> {
        let request = wanted.request()?;
        let kept = fields.map(kept).transpose()?;
        let report = py.detach(|| {
            let job = job(&self.0, &request, kept)?;
            run::job(&job, |_| ()).map_err(|error| error.to_string())
        });
        serde_json::to_string(&report.map_err(value_error)?).map_err(value_error)
    }

    /// Runs the source: what it shows of each frame.
    fn extrapolate<'py>(&self, py: Python<'py>, wanted: Wanted, fields: Option<&str>) -> PyResult<Extrapolated<'py>> {
        let request = wanted.request()?;
        let kept = fields.map(kept).transpose()?;
        let taken = py.detach(|| {
            let job = job(&self.0, &request, kept)?;
            let mut taken = Taken::default();
            let take = |frame: &galpix_sim::engine::Frame<'_>| {
                if frame.number > 0 {
                    taken.take(frame);
                }
            };
            let carried = job.carried().map_err(|error| error.to_string())?;
            let ran = job.engine().run_layers(&carried.base, &carried.hidden_layers(), job.frames, take);
            ran.map_err(|error| error.to_string())?;
            Ok::<_, String>((taken, [job.update.display_height(), job.update.display_width()]))
        });
        let (taken, size) = taken.map_err(value_error)?;
        taken.arrays(py, size)
    }
}

/// Returns fields by their name.
fn kept(name: &str) -> PyResult<Kept> {
    let names = || Kept::ALL.map(Kept::name).join(", ");
    let found = Kept::ALL.into_iter().find(|kept| kept.name() == name);
    found.ok_or_else(|| value_error(format!("`fields` is '{name}': give one of {}", names())))
}

fn job<'s>(source: &'s source::Source, request: &run::Request, kept: Option<Kept>) -> Result<Job<'s>, String> {
    let job = match kept {
        Some(kept) => Job::with_layout(source, request, |_| kept.layout()),
        None => Job::resolve(source, request),
    };
    job.map_err(|error| error.to_string())
}

/// Returns the names of the built-in scenes and what each stresses.
#[pyfunction]
pub fn scenes() -> Vec<(&'static str, &'static str)> {
    scene::all().iter().map(|scene| (scene.name(), scene.about())).collect()
}

/// Writes the golden vectors into a folder.
#[pyfunction]
pub fn write_vectors(py: Python<'_>, folder: PathBuf, seed: u64) -> PyResult<()> {
    py.detach(|| {
        let cases = vectors::cases(seed).map_err(value_error)?;
        let save = |path: &str, text: &str| {
            let path = folder.join(path);
            path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
            std::fs::write(&path, text)
        };
        vectors::write(seed, &cases, &vectors::Choice::default(), save)
            .map(|_| ())
            .map_err(|error: std::io::Error| error.into())
    })
}
