//! `galpix run`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::choices::Extrapolation;
use super::hidden::HiddenArguments;
use super::{CliError, note, print, print_json, printable, progress};
use crate::output::column::{Column, Table, Value};
use crate::output::measures;
use crate::output::save::file_name;
use crate::source::Source;
use crate::study::job::{Job, Request};
use crate::study::run::{self, FrameReport, RunReport, TruthReport};

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
        let request = self.extrapolation.request()?;
        let request = Request { strategy: self.hidden.strategy(request.scheme), ..request };
        let source = Source::open(&self.source, &self.extrapolation.acceleration.into()).map_err(CliError::unusable)?;
        let job = Job::resolve(&source, &request).map_err(CliError::unusable)?;
        run::check_strategy(&source, request.strategy).map_err(CliError::unusable)?;
        let out = self.out.clone().unwrap_or_else(|| Path::new("galpix-out").join(file_name(source.name())));
        std::fs::create_dir_all(&out).map_err(|error| CliError::unwritable(&out, &error))?;
        let bar = progress::bar(u64::from(job.frames), &printable(source.name()));
        let mut written = Ok(());
        let report = run::job(&job, |shown| {
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
        super::remark(&source);
        note(&format!("{} frames and the update in {}", report.frames.len(), out.display()));
        if self.json { print_json(&report) } else { print(&table(&report)) }
    }
}

fn columns() -> Vec<Column<FrameReport>> {
    fn truth<V: Into<Value>>(frame: &FrameReport, of: fn(TruthReport) -> V) -> Value {
        frame.truth.map(of).into()
    }
    let column = Column::<FrameReport>::new;
    let mut columns = vec![
        column(|frame| frame.frame.into()).terminal("frame", 0),
        column(|frame| truth(frame, |truth| truth.psnr_db)).terminal("psnr dB", 2),
        column(|frame| truth(frame, |truth| truth.psnr_hold_db)).terminal("hold", 2),
        column(|frame| truth(frame, |truth| truth.psnr_known_db)).terminal("known", 2),
        column(|frame| truth(frame, |truth| truth.ssim)).terminal("ssim", 4),
        column(|frame| truth(frame, |truth| truth.flip)).terminal("flip", 4),
    ];
    columns.extend(measures::columns());
    columns.extend([
        column(|frame| frame.holes.into()).terminal("holes", 0),
        column(|frame| frame.bullets.into()).terminal("bullets", 0),
        column(|frame| frame.lost.into()).terminal("lost", 0),
        column(|frame| frame.collided.into()).terminal("collided", 0),
        column(|frame| frame.position.map(|position| position.worst_px).into()).terminal("worst px", 4),
    ]);
    columns
}

fn table(report: &RunReport) -> String {
    let mut lines = vec![
        format!(
            "{}: {}x{}, D = {}, tau_recog = {}, tau_prop = {}, {} bytes per galpixel, {} rounding, fill {}, scheme {}, \
             scan-out {}, certified {:.4} px up to frame {}, {:.4} px on the screen",
            printable(&report.source),
            report.width,
            report.height,
            report.budget.extent,
            report.budget.recog,
            report.budget.prop,
            report.budget.stored_bytes_per_galpixel,
            report.rounding,
            report.fill,
            report.scheme,
            report.scan_out,
            report.certificate.total_px,
            report.budget.prop,
            report.displayed_px
        ),
        format!(
            "{} galpixels, {} cells start empty, {} fields clamped; {:.1} ns a galpixel",
            report.loaded.galpixels, report.loaded.empty, report.loaded.saturated, report.ns_per_galpixel
        ),
    ];
    if let Some(hidden) = &report.hidden {
        let line = format!(
            "{}: {} hidden layers; {} samples behind the first layer, {} handed over, {} shown",
            hidden.strategy, hidden.layers, hidden.offered, hidden.kept, hidden.used
        );
        lines.push(line);
    }
    let columns = columns();
    lines.extend(Table::new(&columns, &report.frames).lines(&report.frames));
    lines.join("\n")
}
