//! The columns of the figures: a line for each source, strategy and frame, and one for all frames, whose frame is
//! empty.

use super::report::{SourceReport, StrategyFrame, StrategyReport};
use crate::output::column::{Column, Table, Value};
use crate::source::hidden::HiddenReport;
use crate::study::timing::Time;

/// A strategy in a frame, or in all of them.
pub struct Row<'r> {
    source: &'r SourceReport,
    strategy: &'r StrategyReport,
    frame: Option<&'r StrategyFrame>,
}

impl Row<'_> {
    fn hidden(&self, of: fn(&HiddenReport) -> u64) -> Value {
        self.strategy.hidden.as_ref().map(of).into()
    }

    fn cells(&self, of: fn(&StrategyFrame) -> u64, all: u64) -> Value {
        self.frame.map_or(all, of).into()
    }

    fn figure(&self, of: fn(&StrategyFrame) -> Option<f64>, all: Option<f64>) -> Value {
        self.frame.map_or(all, of).into()
    }

    /// Returns a figure of all frames together.
    fn of_all(&self, figure: Option<f64>) -> Value {
        figure.filter(|_| self.frame.is_none()).into()
    }

    fn time(&self, of: fn(Time) -> f64) -> Value {
        self.of_all(self.strategy.time.map(of))
    }

    fn mean(&self, cells: u64) -> Value {
        (cells as f64 / self.strategy.frames.len().max(1) as f64).into()
    }
}

/// Returns the lines of the CSV of a source.
pub fn rows(source: &SourceReport) -> impl Iterator<Item = Row<'_>> {
    source.strategies.iter().flat_map(move |strategy| {
        let frames = strategy.frames.iter().map(Some).chain([None]);
        frames.map(move |frame| Row { source, strategy, frame })
    })
}

/// Returns a row for each strategy, of all frames together.
pub fn summaries(source: &SourceReport) -> Vec<Row<'_>> {
    source.strategies.iter().map(|strategy| Row { source, strategy, frame: None }).collect()
}

/// Returns the columns. Missing cells are summed up in the CSV, and means elsewhere.
pub fn columns<'r>() -> [Column<Row<'r>>; 18] {
    [
        Column::new(|row: &Row| row.source.source.as_str().into()).csv("source"),
        Column::new(|row: &Row| row.strategy.name.as_str().into()).csv("way").both("way", 0).words(),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.layers as u64)).csv("layers").csv_else("0"),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.offered.into()))
            .csv("offered")
            .csv_else("0")
            .both("offered", 0),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.kept.into())).csv("kept").csv_else("0").both("kept", 0),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.used.into())).csv("used").csv_else("0").both("used", 0),
        Column::new(|row: &Row| row.frame.map(|frame| frame.frame).into()).csv("frame"),
        Column::new(|row: &Row| row.cells(|frame| frame.missing, row.strategy.missing)).csv("missing"),
        Column::new(|row: &Row| row.cells(|frame| frame.disoccluded, row.strategy.disoccluded)).csv("disoccluded"),
        Column::new(|row: &Row| row.mean(row.strategy.missing)).both("missing", 1),
        Column::new(|row: &Row| row.mean(row.strategy.disoccluded)).both("disoccluded", 1),
        Column::new(|row: &Row| row.figure(|frame| frame.psnr_db, row.strategy.psnr_db))
            .csv("psnr_db")
            .both("PSNR dB", 2),
        Column::new(|row: &Row| row.figure(|frame| frame.flip, row.strategy.flip)).csv("flip").both("FLIP", 4),
        Column::new(|row: &Row| row.figure(|frame| frame.disoccluded_db, row.strategy.disoccluded_db))
            .csv("disoccluded_db")
            .both("there dB", 2),
        Column::new(|row: &Row| row.time(|time| time.frame_us)).csv("frame_us").both("us/frame", 1),
        Column::new(|row: &Row| row.of_all(row.strategy.x_one)).csv("x_one").both("x one", 2),
        Column::new(|row: &Row| row.time(|time| time.x_copy)).both("x copy", 2),
        Column::new(|row: &Row| row.of_all(row.strategy.update_us)).csv("update_us").both("us/update", 1),
    ]
}

/// Returns a source as text.
pub fn text(report: &SourceReport) -> String {
    let head = format!(
        "{}: {}x{}, {} frames with a truth, {} frames to the next update",
        report.source,
        report.width,
        report.height,
        report.cells.len(),
        report.frames
    );
    let (columns, rows) = (columns(), summaries(report));
    std::iter::once(head).chain(Table::new(&columns, &rows).lines(&rows)).collect::<Vec<_>>().join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "offered, kept, used: samples behind the first layer that the source has, that are handed over, that the display ever \
showed; missing: cells that no galpixel reached, a frame; disoccluded: those of them that the first layer alone leaves open and that are not connected \
with the border, a frame; PSNR, FLIP (0 is best): of the whole picture after the fill, means over the frames; there: over the disoccluded cells; \
x one: the time of a frame by that of the first layer alone, x copy: by a copy of its map; us/update: the disocclusion map.";
