//! Two runs side by side: two budgets, two fills, two versions, as their JSON documents say.

use maud::{Markup, html};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value as Json;

use super::SCHEMA;
use crate::metric::stats;
use crate::output::column::{self, Column, Table};
use crate::output::html::plot::{Line, Plot, Stroke, svg};
use crate::output::html::style::Ink;
use crate::output::html::{self as page, line_key};

/// Why two documents cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// It is no document of a run.
    #[error("{name} is no document of `galpix run --json`: make one with `galpix run SOURCE --json > {name}`")]
    NoRun {
        /// The file.
        name: String,
    },
    /// Its keys are of another version.
    #[error("{name} has keys of version {found}, and this is about version {SCHEMA}: make it anew with `galpix run`")]
    Schema {
        /// The file.
        name: String,
        /// The version of its keys.
        found: String,
    },
    /// The two show something else.
    #[error("{0} and {1} are different sources: compare two runs of one")]
    Sources(String, String),
    /// There is no frame that both have.
    #[error("the two have no frame in common: compare runs with more frames")]
    NoFrame,
}

/// What is compared of a frame, by title and place in the document.
const MEASURES: [(&str, &str); 6] = [
    ("PSNR dB", "/truth/psnr_db"),
    ("inside dB", "/truth/psnr_inside_db"),
    ("FLIP", "/truth/flip"),
    ("missing %", "/truth/missing_percent"),
    ("path px", "/position/worst_px"),
    ("ns/galpixel", "/ns_per_galpixel"),
];

/// A frame that both runs have.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Frame {
    /// Frames since the update.
    pub frame: u64,
    /// PSNR, PSNR inside, FLIP, missing per cent, the worst distance from the second-order path and the time a
    /// galpixel of the first run.
    pub first: [Option<f64>; 6],
    /// The same of the second.
    pub second: [Option<f64>; 6],
}

/// How the two were made differently.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Difference {
    /// The key.
    pub key: String,
    /// Its value in the first document.
    pub first: Json,
    /// And in the second.
    pub second: Json,
}

/// Two runs side by side.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Comparison {
    /// The source of both.
    pub source: String,
    /// The calls that made them.
    pub calls: [String; 2],
    /// How they were made differently.
    pub differences: Vec<Difference>,
    /// The frames that both have.
    pub frames: Vec<Frame>,
    /// Means over these frames.
    pub means: Frame,
}

/// Compares two documents, each with the name of its file.
///
/// *Errors:* documents that are not of `galpix run`, or of different sources.
pub fn compare(documents: [(&str, &Json); 2]) -> Result<Comparison, CompareError> {
    for (name, document) in documents {
        if document["kind"] != "run" {
            return Err(CompareError::NoRun { name: name.to_owned() });
        }
        if document["schema"] != SCHEMA {
            return Err(CompareError::Schema { name: name.to_owned(), found: document["schema"].to_string() });
        }
    }
    let [first, second] = documents.map(|(_, document)| document);
    let [source, other] = [first, second].map(|document| text(&document["source"]));
    if source != other {
        return Err(CompareError::Sources(source, other));
    }
    let frames: Vec<Frame> = list(first).filter_map(|frame| pair(frame, second)).collect();
    if frames.is_empty() {
        return Err(CompareError::NoFrame);
    }
    let mean = |of: fn(&Frame) -> &[Option<f64>; 6], index: usize| {
        stats::mean(frames.iter().filter_map(|frame| of(frame)[index]))
    };
    let means = Frame {
        frame: frames.len() as u64,
        first: std::array::from_fn(|index| mean(|frame| &frame.first, index)),
        second: std::array::from_fn(|index| mean(|frame| &frame.second, index)),
    };
    Ok(Comparison {
        source,
        calls: [first, second].map(|document| text(&document["command"])),
        differences: differences(first, second),
        frames,
        means,
    })
}

fn text(value: &Json) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn list(document: &Json) -> impl Iterator<Item = &Json> {
    document["frames"].as_array().into_iter().flatten()
}

/// Returns a frame of the first document with that of the second.
fn pair(frame: &Json, second: &Json) -> Option<Frame> {
    let number = frame["frame"].as_u64()?;
    let other = list(second).find(|other| other["frame"] == number)?;
    let measures = |of: &Json| MEASURES.map(|(_, place)| of.pointer(place).and_then(Json::as_f64));
    Some(Frame { frame: number, first: measures(frame), second: measures(other) })
}

/// Returns the settings and the budget that differ.
fn differences(first: &Json, second: &Json) -> Vec<Difference> {
    let settings = ["version", "rounding", "fill", "scheme", "scan_out", "edge_threshold", "displayed_px"];
    let budget = first["budget"].as_object().into_iter().flat_map(|budget| budget.keys());
    let places = settings.iter().map(|key| (format!("/{key}"), (*key).to_owned()));
    let places = places.chain(budget.map(|key| (format!("/budget/{key}"), format!("budget.{key}"))));
    let of = |document: &Json, place: &str| document.pointer(place).cloned().unwrap_or(Json::Null);
    let all = places.map(|(place, key)| Difference { key, first: of(first, &place), second: of(second, &place) });
    all.filter(|difference| difference.first != difference.second).collect()
}

/// Returns the columns: of each measure the first run, the second, and by how much that is more.
fn columns() -> Vec<Column<Frame>> {
    let mut columns = vec![Column::new(|row: &Frame| row.frame.into()).csv("frame").both("frame", 0)];
    columns.extend(measure::<0>(["psnr_db_a", "psnr_db_b"], ["A PSNR dB", "B", "B-A"]));
    columns.extend(measure::<1>(["psnr_inside_db_a", "psnr_inside_db_b"], ["A inside dB", "B", "B-A"]));
    columns.extend(measure::<2>(["flip_a", "flip_b"], ["A FLIP", "B", "B-A"]));
    columns.extend(measure::<3>(["missing_percent_a", "missing_percent_b"], ["A missing %", "B", "B-A"]));
    columns.extend(measure::<4>(["worst_px_a", "worst_px_b"], ["A path px", "B", "B-A"]));
    columns.extend(measure::<5>(["ns_per_galpixel_a", "ns_per_galpixel_b"], ["A ns/galpixel", "B", "B-A"]));
    columns
}

fn measure<const N: usize>(ids: [&'static str; 2], titles: [&'static str; 3]) -> [Column<Frame>; 3] {
    fn more<const N: usize>(row: &Frame) -> Option<f64> {
        row.second[N].zip(row.first[N]).map(|(second, first)| second - first)
    }
    let digits = [2, 2, 4, 2, 4, 1][N];
    let [first, second, difference] = [
        Column::new(|row: &Frame| row.first[N].into()).csv(ids[0]),
        Column::new(|row: &Frame| row.second[N].into()).csv(ids[1]),
        Column::new(|row: &Frame| more::<N>(row).into()).signed(),
    ];
    [first.both(titles[0], digits), second.both(titles[1], digits), difference.both(titles[2], digits)]
}

/// Returns the comparison as comma-separated values, a line a frame.
///
/// *Errors:* those of the writer; none are known.
pub fn csv(comparison: &Comparison) -> csv::Result<String> {
    column::csv(&columns(), comparison.frames.iter().cloned())
}

/// Returns the comparison as text.
#[must_use]
pub fn terminal(comparison: &Comparison) -> String {
    let [first, second] = &comparison.calls;
    let mut lines = vec![format!("A: {first}"), format!("B: {second}")];
    let differ =
        |difference: &Difference| format!("{}: {} in A, {} in B", difference.key, difference.first, difference.second);
    lines.extend(comparison.differences.iter().map(differ));
    let columns = columns();
    let table = Table::new(&columns, &comparison.frames);
    lines.extend(table.lines(&comparison.frames));
    lines.push(format!("means of these {} frames:", comparison.means.frame));
    lines.push(table.line(&comparison.means));
    lines.join("\n")
}

/// Returns the comparison as a self-contained page.
#[must_use]
pub fn html(comparison: &Comparison) -> String {
    let [first, second] = &comparison.calls;
    let intro = ["Two runs of one source, frame by frame. Differences are those of B from A.".to_owned()];
    let facts = [
        ("Version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("A".to_owned(), first.clone()),
        ("B".to_owned(), second.clone()),
    ];
    let differ =
        |difference: &Difference| format!("{}: {} in A, {} in B", difference.key, difference.first, difference.second);
    let differences: Vec<String> = comparison.differences.iter().map(differ).collect();
    let main = html! {
        section.story {
            h2 { "How they differ" }
            @if differences.is_empty() { p { "Neither settings nor budget differ." } } @else { (page::list(&differences)) }
            p.legend { (line_key("A", Ink::Hold, true)) (line_key("B", Ink::Galpix, false)) }
            div.plots { @for index in 0..MEASURES.len() { (plot(comparison, index)) } }
            (column::html("rows points", &columns(), &comparison.frames))
        }
    };
    page::document(&format!("galpix: two runs of {}", comparison.source), &intro, &facts, &main, &Markup::default())
}

fn plot(comparison: &Comparison, index: usize) -> Markup {
    let (title, _) = MEASURES[index];
    let line = |name: &str, ink, stroke, of: fn(&Frame) -> &[Option<f64>; 6]| {
        let points = comparison.frames.iter().map(|frame| (frame.frame as u32, of(frame)[index]));
        Line { name: name.to_owned(), ink, stroke, points: points.collect() }
    };
    let lines = vec![
        line("A", Ink::Hold, Stroke::Dashed, |frame| &frame.first),
        line("B", Ink::Galpix, Stroke::Solid, |frame| &frame.second),
    ];
    let description = format!("{}: {title} of both runs over frames since the update", comparison.source);
    let drawing = svg(&Plot { description, lines, from_zero: index >= 2, cap: f64::INFINITY });
    page::plotted(title, drawing, "Over frames since the update.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn run(fill: &str, psnr: f64) -> Json {
        let frame = |number: u32| json!({ "frame": number, "truth": { "psnr_db": psnr, "flip": 0.1 } });
        json!({
            "schema": 1, "kind": "run", "version": "0", "command": "galpix run", "source": "pan", "fill": fill,
            "budget": { "prop": 16 }, "frames": [frame(1), frame(2)]
        })
    }

    #[test]
    fn the_same_frames_stand_side_by_side_and_what_differs_is_said() {
        let (a, mut b) = (run("hold", 20.0), run("extend", 22.5));
        b["frames"].as_array_mut().expect("frames").remove(0);
        let comparison = compare([("a", &a), ("b", &b)]).expect("two runs");
        assert_eq!((comparison.frames.len(), comparison.means.second[0]), (1, Some(22.5)));
        let differences: Vec<&str> = comparison.differences.iter().map(|one| one.key.as_str()).collect();
        assert_eq!(differences, ["fill"]);
        let text = terminal(&comparison);
        assert!(text.contains("fill: \"hold\" in A, \"extend\" in B") && text.contains("2.50"), "{text}");
        assert!(csv(&comparison).expect("text").starts_with("frame,psnr_db_a,psnr_db_b,"));
        assert!(html(&comparison).contains("How they differ"));
    }

    #[test]
    fn what_is_no_run_or_of_another_source_is_refused() {
        let (a, mut b) = (run("hold", 20.0), run("hold", 20.0));
        b["source"] = "disc".into();
        assert!(matches!(compare([("a", &a), ("b", &b)]), Err(CompareError::Sources(..))));
        b["schema"] = 2.into();
        assert!(matches!(compare([("a", &a), ("b", &b)]), Err(CompareError::Schema { .. })));
        b["kind"] = "fills".into();
        assert!(matches!(compare([("a", &a), ("b", &b)]), Err(CompareError::NoRun { .. })));
        b = run("hold", 20.0);
        b["frames"] = json!([]);
        assert!(matches!(compare([("a", &a), ("b", &b)]), Err(CompareError::NoFrame)));
    }
}
