//! `galpix stability`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use galpix_core::{Demand, Rounding};

use super::choices::RoundingChoice;
use super::{CliError, print, print_json, say};
use crate::cli::progress;
use crate::output::html::write_atomically;
use crate::study::stability::verdict::{Uncovered, Verdict};
use crate::study::stability::{self, CaseReport, PictureReport, Report, Request, RoundingReport};

/// Arguments of `galpix stability`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Stability {
    /// Cases to run [default: all of them]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// One rounding [default: all of them; the tables show low-discrepancy]
    #[arg(long, value_enum, value_name = "ROUNDING")]
    rounding: Option<RoundingChoice>,
    /// D, the extent of the display in pixels
    #[arg(long, value_name = "PX", default_value_t = 1024)]
    extent: u32,
    /// tau_recog, the shortest recognisable time in frames
    #[arg(long, value_name = "FRAMES", default_value_t = 8)]
    recog: u32,
    /// tau_prop, the frames to survive without an update
    #[arg(long, value_name = "FRAMES", default_value_t = 16)]
    prop: u32,
    /// Folder for the report
    #[arg(long, value_name = "DIR", default_value = "galpix-out")]
    out: PathBuf,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Stability {
    /// Runs the suite.
    pub fn run(&self) -> Result<(), CliError> {
        let started = Instant::now();
        let request = Request {
            demand: Demand { extent: self.extent, recog: self.recog, prop: self.prop },
            rounding: self.rounding.map(Rounding::from),
            cases: self.cases.clone(),
        };
        request.check().map_err(CliError::unusable)?;
        std::fs::create_dir_all(&self.out).map_err(|error| CliError::unwritable(&self.out, &error))?;
        let bar = progress::bar(request.cases().count() as u64, "stability");
        let report = stability::run(&request, |case| {
            bar.set_message(case);
            bar.inc(1);
        })
        .map_err(CliError::unusable)?;
        bar.finish_and_clear();
        let page = stability::html(&report, started.elapsed());
        let path = self.out.join("stability.html");
        write_atomically(&path, page.as_bytes()).map_err(|error| CliError::unwritable(&path, &error))?;
        if self.json {
            print_json(&report)?;
            say(&format!("the report is in {}", path.display()));
        } else {
            for line in tables(&report) {
                print(&line)?;
            }
            print(&path.display().to_string())?;
        }
        if report.stable {
            Ok(())
        } else {
            let count = report.count(Verdict::Unstable);
            Err(CliError::Failed(format!(
                "{count} of {} cases are unstable: see the findings above",
                report.cases.len()
            )))
        }
    }
}

/// A length in at most six characters.
fn px(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        small if small < 0.000_05 => format!("{small:.0e}"),
        _ if value < 9.999_95 => format!("{value:.4}"),
        _ if value < 999.95 => format!("{value:.1}"),
        _ if value < 999_999.5 => format!("{value:.0}"),
        _ => format!("{value:.0e}"),
    }
}

/// The verdict with what is not covered, in the order of the columns.
fn verdict(verdict: Verdict, uncovered: Uncovered) -> String {
    let parts = [
        (uncovered.taylor_px.is_some(), "Taylor"),
        (uncovered.saturation_px.is_some(), "clamped"),
        (uncovered.past_prop_px.is_some(), "late"),
    ];
    let parts: Vec<&str> = parts.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
    match verdict {
        Verdict::NotCovered if !parts.is_empty() => format!("{}: {}", verdict.name(), parts.join(", ")),
        _ => verdict.name().to_owned(),
    }
}

fn tables(report: &Report) -> Vec<String> {
    let budget = &report.budget;
    let shown: Vec<(&CaseReport, &RoundingReport)> =
        report.cases.iter().filter_map(|case| Some((case, case.shown()?))).collect();
    let rounding = shown.first().map_or("", |(_, shown)| shown.rounding);
    let mut lines = vec![format!(
        "D = {} px, tau_recog = {}, tau_prop = {}, {rounding} rounding; the largest error in any frame, in px, by cause",
        budget.extent, budget.recog, budget.prop
    )];
    paths(&shown, &mut lines);
    pictures(&shown, &mut lines);
    drifts(report, &mut lines);
    for (case, rounding) in report.cases.iter().flat_map(|case| case.roundings.iter().map(move |one| (case, one))) {
        for finding in &rounding.findings {
            lines.push(format!("UNSTABLE {}, {}: {finding}", case.name, rounding.rounding));
        }
    }
    lines.push(format!(
        "{} bounded, {} not covered, {} unstable. Taylor: beyond second order; clamped: a field ended; late: after \
         tau_prop.",
        report.count(Verdict::Bounded),
        report.count(Verdict::NotCovered),
        report.count(Verdict::Unstable)
    ));
    lines
}

fn paths(shown: &[(&CaseReport, &RoundingReport)], lines: &mut Vec<String>) {
    let rows: Vec<String> = shown
        .iter()
        .filter_map(|(case, rounding)| {
            let worst = rounding.worst?;
            Some(format!(
                "{:<17}{:>6}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>8}  {}",
                case.name,
                rounding.frames,
                px(worst.taylor_px),
                px(worst.quantisation_px),
                px(worst.drift_px),
                px(worst.snapping_px),
                px(worst.saturation_px),
                px(worst.bound_px),
                px(worst.f32_px),
                px(worst.f64_px),
                rounding.clamped,
                verdict(rounding.verdict, rounding.uncovered)
            ))
        })
        .collect();
    if !rows.is_empty() {
        lines.push(format!(
            "{:<17}{:>6}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>7}{:>8}  verdict",
            "paths", "frames", "Taylor", "quant", "drift", "snap", "satur", "bound", "f32", "f64", "clamped"
        ));
        lines.extend(rows);
    }
}

fn pictures(shown: &[(&CaseReport, &RoundingReport)], lines: &mut Vec<String>) {
    let rows: Vec<String> = shown
        .iter()
        .filter(|(_, rounding)| !rounding.pictures.is_empty())
        .map(|(case, rounding)| {
            let sum = |column: fn(&PictureReport) -> u64| rounding.pictures.iter().map(column).sum::<u64>();
            let largest =
                |column: fn(&PictureReport) -> f64| px(rounding.pictures.iter().map(column).fold(0.0, f64::max));
            format!(
                "{:<17}{:>6}{:>10}{:>10}{:>9}{:>9}{:>9}{:>8}{:>8}{:>8}  {}",
                case.name,
                rounding.frames,
                sum(|picture| picture.moved),
                sum(|picture| picture.settled),
                sum(|picture| picture.lost),
                sum(|picture| picture.collided),
                sum(|picture| picture.holes),
                largest(|picture| picture.worst_px),
                largest(|picture| picture.bound_px),
                sum(|picture| picture.clamped),
                verdict(rounding.verdict, rounding.uncovered)
            )
        })
        .collect();
    if !rows.is_empty() {
        lines.push(format!(
            "{:<17}{:>6}{:>10}{:>10}{:>9}{:>9}{:>9}{:>8}{:>8}{:>8}  verdict, all rungs",
            "pictures", "frames", "moved", "settled", "lost", "collided", "holes", "px", "bound", "clamped"
        ));
        lines.extend(rows);
    }
}

/// The drift of each case with each rounding.
fn drifts(report: &Report, lines: &mut Vec<String>) {
    let Some(first) = report.cases.iter().find(|case| case.roundings.len() > 1) else { return };
    let mut head = format!("{:<17}", "drift, px");
    first.roundings.iter().for_each(|rounding| head.push_str(&format!("{:>17}", rounding.rounding)));
    let rows = report.cases.iter().filter(|case| case.roundings.iter().any(|rounding| rounding.worst.is_some()));
    let rows = rows.map(|case| {
        let mut row = format!("{:<17}", case.name);
        for rounding in &case.roundings {
            row.push_str(&format!("{:>17}", rounding.worst.map_or_else(|| "-".to_owned(), |worst| px(worst.drift_px))));
        }
        row
    });
    lines.push(head);
    lines.extend(rows);
}
