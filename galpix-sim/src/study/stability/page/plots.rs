//! Which lines the plots of a case have.

use maud::{Markup, PreEscaped, html};

use super::super::summary::{CaseReport, PathReport, RoundingReport, SeriesRow};
use crate::output::html::line_key;
use crate::output::html::plot::{Line, Plot, Stroke, svg, svg_log};
use crate::output::html::style::Ink;
use crate::output::html::text::Text;

/// Returns the plots of a case, each a `<figure>` with its legend.
pub fn plots(case: &CaseReport, shown: &RoundingReport) -> Markup {
    html! {
        div.plots {
            @if let Some(path) = shown.reported() { (by_cause(case, path)) (floats_compared(case, path)) (by_rounding(case)) }
            @if !shown.pictures.is_empty() { (tallies(case, shown)) }
        }
    }
}

/// Of more updates than this only the largest figure between two of them is drawn.
const MOST_UPDATES: usize = 8;

fn line(name: &str, ink: Ink, stroke: Stroke, path: &PathReport, column: impl Fn(&SeriesRow) -> Option<f64>) -> Line {
    let points = path.series.iter().map(|row| (row.frame, column(row)));
    let points = if many_updates(path) {
        let between = path.series.chunk_by(|one, next| one.since_update < next.since_update);
        let largest = |rows: &[SeriesRow]| {
            let values = rows.iter().filter_map(&column);
            values.max_by(|one, two| one.abs().total_cmp(&two.abs()))
        };
        between.map(|rows| (rows.last().map_or(0, |row| row.frame), largest(rows))).collect()
    } else {
        points.collect()
    };
    Line { name: name.to_owned(), ink, stroke, points }
}

fn many_updates(path: &PathReport) -> bool {
    path.series.windows(2).filter(|rows| rows[1].since_update <= rows[0].since_update).count() > MOST_UPDATES
}

/// Returns a remark with a word on what is left out.
fn remark(text: &str, path: &PathReport) -> String {
    let left_out = if many_updates(path) { " A point an update: the largest until the next." } else { "" };
    format!("{text}{left_out}")
}

/// Returns what quantisation and drift together may be. Where the certificate ends for good, so does its line.
fn bounds(path: &PathReport) -> Vec<Line> {
    let line = |name: &str, ink: Ink, stroke: Stroke, column: fn(&SeriesRow) -> bool| {
        line(name, ink, stroke, path, |row| column(row).then_some(row.bound_px))
    };
    let certified = path.series.iter().take_while(|row| row.certified).count();
    let left = || path.series.iter().skip(certified);
    if certified < 2 || left().any(|row| row.certified) {
        let name = if left().next().is_some() { "bound, were nothing clamped" } else { "certified bound" };
        return vec![line(name, Ink::Bound, Stroke::Dashed, |_| true)];
    }
    let mut lines = vec![
        line("the same law, uncertified", Ink::Lost, Stroke::Dashed, |row| !row.certified),
        line("certified bound", Ink::Bound, Stroke::Dashed, |row| row.certified),
    ];
    lines.retain(|line| !line.is_empty());
    lines
}

/// Returns whether a line can be drawn on a logarithmic axis: one that never leaves 0 cannot.
fn is_drawable(line: &Line) -> bool {
    line.points.iter().any(|&(_, value)| value.is_some_and(|value| value > 0.0))
}

fn by_cause(case: &CaseReport, path: &PathReport) -> Markup {
    let share = |name: &str, ink: Ink, column: fn(&SeriesRow) -> f64| {
        line(name, ink, Stroke::Solid, path, |row| Some(column(row).abs()))
    };
    let mut lines = bounds(path);
    lines.extend([
        share("snapping", Ink::Guide, |row| row.snapping_px),
        share("saturation", Ink::Holes, |row| row.saturation_px),
        share("Taylor", Ink::Hold, |row| row.taylor_px),
        share("quantisation", Ink::Known, |row| row.quantisation_px),
        share("drift", Ink::Galpix, |row| row.drift_px),
    ]);
    lines.retain(is_drawable);
    figure(
        case,
        ["Error by cause", "px"],
        &remark(&format!("{}: the path that is farthest off.", path.name), path),
        lines,
        true,
    )
}

fn floats_compared(case: &CaseReport, path: &PathReport) -> Markup {
    let mut lines = bounds(path);
    lines.extend([
        line("f64", Ink::Collided, Stroke::Solid, path, |row| Some(row.f64_px.abs())),
        line("f32", Ink::Hold, Stroke::Solid, path, |row| Some(row.f32_px.abs())),
        line("engine", Ink::Galpix, Stroke::Solid, path, |row| {
            Some((row.quantisation_px + row.drift_px + row.saturation_px).abs())
        }),
    ]);
    lines.retain(is_drawable);
    let mut text =
        "From the exact second-order path of the exact values. The engine has what fits into its fields.".to_owned();
    if !lines.iter().any(|line| line.name.starts_with('f')) {
        text += " Floats are exact here.";
    }
    figure(case, ["The engine and floats", "px"], &remark(&text, path), lines, true)
}

/// Returns the largest drift so far with each rounding.
fn by_rounding(case: &CaseReport) -> Markup {
    let inks = [Ink::Hold, Ink::Collided, Ink::Galpix, Ink::Filled];
    let lines = case.roundings.iter().zip(inks).map(|(one, ink)| Line {
        name: one.rounding.to_owned(),
        ink,
        stroke: Stroke::Solid,
        points: (0..).zip(one.drift_up_to_px.iter().map(|&drift| Some(drift))).collect(),
    });
    let mut lines: Vec<Line> = lines.collect();
    if !lines.iter().any(is_drawable) {
        lines.clear();
    }
    figure(case, ["Drift with each rounding", "px"], "The largest of any path up to this frame.", lines, false)
}

/// Returns all pictures of a case together.
fn tallies(case: &CaseReport, shown: &RoundingReport) -> Markup {
    let frames = shown.pictures.iter().map(|picture| picture.tallies.len()).max().unwrap_or(0);
    let sum = |frame: usize, column: usize| {
        let counted = shown.pictures.iter().filter_map(|picture| picture.tallies.get(frame));
        Some(counted.map(|tally| f64::from(tally[column])).sum::<f64>())
    };
    let line = |name: &str, ink: Ink, stroke: Stroke, column: usize| Line {
        name: name.to_owned(),
        ink,
        stroke,
        points: (0..frames).map(|frame| (frame as u32 + 1, sum(frame, column))).collect(),
    };
    let lines = vec![
        line("collided", Ink::Collided, Stroke::Dashed, 2),
        line("lost at the border", Ink::Lost, Stroke::Dashed, 1),
        line("holes", Ink::Holes, Stroke::Solid, 3),
        line("settled", Ink::Galpix, Stroke::Solid, 0),
    ];
    figure(case, ["Tallies", "cells"], "All pictures of this case together, with the richest fill mode.", lines, false)
}

fn figure(case: &CaseReport, [title, unit]: [&str; 2], remark: &str, lines: Vec<Line>, log: bool) -> Markup {
    let legend = html! {
        @for line in lines.iter().rev() { (line_key(&line.name, line.ink, line.stroke == Stroke::Dashed)) }
    };
    let description = format!("{}: {title} in {unit} over frames", case.name);
    let plot = Plot { description, lines, from_zero: true, cap: f64::INFINITY };
    let drawing = if log { svg_log(&plot) } else { svg(&plot) };
    html! {
        figure {
            @match drawing {
                None => { h3 { (title) } p.nothing { "Nothing to draw: it is 0 in every frame." } },
                Some(drawing) => {
                    h3 { (title) " " small { (unit) @if log { ", logarithmic" } } }
                    p.legend { (legend) }
                    (PreEscaped(drawing))
                    p.axis { "frames since the first update" }
                    figcaption { (Text(remark)) }
                },
            }
        }
    }
}
