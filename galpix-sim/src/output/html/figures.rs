//! Which lines the plots of a story have.

use maud::{Markup, PreEscaped, html};

use super::page::line_key;
use super::plot::{Line, Plot, Stroke, svg};
use super::style::Ink;
use super::text::Text;
use super::{Row, Story};
use crate::metric::PSNR_CAP_DB;

/// Returns the plots of a story, each a `<figure>` with its legend: PSNR, position error, tallies.
pub fn figures(story: &Story) -> Markup {
    html! { div.plots { (quality(story)) (perceived(story)) (position(story)) (tallies(story)) } }
}

/// Returns a line through one column of the rows.
fn line(story: &Story, name: &str, ink: Ink, stroke: Stroke, column: impl Fn(&Row) -> Option<f64>) -> Line {
    let points = story.rows.iter().map(|row| (row.frame, column(row))).collect();
    Line { name: name.to_owned(), ink, stroke, points }
}

fn quality(story: &Story) -> Markup {
    let lines = vec![
        line(story, "sample-and-hold", Ink::Hold, Stroke::Solid, |row| row.psnr_hold_db),
        line(story, "galpix, reached cells", Ink::Known, Stroke::Dashed, |row| row.psnr_known_db),
        line(story, "galpix, inside", Ink::Filled, Stroke::Dashed, |row| row.measures.psnr_inside_db),
        line(story, "galpix", Ink::Galpix, Stroke::Solid, |row| row.measures.psnr_db),
    ];
    let mut remark = "Likeness to the truth: higher is better.".to_owned();
    // A likeness of what is left says little without how much that is.
    if let Some(missing) = story.rows.iter().rev().find_map(|row| row.measures.missing_percent) {
        remark += &format!(" In the last frame {:.1} % of the cells are reached.", 100.0 - missing);
    }
    let capped = |line: &Line| line.points.iter().any(|&(_, value)| value.is_some_and(|value| value >= PSNR_CAP_DB));
    if lines.iter().any(capped) {
        remark += " Identical pictures are drawn at the upper end.";
    }
    figure(story, ["PSNR", "dB"], [&remark, "No truth to compare with."], lines, false)
}

/// Returns the plot of FLIP, where that was worked out.
fn perceived(story: &Story) -> Markup {
    if story.rows.iter().all(|row| row.flip.is_none()) {
        return html! {};
    }
    let lines = vec![line(story, "galpix", Ink::Galpix, Stroke::Solid, |row| row.flip)];
    let remark = "How visible the difference from the truth is: 0 for equals, lower is better.";
    figure(story, ["FLIP", "mean of the picture"], [remark, "No truth to compare with."], lines, true)
}

fn position(story: &Story) -> Markup {
    let mut lines = Vec::new();
    let measured = |row: &Row| row.position_error_px.or(row.mean_position_error_px);
    let mut remark =
        "How far galpixels are from the update\u{2019}s second-order path, before the snap to a cell.".to_owned();
    if let Some(certificate) = &story.certificate {
        let bound = certificate.per_frame_px.iter().zip(0..).map(|(&bound, frame)| (frame, Some(bound))).collect();
        lines.push(Line { name: "certified bound".into(), ink: Ink::Bound, stroke: Stroke::Dashed, points: bound });
        remark += " The bound covers the arithmetic; the snap adds at most half a pixel, as with any method.";
    }
    let beyond =
        |row: &Row| row.truth_error_px.zip(row.position_error_px).is_some_and(|(truth, path)| truth > path + 0.01);
    if story.rows.iter().any(beyond) {
        lines.push(line(story, "worst from the true motion", Ink::Hold, Stroke::Solid, |row| row.truth_error_px));
        remark += " The true motion leaves that path here: what second order cannot describe no certificate covers.";
    }
    lines.push(line(story, "mean from the path", Ink::Known, Stroke::Dashed, |row| row.mean_position_error_px));
    lines.push(line(story, "worst from the path", Ink::Galpix, Stroke::Solid, |row| row.position_error_px));
    let nothing = "The true motion is not known here.";
    if !story.rows.iter().any(|row| measured(row).is_some_and(f64::is_finite)) {
        remark = format!("{nothing} {remark}");
    }
    figure(story, ["Position error", "px"], [&remark, nothing], lines, true)
}

fn tallies(story: &Story) -> Markup {
    let lines = vec![
        line(story, "collided", Ink::Collided, Stroke::Dashed, |row| Some(row.collided as f64)),
        line(story, "lost at the border", Ink::Lost, Stroke::Dashed, |row| Some(row.lost as f64)),
        line(story, "holes", Ink::Holes, Stroke::Solid, |row| Some(row.holes as f64)),
        line(story, "filled", Ink::Filled, Stroke::Dashed, |row| Some(row.filled as f64)),
    ];
    let remark = "What the passes counted in each frame.";
    figure(story, ["Tallies", "cells"], [remark, "No frame was counted."], lines, true)
}

/// Returns a figure with its title and unit, and its caption, or a sentence instead where there is nothing to draw.
fn figure(
    story: &Story,
    [title, unit]: [&str; 2],
    [remark, nothing]: [&str; 2],
    mut lines: Vec<Line>,
    from_zero: bool,
) -> Markup {
    lines.retain(|line| !line.is_empty());
    let legend = html! {
        @for line in lines.iter().rev() { (line_key(&line.name, line.ink, line.stroke == Stroke::Dashed)) }
    };
    let description = format!("{}: {title} in {unit} over frames since the update", story.name);
    let cap = if from_zero { f64::INFINITY } else { PSNR_CAP_DB };
    let drawing = svg(&Plot { description, lines, from_zero, cap });
    html! {
        figure {
            @match drawing {
                None => { h3 { (title) } p.nothing { (Text(nothing)) } },
                Some(drawing) => {
                    h3 { (title) " " small { (unit) } }
                    p.legend { (legend) }
                    (PreEscaped(drawing))
                    p.axis { "frames since the update" }
                    figcaption { (Text(remark)) }
                },
            }
        }
    }
}
