//! `galpix layers`.

use clap::Args;

use super::choices::AccelerationChoice;
use super::demo::sources;
use super::{CliError, check, print, print_json, printable, printable_lines, say};
use crate::experiment::{Request, Source};
use crate::layers::{self, Plan, Study, table};
use crate::progress;

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
    #[arg(long, value_name = "PART", default_value_t = crate::hidden::SEPARATION, value_parser = super::hidden::separation)]
    separation: f64,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl LayersArguments {
    /// Compares the ways.
    pub fn run(&self) -> Result<(), CliError> {
        let request = Request { frames: self.frames, ..Request::default() };
        let plan = Plan { request, ways: layers::ways(self.separation) };
        let open = |name: &String| Source::open(name, &self.acceleration.into()).map_err(CliError::unusable);
        let sources = match self.sources.as_slice() {
            [] => sources(),
            names => names.iter().map(open).collect::<Result<_, _>>()?,
        };
        sources.iter().try_for_each(|source| check(source, &plan.request))?;
        let mut reports = Vec::new();
        for source in &sources {
            let name = printable(source.name());
            let bar = progress::bar(plan.ways.len() as u64, &name);
            let study = layers::study(source, &plan, || bar.inc(1)).map_err(CliError::unusable)?;
            bar.finish_and_clear();
            match study {
                Study::NothingDisoccluded => say(&format!("{name}: nothing is disoccluded")),
                Study::NothingHidden => say(&format!("{name}: nothing is known behind its first layer")),
                Study::Compared(report) => {
                    if !self.json {
                        print(&printable_lines(&table::text(&report)))?;
                    }
                    reports.push(report);
                }
            }
        }
        if self.json { print_json(&reports) } else { print(table::LEGEND) }
    }
}
