//! `galpix stability`.

use std::path::PathBuf;

use clap::Args;
use galpix_core::{Demand, Rounding};

use super::CliError;
use super::choices::RoundingChoice;
use super::drive::{Publication, drive};
use crate::study::stability::{self, Request};

/// Arguments of `galpix stability`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_long_help = stability::LEGEND)]
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
        let request = Request {
            demand: Demand { extent: self.extent, recog: self.recog, prop: self.prop },
            rounding: self.rounding.map(Rounding::from),
            cases: self.cases.clone(),
        };
        drive(&request, &[()], &Publication::to(Some(&self.out), self.json))
    }
}
