//! What the terminal shows: a line per strategy, and a line per strategy of pinning.

use super::pinned::PinnedStrategy;
use super::report::{GraftReport, StrategyReport};
use crate::output::column::{Column, Table};

fn strategies() -> [Column<StrategyReport>; 12] {
    let column = Column::<StrategyReport>::new;
    [
        column(|strategy| strategy.strategy.into()).terminal("way", 0).words(),
        column(|strategy| strategy.objects_every.into()).terminal("objects", 0),
        column(|strategy| strategy.background_every.into()).terminal("backgr.", 0),
        column(|strategy| strategy.late.into()).terminal("late", 0),
        column(|strategy| strategy.cells_per_frame.into()).terminal("cells/f", 0),
        column(|strategy| strategy.psnr_db.into()).terminal("dB", 2),
        column(|strategy| strategy.worst_psnr_db.into()).terminal("worst", 2),
        column(|strategy| strategy.flip.into()).terminal("FLIP", 4),
        column(|strategy| strategy.objects_px.into()).terminal("obj px", 4),
        column(|strategy| strategy.background_px.into()).terminal("back px", 4),
        column(|strategy| strategy.missing.into()).terminal("missing", 0),
        column(|strategy| format!("{}/{}", strategy.refused.total, strategy.renderings).into()).terminal("refused", 0),
    ]
}

fn pinned() -> [Column<PinnedStrategy>; 5] {
    let column = Column::<PinnedStrategy>::new;
    [
        column(|strategy| strategy.strategy.into()).terminal("instruments", 0).words(),
        column(|strategy| strategy.pinned_wrong.into()).terminal("pinned wrong", 1),
        column(|strategy| strategy.others_smeared.into()).terminal("others smear", 1),
        column(|strategy| strategy.psnr_db.into()).terminal("dB", 2),
        column(|strategy| strategy.worst_psnr_db.into()).terminal("worst", 2),
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
    lines.extend(Table::new(&strategies(), &report.strategies).lines(&report.strategies));
    if let Some(found) = &report.pinned {
        lines.push(format!("\n{} of {} pixels are pinned, {} frames", found.pinned, found.pixels, found.frames));
        lines.extend(Table::new(&pinned(), &found.strategies).lines(&found.strategies));
    }
    lines.join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "objects, backgr.: frames from one rendering to the next; late: frames until it enters; cells/f: cells \
    sent a frame; dB (of all frames together), worst, FLIP: against the truth; obj px, back px: how far shown galpixels are from their true places; \
    missing: cells that no galpixel reached (the last three without fills); refused: renderings that the queue refused, of all";
