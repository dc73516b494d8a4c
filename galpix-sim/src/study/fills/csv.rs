//! The figures as comma-separated values: a line for each source, fill and frame, and one for all frames, whose frame is empty.

use super::figures::Figures;
use super::report::{Document, FillReport, FrameCells, SourceReport};
use crate::study::error::csv::line;

/// The columns, in order.
pub const COLUMNS: [&str; 18] = [
    "source",
    "fill",
    "gamma",
    "depth_aware",
    "frame",
    "missing",
    "at_border",
    "disoccluded",
    "psnr_db",
    "ssim",
    "flip",
    "variance",
    "truth_variance",
    "flicker",
    "ssimulacra2",
    "frame_us",
    "ns_per_galpixel",
    "x_copy",
];

/// The document's figures.
#[must_use]
pub fn csv(document: &Document) -> String {
    let mut text = line(&COLUMNS.map(str::to_owned));
    for source in &document.sources {
        for fill in &source.fills {
            for (frame, cells) in fill.frames.iter().zip(&source.cells) {
                text += &line(&row(source, fill, &frame.figures, Some(cells)));
            }
            text += &line(&row(source, fill, &fill.summary, None));
        }
    }
    text
}

fn row(source: &SourceReport, fill: &FillReport, figures: &Figures, frame: Option<&FrameCells>) -> Vec<String> {
    let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    let cells = |cells: fn(&FrameCells) -> u64| match frame {
        Some(frame) => cells(frame).to_string(),
        None => source.cells.iter().map(cells).sum::<u64>().to_string(),
    };
    let of_all = |value: Option<f64>| number(value.filter(|_| frame.is_none()));
    vec![
        source.source.clone(),
        fill.name.to_owned(),
        fill.gamma.unwrap_or_default().to_owned(),
        fill.depth_aware.map(|aware| aware.to_string()).unwrap_or_default(),
        frame.map(|frame| frame.frame.to_string()).unwrap_or_default(),
        cells(|frame| frame.missing),
        cells(|frame| frame.at_border),
        cells(|frame| frame.disoccluded),
        number(figures.psnr_db),
        number(figures.ssim),
        number(figures.flip),
        number(figures.variance),
        of_all(source.truth.variance),
        number(figures.flicker),
        number(figures.ssimulacra2),
        of_all(fill.time.map(|time| time.frame_us)),
        of_all(fill.time.map(|time| time.ns_per_cell)),
        of_all(fill.time.map(|time| time.x_copy)),
    ]
}
