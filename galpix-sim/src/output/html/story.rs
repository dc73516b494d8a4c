//! One scene: film, plots, certificate, notes, table.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use super::figures::figures;
use super::overview::{Standing, Summary};
use super::page::{list, picture};
use super::text::{Text, anchor, figure};
use super::{CertificateLine, Row, Story};
use crate::metric::measures::Measures;
use crate::output::column::{self, Column};
use crate::output::measures::{self, Measured};

/// Returns the story as a section; `index` counts from 0.
pub fn section(index: usize, story: &Story) -> Markup {
    let size = format!("{}\u{00D7}{}", story.width, story.height);
    let budget = [&size, &story.budget_line, &story.rounding, &story.fill];
    let tags = ["display", "budget", "rounding", "fill"].into_iter().zip(budget);
    html! {
        section.story id=(anchor(index, &story.name)) {
            h2 { (Text(&story.name)) }
            p.about { (Text(&story.about)) }
            ul.tags {
                @for (name, value) in tags.filter(|(_, value)| !value.is_empty()) { li { b { (name) } " " (Text(value)) } }
            }
            @if !story.film_apng.is_empty() { (film(story)) }
            @if let Some(certificate) = &story.certificate { (promise(certificate, &Summary::of(story))) }
            (figures(story))
            @if let Some(heat) = &story.heat {
                h3.over { "FLIP, pixel by pixel, of frame " (heat.frame) }
                p.remark { "Black: no difference is seen. Red, orange, white: ever more is." }
                div.crops { (picture(&heat.picture, &format!("{}: FLIP of each pixel", story.name), "FLIP")) }
            }
            @if !story.notes.is_empty() { (list(&story.notes)) }
            (table(story))
            p.up { a href="#overview" { "to the overview" } }
        }
    }
}

fn film(story: &Story) -> Markup {
    let size = png_size(&story.film_apng);
    html! {
        figure.film {
            div.wide {
                img width=[size.map(|size| size[0])] height=[size.map(|size| size[1])]
                    alt={ (Text(&story.name)) ": truth, sample-and-hold, galpix and their difference, animated" }
                    src={ "data:image/png;base64," (STANDARD.encode(&story.film_apng)) };
            }
            figcaption {
                b { "truth" } " what a renderer would show in each frame \u{00B7} "
                b { "sample-and-hold" } " the update, frozen \u{00B7} "
                b { "galpix" } " the update, kept moving \u{00B7} "
                b { "difference" } " galpix against the truth, enlarged; black is identical"
            }
        }
    }
}

/// Returns the width and height from a PNG's header.
fn png_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let side = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    (bytes.get(12..16)? == b"IHDR").then_some([side(16)?, side(20)?])
}

/// A true motion that leaves the second-order path by more than this, in pixels, is no promise kept on the screen.
const LEFT_PX: f64 = 1.0;

/// Returns the certificate in words, and the measured errors: against the path that it is about, and against the true
/// motion.
fn promise(certificate: &CertificateLine, summary: &Summary) -> Markup {
    let px = |value: f64| format!("{}\u{00A0}px", figure(Some(value), 4));
    let leaves = summary.truth_px.filter(|&truth| truth > summary.worst_px.unwrap_or(0.0) + LEFT_PX);
    let (kept, total) = (certificate.holds, px(certificate.total_px));
    let not = if kept { "keeps" } else { "does not keep" };
    let until = if certificate.prop > 0 { format!(" up to frame {}", certificate.prop) } else { String::new() };
    let verdict = format!("The arithmetic {not} the paper\u{2019}s one-pixel promise: at most {total}{until}.");
    let measured = match (summary.worst_px, summary.standing) {
        (Some(worst), Some(Standing::Inside)) => format!(
            "The worst distance from the second-order path measured in the frames that it covers is {}; each frame is inside \
             its bound, which is {} for these frames.",
            px(worst),
            px(summary.bound_px.unwrap_or(certificate.total_px))
        ),
        (Some(worst), Some(Standing::BeyondFrom(frame))) => format!(
            "The worst distance from the second-order path measured in the frames that it covers is {}, past the bound of its \
             frame first in frame {frame}: galpixels that a range stopped are outside of the certificate.",
            px(worst)
        ),
        _ => "No galpixel of the update was left to measure.".to_owned(),
    };
    // First what is seen: a promise of the arithmetic is none of it.
    let first = leaves.map(|truth| {
        format!(
            "Galpixels are up to {} from the true motion here, which leaves the second-order path: no certificate covers that.",
            px(truth)
        )
    });
    let truth = match (leaves, summary.truth_px) {
        (Some(_), _) => String::new(),
        (None, Some(truth)) => format!(" From the true motion they are at most {}.", px(truth)),
        (None, None) => " The true motion is not known here.".to_owned(),
    };
    let class = if kept && leaves.is_none() { "good" } else { "poor" };
    html! {
        p class={ "promise " (class) } {
            @match first {
                Some(first) => { strong { (first) } " " (verdict) }
                None => strong { (verdict) }
            }
            " " (px(certificate.quantisation_px)) " from quantisation and " (px(certificate.drift_px))
            " from rounding drift, in the worst case over all states. " (measured) (truth)
            " The snap to a cell, at most half a pixel, stands apart."
        }
    }
}

impl Measured for Row {
    fn measures(&self) -> Measures {
        self.measures
    }
}

fn columns() -> Vec<Column<Row>> {
    let mut columns = vec![
        Column::new(|row: &Row| row.frame.into()).page("frame", 0),
        Column::new(|row: &Row| row.measures.psnr_db.into()).page("galpix dB", 2),
        Column::new(|row: &Row| row.psnr_hold_db.into()).page("hold dB", 2),
        Column::new(|row: &Row| row.flip.into()).page("FLIP", 4),
        Column::new(|row: &Row| row.psnr_known_db.into()).page("reached dB", 2),
    ];
    columns.extend(measures::columns());
    columns.extend([
        Column::new(|row: &Row| row.position_error_px.into()).page("path px", 3),
        Column::new(|row: &Row| row.mean_position_error_px.into()).page("mean path px", 3),
        Column::new(|row: &Row| row.truth_error_px.into()).page("truth px", 3),
        Column::new(|row: &Row| row.holes.into()).page("holes", 0).grouped(),
        Column::new(|row: &Row| row.filled.into()).page("filled", 0).grouped(),
        Column::new(|row: &Row| row.bullets.into()).page("bullets", 0).grouped(),
        Column::new(|row: &Row| row.unobscured.into()).page("unobscured", 0).grouped(),
        Column::new(|row: &Row| row.lost.into()).page("lost", 0).grouped(),
        Column::new(|row: &Row| row.collided.into()).page("collided", 0).grouped(),
        Column::new(|row: &Row| row.saturated.into()).page("saturated", 0).grouped(),
        Column::new(|row: &Row| row.ns_per_galpixel.into()).page("ns a galpixel", 2),
    ]);
    columns
}

fn table(story: &Story) -> Markup {
    html! {
        @if story.rows.is_empty() {
            p.nothing { "No frame was run." }
        } @else {
            details {
                summary { "All figures, frame by frame" }
                (column::html("rows", &columns(), &story.rows))
            }
        }
    }
}
