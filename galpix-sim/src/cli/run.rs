//! `galpix run`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::choices::Extrapolation;
use super::hidden::HiddenArguments;
use super::{CliError, call, note, print, print_json, printable, progress};
use crate::output::column::{self, Column, Table, Value};
use crate::output::frames::{self, Frames};
use crate::output::html::{self, Report, Story};
use crate::output::measures;
use crate::output::save::{file_name, write_atomically};
use crate::study::job::{Job, Request};
use crate::study::run::{self, FrameReport, RunReport, TruthReport};
use crate::study::story::Film;

/// Arguments of `galpix run`.
#[derive(Debug, Default, Args)]
#[command(after_long_help = legend())]
pub struct Run {
    /// A built-in scene's name, or the path of a capture.toml or of its folder
    source: String,
    #[command(flatten)]
    extrapolation: Extrapolation,
    #[command(flatten)]
    hidden: HiddenArguments,
    /// Folder for the frames, and without --json for report.html and frames.csv [default: galpix-out/NAME]
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
        let request = Request { strategy: self.hidden.strategy(request.scheme)?, ..request };
        let source = call::open(&self.source, self.extrapolation.acceleration)?;
        let job = Job::resolve(&source, &request).map_err(CliError::unusable)?;
        run::check_strategy(&source, request.strategy).map_err(CliError::unusable)?;
        let key = call::key(&source, &self.source);
        let usual = || Frames::usual(Path::new("galpix-out"), &file_name(source.name()), &key);
        let out = self.out.clone().unwrap_or_else(usual);
        call::spare(&self.source, (0..=job.frames).map(|frame| frames::path(&out, frame)))?;
        let (frames, removed) = Frames::open(&out, &key, job.frames).map_err(CliError::unusable)?;
        if let (Some(first), Some(last)) = (removed.first(), removed.last()) {
            let [first, last] = [first, last].map(|path| path.file_name().unwrap_or_default().display());
            let count = removed.len();
            note(&format!(
                "{count} frames of an earlier, longer run removed from {}: {first} to {last}",
                out.display()
            ));
        }
        // What tells of earlier frames: without `--json` it is written anew.
        for name in [CSV, PAGE].into_iter().filter(|_| self.json && frames.again) {
            if std::fs::remove_file(out.join(name)).is_ok() {
                note(&format!("{name} of an earlier run removed from {}", out.display()));
            }
        }
        let bar = progress::bar(u64::from(job.frames), &printable(source.name()));
        let mut written = Ok(());
        let mut film = (!self.json).then(Film::default);
        let report = run::job(&job, |shown| {
            if written.is_ok() {
                written = frames.write(shown.frame, shown.picture);
            }
            film.iter_mut().for_each(|film| film.see(shown));
            bar.set_position(u64::from(shown.frame));
        })
        .map_err(CliError::unusable)?;
        bar.finish_and_clear();
        written.map_err(CliError::unusable)?;
        super::remark(&source);
        note(&format!("{} frames and the update in {}", report.frames.len(), out.display()));
        let Some(film) = film else { return print_json("run", &report) };
        let csv = column::csv(&columns(), report.frames.iter().copied());
        let csv = csv.map_err(|error| CliError::Failed(error.to_string()))?;
        let page = page(film.story(source.about(), &report, Vec::new()), &report);
        for (name, text) in [(CSV, csv), (PAGE, page)] {
            let path = out.join(name);
            call::spare(&self.source, [path.clone()])?;
            write_atomically(&path, text.as_bytes()).map_err(|error| CliError::unwritable(&path, &error))?;
            note(&format!("{} is written", path.display()));
        }
        print(&table(&report))
    }
}

/// What is written beside the frames.
const CSV: &str = "frames.csv";
const PAGE: &str = "report.html";

/// Returns the run as a page.
fn page(story: Story, report: &RunReport) -> String {
    html::html(&Report {
        title: format!("galpix: {}, extrapolated from one update", report.source),
        intro: vec![
            "From one picture with the motion of every pixel the engine made all the frames that follow; a conventional \
             display would have shown that picture until the next one came."
                .to_owned(),
        ],
        facts: vec![
            ("Version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
            ("Command".to_owned(), call::command()),
            ("Machine".to_owned(), call::machine()),
            ("Scheme".to_owned(), format!("{}, scan-out {}", report.scheme, report.scan_out)),
        ],
        stories: vec![story],
    })
}

/// Returns the columns of the frames.
fn columns() -> Vec<Column<FrameReport>> {
    fn truth<V: Into<Value>>(frame: &FrameReport, of: fn(TruthReport) -> V) -> Value {
        frame.truth.map(of).into()
    }
    let column = Column::<FrameReport>::new;
    let mut columns = vec![
        column(|frame| frame.frame.into()).csv("frame").terminal("frame", 0).means("frames since the update"),
        column(|frame| truth(frame, |truth| truth.psnr_db))
            .csv("psnr_db")
            .terminal("galpix dB", 2)
            .means("PSNR of what is shown against the truth, in decibels"),
        column(|frame| truth(frame, |truth| truth.psnr_hold_db))
            .csv("psnr_hold_db")
            .terminal("hold dB", 2)
            .means("the same of sample-and-hold: the update, unmoved"),
        column(|frame| truth(frame, |truth| truth.ssim))
            .csv("ssim")
            .terminal("SSIM", 4)
            .means("structural similarity to the truth, 1 for equals"),
        column(|frame| truth(frame, |truth| truth.flip))
            .csv("flip")
            .terminal("FLIP", 4)
            .means("mean FLIP against the truth, 0 for equals"),
        column(|frame| truth(frame, |truth| truth.psnr_known_db))
            .csv("psnr_known_db")
            .terminal("reached dB", 2)
            .means("PSNR of the cells that a galpixel of the update reached: all but those of missing %"),
    ];
    columns.extend(measures::columns());
    columns.extend(counts());
    columns.extend(places());
    columns
}

/// Returns the columns of what was counted.
fn counts() -> [Column<FrameReport>; 5] {
    let column = Column::<FrameReport>::new;
    [
        column(|frame| frame.truth.map(|truth| truth.missing_at_border).into())
            .csv("missing_at_border")
            .terminal("border", 0)
            .means("cells that are missing in connection with the border: what enters the picture"),
        column(|frame| frame.holes.into())
            .csv("holes")
            .terminal("holes", 0)
            .means("cells that nothing reached in this frame, fillings of the frame before among what reaches"),
        column(|frame| frame.filled.into())
            .csv("filled")
            .terminal("filled", 0)
            .means("holes that something was put into"),
        column(|frame| frame.lost.into()).csv("lost").terminal("lost", 0).means("galpixels that left over the border"),
        column(|frame| frame.collided.into())
            .csv("collided")
            .terminal("collided", 0)
            .means("galpixels that met a nearer one in their cell"),
    ]
}

/// Returns the columns of where galpixels are.
fn places() -> [Column<FrameReport>; 3] {
    let column = Column::<FrameReport>::new;
    [
        column(|frame| frame.position.map(|position| position.worst_px).into())
            .csv("worst_px")
            .terminal("path px", 4)
            .means("the worst distance of a galpixel from the update's second-order path, before the snap to a cell"),
        column(|frame| frame.certified_px.into())
            .csv("certified_px")
            .terminal("bound px", 4)
            .means("the certificate for that distance up to this frame; none beyond tau_prop"),
        column(|frame| frame.position.and_then(|position| position.truth_worst_px).into())
            .csv("truth_worst_px")
            .terminal("truth px", 4)
            .means("the worst distance from the true motion, where that is known: what no certificate covers"),
    ]
}

/// Returns what the columns are.
fn legend() -> String {
    column::legend(&columns())
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
    let (last, prop) = (report.frames.last().map_or(0, |frame| frame.frame), report.budget.prop);
    if last > prop {
        lines.push(format!(
            "frames {} to {last} are beyond tau_prop, and no certificate covers them: `--prop {}` makes a budget that does",
            prop + 1,
            last.next_power_of_two()
        ));
    }
    if let Some(hidden) = &report.hidden {
        let line = format!(
            "{}: {} hidden layers; {} samples behind the first layer, {} handed over, {} shown",
            hidden.strategy, hidden.layers, hidden.offered, hidden.kept, hidden.used
        );
        lines.push(line);
    }
    lines.push(legend());
    let columns = columns();
    lines.extend(Table::new(&columns, &report.frames).lines(&report.frames));
    lines.join("\n")
}
