//! What a scene does not need: the fields, bits, rounding and fill mode that keep an error asked for, with a
//! certificate.
//!
//! ```text
//! update ─▶ extremes (how fast, how far) ─▶ motion (fields and bits in the plane) ─▶ depth (fields and bits of depth)
//!                     ─▶ fill mode (which holes there are) ─▶ measured (run, and checked) ─▶ code (the Rust)
//! ```
//!
//! The fields in the plane are chosen by arithmetic: the largest error of a field that is left out is added to the
//! certificate of the rest. Depth and fill mode are chosen by running the update, as a display does.

mod code;
mod depth;
mod extremes;
mod measured;
mod motion;

use galpix_core::record::Component;
use galpix_core::{Bits, BudgetError, Demand, FillMode, Layout, Record, Rounding};
use schemars::JsonSchema;
use serde::Serialize;

use crate::certificate::Unreachable;
use crate::engine::EngineError;
use crate::source::Source;
use crate::study::job::{ExperimentError, Job, Request};
use extremes::Extremes;
pub use measured::Measured;
use measured::Subject;
pub use motion::{Axis, Motion};

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum PlanError {
    /// No budget keeps the error.
    #[error("{0}")]
    Unreachable(#[from] Unreachable),
    /// The source cannot be run.
    #[error("{0}")]
    Experiment(#[from] ExperimentError),
    /// The budget that the plan is compared with cannot exist.
    #[error("this budget cannot exist: {0}")]
    Budget(#[from] BudgetError),
    /// The engine cannot be set up.
    #[error("{0}")]
    Engine(#[from] EngineError),
}

/// What a display needs for one source and one error.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Plan {
    /// The requested position error, in pixels.
    pub max_error_px: f64,
    /// Fields and bits in the plane.
    pub motion: Motion,
    /// Bits of the z-buffer; 0 where no depth is needed.
    pub depth_bits: u32,
    /// Whether the depth moves.
    pub depth_motion: bool,
    /// Whether the luminosity moves.
    pub luminosity: bool,
    /// The name of the fill mode.
    #[serde(rename = "rung")]
    pub fill_mode: &'static str,
    /// Why each field and fill mode is kept or left out, a sentence each.
    pub reasons: Vec<String>,
    /// Bits in use of a galpixel.
    pub used_bits_per_galpixel: u32,
    /// Bytes of a galpixel, in whole words.
    pub stored_bytes_per_galpixel: usize,
    /// What was seen when it was run.
    pub measured: Measured,
    /// The Rust that makes it so.
    pub code: String,
    #[serde(skip)]
    build: Build,
}

/// What an engine is built from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Build {
    pub bits: Bits,
    pub layout: Layout,
    pub rounding: Rounding,
    pub fill_mode: FillMode,
}

/// A plan for the requested error, one for a tighter error, and the full budget.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Planning {
    /// Scene or capture.
    pub source: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// Frames that the plan covers.
    pub frames: u32,
    /// What the update holds.
    pub extremes: Extremes,
    /// For the requested error.
    pub plan: Plan,
    /// For a tighter error; null where no budget reaches it.
    pub tighter: Option<Plan>,
    /// The paper's widths with every field, over a 16-bit z-buffer, and the richest fill mode.
    pub full: Full,
}

/// The full budget.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Full {
    /// `D` in pixels.
    pub extent: u32,
    /// `tau_recog` in frames.
    pub recog: u32,
    /// `tau_prop` in frames.
    pub prop: u32,
    /// Its certificate, in pixels.
    pub certified_px: f64,
    /// Bits in use of a galpixel.
    pub used_bits_per_galpixel: u32,
    /// Bytes of a galpixel, in whole words.
    pub stored_bytes_per_galpixel: usize,
    /// What was seen when it was run.
    pub measured: Measured,
}

/// How often `done` is called by [`plan`].
pub const PIECES: u64 = 4;

/// Plans a source for an error in pixels, and for a tighter one; `done` is called after each piece of it.
///
/// *Errors:* an error that no budget keeps, a full budget that cannot exist.
pub fn plan(
    source: &Source,
    request: &Request,
    [max_error, tighter]: [f64; 2],
    done: impl Fn(),
) -> Result<Planning, PlanError> {
    // A plan looks at frames from one to the next.
    let frames = Some(request.frames(source).max(2));
    let subject = Subject(Job::resolve(source, &Request { frames, ..*request })?);
    let Job { frames, demand, ref update, .. } = subject.0;
    let extremes = Extremes::of(update, frames);
    let mut full = full(&subject, demand)?;
    done();
    let mut plan = one(&subject, &extremes, demand, max_error)?;
    done();
    let mut tight = match one(&subject, &extremes, demand, tighter) {
        Ok(plan) => Some(plan),
        Err(PlanError::Unreachable(_)) => None,
        Err(error) => return Err(error),
    };
    done();
    let mut timed = vec![(full_build(demand)?, &mut full.measured), (plan.build, &mut plan.measured)];
    timed.extend(tight.as_mut().map(|tight| (tight.build, &mut tight.measured)));
    measured::time(&subject, &mut timed)?;
    done();
    Ok(Planning {
        source: source.name().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        frames,
        extremes,
        plan,
        tighter: tight,
        full,
    })
}

fn full_build(demand: Demand) -> Result<Build, PlanError> {
    let layout = Layout { luminosity: true, ..Layout::FULL };
    Ok(Build { bits: Bits::derive(demand)?, layout, rounding: Rounding::default(), fill_mode: FillMode::default() })
}

fn full(subject: &Subject<'_>, demand: Demand) -> Result<Full, PlanError> {
    let build = full_build(demand)?;
    let record = Record::plan(build.bits, build.layout)?;
    let certificate =
        crate::certificate::Certificate::of(&record.scales[0], true, build.rounding, subject.0.frames.max(demand.prop));
    Ok(Full {
        extent: demand.extent,
        recog: demand.recog,
        prop: demand.prop,
        certified_px: certificate.total_px,
        used_bits_per_galpixel: record.bits(),
        stored_bytes_per_galpixel: record.bytes(),
        measured: subject.run(&build)?.measured(None),
    })
}

/// Returns a plan for one error.
fn one(subject: &Subject<'_>, extremes: &Extremes, demand: Demand, max_error: f64) -> Result<Plan, PlanError> {
    let motion = Motion::for_error(extremes, subject.0.frames, max_error)?;
    let mut reasons = motion.reasons(extremes, max_error);
    let luminosity = extremes.luminosity_gain >= 0.5;
    reasons.push(if luminosity {
        format!("luminosity is kept: it changes by up to {:.1} code values", extremes.luminosity_gain)
    } else {
        "luminosity is left out: no code value changes by a half".to_owned()
    });
    let layout = Layout {
        depth_bits: 16,
        velocity: motion.velocity,
        acceleration: motion.acceleration,
        depth_motion: motion.velocity,
        luminosity,
        ..Layout::STILL
    };
    let z =
        if motion.acceleration { Component::derive(demand)? } else { Component::derive_without_acceleration(demand)? };
    let derived = Bits::derive(demand)?;
    let bits = derived.with_xy(motion.x.component, motion.y.component).with_z(z, derived.depth_int);
    let mut build = Build { bits, layout, rounding: motion.rounding(), fill_mode: FillMode::Extend };
    depth::decide(subject, extremes, &mut build, &mut reasons)?;
    let record = Record::plan(build.bits, build.layout)?;
    let ran = subject.run(&build)?;
    let code = code::text(subject.0.source.name(), &build, &record, subject.settings(&build, &record));
    Ok(Plan {
        max_error_px: max_error,
        depth_bits: build.layout.depth_bits,
        depth_motion: build.layout.depth_motion,
        luminosity,
        fill_mode: build.fill_mode.name(),
        reasons,
        used_bits_per_galpixel: record.bits(),
        stored_bytes_per_galpixel: record.bytes(),
        measured: ran.measured(Some(motion.certified_px)),
        motion,
        code,
        build,
    })
}
