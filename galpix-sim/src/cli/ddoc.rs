//! `galpix ddoc`.

use std::path::{Path, PathBuf};

use clap::Args;
use galpix_core::ddoc::MOST_RADIUS;

use super::call::{self, command, machine};
use super::{CliError, file_name, print, print_json};
use crate::output::html::write_atomically;
use crate::study::ddoc::pictures::Pictures;
use crate::study::ddoc::report::{self, Document};
use crate::study::ddoc::{self, Request, SIZES, page};

/// Arguments of `galpix ddoc`.
#[derive(Debug, Args)]
pub struct Ddoc {
    /// Built-in scenes, the worlds portal and knot, or paths of OBJ files [default: pillars, sphere, crossing, near-plane, portal,
    /// knot]
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
    /// Folder for ddoc.html, ddoc.json and the pictures [default: galpix-out/ddoc; with --json nothing is written without it]
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
        let out = call::folder(self.out.as_ref(), self.json, "ddoc")?;
        if !self.json {
            print(&report::head())?;
        }
        let sources = Vec::with_capacity(worlds.len());
        let mut document =
            Document { version: env!("CARGO_PKG_VERSION"), command: command(), machine: machine(), sources };
        let mut all = Vec::with_capacity(worlds.len());
        for world in &worlds {
            let (source, pictures) = ddoc::study(world, &request).map_err(CliError::unusable)?;
            if !self.json {
                print(&report::row(&source))?;
            }
            document.sources.push(source);
            all.push(pictures);
        }
        if let Some(out) = &out {
            write(out, &document, &all)?;
        }
        match out {
            _ if self.json => print_json(&document),
            Some(out) => {
                print(report::LEGEND)?;
                print(&out.join("ddoc.html").display().to_string())
            }
            None => Ok(()),
        }
    }
}

/// Writes the pictures, the figures, and last the page.
fn write(out: &Path, document: &Document, all: &[Pictures]) -> Result<(), CliError> {
    for (source, pictures) in document.sources.iter().zip(all) {
        for (name, _, picture) in &pictures.all {
            let png = picture.png().map_err(|error| CliError::Failed(error.to_string()))?;
            let path = out.join(format!("{}-{name}.png", file_name(&source.source)));
            write_atomically(&path, &png).map_err(|error| CliError::unwritable(&path, &error))?;
        }
    }
    call::write(out, &[("ddoc.json", call::json(document)?), ("ddoc.html", page::html(document, all))])
}
