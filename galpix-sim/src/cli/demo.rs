//! `galpix demo`: all built-in scenes, a table, and a page to read.

use std::path::PathBuf;

use clap::Args;

use super::choices::Extrapolation;
use super::drive::{Publication, drive};
use super::{CliError, call};
use crate::study::demo::Plan;
use crate::study::job::Request;

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
        let plan = Plan { request: Request { perceptual: false, ..self.extrapolation.request()? } };
        drive(&plan, &[call::all()], &Publication { out: Some(self.out.clone()), json: false })
    }
}
