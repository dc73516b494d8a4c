//! `galpix run`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::choices::Extrapolation;
use super::hidden::HiddenArguments;
use super::{CliError, check, print, print_json, printable, say};
use crate::cli::progress;
use crate::source::Source;
use crate::study::run::{self, Request, RunReport};

/// Arguments of `galpix run`.
#[derive(Debug, Default, Args)]
pub struct Run {
    /// A built-in scene's name, or the path of a capture.toml or of its folder
    source: String,
    #[command(flatten)]
    extrapolation: Extrapolation,
    #[command(flatten)]
    hidden: HiddenArguments,
    /// Folder for the frames [default: galpix-out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Run {
    /// Runs the source.
    pub fn run(&self) -> Result<(), CliError> {
        let request = Request { way: self.hidden.way(), ..self.extrapolation.request() };
        let source = Source::open(&self.source, &self.extrapolation.acceleration.into()).map_err(CliError::unusable)?;
        check(&source, &request)?;
        run::check_way(&source, request.way).map_err(CliError::unusable)?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("galpix-out").join(file_name(source.name())));
        std::fs::create_dir_all(&out).map_err(|error| CliError::unwritable(&out, &error))?;
        let frames = request.frames.unwrap_or(source.frames());
        let bar = progress::bar(u64::from(frames), &printable(source.name()));
        let mut written = Ok(());
        let report = run::run(&source, &request, |shown| {
            let path = out.join(format!("{:04}.png", shown.frame));
            if written.is_ok()
                && let Err(error) = shown.picture.write_png(&path)
            {
                written = Err(CliError::unwritable(&path, &error));
            }
            bar.set_position(u64::from(shown.frame));
        })
        .map_err(CliError::unusable)?;
        bar.finish_and_clear();
        written?;
        say(&format!("{} frames and the update in {}", report.frames.len(), out.display()));
        if self.json { print_json(&report) } else { print(&table(&report)) }
    }
}

/// A name that is safe as a file's: a capture's name comes from outside.
pub fn file_name(name: &str) -> String {
    let safe: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).take(64).collect();
    if safe.is_empty() { "capture".to_owned() } else { safe }
}

fn decibels(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2}"))
}

fn table(report: &RunReport) -> String {
    let mut lines = vec![
        format!(
            "{}: {}x{}, D = {}, tau_recog = {}, tau_prop = {}, {} bytes a galpixel, {} rounding, fill {}, \
             certified {:.4} px up to frame {}",
            printable(&report.source),
            report.width,
            report.height,
            report.budget.extent,
            report.budget.recog,
            report.budget.prop,
            report.budget.stored_bytes_per_galpixel,
            report.rounding,
            report.fill,
            report.certificate.total_px,
            report.budget.prop
        ),
        format!(
            "{} galpixels, {} cells start empty, {} fields clamped; {:.1} ns a galpixel",
            report.loaded.galpixels, report.loaded.empty, report.loaded.saturated, report.ns_per_galpixel
        ),
        "frame  psnr dB     hold    known    ssim    flip  missing  border    holes  bullets     lost  collided  worst px"
            .to_owned(),
    ];
    if let Some(hidden) = &report.hidden {
        let said = format!(
            "{}: {} layers beside the base; {} samples behind the first layer, {} handed over, {} shown",
            hidden.way, hidden.layers, hidden.offered, hidden.kept, hidden.used
        );
        lines.insert(2, said);
    }
    for frame in &report.frames {
        let truth = frame.truth.as_ref();
        lines.push(format!(
            "{:>5} {:>8} {:>8} {:>8} {:>7} {:>7} {:>8} {:>7} {:>8} {:>8} {:>8} {:>9} {:>9}",
            frame.frame,
            decibels(truth.and_then(|truth| truth.psnr_db)),
            decibels(truth.and_then(|truth| truth.psnr_hold_db)),
            decibels(truth.and_then(|truth| truth.psnr_known_db)),
            truth.and_then(|truth| truth.ssim).map_or_else(|| "-".to_owned(), |ssim| format!("{ssim:.4}")),
            truth.and_then(|truth| truth.flip).map_or_else(|| "-".to_owned(), |flip| format!("{flip:.4}")),
            truth.map_or_else(|| "-".to_owned(), |truth| truth.missing.to_string()),
            truth.map_or_else(|| "-".to_owned(), |truth| truth.missing_at_border.to_string()),
            frame.holes,
            frame.bullets,
            frame.lost,
            frame.collided,
            frame.position.map_or_else(|| "-".to_owned(), |position| format!("{:.4}", position.worst_px)),
        ));
    }
    lines.join("\n")
}
