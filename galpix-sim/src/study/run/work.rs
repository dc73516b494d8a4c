//! What the data-dependent step saves: the same frames in both modes.

use crate::metric::stats;
use crate::study::job::{ExperimentError, Job};

/// Returns the time of a constant-time frame divided by that of the same data-dependent frame: the
/// medians of the first `frames` frames of a job, whose bits are the same in both modes. 1 where no frame was made.
///
/// *Errors:* a map that does not fit.
pub fn work_gain(job: &Job<'_>, frames: u32) -> Result<f64, ExperimentError> {
    let median = |constant_time: bool| -> Result<f64, ExperimentError> {
        let mut times = Vec::with_capacity(frames as usize);
        job.engine().constant_time(constant_time).run(&job.update, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time.as_secs_f64());
            }
        })?;
        Ok(stats::median(times).unwrap_or(0.0))
    };
    let (data_dependent, constant_time) = (median(false)?, median(true)?);
    Ok(if data_dependent > 0.0 { constant_time / data_dependent } else { 1.0 })
}
