//! What the program says about itself: help, completions, the manual, the schemas; and the head of every document.

use serde_json::Value;

use crate::{done, entries, folder, json, output, refused, text};

/// The capture that comes with the program.
const MARBLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../captures/marbles");

#[test]
fn every_document_has_a_head_and_the_keys_of_its_schema() {
    let folder = folder();
    let small = ["--frames", "2", "--json"];
    for (kind, arguments) in [
        ("run", [&["run", "still"][..], &small].concat()),
        ("error", [&["error", "still", "--quick", "--lanes=still", "--rungs=hold"][..], &small].concat()),
        ("fills", [&["fills", "crossing", "--fills=none"][..], &small].concat()),
        ("layers", [&["layers", "crossing"][..], &small].concat()),
        ("graft", vec!["graft", "--frames", "24", "--json"]),
        ("ddoc", vec!["ddoc", "knot", "--size", "64", "--json"]),
        ("budget", vec!["budget", "--json"]),
        ("fit", vec!["fit", "rp2040", "--json"]),
        ("plan", [&["plan", "still", "--max-error", "0.5"][..], &small].concat()),
        ("stability", vec!["stability", "one-cell", "--json"]),
        ("scenes", vec!["scenes", "--json"]),
        ("check", vec!["check", "still", "--json"]),
        ("init", vec!["init", MARBLES, "--print", "--json"]),
    ] {
        let document = json(folder.path(), &arguments);
        let call = document["command"].as_str().expect("the call");
        assert_eq!((&document["schema"], &document["kind"]), (&1.into(), &kind.into()), "{kind}");
        assert_eq!(document["version"], env!("CARGO_PKG_VERSION"), "{kind}");
        assert!(call.starts_with(&format!("galpix {kind}")), "{kind}: {call}");
        let schema: Value = serde_json::from_str(&done(folder.path(), &["schema", kind])).expect("a schema");
        let described = schema["properties"].as_object().unwrap_or_else(|| panic!("{kind}: {schema}"));
        for (key, _) in document.as_object().expect("keys") {
            assert!(described.contains_key(key), "{kind}: {key}");
        }
        for key in schema["required"].as_array().expect("keys that are always there") {
            assert!(document.get(key.as_str().expect("a key")).is_some(), "{kind}: {key}");
        }
    }
    done(folder.path(), &["schema", "compare"]);
    done(folder.path(), &["schema", "vectors"]);
    done(folder.path(), &["schema", "rtl"]);
    done(folder.path(), &["schema", "demo"]);
    done(folder.path(), &["schema", "send"]);
    done(folder.path(), &["schema", "failure"]);
}

/// With `--json` what went wrong is a document too, whatever went wrong.
#[test]
fn errors_are_documents_where_json_was_asked_for() {
    let folder = folder();
    refused(folder.path(), &["run", "nowhere", "--json"], &["nowhere"]);
    refused(folder.path(), &["run", "still", "--frames", "0", "--json"], &["--frames"]);
    let number = refused(folder.path(), &["run", "still", "--extent", "wide", "--json"], &["--extent", "whole number"]);
    assert!(!number.contains("digit"), "{number}");
    refused(folder.path(), &["budget", "--prop", "1", "--json"], &["this budget cannot exist"]);
    assert!(entries(folder.path()).is_empty());
}

#[test]
fn a_slip_is_told_what_may_have_been_meant() {
    let folder = folder();
    for (arguments, meant) in [
        (["run", "pilars"].as_slice(), "did you mean `pillars`?"),
        (&["error", "crosing"], "did you mean `crossing`?"),
        (&["graft", "hudd"], "did you mean `hud`?"),
        (&["ddoc", "portl"], "did you mean `portal`?"),
        (&["fit", "rp2004"], "did you mean `rp2040`?"),
        (&["stability", "on-cell"], "did you mean `one-cell`?"),
        (&["fills", "crossing", "--fills", "metmer"], "did you mean `metamer`?"),
        (&["run", "still", "--fill", "exend"], "'extend'"),
        (&["bugdet"], "'budget'"),
        (&["run", "still", "--frmes", "3"], "'--frames'"),
    ] {
        refused(folder.path(), arguments, &[meant]);
    }
}

/// Every column of every table is defined by the help of its command.
#[test]
fn help_says_what_the_columns_are() {
    let folder = folder();
    for (command, columns) in [
        ("run", ["reached dB", "missing %", "path px", "truth px"].as_slice()),
        ("demo", &["reached dB", "at end %", "bound px", "truth px"]),
        ("error", &["+- %", "bound px", "path px", "judder px"]),
        ("fills", &["inner dB", "open dB", "whole dB"]),
        ("layers", &["offered", "there dB", "us/update"]),
        ("graft", &["cells/f"]),
        ("ddoc", &["strict"]),
        ("fit", &["RAM KiB", "M instr/frame", "frames/s"]),
    ] {
        let help = done(folder.path(), &[command, "--help"]);
        for column in columns {
            assert!(help.contains(column), "{command}: {column}");
        }
    }
}

#[test]
fn completions_and_manual_are_there() {
    let folder = folder();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(done(folder.path(), &["completions", shell]).contains("stability"), "{shell}");
    }
    assert!(done(folder.path(), &["man"]).starts_with(".ie"));
    assert_eq!(done(folder.path(), &["man", "--out", "man"]), "man/galpix.1\n");
    let pages = entries(&folder.path().join("man"));
    assert!(["galpix.1", "galpix-run.1", "galpix-budget.1"].iter().all(|page| pages.contains(*page)), "{pages:?}");
}

#[test]
fn quiet_says_nothing_but_what_went_wrong() {
    let folder = folder();
    for arguments in [["--quiet", "run", "still", "--frames", "2"], ["run", "still", "--frames", "2", "-q"]] {
        let output = output(folder.path(), &arguments);
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
    }
    refused(folder.path(), &["--quiet", "run", "nowhere"], &["nowhere"]);
}

/// Prints this documentation's own numbers: `galpix budget --layout velocity565 --extent 320`.
#[test]
fn a_layout_without_acceleration_or_depth_has_no_widths_of_them() {
    let folder = folder();
    let text = done(folder.path(), &["budget", "--layout", "velocity565", "--extent", "320"]);
    assert!(text.contains("x and y") && !text.contains("three components"), "{text}");
    assert!(!text.contains("(13)") && !text.contains("(9)") && !text.contains("(14)"), "{text}");
    let report = json(folder.path(), &["budget", "--layout", "velocity565", "--extent", "320", "--json"]);
    let [bits, bytes] = ["motion_bits_per_component", "motion_bytes_per_galpixel"].map(|key| report[key].as_f64());
    assert_eq!(bytes, bits.map(|bits| 2.0 * bits / 8.0));
}
