//! `galpix vectors`.

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{CliError, note, print, print_json};
use crate::output::html::write_atomically;
use crate::vectors;

/// Arguments of `galpix vectors`.
#[derive(Debug, Args)]
pub struct Vectors {
    /// Folder for the vectors
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// What the random maps are drawn with; the hashes that the project keeps are those of 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Write only cases of this kind, for example frame; may be given several times. hashes.txt stays whole
    #[arg(long, value_name = "KIND")]
    kind: Vec<String>,
    /// Write only cases of this layout, the second part of their names, for example paper; may be given several times
    #[arg(long, value_name = "NAME")]
    layout: Vec<String>,
    /// Write what the stages of each frame gave, too: edges, arrivals, winners, the resolved map
    #[arg(long)]
    stages: bool,
    /// Write the maps of frame cases once more, with a record a line
    #[arg(long)]
    records: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What was written.
#[derive(Serialize, JsonSchema)]
pub struct Written {
    /// The manifest, which lists all files with their hashes.
    manifest: String,
    /// What the random maps were drawn with.
    seed: u64,
    /// Cases.
    cases: usize,
    /// Their frames.
    frames: usize,
    /// Their files.
    files: usize,
}

impl Vectors {
    /// Makes the cases and writes them.
    pub fn run(&self) -> Result<(), CliError> {
        let cases = vectors::cases(self.seed).map_err(|error| CliError::Failed(error.to_string()))?;
        let save = |path: &str, text: &str| {
            let path = self.out.join(path);
            let folder = path.parent().map_or(Ok(()), std::fs::create_dir_all);
            let written = folder.and_then(|()| write_atomically(&path, text.as_bytes()));
            written.map_err(|error| CliError::unwritable(&path, &error))
        };
        let choice = vectors::Choice {
            kinds: self.kind.clone(),
            layouts: self.layout.clone(),
            stages: self.stages,
            records: self.records,
        };
        if !cases.iter().any(|case| choice.has(case)) {
            return Err(CliError::unusable(
                "there is no such case: `--kind` takes step, propagate, resolve, edge, fill, frame, inpaint, layers, \
                 objects, disocclusion, subcell or source, `--layout` the second part of a case's name",
            ));
        }
        let manifest = vectors::write(self.seed, &cases, &choice, save)?;
        let files: usize = manifest.cases.iter().map(|case| case.files.len()).sum();
        let frames: usize = manifest.cases.iter().map(|case| case.frames.len()).sum();
        let cases = manifest.cases.len();
        note(&format!("{cases} cases, {frames} frames, {files} files"));
        let manifest = self.out.join("manifest.json").display().to_string();
        if self.json {
            return print_json("vectors", &Written { manifest, seed: self.seed, cases, frames, files });
        }
        print(&manifest)
    }
}
