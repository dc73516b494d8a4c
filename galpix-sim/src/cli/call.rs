//! How a report was made, and where its files go.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::choices::AccelerationChoice;
use super::{CliError, note, printable};
use crate::output::save::{draft, tidy};
use crate::source::{Source, scene};

/// Opens a source.
pub fn open(name: &str, acceleration: AccelerationChoice) -> Result<Source, CliError> {
    let source = Source::open(name, &acceleration.into()).map_err(CliError::unusable)?;
    has_use(acceleration, std::slice::from_ref(&source))?;
    Ok(source)
}

/// Returns the sources that are named; all scenes and the capture marbles if none is.
pub fn sources(names: &[String], acceleration: AccelerationChoice) -> Result<Vec<Source>, CliError> {
    if names.is_empty() {
        return Ok(all(acceleration));
    }
    let open = |name: &String| Source::open(name, &acceleration.into()).map_err(CliError::unusable);
    let sources = names.iter().map(open).collect::<Result<Vec<_>, _>>()?;
    has_use(acceleration, &sources)?;
    let mut seen = BTreeSet::new();
    match sources.iter().find(|source| !seen.insert(source.name())) {
        Some(twice) => Err(CliError::Unusable(format!(
            "two sources are called `{}`: give each once, or another `name` in its manifest",
            printable(twice.name())
        ))),
        None => Ok(sources),
    }
}

/// Refuses a policy for accelerations where nothing has any that it is about.
fn has_use(acceleration: AccelerationChoice, sources: &[Source]) -> Result<(), CliError> {
    let scene = |source: &Source| matches!(source, Source::Scene(_));
    if acceleration != AccelerationChoice::default() && sources.iter().all(scene) {
        let sentence = "`--acceleration` is for captures: the acceleration of a built-in scene is exact; leave it out";
        return Err(CliError::unusable(sentence));
    }
    Ok(())
}

/// Returns the built-in scenes, and the project's own capture if its folder is there.
pub fn all(acceleration: AccelerationChoice) -> Vec<Source> {
    let mut sources: Vec<Source> = scene::all().iter().map(|&scene| Source::Scene(scene)).collect();
    let capture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles/capture.toml");
    if capture.exists() {
        match Source::open(&capture.to_string_lossy(), &acceleration.into()) {
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
    tidy(out);
    draft(out).and_then(tempfile::NamedTempFile::close).map_err(unwritable)
}

/// Returns what tells a source from others of the same name: of a capture, where it is.
pub fn key(source: &Source, given: &str) -> String {
    match source {
        Source::Scene(scene) => format!("scene {}", scene.name()),
        Source::Capture(_) => {
            let place = std::fs::canonicalize(manifest(given)).unwrap_or_else(|_| PathBuf::from(given));
            let digest = Sha256::digest(place.as_os_str().as_encoded_bytes());
            format!("capture {:016x}", digest.iter().take(8).fold(0u64, |all, &byte| all << 8 | u64::from(byte)))
        }
    }
}

/// Refuses files that would replace what a capture is made of.
pub fn spare(given: &str, files: impl IntoIterator<Item = PathBuf>) -> Result<(), CliError> {
    let inputs = inputs(&manifest(given));
    let same = |file: &PathBuf| std::fs::canonicalize(file).is_ok_and(|file| inputs.contains(&file));
    match files.into_iter().find(same) {
        Some(file) => {
            let file = file.display();
            Err(CliError::Unusable(format!("{file} is read from {given}: choose another folder with --out")))
        }
        None => Ok(()),
    }
}

/// Returns the manifest of a capture that is given by its own path or that of its folder.
fn manifest(given: &str) -> PathBuf {
    let path = Path::new(given);
    if path.is_dir() { path.join("capture.toml") } else { path.to_owned() }
}

/// Returns all files that a manifest names, and itself; nothing for what is no manifest.
fn inputs(manifest: &Path) -> BTreeSet<PathBuf> {
    let Ok(text) = std::fs::read_to_string(manifest) else { return BTreeSet::new() };
    let Ok(table) = text.parse::<toml::Table>() else { return BTreeSet::new() };
    let folder = manifest.parent().unwrap_or(Path::new(""));
    let mut named = vec![manifest.to_owned()];
    name(&toml::Value::Table(table), &mut |text| {
        let path = folder.join(text);
        // A name with a number in braces stands for every file beside it.
        if text.contains('{') {
            let beside = path.parent().map(std::fs::read_dir);
            named.extend(beside.into_iter().flatten().flatten().flatten().map(|entry| entry.path()));
        } else {
            named.push(path);
        }
    });
    named.iter().filter_map(|path| std::fs::canonicalize(path).ok()).filter(|path| path.is_file()).collect()
}

/// Calls `with` with each text in a value.
fn name(value: &toml::Value, with: &mut impl FnMut(&str)) {
    match value {
        toml::Value::String(text) => with(text),
        toml::Value::Array(values) => values.iter().for_each(|value| name(value, with)),
        toml::Value::Table(table) => table.values().for_each(|value| name(value, with)),
        _ => {}
    }
}
