//! `galpix layers`.

use std::path::PathBuf;

use clap::Args;

use super::choices::{AccelerationChoice, SchemeChoice};
use super::drive::{Publication, drive};
use super::{CliError, call};
use crate::study::job::Request;
use crate::study::layers::{self, Plan};

/// Arguments of `galpix layers`.
#[derive(Debug, Args)]
#[command(after_long_help = layers::legend())]
pub struct LayersArguments {
    /// Built-in scenes' names, or paths of a capture.toml or of its folder [default: all scenes, and the capture
    /// marbles]
    #[arg(value_name = "SOURCE")]
    sources: Vec<String>,
    /// Frames to extrapolate [default: what the source is meant for]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=255))]
    frames: Option<u32>,
    /// How far a second layer lies behind the first at least, as a part of the depth range
    #[arg(long, value_name = "PART", default_value_t = crate::source::hidden::SEPARATION, value_parser = super::hidden::separation)]
    separation: f64,
    /// How galpixels move: with source, layers are further sources
    #[arg(long, value_enum, value_name = "SCHEME", default_value = "source")]
    scheme: SchemeChoice,
    /// tau_prop, the frames to survive without an update [default: the next power of two of the frames that the source
    /// is meant for, whatever --frames asks for]
    #[arg(long, value_name = "FRAMES")]
    prop: Option<u32>,
    /// What is done with the accelerations of a capture
    #[arg(long, value_enum, value_name = "POLICY", default_value_t)]
    acceleration: AccelerationChoice,
    /// Folder for layers.html, layers.csv and layers.json [default: galpix-out/layers; with --json nothing is written
    /// without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl LayersArguments {
    /// Compares the strategies.
    pub fn run(&self) -> Result<(), CliError> {
        let request =
            Request { frames: self.frames, prop: self.prop, ..Request::default() }.in_scheme(self.scheme.into());
        let plan = Plan { request, strategies: layers::strategies(self.separation) };
        let sources = call::sources(&self.sources, self.acceleration)?;
        let to = Publication::usual(self.out.as_ref(), self.json, "layers").reading(&self.sources).of(&sources);
        drive(&plan, &sources, &to)
    }
}
