//! Instruments over a picture: pinned, as galpixels of the one map, or painted into the picture.

use galpix_core::{Bits, Dynamic, Format, Layout};
use schemars::JsonSchema;
use serde::Serialize;

use crate::engine::{Engine, EngineError};
use crate::metric;
use crate::overlay::Overlay;
use crate::picture::Picture;
use crate::source::scene::{self, Scene};
use crate::study::job::Request;
use crate::update::{Known, Sample, Update};

/// The results of pinning, for each strategy.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PinnedReport {
    /// Pixels of the display.
    pub pixels: usize,
    /// Pixels that are pinned.
    pub pinned: usize,
    /// Frames of a run.
    pub frames: u32,
    /// The strategies.
    #[serde(rename = "ways")]
    pub strategies: Vec<PinnedStrategy>,
}

/// One strategy.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PinnedStrategy {
    /// `pinned`, `nearest` (galpixels at rest before everything), `painted` (colours on what moves).
    #[serde(rename = "way")]
    pub strategy: &'static str,
    /// Pinned pixels that do not show their colour, mean over the frames.
    pub pinned_wrong: f64,
    /// Other pixels that differ from those with a pinned overlay, mean over the frames.
    pub others_smeared: f64,
    /// PSNR against the truth, dB, of all frames together, see [`metric::pooled_db`].
    pub psnr_db: f64,
    /// The worst frame's.
    pub worst_psnr_db: f64,
}

/// Runs a scene in the three strategies for as many frames as it is meant for.
pub(super) fn compare(scene: &dyn Scene, overlay: &Overlay) -> Result<PinnedReport, EngineError> {
    let update = scene::update(scene, 0.0);
    let with = |pinned: fn(&Sample, [u8; 3]) -> Sample| {
        let mut update = Update { overlay: None, ..update.clone() };
        for (at, pinned_there) in overlay.pixels.iter().enumerate() {
            let (x, y) = (at % overlay.width + update.margin.left, at / overlay.width + update.margin.top);
            let sample = &mut update.samples[y * update.width + x];
            if let Some(colour) = pinned_there {
                *sample = pinned(sample, *colour);
            }
        }
        update
    };
    let nearest = with(|_, colour| Sample { colour, known: Known::Motion, ..Sample::default() });
    let painted = with(|sample, colour| Sample { colour, ..*sample });
    let with_pinned = pictures(&update, scene.frames())?;
    let truths: Vec<Picture> = (1..=scene.frames()).map(|frame| scene::render(scene, f64::from(frame))).collect();
    let mut strategies = Vec::new();
    for (strategy, update) in [("pinned", &update), ("nearest", &nearest), ("painted", &painted)] {
        let shown = pictures(update, scene.frames())?;
        let mut found = PinnedStrategy {
            strategy,
            pinned_wrong: 0.0,
            others_smeared: 0.0,
            psnr_db: 0.0,
            worst_psnr_db: f64::INFINITY,
        };
        let mut decibels = Vec::new();
        let share = 1.0 / f64::from(scene.frames());
        for ((shown, with_pinned), truth) in shown.iter().zip(&with_pinned).zip(&truths) {
            for (((shown, with_pinned), truth), pinned) in
                shown.pixels.iter().zip(&with_pinned.pixels).zip(&truth.pixels).zip(&overlay.pixels)
            {
                found.pinned_wrong += share * f64::from(u8::from(pinned.is_some() && shown != truth));
                found.others_smeared += share * f64::from(u8::from(pinned.is_none() && shown != with_pinned));
            }
            decibels.push(metric::psnr_db(shown, truth, None).unwrap_or(0.0));
        }
        found.psnr_db = metric::pooled_db(&decibels);
        found.worst_psnr_db = decibels.iter().copied().fold(f64::INFINITY, f64::min);
        strategies.push(found);
    }
    Ok(PinnedReport { pixels: overlay.pixels.len(), pinned: overlay.pinned(), frames: scene.frames(), strategies })
}

/// Returns what the display shows in each frame after the update.
fn pictures(update: &Update, frames: u32) -> Result<Vec<Picture>, EngineError> {
    let request = Request::default();
    let bits = Bits::derive(request.demand(update, frames))?;
    // RGB888: colours that are pinned are shown as they are.
    let format = Dynamic::new(bits, Layout::FULL)?;
    let engine = Engine::new(format, request.settings(format.record(), update.depth_kind));
    let mut pictures = Vec::new();
    engine.run(update, frames, |frame| {
        if frame.number > 0 {
            pictures.push(frame.picture());
        }
    })?;
    Ok(pictures)
}
