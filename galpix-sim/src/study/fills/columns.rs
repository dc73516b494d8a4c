//! The columns of the figures: a line for each source, fill and frame, and one for all frames, whose frame is empty.

use super::figures::Figures;
use super::report::{FillReport, FrameCells, FrameFigures, SourceReport};
use crate::metric::measures::Measures;
use crate::output::column::{Column, Table, Value};
use crate::output::measures::{self, Measured};
use crate::output::number;
use crate::study::run::TruthReport;
use crate::study::timing::Time;

/// A fill in a frame, or in all of them.
pub struct Row<'r> {
    source: &'r SourceReport,
    fill: &'r FillReport,
    figures: &'r Figures,
    frame: Option<(&'r FrameFigures, &'r FrameCells)>,
}

impl Measured for Row<'_> {
    fn measures(&self) -> Measures {
        self.frame.map_or(self.fill.measures, |(frame, _)| frame.truth.measures())
    }
}

impl<'r> Row<'r> {
    fn summary(source: &'r SourceReport, fill: &'r FillReport) -> Self {
        Self { source, fill, figures: &fill.summary, frame: None }
    }

    /// Returns the figures of all cells that the warp leaves open.
    fn open(&self) -> &'r Figures {
        self.frame.map_or(&self.fill.open, |(frame, _)| &frame.open)
    }

    /// Returns a number of cells of the fill's own run.
    fn cells(&self, of: fn(&TruthReport) -> u64) -> Value {
        let all = || self.fill.frames.iter().map(|frame| of(&frame.truth)).sum();
        self.frame.map_or_else(all, |(frame, _)| of(&frame.truth)).into()
    }

    /// Returns the number of the cells that are judged.
    fn disoccluded(&self) -> u64 {
        self.frame.map_or_else(|| self.source.disoccluded(), |(_, cells)| cells.disoccluded)
    }

    /// Returns a figure of all frames together.
    fn of_all(&self, figure: Option<f64>) -> Value {
        figure.filter(|_| self.frame.is_none()).into()
    }

    fn time(&self, of: fn(Time) -> f64) -> Value {
        self.of_all(self.fill.time.map(of))
    }
}

/// Returns the lines of the CSV of a source.
pub fn rows(source: &SourceReport) -> impl Iterator<Item = Row<'_>> {
    source.fills.iter().flat_map(move |fill| {
        let frames = fill.frames.iter().zip(&source.cells);
        let each = frames.map(move |both| Row { source, fill, figures: &both.0.figures, frame: Some(both) });
        each.chain([Row::summary(source, fill)])
    })
}

/// Returns a row for each fill, of all frames together.
pub fn summaries(source: &SourceReport) -> Vec<Row<'_>> {
    source.fills.iter().map(|fill| Row::summary(source, fill)).collect()
}

/// Returns the columns.
pub fn columns<'r>() -> Vec<Column<Row<'r>>> {
    let mut columns = Vec::from(kinds());
    columns.extend(inner());
    columns.extend(open());
    columns.push(
        Column::new(|row: &Row| row.measures().psnr_db.into())
            .csv("whole_psnr_db")
            .both("whole dB", 2)
            .means("PSNR of the whole picture, a mean over the frames like the four columns that follow"),
    );
    columns.extend(measures::columns());
    columns.push(
        Column::new(|row: &Row| row.figures.ssimulacra2.into())
            .csv("ssimulacra2")
            .both("SSIMUL2", 2)
            .means("SSIMULACRA2 of the whole picture, 100 for equals"),
    );
    columns.extend(times());
    columns
}

/// Returns what a row is.
fn kinds<'r>() -> [Column<Row<'r>>; 9] {
    [
        Column::new(|row: &Row| row.source.source.as_str().into()).csv("source"),
        Column::new(|row: &Row| row.fill.name.into())
            .csv("fill")
            .both("fill", 0)
            .words()
            .means("what is put into the cells that the warp leaves open"),
        Column::new(|row: &Row| row.fill.scheme.into())
            .csv("scheme")
            .both("scheme", 0)
            .words()
            .means("how galpixels move: as map or as stationary sources"),
        Column::new(|row: &Row| row.fill.gamma.into()).csv("gamma"),
        Column::new(|row: &Row| row.fill.depth_aware.into()).csv("depth_aware"),
        Column::new(|row: &Row| row.frame.map(|(frame, _)| frame.frame).into()).csv("frame"),
        Column::new(|row: &Row| row.cells(|truth| truth.missing)).csv("missing"),
        Column::new(|row: &Row| row.cells(|truth| truth.missing_at_border)).csv("at_border"),
        Column::new(|row: &Row| row.disoccluded().into()).csv("disoccluded"),
    ]
}

/// Returns the figures of the inner cells.
fn inner<'r>() -> [Column<Row<'r>>; 6] {
    [
        Column::new(|row: &Row| row.figures.psnr_db.into())
            .csv("psnr_db")
            .both("inner dB", 2)
            .means("PSNR of the inner cells: those that the map's warp leaves open, not connected with the border"),
        Column::new(|row: &Row| row.figures.ssim.into())
            .csv("ssim")
            .both("SSIM", 4)
            .means("of the inner cells, all others set to the truth, 1 for equals"),
        Column::new(|row: &Row| row.figures.flip.into()).csv("flip").both("FLIP", 4).means("likewise, 0 for equals"),
        Column::new(|row: &Row| row.figures.variance.into())
            .csv("variance")
            .both("variance", 1)
            .means("of luma in the 7x7 cells around each inner one: less than the truth's is blurred"),
        Column::new(|row: &Row| row.of_all(row.source.truth.variance)).csv("truth_variance"),
        Column::new(|row: &Row| row.figures.flicker.into())
            .csv("flicker")
            .both("flicker", 3)
            .signed()
            .means("mean change of luma of inner cells from the frame before, less that of the truth"),
    ]
}

/// Returns the figures of all cells that the warp leaves open.
fn open<'r>() -> [Column<Row<'r>>; 3] {
    [
        Column::new(|row: &Row| row.open().psnr_db.into())
            .csv("open_psnr_db")
            .both("open dB", 2)
            .means("PSNR of all cells that the warp leaves open, those connected with the border too"),
        Column::new(|row: &Row| row.open().ssim.into())
            .csv("open_ssim")
            .both("open SSIM", 4)
            .means("of all these cells, the others set to the truth"),
        Column::new(|row: &Row| row.open().flip.into()).csv("open_flip").both("open FLIP", 4).means("likewise"),
    ]
}

fn times<'r>() -> [Column<Row<'r>>; 6] {
    [
        Column::new(|row: &Row| row.time(|time| time.frame_us)).csv("frame_us").both("us/frame", 1).means(
            "time of the whole frame with its fill, of stationary sources with the picture: the median of the rounds",
        ),
        Column::new(|row: &Row| row.time(|time| time.uncertain_percent()))
            .both("+- %", 0)
            .means("half the range of the rounds, of the median: times that differ by less are not told apart"),
        Column::new(|row: &Row| row.time(|time| time.frame_us_range[0])).csv("frame_us_low"),
        Column::new(|row: &Row| row.time(|time| time.frame_us_range[1])).csv("frame_us_high"),
        Column::new(|row: &Row| row.time(|time| time.ns_per_cell))
            .csv("ns_per_galpixel")
            .both("ns/galpixel", 2)
            .means("that time by the cells of the map"),
        Column::new(|row: &Row| row.time(|time| time.x_copy))
            .csv("x_copy")
            .both("x copy", 2)
            .means("that time by a copy of the map"),
    ]
}

/// Returns a source as text.
pub fn text(report: &SourceReport) -> String {
    let frames = report.cells.len();
    let mean = |cells: u64| cells as f64 / frames.max(1) as f64;
    let head = format!(
        "{}: {}x{}, {} frames with a truth; the warp leaves {:.1} cells a frame open, {:.1} of them inner ones ({:.1} %); \
         the truth there: variance {}, change {}",
        report.source,
        report.width,
        report.height,
        frames,
        mean(report.missing()),
        mean(report.disoccluded()),
        100.0 * report.disoccluded() as f64 / report.missing().max(1) as f64,
        number(report.truth.variance, 1),
        number(report.truth.change, 3)
    );
    let (columns, rows) = (columns(), summaries(report));
    let table = Table::new(&columns, &rows);
    let lines = std::iter::once(head).chain(table.lines(&rows));
    lines.chain(report.noise.and_then(|noise| noise.warning())).collect::<Vec<_>>().join("\n")
}
