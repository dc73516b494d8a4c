//! What skipping saves: the same frames in both modes of work.

use std::time::Duration;

use galpix_core::budget::Bits;
use galpix_core::colour::Colour;
use galpix_core::frame::{Settings, Work};
use galpix_core::layout::{Full, Layout, Shaded};
use galpix_core::record::Record;

use super::{ExperimentError, Request, Source, demand, needs_luminosity, settings};
use crate::engine::Engine;
use crate::update::Update;

/// The time of a frame with constant work by that of the same frame without what its picture does not need: the medians of
/// the first `frames` frames of a source, whose bits are the same in both modes. 1 where no frame was made.
///
/// *Errors:* a budget that cannot exist or that does not fit.
pub fn work_gain(source: &Source, request: &Request, frames: u32) -> Result<f64, ExperimentError> {
    let update = source.update();
    let demand = demand(&update, request.frames.unwrap_or(source.frames()), request);
    let bits = Bits::derive(demand)?;
    if needs_luminosity(&update) {
        gain::<Shaded>(&update, bits, request, frames)
    } else {
        gain::<Full>(&update, bits, request, frames)
    }
}

fn gain<L: Layout>(update: &Update, bits: Bits, request: &Request, frames: u32) -> Result<f64, ExperimentError> {
    let record = Record::plan(bits, L::LANES, L::Colour::BITS)?;
    let settings = settings(&record, update.depth_kind, request);
    let median = |work: Work| -> Result<Duration, ExperimentError> {
        let engine = Engine::<L>::new(bits, Settings { work, ..settings })?.inpainting(request.fill.inpaint());
        let mut times = Vec::with_capacity(frames as usize);
        engine.run(update, frames, |frame| {
            if frame.number > 0 {
                times.push(frame.time);
            }
        })?;
        times.sort_unstable();
        Ok(times.get(times.len() / 2).copied().unwrap_or_default())
    };
    let (skipping, constant) = (median(Work::Skipping)?, median(Work::Constant)?);
    Ok(if skipping.is_zero() { 1.0 } else { constant.as_secs_f64() / skipping.as_secs_f64() })
}
