//! The error of one configuration, frame by frame, split into its causes.
//!
//! A shown galpixel is away from its true place by a sum of steps: true motion → exact second-order path (*Taylor*:
//! what second order cannot know) → exact path of the fields kept (*left out*) → the path of what was stored
//! (*quantisation*) → where the engine is (*drift*; for galpixels that a range stopped: *saturation*) → the cell that
//! shows it (*snap*). For each step the mean over the galpixels is
//! reported, and of each galpixel the larger of x and y; steps may cancel, so they add up to at least the whole error.
//! Cells that nothing reached are holes, and count in the squared error of the picture.

use galpix_core::{Bits, Dynamic, Layout, Settings};
use schemars::JsonSchema;
use serde::Serialize;

use super::design::Configuration;
use super::measure::apart;
use super::ranges::Stored;
use super::reference::{Reference, displacement};
use crate::engine::{Engine, EngineError, ScanOut};
use crate::picture::Picture;
use crate::source::Source;
use crate::study::cells::Cells;
use crate::update::Truth;

/// A frame, by cause. Places in pixels, means over the galpixels of the update that are still there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct FrameCauses {
    /// Frames since the update.
    pub frame: u32,
    /// What second order cannot know; not known where the true motion is not.
    pub taylor_px: Option<f64>,
    /// What fields that were left out would have moved.
    pub left_out_px: f64,
    /// From storing velocity and acceleration in few bits.
    pub quantisation_px: f64,
    /// From rounding in each frame.
    pub drift_px: f64,
    /// From ranges that stopped a galpixel.
    pub saturation_px: f64,
    /// From showing it in the best-fitting cell.
    pub snap_px: f64,
    /// All together: from the true place (where that is not known, from the second-order path) to the cell.
    pub all_px: f64,
    /// Cells that no galpixel of the update reached, per cent of those that the truth counts.
    pub missing_percent: Option<f64>,
    /// The squared error of the picture in cells that a galpixel reached, as a part of the mean over all cells (code
    /// values²).
    pub mse_reached: Option<f64>,
    /// The same in cells that nothing reached.
    pub mse_missing: Option<f64>,
    /// The squared error of sample-and-hold.
    pub mse_hold: Option<f64>,
}

/// A true picture, and what was shown.
pub type Pair = (Truth, Picture);

/// Returns the causes of every frame of a configuration, and its pictures where the truth of a capture is known.
///
/// *Errors:* a budget that does not fit the fields.
pub fn causes(
    reference: &Reference<'_>,
    configuration: &Configuration,
    bits: Bits,
    settings: Settings,
) -> Result<(Vec<FrameCauses>, Vec<Pair>), EngineError> {
    let layout = configuration.kept.layout();
    let mut frames = Vec::with_capacity(reference.frames as usize);
    let mut pairs = Vec::new();
    let Configuration { fill, scheme, .. } = *configuration;
    let engine = Engine::new(Dynamic::new(bits, layout)?, settings).inpainting(fill.inpaint());
    let engine = engine.showing(scheme, scheme.scan_out());
    let form = Form { layout, bits, snaps: scheme.scan_out() == ScanOut::Nearest };
    engine.run(&reference.update, reference.frames, |frame| {
        if frame.number == 0 {
            return;
        }
        let mut causes = places(reference, frame.number, form, frame.places().into_iter());
        let reached = frame.reached();
        if let Some(truth) = reference.source.truth(frame.number) {
            causes.missing_percent = Some(Cells::of(&truth, &reached).missing_percent());
            let picture = frame.picture();
            let [there, missing] = squares(&picture, &truth, &reached);
            let [there_hold, missing_hold] = squares(&reference.hold, &truth, &reached);
            causes.mse_reached = Some(there);
            causes.mse_missing = Some(missing);
            causes.mse_hold = Some(there_hold + missing_hold);
            if let Source::Capture(_) = reference.source {
                pairs.push((truth, picture));
            }
        }
        frames.push(causes);
    })?;
    Ok((frames, pairs))
}

/// How galpixels are stored and shown.
#[derive(Clone, Copy)]
struct Form {
    layout: Layout,
    bits: Bits,
    /// Whether a galpixel is shown in one cell, wherever in it it is.
    snaps: bool,
}

fn places(
    reference: &Reference<'_>,
    frame: u32,
    Form { layout, bits, snaps }: Form,
    places: impl Iterator<Item = (u32, [f64; 2])>,
) -> FrameCauses {
    let mut sum = FrameCauses { frame, ..FrameCauses::default() };
    let (mut count, mut taylor) = (0u32, None);
    for (origin, place) in places {
        let Some(sample) = reference.update.samples.get(origin as usize) else { continue };
        let from = reference.from(origin);
        let after = |displacement: [f64; 2]| [from[0] + displacement[0], from[1] + displacement[1]];
        let second_order = after(displacement(sample, Layout::FULL, frame));
        let kept = after(displacement(sample, layout, frame));
        let stored = [0, 1].map(|axis| Stored::of(sample, axis, bits, layout, frame));
        let path = after(stored.map(|stored| stored.displacement(frame)));
        // The best-fitting cell, halves towards +infinity; colours that are resampled are where the galpixel is.
        let cell = if snaps { place.map(|coordinate| (coordinate + 0.5).floor()) } else { place };
        let truth = reference.track(origin, frame);
        if let Some(truth) = truth {
            *taylor.get_or_insert(0.0) += apart(second_order, truth);
        }
        sum.left_out_px += apart(kept, second_order);
        sum.quantisation_px += apart(path, kept);
        if stored.iter().all(|stored| stored.fits) {
            sum.drift_px += apart(place, path);
        } else {
            sum.saturation_px += apart(place, path);
        }
        sum.snap_px += apart(cell, place);
        sum.all_px += apart(cell, truth.unwrap_or(second_order));
        count += 1;
    }
    let mean = |sum: f64| if count > 0 { sum / f64::from(count) } else { 0.0 };
    FrameCauses {
        taylor_px: taylor.map(mean),
        left_out_px: mean(sum.left_out_px),
        quantisation_px: mean(sum.quantisation_px),
        drift_px: mean(sum.drift_px),
        saturation_px: mean(sum.saturation_px),
        snap_px: mean(sum.snap_px),
        all_px: mean(sum.all_px),
        ..sum
    }
}

/// Returns the squared error per channel of the cells that were reached, and of those that were not, each by the number
/// of all cells that count: together they are the mean squared error.
fn squares(picture: &Picture, truth: &Truth, reached: &[bool]) -> [f64; 2] {
    let (mut sums, mut cells) = ([0.0; 2], 0u64);
    for (index, (shown, is)) in picture.pixels.iter().zip(&truth.picture.pixels).enumerate() {
        if truth.mask.as_ref().is_none_or(|mask| mask[index]) {
            let square: u64 = shown.iter().zip(is).map(|(&a, &b)| u64::from(a.abs_diff(b)).pow(2)).sum();
            sums[usize::from(!reached[index])] += square as f64;
            cells += 1;
        }
    }
    sums.map(|sum| sum / (3 * cells.max(1)) as f64)
}
