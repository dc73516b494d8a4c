//! `galpix demo`: all built-in scenes, a table, and a page to read.

use std::path::PathBuf;

use clap::Args;

use super::choices::Extrapolation;
use super::drive::{Publication, drive};
use super::{CliError, call};
use crate::study::demo::{self, Plan};
use crate::study::job::Request;

/// Arguments of `galpix demo`.
#[derive(Debug, Args)]
#[command(after_long_help = demo::legend())]
pub struct Demo {
    #[command(flatten)]
    extrapolation: Extrapolation,
    /// Folder for the report [default: galpix-out; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Default for Demo {
    fn default() -> Self {
        Self { extrapolation: Extrapolation { reach: 1, ..Extrapolation::default() }, out: None, json: false }
    }
}

impl Demo {
    /// Runs the scenes.
    pub fn run(&self) -> Result<(), CliError> {
        let plan = Plan { request: Request { perceptual: false, ..self.extrapolation.request()? } };
        let sources = call::all(self.extrapolation.acceleration);
        let out = self.out.clone().or((!self.json).then(|| PathBuf::from("galpix-out")));
        drive(&plan, &[sources], &Publication::to(out.as_ref(), self.json))
    }
}
