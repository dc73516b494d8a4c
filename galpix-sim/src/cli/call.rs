//! What a report says of how it was made, and where its files go.

use std::path::{Path, PathBuf};

use super::{CliError, demo, print, print_json};
use crate::output::html;
use crate::source::Source;
use crate::source::capture::ImportOptions;

/// The sources that are named; all scenes and the capture marbles if none is.
pub fn sources(names: &[String], options: &ImportOptions) -> Result<Vec<Source>, CliError> {
    let open = |name: &String| Source::open(name, options).map_err(CliError::unusable);
    if names.is_empty() { Ok(demo::sources()) } else { names.iter().map(open).collect() }
}

/// The call, as it can be repeated.
pub fn command() -> String {
    let quoted = |argument: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,+:".contains(c);
        if !argument.is_empty() && argument.chars().all(plain) {
            argument
        } else {
            format!("'{}'", argument.replace('\'', r"'\''"))
        }
    };
    let arguments = std::env::args_os().skip(1).map(|argument| quoted(argument.to_string_lossy().into_owned()));
    std::iter::once("galpix".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// The processor's name and the number of its threads, as far as the system tells.
pub fn machine() -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let name = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let name = name.unwrap_or_else(|| format!("{} ({})", std::env::consts::ARCH, std::env::consts::OS));
    format!("{name}, {threads} threads")
}

/// Where a study's files go: the folder that was asked for, else `galpix-out/NAME`, and nowhere where only JSON is printed. It can be
/// written to.
pub fn folder(out: Option<&PathBuf>, json: bool, name: &str) -> Result<Option<PathBuf>, CliError> {
    let out = match (out, json) {
        (Some(out), _) => out.clone(),
        (None, true) => return Ok(None),
        (None, false) => Path::new("galpix-out").join(name),
    };
    writable(&out)?;
    Ok(Some(out))
}

/// Writes files into a folder, in this order: where the last one is, the others are there too.
pub fn write(out: &Path, files: &[(&str, String)]) -> Result<(), CliError> {
    files.iter().try_for_each(|(name, text)| {
        let path = out.join(name);
        html::write_atomically(&path, text.as_bytes()).map_err(|error| CliError::unwritable(&path, &error))
    })
}

/// Writes the files of a study, of which the last one is its page, into the folder that it has; then prints the document if that was asked
/// for, else the path of the page.
pub fn publish(
    out: Option<&Path>,
    json: bool,
    document: &impl serde::Serialize,
    files: impl FnOnce() -> Result<Vec<(&'static str, String)>, CliError>,
) -> Result<(), CliError> {
    let mut page = None;
    if let Some(out) = out {
        let files = files()?;
        write(out, &files)?;
        page = files.last().map(|(name, _)| out.join(name));
    }
    match page {
        _ if json => print_json(document),
        Some(page) => print(&page.display().to_string()),
        None => Ok(()),
    }
}

/// A document as the text of a file.
pub fn json(document: &impl serde::Serialize) -> Result<String, CliError> {
    Ok(serde_json::to_string_pretty(document).map_err(|error| CliError::Failed(error.to_string()))? + "\n")
}

/// Makes the folder and tries to write into it, before anything is measured.
pub fn writable(out: &Path) -> Result<(), CliError> {
    let unwritable = |error: std::io::Error| CliError::unwritable(out, &error);
    std::fs::create_dir_all(out).map_err(unwritable)?;
    let probe = out.join(format!(".galpix.{}.probe", std::process::id()));
    std::fs::write(&probe, []).and_then(|()| std::fs::remove_file(&probe)).map_err(unwritable)
}
