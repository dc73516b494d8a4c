//! The time of a frame with each fill, in the form that the simulator runs: a budget chosen at run time.

use super::case::Case;
use crate::engine::Scheme;
use crate::study::job::Job;
use crate::study::timing::{Effort, Engine, Maker, Race, Whole, race};

/// Frames that are timed in a round.
const FRAMES: u32 = 8;
/// Rounds that count.
const ROUNDS: u32 = 5;
/// Cells from which on fewer rounds count.
const LARGE: usize = 400_000;

/// Returns the times of a frame of a job, one for each fill.
pub fn of(job: &Job<'_>, cases: &[Case]) -> Race {
    let make = |case: &Case| -> Maker<'_> {
        let (own, update, inpaint) =
            (job.with_scheme(case.scheme).with_fill(case.fill), &job.update, case.fill.inpaint());
        match case.scheme {
            Scheme::Map => Box::new(move || Some(Box::new(Engine::new(update, own.format, own.settings, inpaint)?))),
            Scheme::Source => {
                Box::new(move || Some(Box::new(Whole::new(own.engine(), own.format, update, Vec::new()).ok()?)))
            }
        }
    };
    let makers: Vec<Maker<'_>> = cases.iter().map(make).collect();
    let rounds = if job.update.samples.len() > LARGE { 3 } else { ROUNDS };
    race(&job.update, Effort { rounds, frames: job.frames.min(FRAMES) }, &makers, || {})
}
