//! The time of a frame in each strategy, in the form that the simulator runs: a budget chosen at run time.

use crate::source::hidden::{Carried, Strategy};
use crate::study::job::{ExperimentError, Job};
use crate::study::timing::{Effort, Maker, Noise, Race, Time, Whole, race};

/// Frames that are timed in a round.
const FRAMES: u32 = 12;
/// Rounds that count.
const ROUNDS: u32 = 5;
/// Cells from which on fewer rounds count.
const LARGE: usize = 400_000;

/// The time of a frame of a strategy, and the microseconds that its disocclusion map took, where there is one.
pub type StrategyTime = (Option<Time>, Option<f64>);

/// Returns the times of a job, one per strategy.
///
/// *Errors:* a map that does not fit, a source without the samples of a strategy.
pub fn of(job: &Job<'_>, strategies: &[Strategy]) -> Result<(Vec<StrategyTime>, Option<Noise>), ExperimentError> {
    let update = job.update.as_ref();
    let carried: Vec<Carried> =
        strategies.iter().map(|&strategy| job.with_strategy(strategy).carried()).collect::<Result<_, _>>()?;
    let makers = carried.iter().map(|carried| -> Maker<'_> {
        let contender = || Whole::new(job.engine(), job.format, &carried.base, carried.hidden_layers()).ok();
        Box::new(move || Some(Box::new(contender()?)))
    });
    let makers: Vec<Maker<'_>> = makers.collect();
    let rounds = if update.samples.len() > LARGE { 3 } else { ROUNDS };
    let Race { times, noise } = race(update, Effort { rounds, frames: job.frames.min(FRAMES) }, &makers, || {});
    drop(makers);
    let map_us = |carried: &Carried| carried.culling.as_ref().map(|culling| culling.time.as_secs_f64() * 1e6);
    Ok((times.into_iter().zip(&carried).map(|(time, carried)| (time, map_us(carried))).collect(), noise))
}
