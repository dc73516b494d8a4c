//! `galpix ddoc`.

use std::path::PathBuf;

use clap::Args;
use galpix_core::ddoc::MOST_RADIUS;

use super::CliError;
use super::drive::{Publication, drive};
use crate::study::ddoc::{self, Request, SIZES};

/// Arguments of `galpix ddoc`.
#[derive(Debug, Args)]
#[command(after_long_help = ddoc::LEGEND)]
pub struct Ddoc {
    /// Built-in scenes, the worlds portal and knot, or paths of OBJ files [default: pillars, sphere, crossing,
    /// near-plane, portal, knot]
    #[arg(value_name = "WORLD")]
    worlds: Vec<String>,
    /// D, how far behind an edge samples are fetched, in pixels [default: a 32nd of the size]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_RADIUS)))]
    radius: Option<u32>,
    /// a_f, how many times wider the hidden band is than the visible one, 1 to 15 [default: 2]
    #[arg(long, value_name = "FACTOR", value_parser = asymmetry)]
    asymmetry: Option<f64>,
    /// Side of the reference images, in pixels, 64 to 2048
    #[arg(long, value_name = "PX", default_value_t = 512, value_parser = size)]
    size: usize,
    /// Folder for ddoc.html, ddoc.json and the pictures [default: galpix-out/ddoc; with --json nothing is written
    /// without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

fn asymmetry(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(factor) if (1.0..=15.0).contains(&factor) => Ok(factor),
        _ => Err("give a number from 1 to 15".to_owned()),
    }
}

fn size(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(size) if SIZES.contains(&size) => Ok(size),
        _ => Err(format!("give a whole number from {} to {}", SIZES.start(), SIZES.end())),
    }
}

impl Ddoc {
    /// Takes the images, counts what is missing, and writes the pictures.
    pub fn run(&self) -> Result<(), CliError> {
        let mut request = Request::new(self.size);
        request.radius = self.radius.unwrap_or(request.radius);
        request.asymmetry = self.asymmetry.unwrap_or(request.asymmetry);
        let names: Vec<&str> = match self.worlds.as_slice() {
            [] => ddoc::defaults().to_vec(),
            names => names.iter().map(String::as_str).collect(),
        };
        let worlds =
            names.iter().map(|name| ddoc::open(name)).collect::<Result<Vec<_>, _>>().map_err(CliError::unusable)?;
        let to = Publication::usual(self.out.as_ref(), self.json, "ddoc").reading(&self.worlds);
        drive(&request, &worlds, &to)
    }
}
