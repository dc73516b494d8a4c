//! The figures as comma-separated values: a line for each source, way and frame, and one for all frames, whose frame is empty.

use super::report::{Document, SourceReport, WayFrame, WayReport};
use crate::study::error::csv::line;

/// The columns, in order.
pub const COLUMNS: [&str; 15] = [
    "source",
    "way",
    "layers",
    "offered",
    "kept",
    "used",
    "frame",
    "missing",
    "disoccluded",
    "psnr_db",
    "flip",
    "disoccluded_db",
    "frame_us",
    "x_one",
    "update_us",
];

/// The document's figures.
#[must_use]
pub fn csv(document: &Document) -> String {
    let mut text = line(&COLUMNS.map(str::to_owned));
    for source in &document.sources {
        for way in &source.ways {
            for frame in &way.frames {
                text += &line(&row(source, way, Some(frame)));
            }
            text += &line(&row(source, way, None));
        }
    }
    text
}

fn row(source: &SourceReport, way: &WayReport, frame: Option<&WayFrame>) -> Vec<String> {
    let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    let of_all = |value: Option<f64>| number(value.filter(|_| frame.is_none()));
    let hidden = way.hidden.as_ref();
    let or = |of: fn(&WayFrame) -> Option<f64>, all: Option<f64>| number(frame.map_or(all, of));
    vec![
        source.source.clone(),
        way.name.clone(),
        hidden.map_or(0, |hidden| hidden.layers).to_string(),
        hidden.map_or(0, |hidden| hidden.offered).to_string(),
        hidden.map_or(0, |hidden| hidden.kept).to_string(),
        hidden.map_or(0, |hidden| hidden.used).to_string(),
        frame.map(|frame| frame.frame.to_string()).unwrap_or_default(),
        frame.map_or(way.missing, |frame| frame.missing).to_string(),
        frame.map_or(way.disoccluded, |frame| frame.disoccluded).to_string(),
        or(|frame| frame.psnr_db, way.psnr_db),
        or(|frame| frame.flip, way.flip),
        or(|frame| frame.disoccluded_db, way.disoccluded_db),
        of_all(way.time.map(|time| time.frame_us)),
        of_all(way.x_one),
        of_all(way.update_us),
    ]
}
