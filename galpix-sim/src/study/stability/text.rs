//! What the terminal shows: paths, pictures, and the drift of each rounding, one line per case.

use super::summary::{CaseReport, PictureReport, Report, RoundingReport, Shares};
use super::verdict::{Uncovered, Verdict};
use crate::output::column::{Column, Table, Value};

/// What the columns are.
pub const LEGEND: &str = "paths: the largest error in any frame, in px, as a sum of what second order cannot know (Taylor), what is stored in few \
bits (quant), rounding in each frame (drift), the cell that shows it (snap) and ranges that stopped it (satur); bound: the most that the law of the \
budget allows of quant and drift; f32, f64: the error of the same path in floats; clamped: fields that a range stopped. pictures: galpixels that \
moved, settled in a cell, were lost over the border or collided, cells left as holes, the largest error and its bound in px. drift: the largest of \
each rounding.";

/// A case, and the rounding that is shown of it.
struct Row<'r> {
    case: &'r CaseReport,
    shown: &'r RoundingReport,
}

impl Row<'_> {
    fn worst(&self, of: fn(Shares) -> f64) -> Value {
        self.shown.worst.map(|worst| px(of(worst))).into()
    }

    fn sum(&self, of: fn(&PictureReport) -> u64) -> Value {
        self.shown.pictures.iter().map(of).sum::<u64>().into()
    }

    fn largest(&self, of: fn(&PictureReport) -> f64) -> Value {
        px(self.shown.pictures.iter().map(of).fold(0.0, f64::max)).into()
    }

    fn verdict(&self) -> Value {
        verdict(self.shown.verdict, self.shown.uncovered).into()
    }
}

fn paths<'r>() -> [Column<Row<'r>>; 12] {
    [
        Column::new(|row: &Row| row.case.name.into()).terminal("paths", 0).words(),
        Column::new(|row: &Row| row.shown.frames.into()).terminal("frames", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.taylor_px)).terminal("Taylor", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.quantisation_px)).terminal("quant", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.drift_px)).terminal("drift", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.snapping_px)).terminal("snap", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.saturation_px)).terminal("satur", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.bound_px)).terminal("bound", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.f32_px)).terminal("f32", 0),
        Column::new(|row: &Row| row.worst(|worst| worst.f64_px)).terminal("f64", 0),
        Column::new(|row: &Row| row.shown.clamped.into()).terminal("clamped", 0),
        Column::new(|row: &Row| row.verdict()).terminal("verdict", 0).words(),
    ]
}

fn pictures<'r>() -> [Column<Row<'r>>; 11] {
    [
        Column::new(|row: &Row| row.case.name.into()).terminal("pictures", 0).words(),
        Column::new(|row: &Row| row.shown.frames.into()).terminal("frames", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.moved)).terminal("moved", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.settled)).terminal("settled", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.lost)).terminal("lost", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.collided)).terminal("collided", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.holes)).terminal("holes", 0),
        Column::new(|row: &Row| row.largest(|picture| picture.worst_px)).terminal("px", 0),
        Column::new(|row: &Row| row.largest(|picture| picture.bound_px)).terminal("bound", 0),
        Column::new(|row: &Row| row.sum(|picture| picture.clamped)).terminal("clamped", 0),
        Column::new(|row: &Row| row.verdict()).terminal("verdict, all fill modes", 0).words(),
    ]
}

/// Returns the drift of a case with its `N`-th rounding.
fn drift<const N: usize>(case: &CaseReport) -> Value {
    case.roundings.get(N).and_then(|rounding| rounding.worst).map(|worst| px(worst.drift_px)).into()
}

/// Returns the drift of each case with each rounding.
fn drifts(report: &Report) -> Vec<String> {
    let Some(first) = report.cases.iter().find(|case| case.roundings.len() > 1) else { return Vec::new() };
    let mut columns = vec![Column::new(|case: &CaseReport| case.name.into()).terminal("drift, px", 0).words()];
    let get: [fn(&CaseReport) -> Value; 4] = [drift::<0>, drift::<1>, drift::<2>, drift::<3>];
    columns.extend(first.roundings.iter().zip(get).map(|(one, get)| Column::new(get).terminal(one.rounding, 0)));
    let moved = |case: &&CaseReport| case.roundings.iter().any(|rounding| rounding.worst.is_some());
    let rows: Vec<CaseReport> = report.cases.iter().filter(moved).cloned().collect();
    Table::new(&columns, &rows).lines(&rows).collect()
}

fn table<'r>(columns: &[Column<Row<'r>>], rows: Vec<Row<'r>>) -> Vec<String> {
    if rows.is_empty() { Vec::new() } else { Table::new(columns, &rows).lines(&rows).collect() }
}

/// Returns a length in at most six characters.
fn px(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        small if small < 0.000_05 => format!("{small:.0e}"),
        _ if value < 9.999_95 => format!("{value:.4}"),
        _ if value < 999.95 => format!("{value:.1}"),
        _ if value < 999_999.5 => format!("{value:.0}"),
        _ => format!("{value:.0e}"),
    }
}

/// Returns the verdict with what is not covered, in the order of the columns.
fn verdict(verdict: Verdict, uncovered: Uncovered) -> String {
    let parts = [
        (uncovered.taylor_px.is_some(), "Taylor"),
        (uncovered.saturation_px.is_some(), "clamped"),
        (uncovered.past_prop_px.is_some(), "late"),
    ];
    let parts: Vec<&str> = parts.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
    match verdict {
        Verdict::NotCovered if !parts.is_empty() => format!("{}: {}", verdict.name(), parts.join(", ")),
        _ => verdict.name().to_owned(),
    }
}

/// Returns the report as text.
pub fn text(report: &Report) -> String {
    let budget = &report.budget;
    let shown = || report.cases.iter().filter_map(|case| Some(Row { case, shown: case.shown()? }));
    let rounding = shown().next().map_or("", |row| row.shown.rounding);
    let mut lines = vec![format!(
        "D = {} px, tau_recog = {}, tau_prop = {}, {rounding} rounding; the largest error in any frame, in px, by cause",
        budget.extent, budget.recog, budget.prop
    )];
    lines.extend(table(&paths(), shown().filter(|row| row.shown.worst.is_some()).collect()));
    lines.extend(table(&pictures(), shown().filter(|row| !row.shown.pictures.is_empty()).collect()));
    lines.extend(drifts(report));
    for (case, rounding) in report.cases.iter().flat_map(|case| case.roundings.iter().map(move |one| (case, one))) {
        let unstable = |finding| format!("UNSTABLE {}, {}: {finding}", case.name, rounding.rounding);
        lines.extend(rounding.findings.iter().map(unstable));
    }
    lines.push(format!(
        "{} bounded, {} not covered, {} unstable. Taylor: beyond second order; clamped: a field ended; late: after \
         tau_prop.",
        report.count(Verdict::Bounded),
        report.count(Verdict::NotCovered),
        report.count(Verdict::Unstable)
    ));
    lines.join("\n")
}
