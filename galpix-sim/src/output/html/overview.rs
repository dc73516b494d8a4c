//! The table at the top: one line per scene.

use maud::{Markup, html};

use super::text::{Text, anchor, figure, signed};
use super::{CertificateLine, Report, Row, Story};
use crate::metric::measures::Measures;
use crate::metric::stats::{mean, median};
use crate::output::column;
use crate::output::measures::{self, Measured};

/// How measured position errors lie to the certified bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Inside it in each frame.
    Inside,
    /// Beyond it, for the first time in this frame.
    BeyondFrom(u32),
}

/// One line of the overview: a story.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// The last frame.
    pub frame: Option<u32>,
    /// Means over the frames that were compared with a truth.
    pub measures: Measures,
    /// PSNR of sample-and-hold, mean over the same frames.
    pub psnr_hold_db: Option<f64>,
    /// The difference of the two.
    pub gain_db: Option<f64>,
    /// The worst position error, of the frames that the certificate covers, if it names them.
    pub worst_px: Option<f64>,
    /// The certified bound of the last frame that it covers of those that were run.
    pub bound_px: Option<f64>,
    /// The worst position error against the true motion, of all frames, where that is known.
    pub truth_px: Option<f64>,
    /// How the measured errors lie to the bound, where both are known.
    pub standing: Option<Standing>,
    /// The median over the frames.
    pub ns_per_galpixel: Option<f64>,
}

impl Summary {
    /// Of a whole story.
    pub fn of(story: &Story) -> Self {
        let measures = Measures::mean(story.rows.iter().map(|row| row.measures));
        let psnr_hold_db = mean(finite(story, |row| row.psnr_hold_db));
        let (worst_px, standing) = against_bound(story);
        Self {
            frame: story.rows.last().map(|row| row.frame),
            measures,
            psnr_hold_db,
            gain_db: measures.psnr_db.zip(psnr_hold_db).map(|(galpix, hold)| galpix - hold),
            worst_px,
            bound_px: story.certificate.as_ref().map(|certificate| bound_of(certificate, story)),
            truth_px: finite(story, |row| row.truth_error_px).reduce(f64::max),
            standing,
            ns_per_galpixel: median(finite(story, |row| row.ns_per_galpixel).collect()),
        }
    }
}

/// Returns the bound of a frame, `None` beyond the horizon: that of the frame where there is one for each, else the
/// total.
fn bound_after(certificate: &CertificateLine, frame: u32) -> Option<f64> {
    match certificate.per_frame_px.is_empty() {
        true => Some(certificate.total_px),
        false => certificate.per_frame_px.get(usize::try_from(frame).ok()?).copied(),
    }
}

/// Returns the bound of all frames that were run and that the certificate covers.
fn bound_of(certificate: &CertificateLine, story: &Story) -> f64 {
    let bounds = story.rows.iter().filter_map(|row| bound_after(certificate, row.frame));
    bounds.reduce(f64::max).unwrap_or(certificate.total_px)
}

/// Returns the worst error and its standing, over the frames that the certificate covers (all frames without one).
fn against_bound(story: &Story) -> (Option<f64>, Option<Standing>) {
    let Some(certificate) = &story.certificate else {
        return (finite(story, |row| row.position_error_px).reduce(f64::max), None);
    };
    let mut worst = None;
    let mut standing = None;
    for row in &story.rows {
        let error = row.position_error_px.filter(|error| error.is_finite());
        let Some((error, bound)) = error.zip(bound_after(certificate, row.frame)) else { continue };
        worst = Some(error.max(worst.unwrap_or(error)));
        standing = match standing {
            Some(Standing::BeyondFrom(frame)) => Some(Standing::BeyondFrom(frame)),
            _ if error <= bound => Some(Standing::Inside),
            _ => Some(Standing::BeyondFrom(row.frame)),
        };
    }
    (worst, standing)
}

fn finite(story: &Story, column: impl Fn(&Row) -> Option<f64>) -> impl Iterator<Item = f64> {
    story.rows.iter().filter_map(column).filter(|value| value.is_finite())
}

/// Returns the overview as a section.
pub fn overview(report: &Report) -> Markup {
    let summaries: Vec<_> = report.stories.iter().map(Summary::of).collect();
    let widest = summaries.iter().filter_map(|s| s.gain_db).map(f64::abs).filter(|g| g.is_finite()).fold(0.0, f64::max);
    let columns = measures::columns::<Summary>();
    html! {
        section id="overview" {
            h2 { "Overview" }
            @if report.stories.is_empty() {
                p.nothing { "No scene was run." }
            } @else {
                // Where the page is narrow, the table is too long to lead to the scenes.
                nav.contents aria-label="Scenes" {
                    @for (index, story) in report.stories.iter().enumerate() { (link(index, story)) }
                }
                div.wide {
                    table.overview {
                        thead {
                            tr {
                                th { "scene" }
                                @for name in COMPARED { th { (name) } }
                                @for (name, means) in column::titles(&columns) { th title=(means) { (name) } }
                                @for name in FURTHER { th { (name) } }
                            }
                        }
                        tbody {
                            @for ((index, story), summary) in report.stories.iter().enumerate().zip(&summaries) {
                                (line(&link(index, story), summary, &column::cells(&columns, summary), widest))
                            }
                        }
                    }
                }
                p.remark {
                    "PSNR against the truth, and the measures after it: means over the frames. From the path: the worst position error \
                     against the update\u{2019}s second-order path, before the snap, and its certificate for these frames; from the true motion: \
                     the worst against that, which no certificate covers. Time: the median of all frames. "
                    (measures::reading())
                }
            }
        }
    }
}

/// The columns after the scene's name, before the measures that every table has.
const COMPARED: [&str; 4] = ["frames", "galpix", "sample-and-hold", "gain"];

/// Those after them.
const FURTHER: [&str; 3] = ["from the path", "from the true motion", "ns a galpixel"];

impl Measured for Summary {
    fn measures(&self) -> Measures {
        self.measures
    }
}

fn link(index: usize, story: &Story) -> Markup {
    html! { a href={ "#" (anchor(index, &story.name)) } { (Text(&story.name)) } }
}

fn line(link: &Markup, summary: &Summary, measures: &[(&str, Markup)], widest_gain: f64) -> Markup {
    let frame = summary.frame.map_or_else(|| figure(None, 0), |frame| frame.to_string());
    let bound = html! {
        @match (summary.bound_px, summary.standing) {
            (Some(bound), Some(Standing::Inside)) => { " " em.good { "inside " (figure(Some(bound), 2)) } },
            (Some(_), Some(Standing::BeyondFrom(frame))) => { " " em.poor { "past bound at " (frame) } },
            (Some(bound), None) => { " " em { "bound " (figure(Some(bound), 2)) } },
            (None, _) => {},
        }
    };
    html! {
        tr {
            th scope="row" { (link) }
            (cell("frame", &html! { (frame) }))
            (cell("galpix", &unit(summary.measures.psnr_db, 1, "dB")))
            (cell("sample-and-hold", &unit(summary.psnr_hold_db, 1, "dB")))
            (cell("gain", &gain(summary.gain_db, widest_gain)))
            @for (name, content) in measures { (cell(name, content)) }
            (cell("from the path", &html! { (unit(summary.worst_px, 2, "px")) (bound) }))
            (cell("from the true motion", &unit(summary.truth_px, 2, "px")))
            (cell("ns a galpixel", &html! { (figure(summary.ns_per_galpixel, 1)) }))
        }
    }
}

/// Returns a cell that shows its column's name where the table is narrow.
pub fn cell(name: &str, content: &Markup) -> Markup {
    html! { td data-name=(name) { span { (content) } } }
}

fn unit(value: Option<f64>, decimals: usize, unit: &str) -> Markup {
    html! {
        @match value.filter(|value| value.is_finite()) {
            Some(value) => { (figure(Some(value), decimals)) small { (unit) } },
            None => (figure(None, 0)),
        }
    }
}

/// Returns the gain as a figure with a bar, relative to the widest gain of the report.
fn gain(gain_db: Option<f64>, widest: f64) -> Markup {
    let Some(gain) = gain_db.filter(|gain| gain.is_finite()) else { return html! { (figure(None, 0)) } };
    let share = if widest > 0.0 { (100.0 * gain.abs() / widest).round() } else { 0.0 };
    let class = if gain < 0.0 { "bar poor" } else { "bar good" };
    html! {
        i class=(class) { i style=(format!("width:{share:.0}%")) {} }
        span.gain { (signed(Some(gain), 1)) small { "dB" } }
    }
}
