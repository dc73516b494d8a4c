//! `galpix fills`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::call::{self, command, machine};
use super::choices::{AccelerationChoice, Inpainting};
use super::{CliError, check, print, printable, printable_lines, say};
use crate::cli::progress;
use crate::engine::fill::Gamma;
use crate::study::fills::case::{self, Case};
use crate::study::fills::export::{self, Export};
use crate::study::fills::report::Document;
use crate::study::fills::{self, FillsError, Plan, csv, page, table};
use crate::study::run::Request;

/// Arguments of `galpix fills`.
#[derive(Debug, Args)]
pub struct Fills {
    /// Built-in scenes' names, or paths of a capture.toml or of its folder [default: all scenes, and the capture marbles]
    #[arg(value_name = "SOURCE")]
    sources: Vec<String>,
    /// Fills to compare [default: all of none, hold, debris, bullet, galdebris, extend, push-pull-classic, push-pull, metamer]
    #[arg(long, value_name = "FILLS", value_delimiter = ',')]
    fills: Vec<String>,
    #[command(flatten)]
    inpainting: Inpainting,
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    frames: Option<u32>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for fills.html, fills.csv, fills.json, and each picture with its mask and its truth, listed in index.json [default:
    /// galpix-out/fills; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Fills {
    /// Compares the fills and writes the report.
    pub fn run(&self) -> Result<(), CliError> {
        let started = Instant::now();
        let plan = self.plan()?;
        let sources = call::sources(&self.sources, &self.acceleration.into())?;
        sources.iter().try_for_each(|source| check(source, &plan.request))?;
        let out = call::folder(self.out.as_ref(), self.json, "fills")?;
        let export = out.as_deref().map(Export::new);
        let mut document = Document {
            version: env!("CARGO_PKG_VERSION"),
            command: command(),
            machine: machine(),
            seconds: 0.0,
            fovea: plan.fovea,
            sources: Vec::new(),
            nothing_disoccluded: Vec::new(),
        };
        for source in &sources {
            let name = printable(source.name());
            let bar = progress::bar(plan.cases.len() as u64, &name);
            let report = fills::study(source, &plan, export.as_ref(), || bar.inc(1)).map_err(|error| match error {
                FillsError::Experiment(_) | FillsError::Export(_) => CliError::unusable(error),
            })?;
            bar.finish_and_clear();
            match report {
                Some(report) => {
                    if !self.json {
                        print(&printable_lines(&table::text(&report)))?;
                    }
                    document.sources.push(report);
                }
                None => {
                    say(&format!("{name}: nothing is disoccluded"));
                    document.nothing_disoccluded.push(source.name().to_owned());
                }
            }
        }
        document.seconds = started.elapsed().as_secs_f64();
        if !self.json {
            print(table::LEGEND)?;
        }
        call::publish(out.as_deref(), self.json, &document, || {
            let index = export::index(&document).map_err(|error| CliError::Failed(error.to_string()))?;
            Ok(vec![
                ("fills.csv", csv::csv(&document)),
                ("fills.json", call::json(&document)?),
                ("index.json", index),
                ("fills.html", page::html(&document)),
            ])
        })
    }

    fn plan(&self) -> Result<Plan, CliError> {
        let mut cases = case::all(self.inpainting.gamma.map(Gamma::from), self.inpainting.fovea);
        let names: Vec<&str> = cases.iter().map(|case| case.name).collect();
        if let Some(unknown) = self.fills.iter().find(|name| !names.contains(&name.as_str())) {
            let unknown = printable(unknown);
            return Err(CliError::unusable(format!("there is no fill `{unknown}`: give some of {}", names.join(", "))));
        }
        let wanted = |case: &Case| self.fills.is_empty() || self.fills.iter().any(|name| name == case.name);
        cases.retain(wanted);
        let request = Request { frames: self.frames, ..Request::default() };
        Ok(Plan { request, cases, fovea: self.inpainting.fovea })
    }
}
