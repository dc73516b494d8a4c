//! The time of a frame with each fill, in the form that the simulator runs: a budget chosen at run time.

use galpix_core::{Bits, Dynamic, Format};

use super::Plan;
use crate::source::Source;
use crate::study::error::timing::{Effort, Engine, Maker, Time, race};
use crate::study::run::{self, ExperimentError, Request};

/// Frames that are timed in a round.
const FRAMES: u32 = 8;
/// Rounds that count.
const ROUNDS: u32 = 3;
/// Cells from which on one round counts.
const LARGE: usize = 400_000;

/// The times of a frame of a source, one a fill.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn of(source: &Source, plan: &Plan) -> Result<Vec<Option<Time>>, ExperimentError> {
    let update = source.update();
    let frames = plan.request.frames.unwrap_or(source.frames());
    let bits = Bits::derive(run::demand(&update, frames, &plan.request))?;
    let format = Dynamic::new(bits, run::layout_for(&update))?;
    let makers: Vec<Maker<'_>> = plan
        .cases
        .iter()
        .map(|case| {
            let request = Request { fill: case.fill, ..plan.request };
            let settings = run::settings(format.record(), update.depth_kind, &request);
            let update = &update;
            let maker: Maker<'_> =
                Box::new(move || Some(Box::new(Engine::new(update, format, settings, case.fill.inpaint())?)));
            maker
        })
        .collect();
    let rounds = if update.samples.len() > LARGE { 1 } else { ROUNDS };
    Ok(race(&update, Effort { rounds, frames: frames.min(FRAMES) }, &makers, || {}))
}
