//! `galpix compare`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{CliError, print, print_json, printable, printable_lines};
use crate::output::save::write_atomically;
use crate::study::compare::{self, Comparison};

/// Arguments of `galpix compare`.
#[derive(Debug, Args)]
pub struct Compare {
    /// What `galpix run SOURCE --json` printed, in a file
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The same of another run: another budget, another fill, another version
    #[arg(value_name = "B")]
    second: PathBuf,
    /// Folder for compare.html and compare.csv [default: galpix-out/compare; with --json nothing is written without it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Compare {
    /// Compares the two.
    pub fn run(&self) -> Result<(), CliError> {
        let names = [&self.first, &self.second].map(|path| printable(&path.display().to_string()));
        let [first, second] = [read(&self.first)?, read(&self.second)?];
        let documents = [(&*names[0], &first), (&*names[1], &second)];
        let comparison = compare::compare(documents).map_err(CliError::unusable)?;
        if !self.json {
            print(&printable_lines(&compare::terminal(&comparison)))?;
        }
        let usual = (!self.json).then(|| Path::new("galpix-out").join("compare"));
        let page = self.out.clone().or(usual).map(|out| write(&out, &comparison)).transpose()?;
        match page {
            _ if self.json => print_json("compare", &comparison),
            Some(page) => print(&page.display().to_string()),
            None => Ok(()),
        }
    }
}

fn read(path: &Path) -> Result<serde_json::Value, CliError> {
    let name = printable(&path.display().to_string());
    let text = std::fs::read_to_string(path)
        .map_err(|error| CliError::Unusable(format!("{name} cannot be read ({error}): correct the path")))?;
    serde_json::from_str(&text).map_err(|error| {
        CliError::Unusable(format!("{name} is no JSON ({error}): save what `galpix run SOURCE --json` prints"))
    })
}

/// Writes the files; returns the page's path.
fn write(out: &Path, comparison: &Comparison) -> Result<PathBuf, CliError> {
    std::fs::create_dir_all(out).map_err(|error| CliError::unwritable(out, &error))?;
    let csv = compare::csv(comparison).map_err(|error| CliError::Failed(error.to_string()))?;
    for (name, text) in [("compare.csv", csv), ("compare.html", compare::html(comparison))] {
        let path = out.join(name);
        write_atomically(&path, text.as_bytes()).map_err(|error| CliError::unwritable(&path, &error))?;
    }
    Ok(out.join("compare.html"))
}
