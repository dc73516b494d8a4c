//! The time of a frame in each strategy, in the form that the simulator runs: a budget chosen at run time.

use galpix_core::{Galpixmap, Grid};

use crate::engine::{Engine, EngineError, HiddenLayer, grid, margin};
use crate::source::hidden::{Carried, Layer, Strategy};
use crate::study::job::{ExperimentError, Job};
use crate::study::timing::{Contender, Effort, Maker, Time, race};
use crate::update::Update;

/// Frames that are timed in a round.
const FRAMES: u32 = 12;
/// Rounds that count.
const ROUNDS: u32 = 5;
/// Cells from which on one round counts.
const LARGE: usize = 400_000;

/// The time of a frame of a strategy, and the microseconds that its disocclusion map took, where there is one.
pub type StrategyTime = (Option<Time>, Option<f64>);

/// An update and its hidden layers.
struct Layered<'u> {
    engine: Engine,
    carried: &'u Carried,
    bytes: usize,
}

impl Contender for Layered<'_> {
    fn bytes(&self) -> usize {
        self.bytes
    }

    /// Each turn begins with the update.
    fn restart(&mut self, _update: &Update) {}

    fn step(&mut self) {
        self.times(1);
    }

    fn times(&mut self, frames: u32) -> Vec<f64> {
        let hidden: Vec<HiddenLayer<'_>> = self.carried.layers.iter().map(Layer::for_engine).collect();
        let mut times = Vec::with_capacity(frames as usize);
        let ran = self.engine.run_layers(&self.carried.base, &hidden, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time.as_secs_f64());
            }
        });
        // What ran when errors were measured runs again.
        if ran.is_ok() { times } else { Vec::new() }
    }
}

/// Returns the times of a job, one per strategy.
///
/// *Errors:* a map that does not fit, a source without the samples of a strategy.
pub fn of(job: &Job<'_>, strategies: &[Strategy]) -> Result<Vec<StrategyTime>, ExperimentError> {
    let update = job.update.as_ref();
    let mut starts = vec![0; Grid::rows(update.display_height() as u32, margin(update.margin))];
    let bytes = 4 * Galpixmap::words(&grid(update, &mut starts).map_err(EngineError::from)?, job.format);
    let carried: Vec<Carried> =
        strategies.iter().map(|&strategy| job.with_strategy(strategy).carried()).collect::<Result<_, _>>()?;
    let make =
        |carried| -> Maker<'_> { Box::new(move || Some(Box::new(Layered { engine: job.engine(), carried, bytes }))) };
    let makers: Vec<Maker<'_>> = carried.iter().map(make).collect();
    let rounds = if update.samples.len() > LARGE { 1 } else { ROUNDS };
    let times = race(update, Effort { rounds, frames: job.frames.min(FRAMES) }, &makers, || {});
    drop(makers);
    let map_us = |carried: &Carried| carried.culling.as_ref().map(|culling| culling.time.as_secs_f64() * 1e6);
    Ok(times.into_iter().zip(&carried).map(|(time, carried)| (time, map_us(carried))).collect())
}
