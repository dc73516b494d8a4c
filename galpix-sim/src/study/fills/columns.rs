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
    let mut columns = vec![
        Column::new(|row: &Row| row.source.source.as_str().into()).csv("source"),
        Column::new(|row: &Row| row.fill.name.into()).csv("fill").both("fill", 0).words(),
        Column::new(|row: &Row| row.fill.scheme.into()).csv("scheme").both("scheme", 0).words(),
        Column::new(|row: &Row| row.fill.gamma.into()).csv("gamma"),
        Column::new(|row: &Row| row.fill.depth_aware.into()).csv("depth_aware"),
        Column::new(|row: &Row| row.frame.map(|(frame, _)| frame.frame).into()).csv("frame"),
        Column::new(|row: &Row| row.cells(|truth| truth.missing)).csv("missing"),
        Column::new(|row: &Row| row.cells(|truth| truth.missing_at_border)).csv("at_border"),
        Column::new(|row: &Row| row.disoccluded().into()).csv("disoccluded"),
        Column::new(|row: &Row| row.figures.psnr_db.into()).csv("psnr_db").both("PSNR dB", 2),
        Column::new(|row: &Row| row.figures.ssim.into()).csv("ssim").both("SSIM", 4),
        Column::new(|row: &Row| row.figures.flip.into()).csv("flip").both("FLIP", 4),
        Column::new(|row: &Row| row.figures.variance.into()).csv("variance").both("variance", 1),
        Column::new(|row: &Row| row.of_all(row.source.truth.variance)).csv("truth_variance"),
        Column::new(|row: &Row| row.figures.flicker.into()).csv("flicker").both("flicker", 3).signed(),
        Column::new(|row: &Row| row.measures().psnr_db.into()).csv("whole_psnr_db").both("whole dB", 2),
    ];
    columns.extend(measures::columns());
    columns.extend([
        Column::new(|row: &Row| row.figures.ssimulacra2.into())
            .csv("ssimulacra2")
            .terminal("SSIMUL2", 2)
            .page("SSIMULACRA2", 2),
        Column::new(|row: &Row| row.time(|time| time.frame_us))
            .csv("frame_us")
            .terminal("us/frame", 1)
            .page("\u{00B5}s a frame", 0),
        Column::new(|row: &Row| row.time(|time| time.ns_per_cell))
            .csv("ns_per_galpixel")
            .terminal("ns/galpixel", 2)
            .page("ns a galpixel", 2),
        Column::new(|row: &Row| row.time(|time| time.x_copy))
            .csv("x_copy")
            .terminal("x copy", 2)
            .page("\u{00D7} copy", 1),
    ]);
    columns
}

/// Returns a source as text.
pub fn text(report: &SourceReport) -> String {
    let frames = report.cells.len();
    let mean = |cells: u64| cells as f64 / frames.max(1) as f64;
    let head = format!(
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
    );
    let (columns, rows) = (columns(), summaries(report));
    std::iter::once(head).chain(Table::new(&columns, &rows).lines(&rows)).collect::<Vec<_>>().join("\n")
}

/// What the columns are.
pub const LEGEND: &str = "PSNR, SSIM, FLIP (0 is best) and variance: over the disoccluded cells alone, all others set to the truth: those that \
the map leaves open without a fill, for all schemes and fills. \
variance: of luma, in 7x7 cells around each; flicker: change of luma from the frame before, less the truth's, where both frames are \
disoccluded; whole, SSIMUL2: PSNR, SSIMULACRA2 of the whole picture; times: of the whole frame with the fill, x copy: by a copy of the map; of stationary sources with the picture.";
