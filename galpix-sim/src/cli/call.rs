//! How a report was made, and where its files go.

use std::path::Path;

use super::{CliError, note};
use crate::output::save::draft;
use crate::source::capture::ImportOptions;
use crate::source::{Source, scene};

/// Returns the sources that are named; all scenes and the capture marbles if none is.
pub fn sources(names: &[String], options: &ImportOptions) -> Result<Vec<Source>, CliError> {
    let open = |name: &String| Source::open(name, options).map_err(CliError::unusable);
    let sources = if names.is_empty() { all() } else { names.iter().map(open).collect::<Result<_, _>>()? };
    sources.iter().for_each(super::remark);
    Ok(sources)
}

/// Returns the built-in scenes, and the project's own capture if its folder is there.
pub fn all() -> Vec<Source> {
    let mut sources: Vec<Source> = scene::all().iter().map(|&scene| Source::Scene(scene)).collect();
    let capture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles/capture.toml");
    if capture.exists() {
        match Source::open(&capture.to_string_lossy(), &ImportOptions::default()) {
            Ok(source) => sources.push(source),
            Err(error) => note(&format!("galpix: {error}")),
        }
    }
    sources
}

/// Returns the call, as it can be repeated.
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

/// Returns the processor's name and the number of its threads, if the system reports them.
pub fn machine() -> String {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let name = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let name = name.unwrap_or_else(|| format!("{} ({})", std::env::consts::ARCH, std::env::consts::OS));
    format!("{name}, {threads} threads")
}

/// Makes the folder and tries to write into it, before anything is measured.
pub fn writable(out: &Path) -> Result<(), CliError> {
    let unwritable = |error: std::io::Error| CliError::unwritable(out, &error);
    std::fs::create_dir_all(out).map_err(unwritable)?;
    draft(out).and_then(tempfile::NamedTempFile::close).map_err(unwritable)
}
