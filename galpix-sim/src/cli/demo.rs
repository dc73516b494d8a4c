//! `galpix demo`: all built-in scenes, a table, and a page to read.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use rayon::prelude::*;

use super::choices::Extrapolation;
use super::{CliError, check, print, say};
use crate::certificate::FrameBound;
use crate::cli::progress;
use crate::output::film::{self, Colours};
use crate::output::html::{self, CertificateLine, Report, Row, Story};
use crate::picture::Picture;
use crate::source::Source;
use crate::source::capture::ImportOptions;
use crate::source::scene;
use crate::study::run::{self, FrameReport, PositionReport, Request, RunReport, Shown, TruthReport};

/// A film's frame is shown for this long.
const FRAME_MS: u16 = 120;

/// A film may be this large before its colours are counted.
const FILM_BYTES: usize = 1_000_000;

/// Frames of each scene that are made once more in both modes of work, to say what skipping saves.
const FRAMES_FOR_GAIN: u32 = 5;

/// Arguments of `galpix demo`.
#[derive(Debug, Args)]
pub struct Demo {
    #[command(flatten)]
    extrapolation: Extrapolation,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "galpix-out")]
    out: PathBuf,
}

impl Default for Demo {
    fn default() -> Self {
        Self { extrapolation: Extrapolation { reach: 1, ..Extrapolation::default() }, out: PathBuf::from("galpix-out") }
    }
}

impl Demo {
    /// Runs the scenes.
    pub fn run(&self) -> Result<(), CliError> {
        let started = Instant::now();
        let request = Request { perceptual: false, ..self.extrapolation.request() };
        let sources = sources();
        sources.iter().try_for_each(|source| check(source, &request))?;
        std::fs::create_dir_all(&self.out).map_err(|error| CliError::unwritable(&self.out, &error))?;
        let frames: u64 = sources.iter().map(|source| u64::from(request.frames.unwrap_or(source.frames())) + 1).sum();
        let bar = progress::bar(frames, "demo");
        let told: Vec<Told> = sources
            .par_iter()
            .map(|source| tell(source, &request, &bar))
            .collect::<Result<_, _>>()
            .map_err(CliError::unusable)?;
        bar.finish_and_clear();
        for line in table(&told) {
            print(&line)?;
        }
        let page = html::html(&Report {
            title: "galpix: pictures that keep moving between updates".to_owned(),
            intro: vec![
                "Each scene below was rendered once, with the motion of every pixel. From that one picture the engine made \
                 all the frames that follow, with additions and shifts only; a conventional display would have shown the \
                 first picture until the next one came."
                    .to_owned(),
            ],
            facts: vec![
                ("Version".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
                ("Rounding".to_owned(), request.rounding.name().to_owned()),
                ("Holes".to_owned(), request.fill.name().to_owned()),
                ("ns a galpixel".to_owned(), "a budget chosen at run time, scenes side by side".to_owned()),
                ("Time".to_owned(), format!("{:.1} s", started.elapsed().as_secs_f64())),
            ],
            stories: told.into_iter().map(|told| told.story).collect(),
        });
        let path = self.out.join("report.html");
        html::write_atomically(&path, page.as_bytes()).map_err(|error| CliError::unwritable(&path, &error))?;
        print(&path.display().to_string())
    }
}

/// The built-in scenes, and the project's own capture if its folder is there.
pub(super) fn sources() -> Vec<Source> {
    let mut sources: Vec<Source> = scene::all().iter().map(|&scene| Source::Scene(scene)).collect();
    let capture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles/capture.toml");
    if capture.exists() {
        match Source::open(&capture.to_string_lossy(), &ImportOptions::default()) {
            Ok(source) => sources.push(source),
            Err(error) => say(&format!("galpix: {error}")),
        }
    }
    sources
}

/// A source after its run.
struct Told {
    run: RunReport,
    story: Story,
    /// The time of a frame with constant work by that of one that skips.
    gain: f64,
}

/// Runs a source and makes its story.
fn tell(source: &Source, request: &Request, bar: &indicatif::ProgressBar) -> Result<Told, run::ExperimentError> {
    let mut pictures = Vec::new();
    let run = run::run(source, request, |shown| {
        pictures.extend(panels(shown));
        bar.inc(1);
    })?;
    let gain = run::work_gain(source, request, run.frames.len().min(FRAMES_FOR_GAIN as usize) as u32)?;
    let mut notes = vec![format!(
        "Constant work, the mode whose instructions do not depend on the picture, takes {gain:.1} times as long as a frame that \
         skips what this picture does not need (medians of the first {FRAMES_FOR_GAIN} frames)."
    )];
    if run.loaded.saturated > 0 {
        notes.push(format!("{} fields of the update were clamped to their range.", run.loaded.saturated));
    }
    let film_apng = match film::apng_within(&pictures, FRAME_MS, FILM_BYTES) {
        Ok((film, colours)) => {
            if matches!(colours, Colours::Palette) {
                notes.push("The film above has 256 colours; every figure comes from the full ones.".to_owned());
            }
            film
        }
        Err(error) => {
            notes.push(format!("There is no film: {error}."));
            Vec::new()
        }
    };
    let story = Story {
        name: run.source.clone(),
        about: source.about().to_owned(),
        width: run.width,
        height: run.height,
        budget_line: budget_line(&run),
        rounding: run.rounding.to_owned(),
        fill: run.fill.to_owned(),
        certificate: Some(CertificateLine {
            quantisation_px: run.certificate.quantisation_px,
            drift_px: run.certificate.drift_px,
            total_px: run.certificate.total_px,
            holds: run.certificate.keeps_one_pixel(),
            per_frame_px: std::iter::once(0.0).chain(run.certificate.frames.iter().map(FrameBound::total_px)).collect(),
        }),
        film_apng,
        rows: run.frames.iter().map(row).collect(),
        notes,
    };
    Ok(Told { run, story, gain })
}

fn budget_line(run: &RunReport) -> String {
    let budget = &run.budget;
    format!(
        "D = {} px, tau_recog = {}, tau_prop = {}: velocity {}+{}, acceleration {}+{}, position +{} bits; {} bytes a galpixel",
        budget.extent,
        budget.recog,
        budget.prop,
        budget.velocity_int_bits,
        budget.velocity_frac_bits,
        budget.acceleration_int_bits,
        budget.acceleration_frac_bits,
        budget.position_frac_bits,
        budget.stored_bytes_per_galpixel
    )
}

/// Truth, sample-and-hold, galpix and their difference, side by side; frames without a truth are left out.
fn panels(shown: &Shown<'_>) -> Option<Picture> {
    let truth = &shown.truth?.picture;
    let difference = film::difference(shown.picture, truth);
    let panels = [
        film::labelled(truth, "truth"),
        film::labelled(shown.hold, "sample-and-hold"),
        film::labelled(shown.picture, "galpix"),
        film::labelled(&difference, "difference x4"),
    ];
    Some(film::side_by_side(&panels.each_ref(), 4))
}

fn row(frame: &FrameReport) -> Row {
    let truth = frame.truth.as_ref();
    Row {
        frame: frame.frame,
        psnr_db: truth.and_then(|truth| truth.psnr_db),
        psnr_hold_db: truth.and_then(|truth| truth.psnr_hold_db),
        psnr_known_db: truth.and_then(|truth| truth.psnr_known_db),
        position_error_px: frame.position.map(|position| position.worst_px),
        mean_position_error_px: frame.position.map(|position| position.mean_px),
        truth_error_px: frame.position.and_then(|position| position.truth_worst_px),
        holes: frame.holes.into(),
        filled: frame.filled.into(),
        lost: frame.lost.into(),
        collided: frame.collided.into(),
        saturated: frame.saturated.into(),
        bullets: frame.bullets.into(),
        unobscured: (frame.debris + frame.galdebris).into(),
        ns_per_galpixel: Some(frame.ns_per_galpixel),
    }
}

/// A line for each scene: means over the frames whose truth is known, and the worst position error of all frames.
fn table(told: &[Told]) -> Vec<String> {
    let mut lines = vec![format!(
        "{:<16} {:>6} {:>9} {:>9} {:>9} {:>10} {:>10} {:>10} {:>8} {:>7} {:>7}",
        "scene",
        "frames",
        "galpix dB",
        "hold dB",
        "known dB",
        "worst px",
        "bound px",
        "truth px",
        "holes %",
        "ns/gal",
        "x const"
    )];
    for Told { run, gain, .. } in told {
        let truths: Vec<_> = run.frames.iter().filter_map(|frame| frame.truth).collect();
        let decibels = |column: fn(&TruthReport) -> Option<f64>| {
            let values: Vec<f64> = truths.iter().filter_map(column).collect();
            number((!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64), 2)
        };
        let worst = |column: fn(&PositionReport) -> Option<f64>| {
            number(run.frames.iter().filter_map(|frame| column(&frame.position?)).reduce(f64::max), 4)
        };
        let cells = (run.width * run.height * run.frames.len()).max(1) as f64;
        lines.push(format!(
            "{:<16} {:>6} {:>9} {:>9} {:>9} {:>10} {:>10} {:>10} {:>8.2} {:>7.1} {:>7.1}",
            run.source,
            run.frames.len(),
            decibels(|truth| truth.psnr_db),
            decibels(|truth| truth.psnr_hold_db),
            decibels(|truth| truth.psnr_known_db),
            worst(|position| Some(position.worst_px)),
            number(run.certificate.after(run.frames.len() as u32), 4),
            worst(|position| position.truth_worst_px),
            100.0 * run.frames.iter().map(|frame| f64::from(frame.holes)).sum::<f64>() / cells,
            run.ns_per_galpixel,
            gain
        ));
    }
    lines.push(
        "dB: mean over the frames whose truth is known. worst px: from the exact second-order path, bounded by bound px; \
         truth px: from the true motion. x const: a frame with constant work by one that skips."
            .to_owned(),
    );
    lines
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}
