//! The report as a page: how to read it, a section for each source, and what it was made with.

use maud::{Markup, PreEscaped, html};

use super::Document;
use super::columns::{Row, columns};
use super::report::{Point, Scheme, SourceReport};
use super::{figures, text};
use crate::output::column;
use crate::output::html::text::figure;
use crate::output::html::{self as page, Head};
use crate::output::measures;

/// Returns the document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "Each point is one way to run the engine: a bit budget, the fields that a galpixel carries, a rounding, and a \
         fill mode. To the right: what a frame costs. Upwards: how wrong it gets. What lies at the lower \
         left is better in both; what nothing beats is on the front and has a letter."
            .to_owned(),
    ];
    let main = html! {
        (page::reading(&format!("{READING}<li>{}</li>", measures::reading().into_string())))
        @for (index, source) in document.sources.iter().enumerate() { (section(index, source)) }
        (page::notes("Left out of all this", &LEFT_OUT.map(str::to_owned)))
    };
    page::document("galpix: error against run time", &intro, &document.facts(), &main, &Markup::default())
}

const READING: &str = "\
<li><b>Time</b> is that of a product, whose budget is fixed at compile time, on one core: the median of rounds in which \
all points take turns, with their range (<b>+- %</b>), also by a memory copy of the same bytes in the same run (<b>x copy</b>). It was measured with a stand-in of the same fields and the nearest number \
of words, on the same pictures; single bits hardly matter to it. <b>Run-time form</b> is the simulator\u{2019}s own, with the \
budget chosen at run time.</li>\
<li><b>Certified position error</b> is what a galpixel can at most be away from the exact second-order path of the update, before \
the snap to a cell: the certificate, and what the fields that were left out would have moved (more only where a range stopped a \
galpixel and more was measured). By it points are ranked. The <span class=\"ink\" style=\"--ink:var(--bound)\">tick below a \
point</span> is the worst that was measured here (<b>path px</b>); <b>truth px</b> is against the true motion, which no certificate \
covers.</li>\
<li><b>Picture error</b> is FLIP against the true picture, 0 for equals. <b>f32</b> is the same scheme in floats, a packed struct a pixel, timed as it is.</li>";

const LEFT_OUT: [&str; 4] = [
    "Depth has the same steps as x and y; budgets that shave depth alone were not tried.",
    "The memory copy is one of aligned memory by the C library; where a map fits into a cache, so does the copy, and the ratio \
     is that of two things in the cache.",
    "Floats are not tried with the fill modes that tell surfaces apart, and galpix is not tried with several threads.",
    "error.csv and error.json in this folder hold every figure.",
];

fn section(index: usize, source: &SourceReport) -> Markup {
    let demand = source.demand;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames", source.frames.to_string()),
        ("looked at", format!("positions of {}, pictures of {}", source.looked_at.len(), source.pictures.len())),
        (
            "derived budget",
            format!("D = {} px, tau_recog = {}, tau_prop = {}", demand.extent, demand.recog, demand.prop),
        ),
        ("points", source.points.len().to_string()),
    ];
    let body = html! {
        (gain(source))
        (page::list(&text::doubts(source)))
        div class="plots two" { (figures::all(source)) }
        (fronts(source))
        details {
            summary { "All " (source.points.len()) " points" }
            (table(source, &source.points, |_, point| point.id.to_string()))
        }
        (page::list(&source.left_out))
    };
    page::source(&Head { index, name: &source.source, about: &source.about, tags: &tags }, &body)
}

/// Returns what galpixels buy, in a sentence or two.
fn gain(source: &SourceReport) -> Markup {
    let bought = source.rates.iter().filter_map(|rate| {
        let equal = rate.hold_equals_every.filter(|&equal| equal < f64::from(rate.every))?;
        Some(format!("<strong>1 in {}</strong> as good as 1 in {equal:.1}", rate.every))
    });
    let sentences: Vec<String> = bought.collect();
    // The oldest frame that sample-and-hold is as bad as at an earlier age already.
    let aged = || {
        source.ages.iter().rev().find_map(|age| {
            let as_bad = source.ages.iter().find(|held| held.flip_hold >= age.flip && held.frame < age.frame)?;
            Some(format!(
                "<strong>{} frames</strong> after the update galpix has FLIP {}; sample-and-hold has {} after {} already",
                age.frame,
                figure(Some(age.flip), 3),
                figure(Some(as_bad.flip_hold), 3),
                as_bad.frame
            ))
        })
    };
    html! {
        @match (sentences.is_empty(), source.rates.is_empty()) {
            (false, _) => p class="promise good" {
                "One update in so many frames, by mean FLIP over all frames and interpolated between the rates below: galpix is with "
                (PreEscaped(sentences.join(", with "))) " with sample-and-hold."
            },
            (true, true) => { @if let Some(text) = aged() { p class="promise good" { (PreEscaped(text)) "." } } },
            (true, false) => p class="promise poor" {
                "At no rate does galpix save an update here: sample-and-hold is as good."
            },
        }
    }
}

/// Returns a table of points, each named by its place and itself.
fn table<'p>(
    source: &SourceReport,
    points: impl IntoIterator<Item = &'p Point>,
    name: impl Fn(usize, &Point) -> String,
) -> Markup {
    let points = points.into_iter().enumerate();
    let rows: Vec<Row<'_>> = points.map(|(place, point)| Row::new(source, point, name(place, point))).collect();
    column::html("rows points", &columns(), &rows)
}

/// Returns the fronts, named as in the plots, with floats beneath.
fn fronts(source: &SourceReport) -> Markup {
    let fronts = [
        ("Time against the certified position error", &source.fronts.position),
        ("Time against FLIP", &source.fronts.picture),
        ("Bytes against the certified position error", &source.fronts.bytes),
    ];
    let on = |front: &[usize]| -> Vec<&Point> {
        front.iter().filter_map(|id| source.points.iter().find(|point| point.id == *id)).collect()
    };
    let of = |scheme| source.points.iter().filter(|point| point.scheme == scheme).collect::<Vec<&Point>>();
    let (sources, floats) = (of(Scheme::Source), of(Scheme::F32));
    html! {
        h3.over { "The fronts, by the letters of the plots" }
        @for (title, front) in fronts.into_iter().filter(|(_, front)| !front.is_empty()) {
            h3 { (title) }
            (table(source, on(front), |place, _| figures::letter(place)))
        }
        @if !sources.is_empty() {
            h3 { "As stationary sources" }
            (table(source, sources, |_, point| point.id.to_string()))
        }
        @if !floats.is_empty() {
            h3 { "The same scheme in 32-bit floats" }
            (table(source, floats, |_, _| "f32".to_owned()))
        }
    }
}
