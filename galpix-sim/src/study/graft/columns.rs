//! What the terminal says: a line a way, and a line a way of pinning.

use super::pinned::PinnedWay;
use super::report::{GraftReport, WayReport};
use crate::output::column::{Column, Table};

fn ways() -> [Column<WayReport>; 12] {
    let column = Column::<WayReport>::new;
    [
        column(|way| way.way.into()).terminal("way", 0).words(),
        column(|way| way.objects_every.into()).terminal("objects", 0),
        column(|way| way.background_every.into()).terminal("backgr.", 0),
        column(|way| way.late.into()).terminal("late", 0),
        column(|way| way.cells_per_frame.into()).terminal("cells/f", 0),
        column(|way| way.psnr_db.into()).terminal("dB", 2),
        column(|way| way.worst_psnr_db.into()).terminal("worst", 2),
        column(|way| way.flip.into()).terminal("FLIP", 4),
        column(|way| way.objects_px.into()).terminal("obj px", 4),
        column(|way| way.background_px.into()).terminal("back px", 4),
        column(|way| way.missing.into()).terminal("missing", 0),
        column(|way| format!("{}/{}", way.refused.total, way.renderings).into()).terminal("refused", 0),
    ]
}

fn pinned() -> [Column<PinnedWay>; 5] {
    let column = Column::<PinnedWay>::new;
    [
        column(|way| way.way.into()).terminal("instruments", 0).words(),
        column(|way| way.pinned_wrong.into()).terminal("pinned wrong", 1),
        column(|way| way.others_smeared.into()).terminal("others smear", 1),
        column(|way| way.psnr_db.into()).terminal("dB", 2),
        column(|way| way.worst_psnr_db.into()).terminal("worst", 2),
    ]
}

/// Returns a scene as text.
pub fn text(report: &GraftReport) -> String {
    let mut lines = vec![format!(
        "{}: {} objects of {:?} cells in a map of {}, {} frames",
        report.scene,
        report.objects.len(),
        report.objects,
        report.cells,
        report.frames
    )];
    lines.extend(Table::new(&ways(), &report.ways).lines(&report.ways));
    if let Some(found) = &report.pinned {
        lines.push(format!("\n{} of {} pixels are pinned, {} frames", found.pinned, found.pixels, found.frames));
        lines.extend(Table::new(&pinned(), &found.ways).lines(&found.ways));
    }
    lines.join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "objects, backgr.: frames from one rendering to the next; late: frames until it enters; cells/f: cells \
    sent a frame; dB (of all frames together), worst, FLIP: against the truth; obj px, back px: how far shown galpixels are from their true places; \
    missing: cells that no galpixel reached (the last three without fills); refused: renderings that the queue refused, of all";
