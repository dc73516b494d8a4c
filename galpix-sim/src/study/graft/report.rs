//! What a comparison found, for programs and for people.

use serde::Serialize;

use super::pinned::PinnedReport;

/// One scene.
#[derive(Debug, Serialize)]
pub struct GraftReport {
    /// Its name.
    pub scene: &'static str,
    /// Frames of each run.
    pub frames: u32,
    /// Cells of each object's rendering at the beginning, the background first.
    pub objects: Vec<u32>,
    /// Cells of the map.
    pub cells: u32,
    /// The ways.
    pub ways: Vec<WayReport>,
    /// What pinning does, where the scene has an overlay.
    pub pinned: Option<PinnedReport>,
}

/// One way of delivering updates.
#[derive(Debug, Default, Serialize)]
pub struct WayReport {
    /// Its name.
    pub way: &'static str,
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
    /// How far shown galpixels of objects are from where they truly are, px: mean over all and over the frames; without fills.
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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

/// The report as a table.
#[must_use]
pub fn table(report: &GraftReport) -> String {
    let mut lines = vec![
        format!(
            "{}: {} objects of {:?} cells in a map of {}, {} frames",
            report.scene,
            report.objects.len(),
            report.objects,
            report.cells,
            report.frames
        ),
        format!(
            "{:<19} {:>7} {:>7} {:>4} {:>8} {:>6} {:>6} {:>6} {:>8} {:>8} {:>7} {:>9}",
            "way",
            "objects",
            "backgr.",
            "late",
            "cells/f",
            "dB",
            "worst",
            "FLIP",
            "obj px",
            "back px",
            "missing",
            "refused"
        ),
    ];
    for way in &report.ways {
        lines.push(format!(
            "{:<19} {:>7} {:>7} {:>4} {:>8.0} {:>6.2} {:>6.2} {:>6.4} {:>8.4} {:>8.4} {:>7.0} {:>9}",
            way.way,
            way.objects_every,
            way.background_every,
            way.late,
            way.cells_per_frame,
            way.psnr_db,
            way.worst_psnr_db,
            way.flip,
            way.objects_px,
            way.background_px,
            way.missing,
            format!("{}/{}", way.refused.total, way.renderings)
        ));
    }
    if let Some(pinned) = &report.pinned {
        lines.push(format!(
            "\n{} of {} pixels are pinned, {} frames\n{:<16} {:>12} {:>12} {:>6} {:>6}",
            pinned.pinned, pinned.pixels, pinned.frames, "instruments", "pinned wrong", "others smear", "dB", "worst"
        ));
        for way in &pinned.ways {
            lines.push(format!(
                "{:<16} {:>12.1} {:>12.1} {:>6.2} {:>6.2}",
                way.way, way.pinned_wrong, way.others_smeared, way.psnr_db, way.worst_psnr_db
            ));
        }
    }
    lines.join("\n")
}

/// What the columns mean.
pub const LEGEND: &str = "objects, backgr.: frames from one rendering to the next; late: frames until it enters; cells/f: cells \
    sent a frame; dB (of all frames together), worst, FLIP: against the truth; obj px, back px: how far shown galpixels are from their true places; \
    missing: cells that no galpixel reached (the last three without fills); refused: renderings that the queue refused, of all";
