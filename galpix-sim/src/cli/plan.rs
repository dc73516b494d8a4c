//! `galpix plan`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use maud::{Markup, html};

use super::call::{command, machine};
use super::choices::{AccelerationChoice, pixels};
use super::{CliError, call, note, print, print_json, printable, progress};
use crate::output::html::{document, list};
use crate::output::save::write_atomically;
use crate::study::job::Request;
use crate::study::plan::{self, Axis, Measured, Plan, PlanError, Planning};
use crate::study::timing::Noise;

/// Arguments of `galpix plan`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_long_help = LEGEND)]
pub struct PlanArguments {
    /// A built-in scene's name, or the path of a capture.toml or of its folder
    source: String,
    /// The position error that is allowed, in pixels, before the snap to a cell
    #[arg(long, value_name = "PX", value_parser = pixels)]
    max_error: f64,
    /// A second, tighter, error to compare with [default: a quarter of the first]
    #[arg(long, value_name = "PX", value_parser = pixels)]
    tighter: Option<f64>,
    /// Frames that the plan must cover [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000))]
    frames: Option<u32>,
    /// D of the full budget that is compared with [default: the next power of two of the larger side]
    #[arg(long, value_name = "PX")]
    extent: Option<u32>,
    /// tau_recog of the full budget [default: 8]
    #[arg(long, value_name = "FRAMES")]
    recog: Option<u32>,
    /// tau_prop of the full budget [default: the next power of two of the frames that the source is meant for]
    #[arg(long, value_name = "FRAMES")]
    prop: Option<u32>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for plan.html [default: galpix-out/plan; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl PlanArguments {
    /// Makes the plan.
    pub fn run(&self) -> Result<(), CliError> {
        let source = call::open(&self.source, self.acceleration)?;
        let request = Request {
            frames: self.frames,
            extent: self.extent,
            recog: self.recog,
            prop: self.prop,
            perceptual: false,
            ..Request::default()
        };
        let tighter = self.tighter.unwrap_or(self.max_error / 4.0);
        let bar = progress::bar(plan::PIECES, &printable(source.name()));
        let goals = [self.max_error, tighter];
        let planning = plan::plan(&source, &request, goals, || bar.inc(1)).map_err(|error| match error {
            PlanError::Engine(_) => CliError::Failed(error.to_string()),
            _ => CliError::unusable(error),
        })?;
        bar.finish_and_clear();
        super::remark(&source);
        if let Some(out) = self.out.clone().or((!self.json).then(|| Path::new("galpix-out").join("plan"))) {
            std::fs::create_dir_all(&out).map_err(|error| CliError::unwritable(&out, &error))?;
            let path = out.join("plan.html");
            call::spare(&self.source, [path.clone()])?;
            write_atomically(&path, page(&planning).as_bytes()).map_err(|error| CliError::unwritable(&path, &error))?;
            note(&format!("{} is written", path.display()));
        }
        if self.json { print_json("plan", &planning) } else { print(&text(&planning)) }
    }
}

/// Returns the heads of the columns: the full budget, the plan, the tighter one.
fn heads(planning: &Planning) -> [String; 4] {
    let tighter =
        planning.tighter.as_ref().map_or_else(|| "tighter".to_owned(), |plan| format!("{} px", plan.max_error_px));
    [String::new(), "full budget".to_owned(), format!("{} px", planning.plan.max_error_px), tighter]
}

/// Returns the table, a line for each property of the three.
fn rows(planning: &Planning) -> Vec<[String; 4]> {
    let full = &planning.full;
    let mut rows = Vec::new();
    let mut row = |name: &str, full: String, of: &dyn Fn(&Plan) -> String| {
        let tighter = planning.tighter.as_ref().map_or_else(|| "-".to_owned(), of);
        rows.push([name.to_owned(), full, of(&planning.plan), tighter]);
    };
    let yes = |there: bool| if there { "yes" } else { "no" }.to_owned();
    row("velocity", yes(true), &|plan| yes(plan.motion.velocity));
    row("acceleration", yes(true), &|plan| yes(plan.motion.acceleration));
    row("motion in depth", yes(true), &|plan| yes(plan.depth_motion));
    row("luminosity", yes(true), &|plan| yes(plan.luminosity));
    row("depth bits", "16".to_owned(), &|plan| plan.depth_bits.to_string());
    row("motion bits x", String::new(), &|plan| widths(&plan.motion.x));
    row("motion bits y", String::new(), &|plan| widths(&plan.motion.y));
    row("rounding", "low-discrepancy".to_owned(), &|plan| plan.motion.rounding.to_owned());
    row("fill mode", "extend".to_owned(), &|plan| plan.fill_mode.to_owned());
    row("bits a galpixel", full.used_bits_per_galpixel.to_string(), &|plan| plan.used_bits_per_galpixel.to_string());
    row("bytes, in words", full.stored_bytes_per_galpixel.to_string(), &|plan| {
        plan.stored_bytes_per_galpixel.to_string()
    });
    row("certified px", format!("{:.4}", full.certified_px), &|plan| format!("{:.4}", plan.motion.certified_px));
    let worst = |measured: &Measured| measured.worst_px.map_or_else(|| "-".to_owned(), |worst| format!("{worst:.4}"));
    row("measured px", worst(&full.measured), &|plan| worst(&plan.measured));
    row("fields clamped", full.measured.saturated.to_string(), &|plan| plan.measured.saturated.to_string());
    row("frame us", format!("{:.0}", full.measured.frame_us), &|plan| format!("{:.0}", plan.measured.frame_us));
    let between = |[low, high]: [f64; 2]| format!("{low:.0} to {high:.0}");
    row("  of all rounds", between(full.measured.frame_us_range), &|plan| between(plan.measured.frame_us_range));
    let saved = |ratio: f64| 100.0 * (1.0 - ratio);
    row("time saved %", String::new(), &|plan| format!("{:.0}", saved(plan.measured.x_full)));
    row("  of all rounds", String::new(), &|plan| {
        let [low, high] = plan.measured.x_full_range;
        between([saved(high), saved(low)])
    });
    rows
}

/// What the rows are.
const LEGEND: &str = "Motion bits: position fraction, velocity integer+fraction, acceleration integer+fraction. \
                      Certified and measured: from the second-order path, before the snap to a cell. Time: budgets chosen \
                      at run time, the median of rounds in which all take turns, and their range.";

/// Returns a warning where the same frames took very different times.
fn doubt(planning: &Planning) -> Option<String> {
    let [low, high] = planning.full.measured.frame_us_range;
    let spread = high / low.max(f64::MIN_POSITIVE);
    (spread > Noise::DOUBTFUL).then(|| {
        format!(
            "The machine was noisy: the full budget took up to {spread:.2} times as long as at its fastest. Repeat this while \
             nothing else runs."
        )
    })
}

fn text(planning: &Planning) -> String {
    let mut text = format!(
        "{}: {}x{}, {} frames\n\n",
        printable(&planning.source),
        planning.width,
        planning.height,
        planning.frames
    );
    for [name, full, plan, tighter] in std::iter::once(heads(planning)).chain(rows(planning)) {
        let _ = writeln!(text, "{name:<18} {full:>15} {plan:>15} {tighter:>15}");
    }
    text.push('\n');
    for reason in &planning.plan.reasons {
        let _ = writeln!(text, "- {reason}");
    }
    if let Some(doubt) = doubt(planning) {
        let _ = writeln!(text, "{doubt}");
    }
    let _ = write!(text, "{LEGEND}\n\n{}", planning.plan.code.trim_end());
    text
}

/// Returns the plan as a self-contained page.
fn page(planning: &Planning) -> String {
    let intro =
        ["The fields, bits, rounding and fill mode that suffice for a position error, certified and run.".to_owned()];
    let facts = [("Version", env!("CARGO_PKG_VERSION").to_owned()), ("Command", command()), ("Machine", machine())];
    let main = html! {
        section.story {
            h2 { (planning.source) }
            ul.tags {
                li { b { "display" } " " (planning.width) "\u{00D7}" (planning.height) }
                li { b { "frames" } " " (planning.frames) }
            }
            div.wide {
                table.rows {
                    thead { tr { @for head in heads(planning) { th { (head) } } } }
                    tbody { @for row in rows(planning) { tr { @for (place, cell) in row.iter().enumerate() {
                        td class=[(place == 0).then_some("word")] { (cell.trim()) }
                    } } } }
                }
            }
            p.remark { (LEGEND) }
            (list(&planning.plan.reasons))
            @if let Some(doubt) = doubt(planning) { p.remark { (doubt) } }
            h3.over { "As Rust" }
            div.wide { pre { (planning.plan.code) } }
        }
    };
    let facts = facts.map(|(name, value)| (name.to_owned(), value));
    document(&format!("galpix: what {} does not need", planning.source), &intro, &facts, &main, &Markup::default())
}

fn widths(axis: &Axis) -> String {
    let component = axis.component;
    let mut widths = format!("{} {}+{}", component.position_frac, component.velocity_int, component.velocity_frac);
    if component.has_acceleration() {
        let _ = write!(widths, " {}+{}", component.acceleration_int, component.acceleration_frac);
    }
    widths
}
