//! The time of a frame with each fill, in the form that the simulator runs: a budget chosen at run time.

use galpix_core::budget::Bits;
use galpix_core::colour::Colour;
use galpix_core::galpixel::Chosen;
use galpix_core::layout::{Full, Layout, Shaded};
use galpix_core::record::Record;

use super::Plan;
use crate::engine::EngineError;
use crate::experiment::{self, ExperimentError, Request, Source};
use crate::tradeoff::timing::{Effort, Engine, Maker, Time, race};

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
    if experiment::needs_luminosity(&update) { timed::<Shaded>(source, plan) } else { timed::<Full>(source, plan) }
}

fn timed<L: Layout + 'static>(source: &Source, plan: &Plan) -> Result<Vec<Option<Time>>, ExperimentError> {
    let update = source.update();
    let frames = plan.request.frames.unwrap_or(source.frames());
    let bits = Bits::derive(experiment::demand(&update, frames, &plan.request))?;
    let record = Record::plan(bits, L::LANES, L::Colour::BITS)?;
    let budget = Chosen::<L>::new(bits).map_err(EngineError::from)?;
    let makers: Vec<Maker<'_>> = plan
        .cases
        .iter()
        .map(|case| {
            let request = Request { fill: case.fill, ..plan.request };
            let settings = experiment::settings(&record, update.depth_kind, &request);
            let update = &update;
            let maker: Maker<'_> =
                Box::new(move || Some(Box::new(Engine::new(update, budget, settings, case.fill.inpaint())?)));
            maker
        })
        .collect();
    let rounds = if update.samples.len() > LARGE { 1 } else { ROUNDS };
    Ok(race(&update, Effort { rounds, frames: frames.min(FRAMES) }, &makers, || {}))
}
