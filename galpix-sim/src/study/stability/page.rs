//! The page: what the suite found, a section per case.

mod plots;

use maud::{Markup, html};

use super::summary::{CaseReport, PathReport, PictureReport, Report, RoundingReport, Shares};
use super::verdict::{Uncovered, Verdict};
use crate::output::html::text::{Text, anchor, count};
use crate::output::html::{cell, document, list};

/// Returns the report as one HTML document that needs nothing but itself.
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
    let main = html! {
        (overview(report))
        (reading())
        @for (index, case) in report.cases.iter().enumerate() {
            @if let Some(shown) = case.shown() { (section(index, case, shown)) }
        }
    };
    document("galpix: stiff and extreme", &intro, &facts, &main, &Markup::default())
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

fn reading() -> Markup {
    let ink = |name: &str, text: &str| html! { span.ink style={ "--ink:var(--" (name) ")" } { (text) } };
    html! {
        section id="reading" {
            h2 { "How to read this" }
            ul.reading {
                li {
                    (ink("hold", "Taylor"))
                    ": the true motion minus the exact second-order path of the exact position, velocity and acceleration. No \
                     arithmetic can know it; the next update ends it."
                }
                li {
                    (ink("known", "Quantisation")) ": what storing the three to nearest costs. "
                    (ink("galpix", "Drift")) ": what rounding the position in each frame adds. These two are what the "
                    (ink("bound", "bound")) " holds: the certificate up to tau_prop, the same enumeration beyond."
                }
                li {
                    (ink("holes", "Saturation"))
                    ": what clamping a field at its end changed. A clamped galpixel is counted and leaves the certificate. "
                    (ink("guide", "Snapping")) ": the cell shown is at most half a pixel from the position."
                }
            }
        }
    }
}

/// Returns a length in pixels: four digits after the point while it is small, powers of ten where it is tiny.
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

fn badge(verdict: Verdict) -> Markup {
    let class = match verdict {
        Verdict::Bounded => Some("good"),
        Verdict::NotCovered => None,
        Verdict::Unstable => Some("poor"),
    };
    html! { em class=[class] { (verdict.name()) } }
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

fn overview(report: &Report) -> Markup {
    let rounding = report.cases.first().and_then(CaseReport::shown).map_or("", |shown| shown.rounding);
    html! {
        section id="overview" {
            h2 { "Overview" }
            (path_overview(report))
            p.remark {
                "Pixels: the largest in any frame of any path, with " (rounding)
                " rounding. f32, f64: the same scheme in floating point, from the exact second-order path. clamped: fields."
            }
            (picture_overview(report))
            p.remark {
                "Cells, all frames and all fill modes together. position: the largest error of a galpixel of the \
                 update, in pixels."
            }
        }
    }
}

fn name(index: usize, case: &CaseReport) -> Markup {
    html! { th scope="row" { a href={ "#" (anchor(index, case.name)) } { (Text(case.name)) } } }
}

/// Returns the cases of which something is shown, with their places.
fn cases(report: &Report) -> impl Iterator<Item = (usize, &CaseReport, &RoundingReport)> {
    report.cases.iter().enumerate().filter_map(|(index, case)| Some((index, case, case.shown()?)))
}

fn path_overview(report: &Report) -> Markup {
    let rows: Vec<Markup> = cases(report)
        .filter_map(|(index, case, shown)| {
            let worst = shown.worst?;
            Some(html! {
                (name(index, case))
                @for (name, column) in PATH_COLUMNS { (cell(name, &html! { (px(column(&worst))) })) }
                (cell("clamped", &html! { (shown.clamped) }))
                (cell("verdict", &badge(case.verdict)))
            })
        })
        .collect();
    let names = PATH_COLUMNS.iter().map(|column| column.0);
    let heads: Vec<&str> = ["paths"].into_iter().chain(names).chain(["clamped", "verdict"]).collect();
    table("overview", &heads, &rows)
}

fn picture_overview(report: &Report) -> Markup {
    let rows: Vec<Markup> = cases(report)
        .filter(|(_, _, shown)| !shown.pictures.is_empty())
        .map(|(index, case, shown)| {
            let sum = |column: fn(&PictureReport) -> u64| count(shown.pictures.iter().map(column).sum());
            let off = shown.pictures.iter().map(|picture| picture.worst_px).fold(0.0, f64::max);
            html! {
                (name(index, case))
                @for (name, column) in PICTURE_COLUMNS { (cell(name, &html! { (sum(column)) })) }
                (cell("position", &html! { (px(off)) }))
                (cell("verdict", &badge(case.verdict)))
            }
        })
        .collect();
    let names = PICTURE_COLUMNS.iter().map(|column| column.0);
    let heads: Vec<&str> = ["pictures"].into_iter().chain(names).chain(["position", "verdict"]).collect();
    table("overview", &heads, &rows)
}

/// Returns a table of rows that are cells; nothing where there are none.
fn table(class: &str, heads: &[&str], rows: &[Markup]) -> Markup {
    html! {
        @if !rows.is_empty() {
            div.wide {
                table class=(class) {
                    thead { tr { @for head in heads { th { (head) } } } }
                    tbody { @for row in rows { tr { (row) } } }
                }
            }
        }
    }
}

fn section(index: usize, case: &CaseReport, shown: &RoundingReport) -> Markup {
    html! {
        section.story id=(anchor(index, case.name)) {
            h2 { (Text(case.name)) }
            p.about { (Text(case.stress)) "." }
            (promise(case, shown))
            (plots::plots(case, shown))
            (findings(case))
            (path_table(shown))
            (picture_table(shown))
            p.up { a href="#overview" { "to the overview" } }
        }
    }
}

/// Returns what is not covered, in words.
pub fn reasons(uncovered: &Uncovered) -> Vec<String> {
    let Uncovered { taylor_px, saturation_px, past_prop_px } = *uncovered;
    let part = |what: &str, value: Option<f64>| value.map(|value| format!("{what} {}\u{a0}px", px(value)));
    [
        part("Taylor error up to", taylor_px),
        part("clamped fields, which cost up to", saturation_px),
        part("frames after tau_prop, off by up to", past_prop_px),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn promise(case: &CaseReport, shown: &RoundingReport) -> Markup {
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
    html! { p class={ "promise " (class) } { strong { (Text(&verdict)) } (reached) (conserved) } }
}

fn findings(case: &CaseReport) -> Markup {
    let of = |one: &RoundingReport| -> Vec<String> {
        one.findings.iter().map(|finding| format!("{}: {finding}", one.rounding)).collect()
    };
    let items: Vec<String> = case.roundings.iter().flat_map(of).collect();
    html! { @if !items.is_empty() { (list(&items)) } }
}

fn details(title: &str, heads: &[&str], rows: &[Markup]) -> Markup {
    html! { @if !rows.is_empty() { details { summary { (title) } (table("rows", heads, rows)) } } }
}

fn path_table(shown: &RoundingReport) -> Markup {
    let row = |path: &PathReport| {
        html! {
            td { (Text(&path.name)) }
            @for (_, column) in PATH_COLUMNS { td { (px(column(&path.worst))) } }
            td { (path.clamped) }
            td { (path.verdict.name()) }
        }
    };
    let names = PATH_COLUMNS.iter().map(|column| column.0);
    let heads: Vec<&str> = ["path"].into_iter().chain(names).chain(["clamped", "verdict"]).collect();
    let rows: Vec<Markup> = shown.paths.iter().map(row).collect();
    details(&format!("Path by path, {} rounding", shown.rounding), &heads, &rows)
}

fn picture_table(shown: &RoundingReport) -> Markup {
    let row = |picture: &PictureReport| {
        html! {
            td { (Text(&picture.name)) }
            @for (_, column) in PICTURE_COLUMNS { td { (count(column(picture))) } }
            td { (px(picture.worst_px)) }
        }
    };
    let names = PICTURE_COLUMNS.iter().map(|column| column.0);
    let heads: Vec<&str> = ["picture"].into_iter().chain(names).chain(["position px"]).collect();
    let rows: Vec<Markup> = shown.pictures.iter().map(row).collect();
    details(&format!("Picture by picture, {} rounding, all fill modes together", shown.rounding), &heads, &rows)
}
