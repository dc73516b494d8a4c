//! Small inputs that embody what is really brought: each is read rightly, noted, or refused with what to do about it.

use std::path::{Path, PathBuf};

use super::super::plausible::moved_db;
use super::super::{Capture, CaptureError, ImportOptions, load};
use super::folder::check_refusal;
use crate::update::Known;

/// Returns the folder of the inputs, if it is there.
fn field() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/field");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: ../shared/data/field is absent");
    None
}

/// Loads an input with its manifest changed from the first text of each pair to the second.
fn read(folder: &Path, changes: &[(&str, &str)]) -> Result<Capture, CaptureError> {
    let copy = tempfile::tempdir().unwrap();
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        std::fs::write(copy.path().join(file.file_name().unwrap()), std::fs::read(&file).unwrap()).unwrap();
    }
    let manifest = copy.path().join("capture.toml");
    let mut text = std::fs::read_to_string(&manifest).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from} is not in the manifest");
        text = text.replace(from, to);
    }
    std::fs::write(&manifest, text).unwrap();
    load(copy.path(), &ImportOptions::default())
}

/// Asserts that every truth is met.
#[track_caller]
fn is_right(name: &str, capture: &Capture) {
    for truth in &capture.truths {
        let db = moved_db(&capture.update, truth).unwrap();
        assert!(db >= 60.0, "{name}: {db:.1} dB at frame {}", truth.frame);
    }
    assert!(!capture.truths.is_empty());
}

#[track_caller]
fn notes(name: &str, capture: &Capture, what: &str) {
    let found = &capture.census.notes;
    assert!(found.iter().any(|note| note.contains(what)), "{name} has no note about \"{what}\": {found:?}");
}

#[test]
fn inputs_that_are_read_rightly_as_they_are() {
    let Some(field) = field() else { return };
    // Folder and what the note is about; without a text no note at all.
    let inputs = [
        ("00-reference-camera", ""),
        ("00-reference-flow", ""),
        ("01-exr-data-window", "data window of 64x48 at (-8, -4)"),
        ("03-exr-overscan", "data window of 80x56 at (-8, -4)"),
        ("09-exr-flow-channel-names", "forward.u and forward.v"),
        ("10-blender-first-frame", "no vector to the previous frame"),
        ("13-flo-unknown-exactly-1e9", ""),
        ("14-depth-outlier", "count as nearest"),
        ("18-pfm-top-down", "rows from top to bottom"),
        ("19-pfm-scale-1000", "scale 1000"),
        ("20-pfm-comment", ""),
        ("23-npy-int32", ""),
        ("25-tum-unsorted", "not in the order"),
        ("26-tum-gap", "poses are missing"),
        ("29-transforms-unsorted", "not in the order"),
        ("30-transforms-of-another-size", "128x96"),
        ("32-tum-bom", ""),
        ("33-json-bom", ""),
        ("39-stale-frames", ""),
        ("43-camera-cut-before", "the pose before the update is elsewhere"),
    ];
    for (name, note) in inputs {
        let capture = read(&field.join(name), &[]).unwrap_or_else(|error| panic!("{name}: {error}"));
        is_right(name, &capture);
        if note.is_empty() {
            assert_eq!(capture.census.notes, Vec::<String>::new(), "{name}");
        } else {
            notes(name, &capture, note);
        }
    }
    let capture = read(&field.join("13-flo-unknown-exactly-1e9"), &[]).unwrap();
    assert_eq!(capture.census.unknown_motion, 40);
}

#[test]
fn inputs_that_a_key_makes_right() {
    let Some(field) = field() else { return };
    // Folder, change, and what is said without it.
    let inputs = [
        ("06-flow-in-fractions", ("kind = \"flow\"", "kind = \"flow\", units = \"picture\""), "units = \"picture\""),
        ("08-flow-half-size", ("kind = \"flow\"", "kind = \"flow\", resize = true"), "resize = true"),
        (
            "09-exr-flow-channel-names",
            ("channel = \"forward\"", "channels = [\"forward.u\", \"forward.v\"]"),
            "forward.u",
        ),
        ("16-depth-all-negative", ("kind = \"z\"", "kind = \"z\", sign = -1"), "add sign = -1"),
        ("18-pfm-top-down", ("kind = \"z\"", "kind = \"z\", rows = \"top-down\""), "rows"),
        ("21-depth-along-the-ray", ("kind = \"z\"", "kind = \"ray\""), "kind = \"ray\""),
    ];
    for (name, change, said) in inputs {
        let capture = read(&field.join(name), &[change]).unwrap_or_else(|error| panic!("{name}: {error}"));
        is_right(name, &capture);
        assert_eq!(capture.census.notes, Vec::<String>::new(), "{name}");
        match read(&field.join(name), &[]) {
            Ok(capture) => assert!(said.is_empty() || capture.census.notes.iter().any(|note| note.contains(said))),
            Err(error) => drop(check_refusal(&error, "", said)),
        }
    }
}

#[test]
fn inputs_that_are_refused_or_noted() {
    let Some(field) = field() else { return };
    let error = read(&field.join("04-exr-htj2k"), &[]).unwrap_err();
    let text = check_refusal(&error, "p.exr", "HTJ2K");
    assert!(text.contains("ZIP") && !text.contains("damaged"), "{text}");
    let capture = read(&field.join("12-flow-validity-band"), &[]).unwrap();
    assert_eq!(capture.census.unknown_motion, 288);
    notes("12", &capture, "third band");
    notes("41", &read(&field.join("41-jpeg-turned-by-exif"), &[]).unwrap(), "turned by 180 degrees");
}

#[test]
fn a_far_background_turns_with_the_camera() {
    let Some(field) = field() else { return };
    let capture = read(&field.join("35-sky-and-a-turning-camera"), &[]).unwrap();
    let db = moved_db(&capture.update, &capture.truths[0]).unwrap();
    assert!(db >= 30.0, "{db:.1} dB");
    let still = read(
        &field.join("35-sky-and-a-turning-camera"),
        &[("[[truth]]\nframe = 4", "background = \"still\"\n[[truth]]\nframe = 4")],
    );
    notes("35", &still.unwrap(), "no cell moves");
}

#[test]
fn cells_under_instruments_in_the_picture_start_empty() {
    let Some(field) = field() else { return };
    let capture = read(&field.join("36-hud-in-the-picture"), &[]).unwrap();
    is_right("36", &capture);
    let overlay = capture.update.overlay.as_ref().unwrap();
    for (sample, pinned) in capture.update.samples.iter().zip(&overlay.pixels) {
        assert!(pinned.is_none() || sample.known == Known::ColourOnly);
        assert!(!overlay.pixels.contains(&Some(sample.colour)), "a colour of the instruments is left");
    }
    assert!(capture.census.under_overlay.unwrap() >= overlay.pinned());
}
