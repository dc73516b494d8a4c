//! The report as a page: how to read it, and for each source a table, a plot of error against time, and parts of the pictures.

use super::crops;
use super::report::{Document, FillReport, SourceReport};
use crate::engine::fill::Fill;
use crate::output::html::axis::Scale;
use crate::output::html::scatter::{self, Mark, Scatter, Shape};
use crate::output::html::text::{Text, count, figure, signed};
use crate::output::html::{self, style::Ink};
use crate::study::error::fill_ink;

/// The document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "A thing that moves away uncovers what the update never showed. Each fill below makes something up for it; every figure is \
         over those cells alone."
            .to_owned(),
    ];
    let mut facts = html::facts(document.version, &document.command, &document.machine, document.seconds);
    facts.extend(document.fovea.map(|radius| ("Fovea".to_owned(), format!("{radius} px, not judged"))));
    let sections: String = document.sources.iter().enumerate().map(|(index, source)| section(index, source)).collect();
    let main = [READING.to_owned(), sections, foot(document)].concat();
    html::document("galpix: what is put into holes", &intro, &facts, &main, "")
}

const READING: &str = "<section><h2>How to read it</h2><ul class=\"reading\">\
<li><b>Disoccluded</b> cells are those that no galpixel of the update reached, by the warp alone, and that are not connected with the \
border. <b>PSNR</b>, <b>SSIM</b> and <b>FLIP</b> (0 for equals) are over them, all other cells set to the truth, and means over the frames, \
weighted by their cells.</li>\
<li><b>Variance</b> is that of luma in the 7\u{00D7}7 cells around each. Less than the truth\u{2019}s is blurred. <b>Flicker</b> is the mean \
change of luma from the frame before, where both frames are disoccluded, less that of the truth.</li>\
<li><b>Time</b> is that of the whole frame with the fill, on one core, in the form whose budget is chosen at run time: the median, beside a \
memory copy of the map in the same run (<b>\u{00D7} copy</b>). <b>SSIMULACRA2</b> is of the whole picture, 100 for equals.</li>\
</ul></section>";

fn foot(document: &Document) -> String {
    let mut notes = vec![
        "fills.csv and fills.json beside this page hold every figure, frame by frame; index.json lists the pictures."
            .to_owned(),
    ];
    if !document.nothing_disoccluded.is_empty() {
        notes.push(format!("Nothing is disoccluded in {}.", document.nothing_disoccluded.join(", ")));
    }
    html::notes("Beside this", &notes)
}

fn section(index: usize, source: &SourceReport) -> String {
    let frames = source.cells.len().max(1) as u64;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames with a truth", source.cells.len().to_string()),
        ("disoccluded cells a frame", count(source.disoccluded() / frames)),
        ("variance of the truth", figure(source.truth.variance, 1)),
    ];
    [
        html::source_head(index, &source.source, &source.about, &tags),
        crops::html(&source.source, &source.largest, &source.crops),
        format!("<div class=\"plots two\">{}{}</div>", plot(source, &FLIP), plot(source, &VARIANCE)),
        table(source),
        "</section>".to_owned(),
    ]
    .concat()
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
    axis: "FLIP of the disoccluded cells",
    remark: "Lower is better; 0 is the truth. To the right: what a frame costs.",
    figure: |fill| fill.summary.flip,
    truth: |_| None,
};

const VARIANCE: Shown = Shown {
    title: "Texture against time",
    axis: "local variance of the disoccluded cells",
    remark: "The nearer to the truth\u{2019}s, which is the broken line, the better: below it is blurred.",
    figure: |fill| fill.summary.variance,
    truth: |source| source.truth.variance,
};

fn ink(fill: &FillReport) -> Ink {
    let known = Fill::all().into_iter().find(|known| known.name() == fill.name);
    known.map_or(Ink::Axis, fill_ink)
}

fn plot(source: &SourceReport, shown: &Shown) -> String {
    let mark = |fill: &FillReport| {
        Some(Mark {
            at: (fill.time?.frame_us, (shown.figure)(fill)?),
            bound: None,
            radius: 5.0,
            ink: ink(fill),
            shape: if fill.depth_aware.is_some() { Shape::Diamond } else { Shape::Disc },
            label: fill.name.to_owned(),
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
    let drawing = drawing.unwrap_or_else(|| "<p class=\"nothing\">There is nothing to draw.</p>".to_owned());
    format!("<figure><h3>{}</h3>{drawing}<figcaption>{}</figcaption></figure>", shown.title, Text(shown.remark))
}

fn table(source: &SourceReport) -> String {
    let row = |fill: &FillReport| {
        let summary = &fill.summary;
        let cells = [
            figure(summary.psnr_db, 2),
            figure(summary.ssim, 4),
            figure(summary.flip, 4),
            figure(summary.variance, 1),
            signed(summary.flicker, 3),
            figure(summary.ssimulacra2, 2),
            figure(fill.time.map(|time| time.frame_us), 0),
            figure(fill.time.map(|time| time.ns_per_cell), 2),
            figure(fill.time.map(|time| time.x_copy), 1),
        ];
        let cells = cells.map(|cell| format!("<td>{cell}</td>")).concat();
        format!("<tr><td class=\"word\">{}</td>{cells}</tr>", Text(fill.name))
    };
    let rows: String = source.fills.iter().map(row).collect();
    format!(
        "<div class=\"wide\"><table class=\"rows points\"><thead><tr><th>fill</th><th>PSNR dB</th><th>SSIM</th><th>FLIP</th>\
         <th>variance</th><th>flicker</th><th>SSIMULACRA2</th><th>\u{00B5}s a frame</th><th>ns a galpixel</th><th>\u{00D7} copy</th>\
         </tr></thead><tbody>{rows}</tbody></table></div>"
    )
}
