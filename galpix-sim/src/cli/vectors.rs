//! `galpix vectors`.

use std::path::PathBuf;

use clap::Args;

use super::{CliError, print, say};
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
}

impl Vectors {
    /// Makes the cases and writes them.
    pub fn run(&self) -> Result<(), CliError> {
        let cases = vectors::cases(self.seed).map_err(|error| CliError::Failed(error.to_string()))?;
        let manifest = vectors::write(&self.out, self.seed, &cases)
            .map_err(|(path, error)| CliError::unwritable(&path, &error))?;
        let files: usize = manifest.cases.iter().map(|case| case.files.len()).sum();
        let frames: usize = manifest.cases.iter().map(|case| case.frames.len()).sum();
        say(&format!("{} cases, {frames} frames, {files} files", manifest.cases.len()));
        print(&self.out.join("manifest.json").display().to_string())
    }
}
