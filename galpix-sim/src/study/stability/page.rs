//! The page: what the suite found, a section a case.

mod plots;

use std::fmt::Display;

use maud::PreEscaped;

use super::summary::{CaseReport, PathReport, PictureReport, Report, RoundingReport, Shares};
use super::verdict::{Uncovered, Verdict};
use crate::output::html::document;
use crate::output::html::text::{Text, anchor, count};

/// The report as one HTML document that needs nothing but itself.
#[must_use]
pub fn html(report: &Report, seconds: f64) -> String {
    let budget = &report.budget;
    let roundings = report.cases.first().map(|case| case.roundings.iter().map(|one| one.rounding).collect::<Vec<_>>());
    let facts = [
        ("Version", env!("CARGO_PKG_VERSION").to_owned()),
        ("Budget", format!("D = {} px, tau_recog = {}, tau_prop = {}", budget.extent, budget.recog, budget.prop)),
        ("Rounding", roundings.unwrap_or_default().join(", ")),
        ("Cases", report.cases.len().to_string()),
        ("Time", format!("{seconds:.1} s")),
    ]
    .map(|(name, value)| (name.to_owned(), value));
    let intro = [
        "Motion that is too fast, too stiff or too slow for its fields, fields at their ends, and maps that no renderer would make. \
         The engine runs each case as it runs a picture; the error against the exact trajectory is split by cause, exactly, \
         and the verdict follows from what was measured."
            .to_owned(),
        summary(report),
    ];
    let sections: String = report.cases.iter().enumerate().map(|(index, case)| section(index, case)).collect();
    let main = [overview(report), READING.to_owned(), sections].concat();
    document("galpix: stiff and extreme", &intro, &facts, &PreEscaped(main), &PreEscaped(String::new()))
}

fn summary(report: &Report) -> String {
    let [bounded, uncovered, unstable] =
        [Verdict::Bounded, Verdict::NotCovered, Verdict::Unstable].map(|verdict| report.count(verdict));
    format!(
        "{bounded} of {} cases are within their certificate. In {uncovered} something happens that it does not cover, and the \
         arithmetic keeps its law all the same. {unstable} are unstable.",
        report.cases.len()
    )
}

const READING: &str = "<section id=\"reading\"><h2>How to read this</h2><ul class=\"reading\">\
<li><span class=\"ink\" style=\"--ink:var(--hold)\">Taylor</span>: the true motion minus the exact second-order path of the exact \
position, velocity and acceleration. No arithmetic can know it; the next update ends it.</li>\
<li><span class=\"ink\" style=\"--ink:var(--known)\">Quantisation</span>: what storing the three to nearest costs. \
<span class=\"ink\" style=\"--ink:var(--galpix)\">Drift</span>: what rounding the position in each frame adds. These two are what the \
<span class=\"ink\" style=\"--ink:var(--bound)\">bound</span> holds: the certificate up to tau_prop, the same enumeration beyond.</li>\
<li><span class=\"ink\" style=\"--ink:var(--holes)\">Saturation</span>: what clamping a field at its end changed. A clamped \
galpixel is counted and leaves the certificate. <span class=\"ink\" style=\"--ink:var(--guide)\">Snapping</span>: the cell shown is \
at most half a pixel from the position.</li></ul></section>";

/// A length in pixels: four digits after the point while it is small, powers of ten where it is tiny.
fn px(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if !value.is_finite() => "\u{2013}".to_owned(),
        _ if value < 0.000_05 => format!("{value:.0e}").replace('-', "\u{2212}"),
        _ if value < 10.0 => format!("{value:.4}"),
        _ if value < 1000.0 => format!("{value:.1}"),
        _ => count(value.round() as u64),
    }
}

fn badge(verdict: Verdict) -> String {
    let class = match verdict {
        Verdict::Bounded => " class=\"good\"",
        Verdict::NotCovered => "",
        Verdict::Unstable => " class=\"poor\"",
    };
    format!("<em{class}>{}</em>", verdict.name())
}

fn cell(name: &str, content: impl Display) -> String {
    format!("<td data-name=\"{name}\"><span>{content}</span></td>")
}

type PathColumn = (&'static str, fn(&Shares) -> f64);

const PATH_COLUMNS: [PathColumn; 8] = [
    ("Taylor", |worst| worst.taylor_px),
    ("quantisation", |worst| worst.quantisation_px),
    ("drift", |worst| worst.drift_px),
    ("snapping", |worst| worst.snapping_px),
    ("saturation", |worst| worst.saturation_px),
    ("bound", |worst| worst.bound_px),
    ("f32", |worst| worst.f32_px),
    ("f64", |worst| worst.f64_px),
];

type PictureColumn = (&'static str, fn(&PictureReport) -> u64);

const PICTURE_COLUMNS: [PictureColumn; 6] = [
    ("moved", |picture| picture.moved),
    ("settled", |picture| picture.settled),
    ("lost", |picture| picture.lost),
    ("collided", |picture| picture.collided),
    ("holes", |picture| picture.holes),
    ("clamped", |picture| picture.clamped),
];

fn overview(report: &Report) -> String {
    let cases = || report.cases.iter().enumerate().filter_map(|(index, case)| Some((index, case, case.shown()?)));
    let name = |index: usize, case: &CaseReport| {
        format!("<th scope=\"row\"><a href=\"#{}\">{}</a></th>", anchor(index, case.name), Text(case.name))
    };
    let paths: String = cases()
        .filter_map(|(index, case, shown)| {
            let worst = shown.worst?;
            let columns: String = PATH_COLUMNS.iter().map(|(name, column)| cell(name, px(column(&worst)))).collect();
            let verdict = cell("verdict", badge(case.verdict));
            Some(format!("<tr>{}{columns}{}{verdict}</tr>", name(index, case), cell("clamped", shown.clamped)))
        })
        .collect();
    let pictures: String = cases()
        .filter(|(_, _, shown)| !shown.pictures.is_empty())
        .map(|(index, case, shown)| {
            let sum = |column: fn(&PictureReport) -> u64| count(shown.pictures.iter().map(column).sum());
            let columns: String = PICTURE_COLUMNS.iter().map(|(name, column)| cell(name, sum(*column))).collect();
            let off = shown.pictures.iter().map(|picture| picture.worst_px).fold(0.0, f64::max);
            format!(
                "<tr>{}{columns}{}{}</tr>",
                name(index, case),
                cell("position", px(off)),
                cell("verdict", badge(case.verdict))
            )
        })
        .collect();
    let heads = |names: Vec<&str>| names.iter().map(|name| format!("<th>{name}</th>")).collect::<String>();
    let table = |heads: String, rows: String| {
        if rows.is_empty() {
            return String::new();
        }
        format!(
            "<div class=\"wide\"><table class=\"overview\"><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table></div>"
        )
    };
    let path_heads = heads(
        ["paths"].into_iter().chain(PATH_COLUMNS.iter().map(|column| column.0)).chain(["clamped", "verdict"]).collect(),
    );
    let picture_heads = heads(
        ["pictures"]
            .into_iter()
            .chain(PICTURE_COLUMNS.iter().map(|column| column.0))
            .chain(["position", "verdict"])
            .collect(),
    );
    let rounding = report.cases.first().and_then(CaseReport::shown).map_or("", |shown| shown.rounding);
    format!(
        "<section id=\"overview\"><h2>Overview</h2>{}<p class=\"remark\">Pixels: the largest in any frame of any path, with \
         {rounding} rounding. f32, f64: the same scheme in floating point, from the exact second-order path. clamped: fields.</p>{}\
         <p class=\"remark\">Cells, all frames and all rungs of the fill ladder together. position: the largest error of a \
         galpixel of the update, in pixels.</p></section>",
        table(path_heads, paths),
        table(picture_heads, pictures)
    )
}

fn section(index: usize, case: &CaseReport) -> String {
    let Some(shown) = case.shown() else { return String::new() };
    [
        format!("<section class=\"story\" id=\"{}\"><h2>{}</h2>", anchor(index, case.name), Text(case.name)),
        format!("<p class=\"about\">{}.</p>", Text(case.stress)),
        promise(case, shown),
        plots::plots(case, shown),
        findings(case),
        path_table(shown),
        picture_table(shown),
        "<p class=\"up\"><a href=\"#overview\">to the overview</a></p></section>".to_owned(),
    ]
    .concat()
}

/// What is not covered, in words.
pub fn reasons(uncovered: &Uncovered) -> Vec<String> {
    let Uncovered { taylor_px, saturation_px, past_prop_px } = *uncovered;
    let say = |what: &str, value: Option<f64>| value.map(|value| format!("{what} {}\u{a0}px", px(value)));
    [
        say("Taylor error up to", taylor_px),
        say("clamped fields, which cost up to", saturation_px),
        say("frames after tau_prop, off by up to", past_prop_px),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn promise(case: &CaseReport, shown: &RoundingReport) -> String {
    let reached = match shown.worst {
        Some(worst) if worst.of_bound > 0.0 => format!(
            " Quantisation and drift together reach {}\u{a0}px, and at most {:.0}\u{a0}% of the bound of their frame.",
            px(worst.arithmetic_px),
            100.0 * worst.of_bound
        ),
        Some(_) => " No frame after an update was without a clamped field.".to_owned(),
        None => String::new(),
    };
    let conserved = match shown.pictures.iter().map(|picture| picture.moved).sum::<u64>() {
        _ if shown.pictures.is_empty() => String::new(),
        0 => " Nothing moved, nothing came.".to_owned(),
        moved => format!(
            " Each of {} galpixels moved has settled, left the map, or met another; each cell was reached or is a counted hole.",
            count(moved)
        ),
    };
    let clamped_pictures: u64 = shown.pictures.iter().map(|picture| picture.clamped).sum();
    let mut reasons = reasons(&shown.uncovered);
    if clamped_pictures > 0 {
        reasons.push(format!("{} clamped fields of pictures", count(clamped_pictures)));
    }
    let (class, verdict) = match case.verdict {
        Verdict::Bounded => ("good", "Bounded: the certificate holds in every frame.".to_owned()),
        Verdict::NotCovered => {
            ("plain", format!("Stable, and not covered by the certificate: {}.", reasons.join("; ")))
        }
        Verdict::Unstable => ("poor", "Unstable: the engine did what it may not do.".to_owned()),
    };
    let conserved = if case.verdict == Verdict::Unstable { String::new() } else { conserved };
    format!("<p class=\"promise {class}\"><strong>{}</strong>{reached}{conserved}</p>", Text(&verdict))
}

fn findings(case: &CaseReport) -> String {
    let items: String = case
        .roundings
        .iter()
        .flat_map(|one| one.findings.iter().map(move |finding| format!("{}: {finding}", one.rounding)))
        .map(|finding| format!("<li>{}</li>", Text(&finding)))
        .collect();
    if items.is_empty() { items } else { format!("<ul class=\"notes\">{items}</ul>") }
}

fn details(title: &str, heads: &[&str], rows: String) -> String {
    let heads: String = heads.iter().map(|name| format!("<th>{name}</th>")).collect();
    format!(
        "<details><summary>{title}</summary><div class=\"wide\"><table class=\"rows\"><thead><tr>{heads}</tr></thead>\
         <tbody>{rows}</tbody></table></div></details>"
    )
}

fn path_table(shown: &RoundingReport) -> String {
    if shown.paths.is_empty() {
        return String::new();
    }
    let row = |path: &PathReport| {
        let columns: String =
            PATH_COLUMNS.iter().map(|(_, column)| format!("<td>{}</td>", px(column(&path.worst)))).collect();
        let clamped = path.clamped;
        format!("<tr><td>{}</td>{columns}<td>{clamped}</td><td>{}</td></tr>", Text(&path.name), path.verdict.name())
    };
    let heads: Vec<&str> =
        ["path"].into_iter().chain(PATH_COLUMNS.iter().map(|column| column.0)).chain(["clamped", "verdict"]).collect();
    let title = format!("Path by path, {} rounding", shown.rounding);
    details(&title, &heads, shown.paths.iter().map(row).collect())
}

fn picture_table(shown: &RoundingReport) -> String {
    if shown.pictures.is_empty() {
        return String::new();
    }
    let row = |picture: &PictureReport| {
        let columns: String =
            PICTURE_COLUMNS.iter().map(|(_, column)| format!("<td>{}</td>", count(column(picture)))).collect();
        format!("<tr><td>{}</td>{columns}<td>{}</td></tr>", Text(&picture.name), px(picture.worst_px))
    };
    let heads: Vec<&str> =
        ["picture"].into_iter().chain(PICTURE_COLUMNS.iter().map(|column| column.0)).chain(["position px"]).collect();
    let title = format!("Picture by picture, {} rounding, all rungs together", shown.rounding);
    details(&title, &heads, shown.pictures.iter().map(row).collect())
}
