//! One update extrapolated and compared, frame by frame, with the truth and with sample-and-hold.

mod compare;
mod report;
mod work;

use galpix_core::{Format, Tally};

pub use super::job::{ExperimentError, Request, check_strategy};
pub(crate) use compare::{Comparison, Seen, position};
pub use report::{BudgetReport, ChangeReport, FrameReport, PositionReport, RunReport, TruthReport};
pub use work::work_gain;

use super::job::Job;
use crate::certificate::{Certificate, shown_off_px};
use crate::engine::Frame;
use crate::metric::stats::median;
use crate::picture::Picture;
use crate::source::Source;
use crate::source::hidden::{HiddenReport, Strategy};
use crate::update::Truth;

/// What a visitor sees of each frame, the update (frame 0) included.
pub struct Shown<'s> {
    /// Frames since the update.
    pub frame: u32,
    /// What the display shows.
    pub picture: &'s Picture,
    /// The update's picture: what sample-and-hold shows.
    pub hold: &'s Picture,
    /// The true picture, where it is known.
    pub truth: Option<&'s Truth>,
    /// For each pixel, whether a galpixel of the update reached it.
    pub reached: &'s [bool],
}

/// Runs a source and compares every frame whose truth is known; `visit` sees each frame.
///
/// *Errors:* a budget that cannot exist or that does not fit.
pub fn run(source: &Source, request: &Request, visit: impl FnMut(&Shown<'_>)) -> Result<RunReport, ExperimentError> {
    job(&Job::resolve(source, request)?, visit)
}

/// Runs a job and compares every frame whose truth is known; `visit` sees each frame.
///
/// *Errors:* a source without the requested hidden samples, a map that does not fit.
pub fn job(job: &Job<'_>, mut visit: impl FnMut(&Shown<'_>)) -> Result<RunReport, ExperimentError> {
    let Job { source, frames, demand, format, settings, request, .. } = job;
    let update = job.update.as_ref();
    let carried = job.carried()?;
    let hold = update.picture();
    let mut comparison = Comparison::new(&hold, request.perceptual);
    let mut reports = Vec::with_capacity(*frames as usize);
    let ran = job.engine().outlined().run_layers(&carried.base, &carried.hidden_layers(), *frames, |frame| {
        let picture = frame.picture();
        let truth = source.truth(frame.number);
        let reached = frame.reached();
        visit(&Shown { frame: frame.number, picture: &picture, hold: &hold, truth: truth.as_ref(), reached: &reached });
        if frame.number > 0 {
            let outline = frame.outline();
            let seen = |truth| Seen { picture: &picture, truth, reached: &reached, outline: &outline };
            let truth = truth.as_ref().map(|truth| comparison.frame(&seen(truth)));
            let position = compare::position(source, update, frame, |origin| carried.first(origin));
            let report = report(frame, position, truth);
            let hidden = || frame.origins().filter(|&origin| carried.is_hidden(origin)).count() as u32;
            let from_hidden = (request.strategy != Strategy::ONE).then(hidden);
            reports.push(FrameReport { from_hidden, ..report });
        }
    })?;
    let times: Vec<f64> = reports.iter().map(|report: &FrameReport| report.ns_per_galpixel).collect();
    let (layout, scale) = (format.record().layout(), &format.record().scales[0]);
    let certificate = Certificate::of(scale, layout.acceleration, request.rounding, demand.prop);
    for frame in &mut reports {
        frame.certified_px = certificate.after(frame.frame);
    }
    // A velocity is off by up to half of its step, in each frame.
    let by_steps =
        source.census().and_then(|census| census.motion_step_px).unwrap_or(0.0) / 2.0 * f64::from(demand.prop);
    Ok(RunReport {
        source: source.name().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        budget: BudgetReport::of(*demand, job.bits, format.record()),
        rounding: request.rounding.name(),
        fill: request.fill.name(),
        edge_threshold: settings.edge_threshold,
        scheme: request.scheme.name(),
        scan_out: request.scan_out.name(),
        ns_per_galpixel: median(times).unwrap_or(0.0),
        loaded: ran.loaded,
        hidden: (request.strategy != Strategy::ONE).then(|| HiddenReport::of(request.strategy, &carried, &ran)),
        census: source.census().cloned(),
        displayed_px: certificate.total_px + shown_off_px(request.scan_out, scale.position_frac) + by_steps,
        certificate,
        frames: reports,
    })
}

fn report(frame: &Frame<'_>, position: Option<PositionReport>, truth: Option<TruthReport>) -> FrameReport {
    let Tally { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, .. } = frame.tally;
    FrameReport {
        frame: frame.number,
        holes,
        filled: frame.tally.filled(),
        bullets,
        debris,
        galdebris,
        lost,
        collided,
        saturated,
        edges,
        ns_per_galpixel: frame.time.as_secs_f64() * 1e9 / f64::from(moved.max(1)),
        position,
        certified_px: None,
        from_hidden: None,
        truth,
    }
}
