//! `galpix init`.

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{CliError, note, print, print_json, printable};
use crate::output::save::write_atomically;
use crate::source::capture::{InitOptions, Proposal, init};

/// Arguments of `galpix init`.
#[derive(Debug, Args)]
pub struct Init {
    /// The folder with the files: pictures, depth, vectors or poses
    folder: PathBuf,
    /// Display frames between two numbers of the pictures
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=65_535))]
    step: u32,
    /// The camera's intrinsics in pixels, where no file gives them
    #[arg(long, value_name = "FX,FY,CX,CY", value_parser = intrinsics)]
    intrinsics: Option<[f64; 4]>,
    /// Print the manifest and write nothing
    #[arg(long)]
    print: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What `galpix init` wrote.
#[derive(Serialize, JsonSchema)]
pub struct Initialised {
    /// The manifest's file; nothing with `--print`.
    file: Option<String>,
    #[serde(flatten)]
    proposal: Proposal,
}

/// Reads `FX,FY,CX,CY`.
fn intrinsics(text: &str) -> Result<[f64; 4], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[fx, fy, cx, cy]) if fx > 0.0 && fy > 0.0 && [fx, fy, cx, cy].iter().all(|number| number.is_finite()) => {
            Ok([fx, fy, cx, cy])
        }
        _ => Err("give four numbers FX,FY,CX,CY, of which FX and FY are above 0".to_owned()),
    }
}

impl Init {
    /// Writes a manifest for a folder that has none.
    pub fn run(&self) -> Result<(), CliError> {
        let file = self.folder.join("capture.toml");
        if !self.print && file.exists() {
            return Err(CliError::Unusable(format!(
                "{} is there already and is not overwritten: move it away, or see what would be written with --print",
                file.display()
            )));
        }
        let options = InitOptions { step: self.step, intrinsics: self.intrinsics };
        let proposal = init(&self.folder, &options).map_err(CliError::unusable)?;
        if !self.print {
            write_atomically(&file, proposal.manifest.as_bytes())
                .map_err(|error| CliError::Unusable(format!("{} cannot be written ({error})", file.display())))?;
        }
        if self.json {
            let file = (!self.print).then(|| file.display().to_string());
            return print_json("init", &Initialised { file, proposal });
        }
        let Proposal { manifest, moved_db, still_db, notes, .. } = proposal;
        notes.iter().for_each(|text| note(&format!("note: {}", printable(text))));
        if self.print {
            return print(manifest.trim_end());
        }
        print(&format!("{} is written: it is read without fault", file.display()))?;
        match moved_db.zip(still_db) {
            Some((moved, still)) => print(&format!(
                "moved to the first later picture the update is at {moved:.2} dB, unchanged at {still:.2} dB"
            )),
            None => print("there is no later picture to compare with"),
        }?;
        print(&format!("next: galpix check {0}, galpix run {0}", self.folder.display()))
    }
}
