//! What the terminal says.

use super::report::{SourceReport, WayReport};
use crate::source::hidden::HiddenReport;

/// A number of a way, and how many digits it has after the point.
pub(super) type Column = (&'static str, usize, fn(&WayReport) -> Option<f64>);

fn hidden(way: &WayReport, of: fn(&HiddenReport) -> u32) -> Option<f64> {
    way.hidden.as_ref().map(|hidden| f64::from(of(hidden)))
}

/// The columns of the table, here and on the page.
pub(super) const COLUMNS: [Column; 12] = [
    ("offered", 0, |way| hidden(way, |hidden| hidden.offered)),
    ("kept", 0, |way| hidden(way, |hidden| hidden.kept)),
    ("used", 0, |way| hidden(way, |hidden| hidden.used)),
    ("missing", 1, |way| Some(way.missing as f64 / way.frames.len().max(1) as f64)),
    ("disoccluded", 1, |way| Some(way.disoccluded as f64 / way.frames.len().max(1) as f64)),
    ("PSNR dB", 2, |way| way.psnr_db),
    ("FLIP", 4, |way| way.flip),
    ("there dB", 2, |way| way.disoccluded_db),
    ("us/frame", 1, |way| way.time.map(|time| time.frame_us)),
    ("x one", 2, |way| way.x_one),
    ("x copy", 2, |way| way.time.map(|time| time.x_copy)),
    ("us/update", 1, |way| way.update_us),
];

/// A source as text.
#[must_use]
pub fn text(report: &SourceReport) -> String {
    let mut lines = vec![format!(
        "{}: {}x{}, {} frames with a truth, {} frames to the next update",
        report.source,
        report.width,
        report.height,
        report.cells.len(),
        report.frames
    )];
    let heading = COLUMNS.iter().map(|(name, ..)| format!(" {name:>11}"));
    lines.push(format!("{:<34}{}", "way", heading.collect::<String>()));
    for way in &report.ways {
        let cells = COLUMNS.iter().map(|(_, digits, figure)| format!(" {:>11}", number(figure(way), *digits)));
        lines.push(format!("{:<34}{}", way.name, cells.collect::<String>()));
    }
    lines.join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "offered, kept, used: samples behind the first layer that the source has, that are handed over, that the display ever \
showed; missing: cells that no galpixel reached, a frame; disoccluded: those of them that the first layer alone leaves open and that are not connected \
with the border, a frame; PSNR, FLIP (0 is best): of the whole picture after the fill, means over the frames; there: over the disoccluded cells; \
x one: the time of a frame by that of the first layer alone, x copy: by a copy of its map; us/update: the disocclusion map.";

/// A figure or a dash.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
