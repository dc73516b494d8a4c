//! `galpix plan`.

use std::fmt::Write as _;

use clap::Args;

use super::choices::{AccelerationChoice, pixels};
use super::{CliError, print, print_json, printable};
use crate::source::Source;
use crate::study::job::Request;
use crate::study::plan::{self, Axis, Measured, Plan, PlanError, Planning};

/// Arguments of `galpix plan`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
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
    /// tau_prop of the full budget [default: the next power of two of the frames]
    #[arg(long, value_name = "FRAMES")]
    prop: Option<u32>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl PlanArguments {
    /// Makes the plan.
    pub fn run(&self) -> Result<(), CliError> {
        let source = Source::open(&self.source, &self.acceleration.into()).map_err(CliError::unusable)?;
        let request = Request {
            frames: self.frames,
            extent: self.extent,
            recog: self.recog,
            prop: self.prop,
            perceptual: false,
            ..Request::default()
        };
        let tighter = self.tighter.unwrap_or(self.max_error / 4.0);
        let planning = plan::plan(&source, &request, self.max_error, tighter).map_err(|error| match error {
            PlanError::Engine(_) => CliError::Failed(error.to_string()),
            _ => CliError::unusable(error),
        })?;
        super::remark(&source);
        if self.json { print_json(&planning) } else { print(&text(&planning)) }
    }
}

fn text(planning: &Planning) -> String {
    let full = &planning.full;
    let mut text = format!(
        "{}: {}x{}, {} frames\n\n{:<18} {:>14} {:>14} {:>14}\n",
        printable(&planning.source),
        planning.width,
        planning.height,
        planning.frames,
        "",
        "full budget",
        format!("{} px", planning.plan.max_error_px),
        planning.tighter.as_ref().map_or_else(|| "tighter".to_owned(), |plan| format!("{} px", plan.max_error_px)),
    );
    let mut row = |name: &str, full: String, of: &dyn Fn(&Plan) -> String| {
        let tighter = planning.tighter.as_ref().map_or_else(|| "-".to_owned(), of);
        let _ = writeln!(text, "{name:<18} {full:>14} {:>14} {tighter:>14}", of(&planning.plan));
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
    row("time saved", String::new(), &|plan| {
        format!("{:.0} %", 100.0 * (1.0 - plan.measured.frame_us / full.measured.frame_us.max(f64::MIN_POSITIVE)))
    });
    text.push('\n');
    for reason in &planning.plan.reasons {
        let _ = writeln!(text, "- {reason}");
    }
    text.push_str("Motion bits: position fraction, velocity integer+fraction, acceleration integer+fraction. Time: budgets chosen at run time.\n\n");
    text.push_str(planning.plan.code.trim_end());
    text
}

fn widths(axis: &Axis) -> String {
    let component = axis.component;
    let mut widths = format!("{} {}+{}", component.position_frac, component.velocity_int, component.velocity_frac);
    if component.has_acceleration() {
        let _ = write!(widths, " {}+{}", component.acceleration_int, component.acceleration_frac);
    }
    widths
}
