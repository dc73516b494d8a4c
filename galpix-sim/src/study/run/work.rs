//! What skipping saves: the same frames in both modes of work.

use std::time::Duration;

use galpix_core::{Bits, Dynamic, Format};

use super::{ExperimentError, Request, demand, layout_for, settings};
use crate::engine::Engine;
use crate::source::Source;

/// The time of a frame with constant work by that of the same frame without what its picture does not need: the medians of
/// the first `frames` frames of a source, whose bits are the same in both modes. 1 where no frame was made.
///
/// *Errors:* a budget that cannot exist or that does not fit.
pub fn work_gain(source: &Source, request: &Request, frames: u32) -> Result<f64, ExperimentError> {
    let update = source.update();
    let demand = demand(&update, request.frames.unwrap_or(source.frames()), request);
    let format = Dynamic::new(Bits::derive(demand)?, layout_for(&update))?;
    let settings = settings(format.record(), update.depth_kind, request);
    let median = |constant_time: bool| -> Result<Duration, ExperimentError> {
        let engine = Engine::new(format, settings).inpainting(request.fill.inpaint()).constant_time(constant_time);
        let mut times = Vec::with_capacity(frames as usize);
        engine.run(&update, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time);
            }
        })?;
        times.sort_unstable();
        Ok(times.get(times.len() / 2).copied().unwrap_or_default())
    };
    let (skipping, constant) = (median(false)?, median(true)?);
    Ok(if skipping.is_zero() { 1.0 } else { constant.as_secs_f64() / skipping.as_secs_f64() })
}
