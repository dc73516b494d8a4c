//! The columns of the measures that every table and every page has, beside its own.

use maud::{Markup, html};

use super::column::Column;
use crate::metric::measures::Measures;

/// A row that has the measures.
pub trait Measured {
    /// Returns them.
    fn measures(&self) -> Measures;
}

/// Returns the columns. PSNR of the whole picture is not among them: each table has it beside what it compares it with.
/// The first says how much of the picture PSNR of the reached cells leaves out: that is beside it where there is one.
pub fn columns<R: Measured>() -> [Column<R>; 4] {
    let columns = [
        Column::new(|row: &R| row.measures().missing_percent.into()).csv("missing_percent").both("missing %", 2),
        Column::new(|row: &R| row.measures().psnr_inside_db.into()).csv("psnr_inside_db").both("inside dB", 2),
        Column::new(|row: &R| row.measures().change_error.into()).csv("change_error").both("change", 2),
        Column::new(|row: &R| row.measures().judder_px.into()).csv("judder_px").both("judder px", 3),
    ];
    let mut meanings = MEANINGS.iter();
    columns.map(|column| column.means(meanings.next().map_or("", |(_, means)| means)))
}

/// What the columns are, by name.
const MEANINGS: [(&str, &str); 4] = [
    (
        "missing",
        "cells that no galpixel of the update reached, before anything was put there, of those the truth counts",
    ),
    (
        "inside",
        "PSNR of all cells but those that are missing in connection with the border, the same for all schemes and fills",
    ),
    ("change", "mean of |change shown - true change| of luma from the frame before, inside"),
    (
        "judder",
        "rms change, from the frame before, of the displacement of blocks of 16x16 cells against the truth, where galpixels of the update reached both",
    ),
];

/// Returns what the columns are, for a page.
pub fn reading() -> Markup {
    html! {
        @for (index, (name, meaning)) in MEANINGS.iter().enumerate() {
            @if index > 0 { "; " }
            b { (name) } ": " (meaning)
        }
        "."
    }
}
