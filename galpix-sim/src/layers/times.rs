//! The time of a frame in each way, in the form that the simulator runs: a budget chosen at run time.

use galpix_core::budget::Bits;
use galpix_core::colour::Colour;
use galpix_core::galpixel::Chosen;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::Grid;
use galpix_core::layout::{Full, Layout, Shaded};
use galpix_core::record::Record;

use super::Plan;
use crate::engine::{Beside, Engine, EngineError, core_wings, grid};
use crate::experiment::{self, ExperimentError, Source};
use crate::hidden::{Carried, Layer, Way};
use crate::tradeoff::timing::{Contender, Effort, Maker, Time, race};
use crate::update::Update;

/// Frames that are timed in a round.
const FRAMES: u32 = 12;
/// Rounds that count.
const ROUNDS: u32 = 5;
/// Cells from which on one round counts.
const LARGE: usize = 400_000;

/// The time of a frame of a way, and the microseconds that its disocclusion map took, where there is one.
pub type WayTime = (Option<Time>, Option<f64>);

/// The times of a source, one a way.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn of(source: &Source, plan: &Plan, ways: &[Way]) -> Result<Vec<WayTime>, ExperimentError> {
    let update = source.update();
    if experiment::needs_luminosity(&update) {
        timed::<Shaded>(source, &update, plan, ways)
    } else {
        timed::<Full>(source, &update, plan, ways)
    }
}

/// An update and what is handed over beside it.
struct Layered<'u, L> {
    engine: Engine<L>,
    carried: &'u Carried,
    bytes: usize,
}

impl<L: Layout> Contender for Layered<'_, L> {
    fn bytes(&self) -> usize {
        self.bytes
    }

    /// Each turn begins with the update.
    fn restart(&mut self, _update: &Update) {}

    fn step(&mut self) {
        self.times(1);
    }

    fn times(&mut self, frames: u32) -> Vec<f64> {
        let beside: Vec<Beside<'_>> = self.carried.layers.iter().map(Layer::beside).collect();
        let mut times = Vec::with_capacity(frames as usize);
        let ran = self.engine.run_layers(&self.carried.base, &beside, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time.as_secs_f64());
            }
        });
        // What ran when errors were measured runs again.
        if ran.is_ok() { times } else { Vec::new() }
    }
}

fn timed<L: Layout + 'static>(
    source: &Source,
    update: &Update,
    plan: &Plan,
    ways: &[Way],
) -> Result<Vec<WayTime>, ExperimentError> {
    let frames = plan.request.frames.unwrap_or(source.frames());
    let bits = Bits::derive(experiment::demand(update, frames, &plan.request))?;
    let record = Record::plan(bits, L::LANES, L::Colour::BITS)?;
    let budget = Chosen::<L>::new(bits).map_err(EngineError::from)?;
    let settings = experiment::settings(&record, update.depth_kind, &plan.request);
    let mut starts = vec![0; Grid::rows(update.display_height() as u32, core_wings(update.wings))];
    let bytes = 4 * Galpixmap::<L, _>::words(&grid(update, &mut starts).map_err(EngineError::from)?, budget);
    let carried: Vec<Carried> = ways
        .iter()
        .map(|&way| experiment::carried::<L>(source, update, way, bits, frames))
        .collect::<Result<_, _>>()?;
    let makers: Vec<Maker<'_>> = carried
        .iter()
        .map(|carried| {
            let inpaint = plan.request.fill.inpaint();
            let maker: Maker<'_> = Box::new(move || {
                let engine = Engine::<L>::new(bits, settings).ok()?.inpainting(inpaint);
                Some(Box::new(Layered { engine, carried, bytes }))
            });
            maker
        })
        .collect();
    let rounds = if update.samples.len() > LARGE { 1 } else { ROUNDS };
    let times = race(update, Effort { rounds, frames: frames.min(FRAMES) }, &makers, || {});
    drop(makers);
    Ok(times
        .into_iter()
        .zip(&carried)
        .map(|(time, carried)| (time, carried.culling.as_ref().map(|culling| culling.time.as_secs_f64() * 1e6)))
        .collect())
}
