//! Outputs that are not read, or that take nothing.

use std::process::Stdio;

use crate::{folder, galpix, text};

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = folder();
    for arguments in [
        ["budget"].as_slice(),
        &["budget", "--json"],
        &["scenes"],
        &["--help"],
        &["run", "still", "--frames", "2"],
        &["run", "still", "--frames", "2", "--json"],
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let child = galpix(folder.path(), arguments).stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(!text(&output.stderr).contains("panicked"), "{arguments:?}: {}", text(&output.stderr));
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    }
    // The same for the other output: only the exit code is left.
    for (arguments, code) in
        [(["run", "still", "--frames", "2"].as_slice(), 0), (&["run", "nowhere"], 2), (&["walk"], 2)]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let status = galpix(folder.path(), arguments).stdout(Stdio::null()).stderr(writer).status().unwrap();
        assert_eq!(status.code(), Some(code), "{arguments:?}");
    }
}

/// What is neither arguments nor input is exit code 1: here, an output that takes nothing.
#[cfg(target_os = "linux")]
#[test]
fn an_output_that_is_full_is_exit_code_1() {
    let folder = folder();
    for argument in ["budget", "--help", "--version", "man"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let child = galpix(folder.path(), &[argument]).stdout(full).stderr(Stdio::piped()).spawn().unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{argument}");
        let said = text(&output.stderr);
        assert!(said.starts_with("galpix: standard output cannot be written"), "{argument}: {said}");
    }
}
