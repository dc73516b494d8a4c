//! What the terminal says.

use super::report::{FillReport, SourceReport};

/// A number of a fill, and how many digits it has after the point.
type Column = (&'static str, usize, fn(&FillReport) -> Option<f64>);

const COLUMNS: [Column; 9] = [
    ("PSNR dB", 2, |fill| fill.summary.psnr_db),
    ("SSIM", 4, |fill| fill.summary.ssim),
    ("FLIP", 4, |fill| fill.summary.flip),
    ("variance", 1, |fill| fill.summary.variance),
    ("flicker", 3, |fill| fill.summary.flicker),
    ("SSIMUL2", 2, |fill| fill.summary.ssimulacra2),
    ("us/frame", 1, |fill| fill.time.map(|time| time.frame_us)),
    ("ns/galpixel", 2, |fill| fill.time.map(|time| time.ns_per_cell)),
    ("x copy", 2, |fill| fill.time.map(|time| time.x_copy)),
];

/// A source as text.
#[must_use]
pub fn text(report: &SourceReport) -> String {
    let frames = report.cells.len();
    let mean = |cells: u64| cells as f64 / frames.max(1) as f64;
    let mut lines = vec![format!(
        "{}: {}x{}, {} frames with a truth; disoccluded {:.1} cells a frame, {:.1} more at the border; the truth there: variance {}, \
         change {}",
        report.source,
        report.width,
        report.height,
        frames,
        mean(report.disoccluded()),
        mean(report.cells.iter().map(|frame| frame.at_border).sum()),
        number(report.truth.variance, 1),
        number(report.truth.change, 3)
    )];
    let heading = COLUMNS.iter().map(|(name, ..)| format!(" {name:>11}"));
    lines.push(format!("{:<18}{}", "fill", heading.collect::<String>()));
    for fill in &report.fills {
        let cells = COLUMNS.iter().map(|(_, digits, figure)| format!(" {:>11}", number(figure(fill), *digits)));
        lines.push(format!("{:<18}{}", fill.name, cells.collect::<String>()));
    }
    lines.join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "PSNR, SSIM, FLIP (0 is best) and variance: over the disoccluded cells alone, all others set to the truth. \
variance: of luma, in 7x7 cells around each; flicker: change of luma from the frame before, less the truth's, where both frames are \
disoccluded; SSIMUL2: SSIMULACRA2 of the whole picture; times: of the whole frame with the fill, x copy: by a copy of the map.";

/// A figure or a dash.
fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
