//! The program as a user or a script meets it: exit codes, both outputs, and the files that it leaves.

mod budget;
mod check;
mod ddoc;
mod demo;
mod describe;
mod error;
mod fills;
mod fit;
mod folders;
mod graft;
mod init;
mod layers;
mod plan;
mod run;
mod scenes;
mod send;
mod stability;
mod streams;
mod vectors;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use galpix_sim::picture::Picture;
use galpix_sim::source::capture;
use serde_json::Value;
use tempfile::TempDir;

const SCENES: [&str; 12] =
    ["still", "drift", "pan", "ramp", "pillars", "crossing", "disc", "sphere", "near-plane", "ball", "fovea", "hud"];

fn galpix(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_galpix"));
    command.current_dir(folder).args(arguments);
    command
}

/// Returns a folder of its own for a test, and what a call in it gave.
fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder for temporary files")
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    galpix(folder, arguments).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// Returns the picture in a file.
fn picture(path: &Path) -> Picture {
    capture::picture(path).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns standard output of a call that succeeds.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = output(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

/// Returns the one document on standard output of a call that succeeds.
fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&done(folder, arguments)).expect("one JSON document and nothing else")
}

/// Returns the sentence of a call that is refused: exit code 2, one line on standard error that holds each of `words`,
/// nothing on standard output; with `--json` the same sentence there, in a document.
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) -> String {
    let output = output(folder, arguments);
    let sentence = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {sentence}");
    if arguments.contains(&"--json") {
        let document: Value = serde_json::from_slice(&output.stdout).expect("one JSON document");
        assert_eq!((&document["kind"], &document["error"]["exit_code"]), (&"error".into(), &2.into()));
        assert_eq!(format!("galpix: {}\n", document["error"]["message"].as_str().unwrap()), sentence);
    } else {
        assert_eq!(text(&output.stdout), "", "{arguments:?}");
    }
    assert!(sentence.starts_with("galpix: ") && sentence.ends_with('\n'), "{arguments:?}: {sentence:?}");
    assert!(!sentence.contains('\u{1b}'), "{arguments:?}: {sentence:?}");
    assert_eq!(sentence.lines().count(), 1, "{arguments:?}: {sentence:?}");
    for word in words {
        assert!(sentence.contains(word), "{arguments:?}: {word:?} is not in {sentence:?}");
    }
    sentence.to_owned()
}

fn entries(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

/// Returns a file that was written.
fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the project's own capture.
fn marbles() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles")
}
