//! `galpix fills`.

use std::path::PathBuf;

use clap::Args;

use super::choices::{AccelerationChoice, Inpainting, SchemeChoice, not_of_sources, schemes};
use super::drive::{Publication, drive};
use super::{CliError, call, printable};
use crate::engine::fill::Gamma;
use crate::study::fills::case::{self, Case};
use crate::study::fills::{self, Plan};
use crate::study::job::Request;
use crate::suggest;

/// Arguments of `galpix fills`.
#[derive(Debug, Args)]
#[command(after_long_help = fills::legend())]
pub struct Fills {
    /// Built-in scenes' names, or paths of a capture.toml or of its folder [default: all scenes, and the capture
    /// marbles]
    #[arg(value_name = "SOURCE")]
    sources: Vec<String>,
    /// Fills to compare [default: all of none, hold, debris, bullet, galdebris, extend, push-pull-classic, push-pull,
    /// metamer]
    #[arg(long, value_name = "FILLS", value_delimiter = ',')]
    fills: Vec<String>,
    /// How galpixels move: a row of each fill for each scheme that takes it
    #[arg(long, value_enum, value_name = "SCHEMES", value_delimiter = ',', default_value = "map")]
    scheme: Vec<SchemeChoice>,
    #[command(flatten)]
    inpainting: Inpainting,
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    frames: Option<u32>,
    /// tau_prop, the frames to survive without an update [default: the next power of two of the frames that the source
    /// is meant for, whatever --frames asks for]
    #[arg(long, value_name = "FRAMES")]
    prop: Option<u32>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for fills.html, fills.csv, fills.json, and each picture with its mask and its truth, listed in index.json
    /// [default: galpix-out/fills; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Fills {
    /// Compares the fills and writes the report.
    pub fn run(&self) -> Result<(), CliError> {
        let plan = self.plan()?;
        let sources = call::sources(&self.sources, self.acceleration)?;
        let to = Publication::usual(self.out.as_ref(), self.json, "fills").reading(&self.sources).of(&sources);
        drive(&plan, &sources, &to)
    }

    fn plan(&self) -> Result<Plan, CliError> {
        let mut cases = case::all(self.inpainting.gamma.map(Gamma::from), self.inpainting.fovea);
        let names: Vec<&str> = cases.iter().map(|case| case.name).collect();
        if let Some(unknown) = self.fills.iter().find(|name| !names.contains(&name.as_str())) {
            let (name, hint) = (printable(unknown), suggest::hint(unknown, names.iter().copied()));
            let sentence = format!("there is no fill `{name}`{hint}: give some of {}", names.join(", "));
            return Err(CliError::unusable(sentence));
        }
        let wanted = |case: &Case| self.fills.is_empty() || self.fills.iter().any(|name| name == case.name);
        cases.retain(wanted);
        let (cases, left_out) = case::in_schemes(&cases, &schemes(&self.scheme));
        if cases.is_empty() {
            return Err(not_of_sources("--fills", &self.fills.join(",")));
        }
        // In a fovea nothing is judged, whatever fills it.
        Inpainting { fovea: None, ..self.inpainting }.check(cases.iter().map(|case| case.fill))?;
        let request = Request { frames: self.frames, prop: self.prop, ..Request::default() };
        Ok(Plan { request, cases, left_out, fovea: self.inpainting.fovea })
    }
}
