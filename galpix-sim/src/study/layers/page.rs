//! The report as a page: how to read it, and for each source parts of the pictures, the disocclusion map, plots and a table.

use super::report::{Document, SourceReport, WayReport};
use super::table::COLUMNS;
use crate::output::html::axis::Scale;
use crate::output::html::scatter::{self, Mark, Scatter, Shape};
use crate::output::html::text::{Text, count, figure};
use crate::output::html::{self, style::Ink};
use crate::study::fills::crops;

/// The document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "What a thing covers now may be seen before the next update comes. Each way below hands over samples of what is behind, in layers that move \
         on their own; what none of them has is made up as without them."
            .to_owned(),
    ];
    let mut facts = html::facts(document.version, &document.command, &document.machine, document.seconds);
    facts.push(("Separation".to_owned(), format!("{} of the depth range", document.separation)));
    let sections: String = document.sources.iter().enumerate().map(|(index, source)| section(index, source)).collect();
    let main = [READING.to_owned(), sections, foot(document)].concat();
    html::document("galpix: what was hidden", &intro, &facts, &main, "")
}

const READING: &str = "<section><h2>How to read it</h2><ul class=\"reading\">\
<li><b>Offered</b> are the samples behind the first layer that the source has, <b>kept</b> those that are handed over, <b>used</b> those that the display \
ever showed. <b>Culled</b>: only what the disocclusion map says can be uncovered before the next update.</li>\
<li><b>Missing</b> are the cells that no galpixel reached, a frame; <b>disoccluded</b> those of them that the first layer alone leaves open and that are \
not connected with the border. <b>PSNR</b> and <b>FLIP</b> (0 for equals) are of the whole picture after holes were filled, means over the frames; \
<b>there</b> is the PSNR of the disoccluded cells.</li>\
<li><b>Behind</b>: what is behind the first layer is in a layer of its own. Else what covers something is in a layer of its own, and what is behind it is with \
the rest. <b>DDOC</b>: what a depth discontinuity occlusion camera sees around edges, in an anchored layer. <b>Unlimited</b>, each surface whole in a layer of its own, is a bound and no way to ship.</li>\
<li><b>Time</b> is that of the whole frame with its fill on one core, in the form whose budget is chosen at run time: the median, by that of the first layer \
alone (<b>\u{00D7} one</b>) and by a memory copy of its map in the same run (<b>\u{00D7} copy</b>).</li>\
</ul></section>";

fn foot(document: &Document) -> String {
    let mut notes = vec!["layers.csv and layers.json beside this page hold every figure, frame by frame.".to_owned()];
    if !document.nothing_disoccluded.is_empty() {
        notes.push(format!("Nothing is disoccluded in {}.", document.nothing_disoccluded.join(", ")));
    }
    if !document.nothing_hidden.is_empty() {
        notes.push(format!("Nothing is known behind the first layer of {}.", document.nothing_hidden.join(", ")));
    }
    html::notes("Beside this", &notes)
}

fn section(index: usize, source: &SourceReport) -> String {
    let frames = source.cells.len().max(1) as u64;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames to the next update", source.frames.to_string()),
        ("frames with a truth", source.cells.len().to_string()),
        ("disoccluded cells a frame", count(source.disoccluded() / frames)),
    ];
    [
        html::source_head(index, &source.source, &source.about, &tags),
        crops::html(&source.source, &source.largest, &source.crops),
        map(source),
        format!("<div class=\"plots two\">{}{}</div>", plot(source, &CARRIED), plot(source, &TIME)),
        table(source),
        "</section>".to_owned(),
    ]
    .concat()
}

fn map(source: &SourceReport) -> String {
    let figure = source.map.as_ref().map(|map| map.figure(&source.source)).unwrap_or_default();
    format!(
        "<h3>What may be uncovered within {} frames</h3><p>Red: from the left, green: from the right, blue: from above or below; the stronger the \
         farther. Grey: what is hidden there stays hidden.</p><div class=\"crops\">{figure}</div>",
        source.frames
    )
}

/// What a plot shows missing cells over.
struct Shown {
    title: &'static str,
    axis: &'static str,
    remark: &'static str,
    figure: fn(&WayReport) -> Option<f64>,
}

const CARRIED: Shown = Shown {
    title: "Missing cells against samples",
    axis: "samples handed over beside the first layer",
    remark: "Lower is better; to the right: what has to be rendered, sent and kept. Diamonds are culled.",
    figure: |way| Some(way.hidden.as_ref().map_or(0.0, |hidden| f64::from(hidden.kept))),
};

const TIME: Shown = Shown {
    title: "Missing cells against time",
    axis: "time of a frame, by that of the first layer alone",
    remark: "Lower is better; to the right: what a frame costs.",
    figure: |way| way.x_one,
};

fn ink(way: &WayReport) -> Ink {
    match way.name.as_str() {
        "one layer" => Ink::Hold,
        name if name.starts_with("DDOC") => Ink::Bound,
        name if name.starts_with("unlimited") => Ink::Axis,
        name if name.contains("behind") => Ink::Filled,
        name if name.contains("separated") => Ink::Galpix,
        _ => Ink::Lost,
    }
}

fn plot(source: &SourceReport, shown: &Shown) -> String {
    let mark = |way: &WayReport| {
        Some(Mark {
            at: ((shown.figure)(way)?, way.missing as f64 / way.frames.len().max(1) as f64),
            bound: None,
            radius: 5.0,
            ink: ink(way),
            shape: if way.name.contains("culled") { Shape::Diamond } else { Shape::Disc },
            label: way.name.clone(),
        })
    };
    let drawing = scatter::svg(&Scatter {
        description: format!("{}: missing cells against {}", source.source, shown.axis),
        x: (shown.axis.to_owned(), Scale::Linear),
        y: ("missing cells a frame".to_owned(), Scale::Linear),
        courses: Vec::new(),
        marks: source.ways.iter().filter_map(mark).collect(),
    });
    let drawing = drawing.unwrap_or_else(|| "<p class=\"nothing\">There is nothing to draw.</p>".to_owned());
    format!("<figure><h3>{}</h3>{drawing}<figcaption>{}</figcaption></figure>", shown.title, Text(shown.remark))
}

fn table(source: &SourceReport) -> String {
    let row = |way: &WayReport| {
        let cells: String =
            COLUMNS.iter().map(|(_, digits, of)| format!("<td>{}</td>", figure(of(way), *digits))).collect();
        format!("<tr><td class=\"word\">{}</td>{cells}</tr>", Text(&way.name))
    };
    let rows: String = source.ways.iter().map(row).collect();
    let heads: String = COLUMNS.iter().map(|(name, ..)| format!("<th>{}</th>", Text(name))).collect();
    format!(
        "<div class=\"wide\"><table class=\"rows points\"><thead><tr><th>way</th>{heads}</tr></thead><tbody>{rows}</tbody></table></div>"
    )
}
