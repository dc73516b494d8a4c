//! One scene: film, plots, certificate, notes, table.

use super::figures::figures;
use super::overview::{Standing, Summary};
use super::text::{Text, anchor, count, figure};
use super::{CertificateLine, Row, Story};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// The story as a section; `index` counts from 0.
pub fn section(index: usize, story: &Story) -> String {
    let size = format!("{}\u{00D7}{}", story.width, story.height);
    let budget = [&size, &story.budget_line, &story.rounding, &story.fill];
    let names = ["display", "budget", "rounding", "fill"];
    let tags: String = names
        .iter()
        .zip(budget)
        .filter(|(_, value)| !value.is_empty())
        .map(|(name, value)| format!("<li><b>{name}</b> {}</li>", Text(value)))
        .collect();
    let certificate = story.certificate.as_ref().map(|certificate| promise(certificate, &Summary::of(story)));
    [
        format!("<section class=\"story\" id=\"{}\"><h2>{}</h2>", anchor(index, &story.name), Text(&story.name)),
        format!("<p class=\"about\">{}</p><ul class=\"tags\">{tags}</ul>", Text(&story.about)),
        film(story),
        certificate.unwrap_or_default(),
        figures(story),
        notes(story),
        table(story),
        "<p class=\"up\"><a href=\"#overview\">to the overview</a></p></section>".to_owned(),
    ]
    .concat()
}

fn film(story: &Story) -> String {
    if story.film_apng.is_empty() {
        return String::new();
    }
    let size = png_size(&story.film_apng)
        .map(|[width, height]| format!(" width=\"{width}\" height=\"{height}\""))
        .unwrap_or_default();
    format!(
        "<figure class=\"film\"><div class=\"wide\"><img{size} alt=\"{}: truth, sample-and-hold, galpix and their \
         difference, animated\" src=\"data:image/png;base64,{}\"></div>\
         <figcaption><b>truth</b> what a renderer would show in each frame \u{00B7} <b>sample-and-hold</b> the update, \
         frozen \u{00B7} <b>galpix</b> the update, kept moving \u{00B7} <b>difference</b> galpix against the truth, \
         enlarged; black is identical</figcaption></figure>",
        Text(&story.name),
        STANDARD.encode(&story.film_apng)
    )
}

/// Width and height as a PNG's header says.
fn png_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let side = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    (bytes.get(12..16)? == b"IHDR").then_some([side(16)?, side(20)?])
}

/// The certificate in words, and what was measured beside it.
fn promise(certificate: &CertificateLine, summary: &Summary) -> String {
    let px = |value: f64| format!("{}\u{00A0}px", figure(Some(value), 4));
    let (class, verdict) = match certificate.holds {
        true => ("good", format!("Keeps the paper\u{2019}s one-pixel promise: {}.", px(certificate.total_px))),
        false => ("poor", format!("Does not keep the paper\u{2019}s one-pixel promise: {}.", px(certificate.total_px))),
    };
    let measured = match (summary.worst_px, summary.standing) {
        (Some(worst), Some(Standing::Inside)) => {
            format!(
                "The worst error measured in the frames that it covers is {}; each frame is inside its bound.",
                px(worst)
            )
        }
        (Some(worst), Some(Standing::BeyondFrom(frame))) => format!(
            "The worst error measured in the frames that it covers is {}, past the bound of its frame first in frame {frame}: the \
             certificate covers the arithmetic, not motion that velocity and acceleration cannot describe.",
            px(worst)
        ),
        _ => "The true motion is not known here, so nothing was measured beside it.".to_owned(),
    };
    format!(
        "<p class=\"promise {class}\"><strong>{verdict}</strong> {} from quantisation and {} from rounding drift, in the \
         worst case over all states. {measured} The snap to a cell, at most half a pixel, stands apart.</p>",
        px(certificate.quantisation_px),
        px(certificate.drift_px)
    )
}

fn notes(story: &Story) -> String {
    let items: String = story.notes.iter().map(|note| format!("<li>{}</li>", Text(note))).collect();
    if items.is_empty() { items } else { format!("<ul class=\"notes\">{items}</ul>") }
}

/// A column of the table: heading, and what a row says there.
type Column = (&'static str, fn(&Row) -> String);

const COLUMNS: [Column; 15] = [
    ("frame", |row| row.frame.to_string()),
    ("galpix dB", |row| figure(row.psnr_db, 2)),
    ("hold dB", |row| figure(row.psnr_hold_db, 2)),
    ("reached dB", |row| figure(row.psnr_known_db, 2)),
    ("worst px", |row| figure(row.position_error_px, 3)),
    ("mean px", |row| figure(row.mean_position_error_px, 3)),
    ("truth px", |row| figure(row.truth_error_px, 3)),
    ("holes", |row| count(row.holes)),
    ("filled", |row| count(row.filled)),
    ("bullets", |row| count(row.bullets)),
    ("unobscured", |row| count(row.unobscured)),
    ("lost", |row| count(row.lost)),
    ("collided", |row| count(row.collided)),
    ("saturated", |row| count(row.saturated)),
    ("ns a galpixel", |row| figure(row.ns_per_galpixel, 2)),
];

fn table(story: &Story) -> String {
    if story.rows.is_empty() {
        return "<p class=\"nothing\">No frame was run.</p>".to_owned();
    }
    let head: String = COLUMNS.iter().map(|(name, _)| format!("<th>{name}</th>")).collect();
    let line = |row: &Row| COLUMNS.iter().map(|(_, cell)| format!("<td>{}</td>", cell(row))).collect::<String>();
    let body: String = story.rows.iter().map(|row| format!("<tr>{}</tr>", line(row))).collect();
    format!(
        "<details><summary>All figures, frame by frame</summary><div class=\"wide\"><table class=\"rows\">\
         <thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div></details>"
    )
}
