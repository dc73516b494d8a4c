//! The report as a page: how to read it, and for each source a table, a plot of error against time, and parts of the
//! pictures.

use maud::{Markup, html};

use super::Document;
use super::columns::{columns, summaries};
use super::report::{FillReport, SourceReport};
use crate::engine::Scheme;
use crate::output::column;
use crate::output::html::axis::Scale;
use crate::output::html::scatter::{self, Mark, Scatter, Shape};
use crate::output::html::text::{count, figure};
use crate::output::html::{self as page, Head, style::Ink};
use crate::output::measures;
use crate::study::{crops, ink};

/// Returns the document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "A thing that moves away uncovers what the update never showed. Each fill below makes something up for it; unless it says \
         otherwise, a figure is over those cells alone."
            .to_owned(),
    ];
    let mut facts = document.facts();
    facts.extend(document.extra.fovea.map(|radius| ("Fovea".to_owned(), format!("{radius} px, not judged"))));
    let main = html! {
        (page::reading(&format!("{READING}<li>{}</li>", measures::reading().into_string())))
        @for (index, source) in document.sources.iter().enumerate() { (section(index, source)) }
        (foot(document))
    };
    page::document("galpix: what is put into holes", &intro, &facts, &main, &Markup::default())
}

const READING: &str = "\
<li><b>Open</b> cells are those that no galpixel of the update reached, by the warp of the map alone: the same for all schemes and fills. \
<b>Inner</b> ones are not connected with the border by open cells; what is may enter the picture, and no fill can know it. \
<b>PSNR</b>, <b>SSIM</b> and <b>FLIP</b> (0 for equals) are over the inner ones, and once more over all open ones, the other cells set to the truth: \
means over the frames, weighted by their cells. Where few of the open cells are inner ones, the two may rank fills differently.</li>\
<li><b>Variance</b> is that of luma in the 7\u{00D7}7 cells around each. Less than the truth\u{2019}s is blurred. <b>Flicker</b> is the mean \
change of luma from the frame before, where both are inner cells, less that of the truth.</li>\
<li><b>Time</b> is that of the whole frame with the fill, on one core, in the form whose budget is chosen at run time: the median of \
rounds in which all take turns, with half their range (<b>+- %</b>), also by a memory copy of the map in the same run (<b>x copy</b>). Of stationary sources the picture is part of the frame. <b>Whole</b> (PSNR) and \
<b>SSIMULACRA2</b> (100 for equals) are of the whole picture.</li>";

fn foot(document: &Document) -> Markup {
    let mut notes = vec![
        "fills.csv and fills.json in this folder hold every figure, frame by frame; index.json lists the pictures."
            .to_owned(),
    ];
    notes.extend(document.extra.left_out.iter().cloned());
    let nothing = &document.extra.nothing_disoccluded;
    if !nothing.is_empty() {
        notes.push(format!("Nothing is disoccluded in {}.", nothing.join(", ")));
    }
    page::notes("Notes", &notes)
}

fn section(index: usize, source: &SourceReport) -> Markup {
    let frames = source.cells.len().max(1) as u64;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames with a truth", source.cells.len().to_string()),
        ("open cells a frame", count(source.missing() / frames)),
        ("of these inner ones", count(source.disoccluded() / frames)),
        ("variance of the truth", figure(source.truth.variance, 1)),
    ];
    let body = html! {
        (crops::html(&source.source, &source.largest, &source.crops))
        div class="plots two" { (plot(source, &FLIP)) (plot(source, &OPEN)) (plot(source, &VARIANCE)) }
        (page::list(&source.noise.and_then(|noise| noise.warning()).into_iter().collect::<Vec<_>>()))
        (column::html("rows points", &columns(), &summaries(source)))
    };
    page::source(&Head { index, name: &source.source, about: &source.about, tags: &tags }, &body)
}

/// What a plot shows over the time of a frame.
struct Shown {
    title: &'static str,
    axis: &'static str,
    remark: &'static str,
    figure: fn(&FillReport) -> Option<f64>,
    /// The truth's own.
    truth: fn(&SourceReport) -> Option<f64>,
}

const FLIP: Shown = Shown {
    title: "Error against time",
    axis: "FLIP of the inner cells",
    remark: "Lower is better; 0 is the truth. To the right: what a frame costs.",
    figure: |fill| fill.summary.flip,
    truth: |_| None,
};

const OPEN: Shown = Shown {
    title: "Error of all open cells against time",
    axis: "FLIP of all open cells",
    remark: "The same with the cells that are connected with the border.",
    figure: |fill| fill.open.flip,
    truth: |_| None,
};

const VARIANCE: Shown = Shown {
    title: "Texture against time",
    axis: "local variance of the inner cells",
    remark: "The nearer to the truth\u{2019}s, which is the broken line, the better: below it is blurred.",
    figure: |fill| fill.summary.variance,
    truth: |source| source.truth.variance,
};

fn plot(source: &SourceReport, shown: &Shown) -> Markup {
    let mark = |fill: &FillReport| {
        Some(Mark {
            at: (fill.time?.frame_us, (shown.figure)(fill)?),
            bound: None,
            radius: 5.0,
            ink: ink::named(fill.name).unwrap_or(Ink::Axis),
            shape: match fill.depth_aware {
                _ if fill.scheme == Scheme::Source.name() => Shape::Square,
                Some(_) => Shape::Diamond,
                None => Shape::Disc,
            },
            label: fill.label.clone(),
        })
    };
    let marks: Vec<Mark> = source.fills.iter().filter_map(mark).collect();
    let courses =
        (shown.truth)(source).and_then(|truth| scatter::level(truth, Ink::Guide, &marks)).into_iter().collect();
    let drawing = scatter::svg(&Scatter {
        description: format!("{}: {} against the time of a frame", source.source, shown.axis),
        x: ("time of a frame, \u{00B5}s".to_owned(), Scale::Log { floor: 0.01 }),
        y: (shown.axis.to_owned(), Scale::Linear),
        courses,
        marks,
    });
    page::plotted(shown.title, drawing, shown.remark)
}
