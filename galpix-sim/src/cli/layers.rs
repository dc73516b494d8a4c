//! `galpix layers`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::call::{self, command, machine};
use super::choices::AccelerationChoice;
use super::{CliError, check, print, printable, printable_lines, say};
use crate::cli::progress;
use crate::study::layers::report::Document;
use crate::study::layers::{self, Plan, Study, csv, page, table};
use crate::study::run::Request;

/// Arguments of `galpix layers`.
#[derive(Debug, Args)]
pub struct LayersArguments {
    /// Built-in scenes' names, or paths of a capture.toml or of its folder [default: all scenes, and the capture marbles]
    #[arg(value_name = "SOURCE")]
    sources: Vec<String>,
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=255))]
    frames: Option<u32>,
    /// How far a second layer lies behind the first at least, as a part of the depth range
    #[arg(long, value_name = "PART", default_value_t = crate::source::hidden::SEPARATION, value_parser = super::hidden::separation)]
    separation: f64,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for layers.html, layers.csv and layers.json [default: galpix-out/layers; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl LayersArguments {
    /// Compares the ways.
    pub fn run(&self) -> Result<(), CliError> {
        let started = Instant::now();
        let request = Request { frames: self.frames, ..Request::default() };
        let plan = Plan { request, ways: layers::ways(self.separation) };
        let sources = call::sources(&self.sources, &self.acceleration.into())?;
        sources.iter().try_for_each(|source| check(source, &plan.request))?;
        let out = call::folder(self.out.as_ref(), self.json, "layers")?;
        let mut document = Document {
            version: env!("CARGO_PKG_VERSION"),
            command: command(),
            machine: machine(),
            seconds: 0.0,
            separation: self.separation,
            sources: Vec::new(),
            nothing_disoccluded: Vec::new(),
            nothing_hidden: Vec::new(),
        };
        for source in &sources {
            let name = printable(source.name());
            let bar = progress::bar(plan.ways.len() as u64, &name);
            let study = layers::study(source, &plan, || bar.inc(1)).map_err(CliError::unusable)?;
            bar.finish_and_clear();
            match study {
                Study::NothingDisoccluded => {
                    say(&format!("{name}: nothing is disoccluded"));
                    document.nothing_disoccluded.push(source.name().to_owned());
                }
                Study::NothingHidden => {
                    say(&format!(
                        "{name}: nothing is known behind its first layer; a capture says it in [update.hidden]"
                    ));
                    document.nothing_hidden.push(source.name().to_owned());
                }
                Study::Compared(report) => {
                    if !self.json {
                        print(&printable_lines(&table::text(&report)))?;
                    }
                    document.sources.push(*report);
                }
            }
        }
        document.seconds = started.elapsed().as_secs_f64();
        if !self.json {
            print(table::LEGEND)?;
        }
        call::publish(out.as_deref(), self.json, &document, || {
            Ok(vec![
                ("layers.csv", csv::csv(&document)),
                ("layers.json", call::json(&document)?),
                ("layers.html", page::html(&document)),
            ])
        })
    }
}
