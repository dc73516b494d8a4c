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
pub fn columns<'r>() -> Vec<Column<Row<'r>>> {
    let mut columns = Vec::from(samples());
    columns.extend(cells());
    columns.extend(pictures());
    columns.extend(times());
    columns
}

/// Returns the columns of what is handed over.
fn samples<'r>() -> [Column<Row<'r>>; 6] {
    [
        Column::new(|row: &Row| row.source.source.as_str().into()).csv("source"),
        Column::new(|row: &Row| row.strategy.name.as_str().into())
            .csv("way")
            .both("way", 0)
            .words()
            .means("which hidden samples are handed over, and how"),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.layers as u64)).csv("layers").csv_else("0"),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.offered.into()))
            .csv("offered")
            .csv_else("0")
            .both("offered", 0)
            .means("samples behind the first layer that the source has"),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.kept.into()))
            .csv("kept")
            .csv_else("0")
            .both("kept", 0)
            .means("those that are handed over"),
        Column::new(|row: &Row| row.hidden(|hidden| hidden.used.into()))
            .csv("used")
            .csv_else("0")
            .both("used", 0)
            .means("those that the display ever showed"),
    ]
}

/// Returns the columns of what no galpixel reached.
fn cells<'r>() -> [Column<Row<'r>>; 5] {
    [
        Column::new(|row: &Row| row.frame.map(|frame| frame.frame).into()).csv("frame"),
        Column::new(|row: &Row| row.cells(|frame| frame.missing, row.strategy.missing)).csv("missing"),
        Column::new(|row: &Row| row.cells(|frame| frame.disoccluded, row.strategy.disoccluded)).csv("disoccluded"),
        Column::new(|row: &Row| row.mean(row.strategy.missing))
            .both("missing", 1)
            .means("cells that no galpixel of the update reached, a frame"),
        Column::new(|row: &Row| row.mean(row.strategy.disoccluded))
            .both("disoccluded", 1)
            .means("those that the first layer alone leaves open and that are not connected with the border, a frame"),
    ]
}

/// Returns the columns of the errors of the pictures.
fn pictures<'r>() -> [Column<Row<'r>>; 3] {
    [
        Column::new(|row: &Row| row.figure(|frame| frame.psnr_db, row.strategy.psnr_db))
            .csv("psnr_db")
            .both("PSNR dB", 2)
            .means("of the whole picture after the fill, the mean of the frames"),
        Column::new(|row: &Row| row.figure(|frame| frame.flip, row.strategy.flip))
            .csv("flip")
            .both("FLIP", 4)
            .means("likewise, 0 for equals"),
        Column::new(|row: &Row| row.figure(|frame| frame.disoccluded_db, row.strategy.disoccluded_db))
            .csv("disoccluded_db")
            .both("there dB", 2)
            .means("PSNR of the disoccluded cells"),
    ]
}

fn times<'r>() -> [Column<Row<'r>>; 7] {
    [
        Column::new(|row: &Row| row.time(|time| time.frame_us))
            .csv("frame_us")
            .both("us/frame", 1)
            .means("time of a frame, the median of the rounds"),
        Column::new(|row: &Row| row.time(|time| time.uncertain_percent()))
            .both("+- %", 0)
            .means("half the range of the rounds, of the median: times that differ by less are not told apart"),
        Column::new(|row: &Row| row.time(|time| time.frame_us_range[0])).csv("frame_us_low"),
        Column::new(|row: &Row| row.time(|time| time.frame_us_range[1])).csv("frame_us_high"),
        Column::new(|row: &Row| row.of_all(row.strategy.x_one))
            .csv("x_one")
            .both("x one", 2)
            .means("the time of a frame by that of the first layer alone"),
        Column::new(|row: &Row| row.time(|time| time.x_copy)).both("x copy", 2).means("by a copy of its map"),
        Column::new(|row: &Row| row.of_all(row.strategy.update_us))
            .csv("update_us")
            .both("us/update", 1)
            .means("time of the disocclusion map of an update"),
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
    let table = Table::new(&columns, &rows);
    let lines = std::iter::once(head).chain(table.lines(&rows));
    lines.chain(report.noise.and_then(|noise| noise.warning())).collect::<Vec<_>>().join("\n")
}
