//! The report as a page: how to read it, a section for each source, and what it was made with.

use super::figures;
use super::rates::Rate;
use super::report::{Document, Point, Scheme, SourceReport};
use crate::output::html::{self, text::Text, text::figure};

/// The document as a self-contained page.
#[must_use]
pub fn html(document: &Document) -> String {
    let intro = [
        "Each point is one way to run the engine: a bit budget, the lanes that a galpixel carries, a rounding, and a rung of \
         the ladder that fills holes. To the right: what a frame costs. Upwards: how wrong it gets. What lies at the lower \
         left is better in both; what nothing beats is on the front and has a letter."
            .to_owned(),
    ];
    let facts = html::facts(document.version, &document.command, &document.machine, document.seconds);
    let sections: String = document.sources.iter().enumerate().map(|(index, source)| section(index, source)).collect();
    let main = [READING, &sections, FOOT].concat();
    html::document("galpix: error against run time", &intro, &facts, &main, "")
}

const READING: &str = "<section><h2>How to read it</h2><ul class=\"reading\">\
<li><b>Time</b> is that of a product, whose budget is fixed at compile time, on one core: the median, beside a memory copy of \
the same bytes in the same run (<b>\u{00D7} copy</b>). It was measured with a stand-in of the same lanes and the nearest number \
of words, on the same pictures; single bits hardly matter to it. <b>Run-time form</b> is the simulator\u{2019}s own, with the \
budget chosen at run time.</li>\
<li><b>Position error</b> is that of the worst galpixel against the exact second-order path of the update, before the snap to a \
cell. The <span class=\"ink\" style=\"--ink:var(--bound)\">tick above a point</span> is what it can at most be: the certificate, \
and what the lanes that were left out would have moved. Galpixels that a range stopped are outside of it.</li>\
<li><b>Picture error</b> is FLIP against the true picture, 0 for equals. <b>Missing</b> cells are those that no galpixel of the \
update reached, before filling. <b>f32</b> is the same scheme in floats, a packed struct a pixel, timed as it is.</li>\
</ul></section>";

const FOOT: &str = "<section><h2>Left out of all this</h2><ul class=\"notes\">\
<li>Depth has the same steps as x and y; budgets that shave depth alone were not tried.</li>\
<li>The memory copy is one of aligned memory by the C library; where a map fits into a cache, so does the copy, and the ratio \
is that of two things in the cache.</li>\
<li>Floats are not tried with the rungs that tell surfaces apart, and galpix is not tried with several threads.</li>\
<li>error.csv and error.json beside this page hold every figure.</li></ul></section>";

fn section(index: usize, source: &SourceReport) -> String {
    let demand = source.demand;
    let tags = [
        ("display", format!("{}\u{00D7}{}", source.width, source.height)),
        ("frames", source.frames.to_string()),
        (
            "derived budget",
            format!("D = {} px, tau_recog = {}, tau_prop = {}", demand.extent, demand.recog, demand.prop),
        ),
        ("points", source.points.len().to_string()),
    ];
    [
        html::source_head(index, &source.source, &source.about, &tags),
        gain(source),
        format!("<div class=\"plots two\">{}</div>", figures::all(source)),
        fronts(source),
        points(source),
        left_out(source),
        "</section>".to_owned(),
    ]
    .concat()
}

/// What galpixels buy, in a sentence or two.
fn gain(source: &SourceReport) -> String {
    let better = |rate: &&Rate| rate.every > 1 && rate.hold_needs_every < rate.every;
    let mut needed: Vec<u32> = source.rates.iter().filter(better).map(|rate| rate.hold_needs_every).collect();
    needed.dedup();
    let one_of = |every: u32| match every {
        1 => "every frame".to_owned(),
        every => every.to_string(),
    };
    let bought = needed.iter().map(|&needed| {
        let rates = source.rates.iter().filter(better).filter(|rate| rate.hold_needs_every == needed);
        let every: Vec<String> = rates.map(|rate| rate.every.to_string()).collect();
        format!("an update in <strong>1 frame of {}</strong> as good as one in {}", every.join(" or "), one_of(needed))
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
    match (sentences.is_empty(), source.rates.is_empty()) {
        (false, _) => format!(
            "<p class=\"promise good\">By mean FLIP over all frames, galpix makes {}, with sample-and-hold.</p>",
            sentences.join("; ")
        ),
        (true, true) => aged().map_or_else(String::new, |text| format!("<p class=\"promise good\">{text}.</p>")),
        (true, false) => {
            "<p class=\"promise poor\">At no rate does galpix save an update here: sample-and-hold is as good.</p>"
                .to_owned()
        }
    }
}

const HEAD: &str = "<thead><tr><th></th><th>lanes</th><th>budget</th><th>rounding</th><th>rung</th><th>bytes</th>\
<th>\u{00B5}s a frame</th><th>\u{00D7} copy</th><th>run-time form, \u{00B5}s</th><th>worst px</th><th>at most px</th><th>mean px</th>\
<th>worst, true motion px</th><th>PSNR dB</th><th>SSIM</th><th>FLIP</th><th>missing %</th></tr></thead>";

fn row(point: &Point, name: &str) -> String {
    let summary = &point.summary;
    let (budget, rounding) = match point.scheme {
        Scheme::Galpix => (point.budget.as_str(), point.rounding.unwrap_or("")),
        Scheme::F32 => ("f32", "\u{2013}"),
    };
    let figures = [
        figure(point.compile_time.map(|time| time.frame_us), 0),
        figure(point.compile_time.map(|time| time.x_copy), 1),
        figure(point.run_time.map(|time| time.frame_us), 0),
        figure(summary.worst_px, 4),
        figure(summary.bound_px, 4),
        figure(summary.mean_px, 4),
        figure(summary.truth_worst_px, 3),
        figure(summary.psnr_db, 2),
        figure(summary.ssim, 4),
        figure(summary.flip, 4),
        figure(summary.missing_percent, 1),
    ]
    .map(|text| format!("<td>{text}</td>"))
    .concat();
    format!(
        "<tr><td>{}</td><td class=\"word\">{}</td><td class=\"word\">{}</td><td class=\"word\">{}</td><td class=\"word\">{}</td>\
         <td>{}</td>{figures}</tr>",
        Text(name),
        point.lanes,
        Text(budget),
        rounding,
        point.rung,
        point.bytes
    )
}

fn table(rows: &str) -> String {
    format!("<div class=\"wide\"><table class=\"rows points\">{HEAD}<tbody>{rows}</tbody></table></div>")
}

/// The fronts, named as in the plots, with floats beneath.
fn fronts(source: &SourceReport) -> String {
    let part = |title: &str, front: &[usize]| {
        let named = front.iter().enumerate().filter_map(|(place, id)| {
            let point = source.points.iter().find(|point| point.id == *id)?;
            Some(row(point, &figures::letter(place)))
        });
        let rows: String = named.collect();
        if rows.is_empty() { rows } else { format!("<h3>{title}</h3>{}", table(&rows)) }
    };
    let floats: String =
        source.points.iter().filter(|point| point.scheme == Scheme::F32).map(|point| row(point, "f32")).collect();
    [
        "<h3 class=\"over\">The fronts, by the letters of the plots</h3>".to_owned(),
        part("Time against the worst position error", &source.fronts.position),
        part("Time against FLIP", &source.fronts.picture),
        part("Bytes against the worst position error", &source.fronts.bytes),
        if floats.is_empty() { floats } else { format!("<h3>The same scheme in 32-bit floats</h3>{}", table(&floats)) },
    ]
    .concat()
}

fn points(source: &SourceReport) -> String {
    let rows: String = source.points.iter().map(|point| row(point, &point.id.to_string())).collect();
    format!("<details><summary>All {} points</summary>{}</details>", source.points.len(), table(&rows))
}

fn left_out(source: &SourceReport) -> String {
    let items: String = source.left_out.iter().map(|text| format!("<li>{}</li>", Text(text))).collect();
    format!("<ul class=\"notes\">{items}</ul>")
}
