//! What is written: tables, pages, films, pictures, and files that are whole or not there.

pub mod column;
pub mod film;
pub mod frames;
pub mod html;
pub mod measures;
pub mod save;

/// Returns a number with so many digits after the point, or a dash.
#[must_use]
pub fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
