//! The report as a page.

use super::report::Document;
use crate::report;

/// The document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    report::document(
        "galpix: error against run time",
        &[],
        &[("Version".to_owned(), document.version.to_owned())],
        "",
        "",
    )
}
