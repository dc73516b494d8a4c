//! The report as a page: how to read it, and for each source parts of the pictures, the disocclusion map, plots and a
//! table.

use maud::{Markup, html};

use super::Document;
use super::columns::{columns, summaries};
use super::report::{SourceReport, StrategyReport};
use crate::output::column;
use crate::output::html::axis::Scale;
use crate::output::html::scatter::{self, Mark, Scatter, Shape};
use crate::output::html::text::count;
use crate::output::html::{self as page, Head, style::Ink};
use crate::study::crops;

/// Returns the document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "What a thing covers now may be seen before the next update comes. Each strategy below hands over samples of what is behind, in layers that move \
         on their own; what none of them has is made up as without them."
            .to_owned(),
    ];
    let mut facts = document.facts();
    facts.push(("Separation".to_owned(), format!("{} of the depth range", document.extra.separation)));
    let main = html! {
        (page::reading(READING))
        @for (index, source) in document.sources.iter().enumerate() { (section(index, source)) }
        (foot(document))
    };
    page::document("galpix: what was hidden", &intro, &facts, &main, &Markup::default())
}

const READING: &str = "\
<li><b>Offered</b> are the samples behind the first layer that the source has, <b>kept</b> those that are handed over, <b>used</b> those that the display \
ever showed. <b>Culled</b>: only what the disocclusion map says can be uncovered before the next update.</li>\
<li><b>Missing</b> are the cells that no galpixel reached, a frame; <b>disoccluded</b> those of them that the first layer alone leaves open and that are \
not connected with the border. <b>PSNR</b> and <b>FLIP</b> (0 for equals) are of the whole picture after holes were filled, means over the frames; \
<b>there</b> is the PSNR of the disoccluded cells.</li>\
<li><b>Behind</b>: what is behind the first layer is in a layer of its own. Else what covers something is in a layer of its own, and what is behind it is with \
the rest. <b>DDOC</b>: what a depth discontinuity occlusion camera sees around edges, in a stationary-source layer. <b>Unlimited</b>, each surface whole in a layer of its own, is a bound and no strategy to ship.</li>\
<li><b>Time</b> is that of the whole frame with its fill on one core, in the form whose budget is chosen at run time: the median, by that of the first layer \
alone (<b>\u{00D7} one</b>) and by a memory copy of its map in the same run (<b>\u{00D7} copy</b>).</li>";

fn foot(document: &Document) -> Markup {
    let mut notes = vec!["layers.csv and layers.json in this folder hold every figure, frame by frame.".to_owned()];
    let extra = &document.extra;
    if !extra.nothing_disoccluded.is_empty() {
        notes.push(format!("Nothing is disoccluded in {}.", extra.nothing_disoccluded.join(", ")));
    }
    if !extra.nothing_hidden.is_empty() {
        notes.push(format!("Nothing is known behind the first layer of {}.", extra.nothing_hidden.join(", ")));
    }
    page::notes("Notes", &notes)
}

fn section(index: usize, source: &SourceReport) -> Markup {
    let frames = source.cells.len().max(1) as u64;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames to the next update", source.frames.to_string()),
        ("frames with a truth", source.cells.len().to_string()),
        ("disoccluded cells a frame", count(source.disoccluded() / frames)),
    ];
    let body = html! {
        (crops::html(&source.source, &source.largest, &source.crops))
        (map(source))
        div class="plots two" { (plot(source, &CARRIED)) (plot(source, &TIME)) }
        (page::list(&source.noise.and_then(|noise| noise.warning()).into_iter().collect::<Vec<_>>()))
        (column::html("rows points", &columns(), &summaries(source)))
    };
    page::source(&Head { index, name: &source.source, about: &source.about, tags: &tags }, &body)
}

fn map(source: &SourceReport) -> Markup {
    html! {
        h3 { "What may be uncovered within " (source.frames) " frames" }
        p {
            "Red: from the left, green: from the right, blue: from above or below; the stronger the farther. Grey: what is \
             hidden there stays hidden."
        }
        div.crops { @if let Some(map) = &source.map { (map.figure(&source.source)) } }
    }
}

/// What a plot shows missing cells over.
struct Shown {
    title: &'static str,
    axis: &'static str,
    remark: &'static str,
    figure: fn(&StrategyReport) -> Option<f64>,
}

const CARRIED: Shown = Shown {
    title: "Missing cells against samples",
    axis: "hidden samples handed over",
    remark: "Lower is better; to the right: what has to be rendered, sent and kept. Diamonds are culled.",
    figure: |strategy| Some(strategy.hidden.as_ref().map_or(0.0, |hidden| f64::from(hidden.kept))),
};

const TIME: Shown = Shown {
    title: "Missing cells against time",
    axis: "time of a frame, by that of the first layer alone",
    remark: "Lower is better; to the right: what a frame costs.",
    figure: |strategy| strategy.x_one,
};

fn ink(strategy: &StrategyReport) -> Ink {
    match strategy.name.as_str() {
        "one layer" => Ink::Hold,
        name if name.starts_with("DDOC") => Ink::Bound,
        name if name.starts_with("unlimited") => Ink::Axis,
        name if name.contains("behind") => Ink::Filled,
        name if name.contains("separated") => Ink::Galpix,
        _ => Ink::Lost,
    }
}

fn plot(source: &SourceReport, shown: &Shown) -> Markup {
    let mark = |strategy: &StrategyReport| {
        Some(Mark {
            at: ((shown.figure)(strategy)?, strategy.missing as f64 / strategy.frames.len().max(1) as f64),
            bound: None,
            radius: 5.0,
            ink: ink(strategy),
            shape: if strategy.name.contains("culled") { Shape::Diamond } else { Shape::Disc },
            label: strategy.name.clone(),
        })
    };
    let drawing = scatter::svg(&Scatter {
        description: format!("{}: missing cells against {}", source.source, shown.axis),
        x: (shown.axis.to_owned(), Scale::Linear),
        y: ("missing cells a frame".to_owned(), Scale::Linear),
        courses: Vec::new(),
        marks: source.strategies.iter().filter_map(mark).collect(),
    });
    page::plotted(shown.title, drawing, shown.remark)
}
