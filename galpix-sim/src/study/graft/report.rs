//! What a comparison found, as it is written to JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::pinned::PinnedReport;

/// One scene.
#[derive(Debug, Serialize, JsonSchema)]
pub struct GraftReport {
    /// Its name.
    pub scene: &'static str,
    /// Frames of each run.
    pub frames: u32,
    /// Cells of each object's rendering at the beginning, the background first.
    pub objects: Vec<u32>,
    /// Cells of the map.
    pub cells: u32,
    /// The strategies.
    #[serde(rename = "ways")]
    pub strategies: Vec<StrategyReport>,
    /// What pinning does, where the scene has an overlay.
    pub pinned: Option<PinnedReport>,
}

/// One strategy of delivering updates.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct StrategyReport {
    /// Its name.
    #[serde(rename = "way")]
    pub strategy: &'static str,
    /// Frames from one rendering of an object to the next.
    pub objects_every: u32,
    /// Frames from one rendering of the background to the next.
    pub background_every: u32,
    /// Frames from a rendering's stamp until it enters.
    pub late: u32,
    /// Cells sent after the beginning, a frame.
    pub cells_per_frame: f64,
    /// Galpixels among them.
    pub galpixels_per_frame: f64,
    /// PSNR against the truth, dB, of all frames after the beginning together, see [`crate::metric::pooled_db`].
    pub psnr_db: f64,
    /// The worst frame's.
    pub worst_psnr_db: f64,
    /// Mean FLIP.
    pub flip: f64,
    /// How far shown galpixels of objects are from where they truly are, px: mean over all and over the frames; without
    /// fills.
    pub objects_px: f64,
    /// The same for the background.
    pub background_px: f64,
    /// Cells of the display that no galpixel reached, mean over the frames; without fills.
    pub missing: f64,
    /// Renderings handed over after the beginning.
    pub renderings: u32,
    /// Those that the queue refused.
    pub refused: RefusedReport,
    /// What became of the grafted cells.
    pub grafted: GraftedReport,
}

/// How many renderings were refused, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct RefusedReport {
    /// Altogether.
    pub total: u32,
    /// More cells than one rendering may have.
    pub cells: u32,
    /// As many wait as may.
    pub queue: u32,
    /// Too little memory left.
    pub memory: u32,
    /// Too old.
    pub age: u32,
}

/// The core's tally of grafts, summed over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct GraftedReport {
    /// Renderings that entered.
    pub renderings: u32,
    /// Cells that held the objects before.
    pub removed: u32,
    /// New galpixels in the map.
    pub put: u32,
    /// New galpixels behind nearer ones.
    pub behind: u32,
    /// New galpixels that have left the map.
    pub lost: u32,
    /// Galpixels of others that were replaced.
    pub replaced: u32,
}
