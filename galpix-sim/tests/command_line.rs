//! The program as a user or a script meets it: exit codes, both outputs, and the files that it leaves.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

const SCENES: [&str; 12] =
    ["still", "drift", "pan", "ramp", "pillars", "crossing", "disc", "sphere", "near-plane", "ball", "fovea", "hud"];

fn galpix(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_galpix"));
    command.current_dir(folder).args(arguments);
    command
}

/// A folder of its own for a test, and what a call in it gave.
fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder for temporary files")
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    galpix(folder, arguments).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// Standard output of a call that succeeds.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = output(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

/// The one document on standard output of a call that succeeds.
fn json(folder: &Path, arguments: &[&str]) -> Value {
    serde_json::from_str(&done(folder, arguments)).expect("one JSON document and nothing else")
}

/// The sentence of a call that is refused: exit code 2, one line on standard error that holds each of `words`, nothing on
/// standard output.
fn refused(folder: &Path, arguments: &[&str], words: &[&str]) -> String {
    let output = output(folder, arguments);
    let sentence = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {sentence}");
    assert_eq!(text(&output.stdout), "", "{arguments:?}");
    assert!(sentence.starts_with("galpix: ") && sentence.ends_with('\n'), "{arguments:?}: {sentence:?}");
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

/// The project's own capture.
fn marbles() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles")
}

/// A copy of the marbles whose manifest has `from` replaced by `to`.
fn altered(folder: &Path, from: &str, to: &str) -> PathBuf {
    let copy = folder.join("capture");
    std::fs::create_dir_all(copy.join("frames")).unwrap();
    std::fs::copy(marbles().join("update.exr"), copy.join("update.exr")).unwrap();
    for name in entries(&marbles().join("frames")) {
        std::fs::copy(marbles().join("frames").join(&name), copy.join("frames").join(&name)).unwrap();
    }
    let manifest = std::fs::read_to_string(marbles().join("capture.toml")).unwrap();
    assert!(manifest.contains(from), "{from}");
    std::fs::write(copy.join("capture.toml"), manifest.replace(from, to)).unwrap();
    copy
}

#[test]
fn budget_prints_the_papers_example() {
    let folder = folder();
    let text = done(folder.path(), &["budget"]);
    for (row, value) in [
        ("velocity, integer with sign", "10"),
        ("velocity, fraction", "7"),
        ("acceleration, integer with sign", "8"),
        ("acceleration, fraction", "7"),
        ("position, fraction", "4"),
        ("motion, bits a component", "36"),
        ("motion, bytes a galpixel", "13.5"),
        ("stored, bytes a galpixel", "20"),
        ("total", "0.8438"),
    ] {
        let line = text.lines().find(|line| line.trim().starts_with(row)).unwrap_or_else(|| panic!("no {row}\n{text}"));
        let values = line.trim().strip_prefix(row).map(|rest| rest.split_whitespace().next());
        assert_eq!(values, Some(Some(value)), "{line}");
    }
    assert_eq!(text, done(folder.path(), &["budget", "--extent", "1024", "--recog", "8", "--prop", "16"]));
    assert!(entries(folder.path()).is_empty(), "nothing is written");
}

#[test]
fn budget_as_json_has_the_keys_others_rely_on() {
    let folder = folder();
    for (rounding, total, keeps) in
        [("low-discrepancy", 0.84375, true), ("nearest", 1.09375, false), ("truncate", 1.46875, false)]
    {
        let budget = json(folder.path(), &["budget", "--json", "--rounding", rounding]);
        for (key, value) in [
            ("position_frac_bits", 4.0),
            ("velocity_int_bits", 10.0),
            ("velocity_frac_bits", 7.0),
            ("acceleration_int_bits", 8.0),
            ("acceleration_frac_bits", 7.0),
            ("motion_bits_per_component", 36.0),
            ("motion_bytes_per_galpixel", 13.5),
            ("stored_bytes_per_galpixel", 20.0),
        ] {
            assert_eq!(budget[key].as_f64(), Some(value), "{key}");
        }
        let certificate = &budget["certificate"];
        assert_eq!(certificate["total_px"].as_f64(), Some(total), "{rounding}");
        assert_eq!(certificate["quantisation_px"].as_f64(), Some(0.59375), "{rounding}");
        assert_eq!(certificate["drift_px"].as_f64(), Some(total - 0.59375), "{rounding}");
        assert_eq!((budget["rounding"].as_str(), budget["keeps_one_pixel"].as_bool()), (Some(rounding), Some(keeps)));
    }
}

#[test]
fn a_budget_that_cannot_exist_is_refused_with_a_remedy() {
    let folder = folder();
    for (arguments, words) in [
        ("--extent 0", ["positive number"].as_slice()),
        ("--recog 0", &["positive number"]),
        ("--prop 0", &["positive number"]),
        ("--prop 1", &["2 frames or more"]),
        ("--extent 4294967295 --prop 4294967295", &["lower the extent or prop"]),
        ("--recog 4294967295", &["(8)", "lower recog"]),
        ("--extent 16 --recog 16", &["raise the extent"]),
        ("--extent 99999999999", &["--extent", "0..="]),
        ("--extent -1024", &["--extent", "0..="]),
        ("--recog -8", &["--recog", "0..="]),
        ("--prop -16", &["--prop", "0..="]),
        ("--prop 16.5", &["--prop"]),
        ("--shave velocity-int=32", &["shave fewer"]),
        ("--shave acceleration-int=8", &["shave fewer"]),
        ("--shave-z position-frac=32", &["shave fewer"]),
        ("--shave velocity-frac=7", &["shave the acceleration"]),
        ("--shave velocity-frac=33", &["from 0 to 32"]),
        ("--shave velocity-frac=-1", &["from 0 to 32"]),
        ("--shave speed=1", &["velocity-int"]),
        ("--rounding up", &["truncate", "nearest", "low-discrepancy"]),
    ] {
        let mut all = vec!["budget"];
        all.extend(arguments.split(' '));
        refused(folder.path(), &all, words);
        all.push("--json");
        refused(folder.path(), &all, words);
    }
}

#[test]
fn scenes_lists_all_eleven() {
    let folder = folder();
    let text = done(folder.path(), &["scenes"]);
    let names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, SCENES);
    let list = json(folder.path(), &["scenes", "--json"]);
    let names: Vec<&str> = list.as_array().unwrap().iter().filter_map(|scene| scene["name"].as_str()).collect();
    assert_eq!(names, SCENES);
    assert!(list.as_array().unwrap().iter().all(|scene| scene["about"].as_str().is_some_and(|about| about.len() > 20)));
}

/// Every number of a document is finite: infinities and NaN would have become null.
fn is_number(value: &Value) -> bool {
    value.as_f64().is_some_and(f64::is_finite)
}

fn assert_report(report: &Value, frames: usize) {
    for key in ["source", "rounding", "fill"] {
        assert!(report[key].is_string(), "{key}: {}", report[key]);
    }
    for key in ["width", "height", "ns_per_galpixel"] {
        assert!(is_number(&report[key]), "{key}: {}", report[key]);
    }
    for key in ["extent", "recog", "prop", "motion_bits_per_component", "stored_bytes_per_galpixel"] {
        assert!(is_number(&report["budget"][key]), "budget.{key}: {}", report["budget"]);
    }
    let list = report["frames"].as_array().expect("frames");
    assert_eq!(list.len(), frames);
    for (number, frame) in (1..).zip(list) {
        assert_eq!(frame["frame"].as_u64(), Some(number));
        for key in ["holes", "filled", "lost", "collided", "saturated"] {
            assert!(frame[key].is_u64(), "frame {number}, {key}: {}", frame[key]);
        }
        let truth = frame.get("truth").expect("truth");
        if truth.is_null() {
            continue;
        }
        for key in ["psnr_db", "psnr_hold_db", "psnr_known_db", "ssim", "flip"] {
            assert!(is_number(&truth[key]), "frame {number}, {key}: {}", truth[key]);
        }
        for key in ["missing", "missing_at_border"] {
            assert!(truth[key].is_u64(), "frame {number}, {key}: {}", truth[key]);
        }
    }
}

fn assert_frames(folder: &Path, frames: u32, size: (u32, u32)) {
    let expected: BTreeSet<String> = (0..=frames).map(|frame| format!("{frame:04}.png")).collect();
    assert_eq!(entries(folder), expected);
    for name in expected {
        let picture = image::open(folder.join(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((picture.width(), picture.height()), size, "{name}");
    }
}

#[test]
fn run_as_json_is_one_document_and_writes_the_frames() {
    let folder = folder();
    let report = json(folder.path(), &["run", "still", "--json"]);
    assert_report(&report, 24);
    assert_eq!(
        [&report["source"], &report["rounding"], &report["fill"]].map(|value| value.as_str().unwrap()),
        ["still", "low-discrepancy", "extend"]
    );
    assert_eq!([&report["budget"]["extent"], &report["budget"]["recog"], &report["budget"]["prop"]], [256, 8, 32]);
    assert!(report["frames"].as_array().unwrap().iter().all(|frame| frame["truth"].is_object()), "a scene has a truth");
    assert_frames(&folder.path().join("galpix-out/still"), 24, (192, 144));
}

#[test]
fn a_capture_has_a_truth_where_its_manifest_names_one() {
    let folder = folder();
    let marbles = marbles();
    let report = json(folder.path(), &["run", marbles.to_str().unwrap(), "--json", "--frames", "6", "--out", "there"]);
    assert_report(&report, 6);
    let known: Vec<bool> = report["frames"].as_array().unwrap().iter().map(|f| f["truth"].is_object()).collect();
    assert_eq!(known, [true, true, true, true, false, true]);
    assert_frames(&folder.path().join("there"), 6, (192, 144));
    assert_eq!(entries(folder.path()), BTreeSet::from(["there".to_owned()]), "only --out is written to");
}

#[test]
fn every_rung_and_rounding_is_known_by_name() {
    let folder = folder();
    for rung in ["none", "hold", "debris", "bullet", "galdebris", "extend", "push-pull", "metamer"] {
        let report = json(folder.path(), &["run", "crossing", "--frames", "2", "--fill", rung, "--json"]);
        assert_eq!(report["fill"].as_str(), Some(rung));
    }
    for gamma in ["0", "1/2", "1"] {
        done(folder.path(), &["run", "crossing", "--frames", "2", "--fill", "push-pull", "--gamma", gamma]);
    }
    refused(folder.path(), &["run", "crossing", "--fill", "push-pull", "--gamma", "2"], &["gamma", "1/2"]);
    refused(folder.path(), &["run", "crossing", "--fill", "paint"], &["none", "galdebris", "extend"]);
    for rounding in ["truncate", "nearest", "low-discrepancy"] {
        let report = json(folder.path(), &["run", "drift", "--frames", "2", "--rounding", rounding, "--json"]);
        assert_eq!(report["rounding"].as_str(), Some(rounding));
    }
}

#[test]
fn beyond_the_certificate_frames_are_made_and_the_table_says_where_it_ends() {
    let folder = folder();
    let text = done(folder.path(), &["run", "drift", "--prop", "4", "--frames", "9"]);
    assert!(text.lines().next().unwrap().contains("up to frame 4"), "{text}");
    assert_eq!(text.lines().last().and_then(|line| line.split_whitespace().next()), Some("9"));
    let report = json(folder.path(), &["run", "drift", "--prop", "4", "--frames", "9", "--json"]);
    assert_report(&report, 9);
    assert_eq!(report["certificate"]["frames"].as_array().map(Vec::len), Some(4));
}

#[test]
fn a_run_that_cannot_be_made_is_refused_with_a_remedy() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for (arguments, words) in [
        ("run", ["SOURCE"].as_slice()),
        ("run nowhere", &["`nowhere`", "galpix scenes", "capture.toml"]),
        ("run nowhere.toml", &["nowhere.toml", "correct the path"]),
        ("run .", &["capture.toml", "correct the path"]),
        ("run file", &["file"]),
        ("run still --frames 0", &["--frames", "1..="]),
        ("run still --frames -1", &["--frames", "1..="]),
        ("run still --frames many", &["--frames"]),
        ("run still --prop 1", &["2 frames or more"]),
        ("run still --extent 0", &["positive number"]),
        ("run still --reach 0", &["--reach", "1..=16"]),
        ("run still --edge-threshold NaN", &["--edge-threshold", "from 0 to 8"]),
        ("run still --out file", &["file", "--out"]),
        ("run still --out file/deeper", &["file/deeper", "--out"]),
        ("demo --out file", &["file", "--out"]),
        ("demo --prop 1", &["2 frames or more"]),
        ("send", &["--to", "SOURCE"]),
        ("send nowhere --to file:stream", &["`nowhere`", "galpix scenes"]),
        ("send still --to tcp:nowhere", &["--to", "tcp:HOST:PORT", "file:PATH"]),
        ("send still --to tcp:127.0.0.1:1", &["tcp:127.0.0.1:1", "cannot be reached", "listening"]),
        ("send still --to unix:nowhere", &["unix:nowhere", "cannot be reached"]),
        ("send still --to nowhere", &["nowhere", "serial device", "file:PATH"]),
        ("send still --to file", &["file", "serial device", "file:PATH"]),
        ("send still --to file:stream", &["file:stream", "--panel oled"]),
        ("send still --to file:nowhere/stream --panel oled", &["nowhere/stream", "choose another path"]),
        ("send still --to file:stream --panel oled --baud 9600", &["--baud", "leave it out"]),
        ("send still --to file:stream --panel crt", &["--panel", "oled", "lcd"]),
        ("send still --to file:stream --updates 0", &["--updates", "1..="]),
        ("walk", &["walk", "--help"]),
        ("budget --jason", &["--jason", "--help"]),
    ] {
        refused(folder.path(), &arguments.split(' ').collect::<Vec<_>>(), words);
    }
    assert_eq!(entries(folder.path()), BTreeSet::from(["file".to_owned()]), "what is refused leaves nothing behind");
}

#[test]
fn a_capture_with_an_unknown_key_is_refused_and_the_key_is_named() {
    let folder = folder();
    let capture = altered(folder.path(), "frames = 16", "frames = 16\ncolour = \"a.png\"");
    let sentence = refused(folder.path(), &["run", capture.to_str().unwrap(), "--json"], &["capture.toml", "`colour`"]);
    assert!(sentence.contains("remove that key"), "{sentence}");
    let capture = altered(folder.path(), "frames/0000.png", "frames/nothing.png");
    refused(folder.path(), &["run", capture.to_str().unwrap()], &["nothing.png", "add the file"]);
    assert_eq!(entries(folder.path()), BTreeSet::from(["capture".to_owned()]));
}

#[test]
fn a_hostile_name_stays_inside_of_the_default_folder_and_commands_no_terminal() {
    let around = folder();
    let inner = around.path().join("a/b");
    std::fs::create_dir_all(&inner).unwrap();
    for name in ["../../x", "/x", "..", ".", "", "a\\\\b", "\\u001b[2Jx", "con\\u0000", "\\u202Ex"] {
        let capture = altered(&inner, "name = \"marbles\"", &format!("name = \"{name}\""));
        let output = output(&inner, &["run", capture.to_str().unwrap(), "--frames", "2"]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", text(&output.stderr));
        for stream in [&output.stdout, &output.stderr] {
            let commands = |c: char| c.is_control() && c != '\n';
            assert!(!text(stream).contains(commands), "{name}: {:?}", text(stream));
        }
    }
    assert_eq!(entries(around.path()), BTreeSet::from(["a".to_owned()]));
    assert_eq!(entries(&around.path().join("a")), BTreeSet::from(["b".to_owned()]));
    assert_eq!(entries(&inner), BTreeSet::from(["capture".to_owned(), "galpix-out".to_owned()]));
    for name in entries(&inner.join("galpix-out")) {
        assert!(name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-'), "{name}");
        assert_frames(&inner.join("galpix-out").join(name), 2, (192, 144));
    }
}

/// The report at `path`: whole, with all scenes, and without a word from elsewhere.
fn assert_page(path: &Path) {
    let page = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(page.starts_with("<!DOCTYPE html>") || page.starts_with("<!doctype html>"), "{}", &page[..40]);
    assert!(page.trim_end().ends_with("</html>"), "the page is whole");
    for scene in SCENES {
        assert!(page.contains(&format!("-{scene}\"")), "{scene} is not in the page");
    }
    for attribute in ["src", "href", "url(", "@import"] {
        for at in page.match_indices(attribute).map(|(at, _)| at + attribute.len()) {
            let target = page[at..].trim_start_matches(['=', '"', '\'', ' ']);
            let outside = ["http:", "https:", "//", "file:"].iter().any(|scheme| target.starts_with(scheme));
            assert!(!outside, "{attribute}: {}", target.chars().take(60).collect::<String>());
        }
    }
    let films = page.matches("src=\"data:image/png;base64,").count();
    assert!(films >= SCENES.len(), "{films} films");
}

fn assert_demo(folder: &Path, stdout: &str, out: &str) {
    let last = stdout.lines().last().expect("a last line");
    assert_eq!(Path::new(last), Path::new(out).join("report.html"));
    assert_page(&folder.join(last));
    for scene in SCENES {
        assert!(stdout.lines().any(|line| line.split_whitespace().next() == Some(scene)), "{scene}\n{stdout}");
    }
    assert_eq!(entries(&folder.join(out)), BTreeSet::from(["report.html".to_owned()]));
}

/// Names and figures of a table; the last two columns are times.
fn without_times(stdout: &str) -> Vec<&str> {
    fn shorter(line: &str) -> &str {
        line.trim_end().rsplit_once(' ').map_or("", |(rest, _)| rest.trim_end())
    }
    stdout.lines().map(|line| shorter(shorter(line))).collect()
}

#[test]
fn demo_ends_with_the_path_of_its_report_and_is_what_galpix_does_by_itself() {
    let folder = folder();
    let demo = done(folder.path(), &["demo", "--out", "there/deeper"]);
    assert_demo(folder.path(), &demo, "there/deeper");
    let alone = output(folder.path(), &[]);
    assert_eq!((alone.status.code(), text(&alone.stderr)), (Some(0), ""), "no terminal, no progress");
    let alone = text(&alone.stdout);
    assert_demo(folder.path(), alone, "galpix-out");
    assert_eq!(without_times(&demo), without_times(alone));
}

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
    // The same for the other output: the exit code is all that is left to say.
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
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let child = galpix(folder.path(), &["budget"]).stdout(full).stderr(Stdio::piped()).spawn().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).starts_with("galpix: standard output cannot be written"), "{}", text(&output.stderr));
}

#[test]
fn a_budget_says_its_certificate_by_cause_and_the_smallest_for_an_error() {
    let folder = folder();
    let paper = json(folder.path(), &["budget", "--json"]);
    let frames = paper["certificate"]["frames"].as_array().expect("frame by frame");
    assert_eq!(frames.len(), 16);
    let last = &frames[15];
    let parts = ["position_px", "velocity_px", "acceleration_px"].map(|part| last[part].as_f64().expect("a part"));
    assert_eq!(parts, [0.03125, 0.0625, 0.5]);
    assert_eq!(paper["certificate"]["quantisation_px"], 0.59375);
    assert_eq!(paper["roundings"].as_array().expect("all roundings").len(), 4);
    let bits = |arguments: &[&str]| {
        let all = [&["budget", "--json", "--max-error", "1"], arguments].concat();
        json(folder.path(), &all)["motion_bits_per_component"].as_u64().expect("bits")
    };
    assert_eq!(bits(&[]), 36);
    assert_eq!(bits(&["--rounding", "truncate"]), 37);
    assert_eq!(bits(&["--rounding", "nearest"]), 37);
    refused(folder.path(), &["budget", "--max-error", "0.0000001"], &["no budget certifies", "ask for a larger error"]);
    refused(folder.path(), &["budget", "--max-error", "-1"], &["positive"]);
    refused(folder.path(), &["budget", "--max-error", "1", "--shave", "velocity-int=1"], &["--shave"]);
}

#[test]
fn vectors_are_written_whole_and_again_the_same() {
    let folder = folder();
    let manifest = |out: &str, seed: &str| -> Value {
        let path = done(folder.path(), &["vectors", "--out", out, "--seed", seed]);
        let text = std::fs::read_to_string(folder.path().join(path.trim())).expect("the manifest");
        serde_json::from_str(&text).expect("JSON")
    };
    let (one, again, other) = (manifest("a", "0"), manifest("b", "0"), manifest("c", "1"));
    assert_eq!(one, again);
    assert_ne!(one["cases"], other["cases"]);
    let kinds: BTreeSet<&str> =
        one["cases"].as_array().expect("cases").iter().filter_map(|case| case["kind"].as_str()).collect();
    let known = ["step", "resolve", "edge", "fill", "frame", "inpaint", "layers", "objects", "disocclusion"];
    assert_eq!(kinds, BTreeSet::from(known));
    for case in one["cases"].as_array().expect("cases") {
        for file in case["files"].as_array().expect("files") {
            assert!(folder.path().join("a").join(file["path"].as_str().expect("a path")).is_file(), "{file}");
        }
    }
    assert!(folder.path().join("a/schema.json").is_file() && folder.path().join("a/hashes.txt").is_file());
    std::fs::write(folder.path().join("file"), "kept").expect("a file");
    refused(folder.path(), &["vectors", "--out", "file"], &["cannot be written", "--out"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("file")).expect("the file"), "kept");
}

#[test]
fn a_plan_says_what_is_not_needed() {
    let folder = folder();
    let still = json(folder.path(), &["plan", "still", "--max-error", "0.5", "--json"]);
    assert_eq!((&still["plan"]["motion"]["velocity"], &still["plan"]["depth_bits"]), (&Value::Bool(false), &0.into()));
    assert!(still["plan"]["code"].as_str().expect("Rust").contains("const LANES: Lanes = Lanes::NONE;"));
    let text = done(folder.path(), &["plan", "drift", "--max-error", "0.5"]);
    for word in ["certified px", "measured px", "impl Layout for PlannedDrift", "full budget"] {
        assert!(text.contains(word), "{word:?} is not in {text}");
    }
    refused(folder.path(), &["plan", "ball", "--max-error", "0.00000001"], &["no budget certifies"]);
    refused(folder.path(), &["plan", "ball"], &["--max-error"]);
    refused(folder.path(), &["plan", "nowhere", "--max-error", "1"], &["nowhere", "galpix scenes"]);
}

#[test]
fn send_keeps_a_stream_in_a_file() {
    let folder = folder();
    let marbles = marbles();
    let marbles = marbles.to_string_lossy();
    let more = ["send", &marbles, "--to", "file:stream", "--panel", "lcd", "--updates", "2"];
    refused(folder.path(), &more, &["marbles", "one update", "--updates 2"]);
    let report = json(folder.path(), &["send", &marbles, "--to", "file:stream", "--panel", "lcd", "--json"]);
    assert_eq!((report["source"].as_str(), report["panel"].as_str()), (Some("marbles"), Some("lcd")));
    assert_eq!((report["width"].as_u64(), report["height"].as_u64()), (Some(320), Some(240)));
    assert_eq!(report["frames"].as_u64(), Some(18 * 240));
    assert!(report["device"].is_null());
    let length = std::fs::metadata(folder.path().join("stream")).unwrap().len();
    assert_eq!(report["bytes"].as_u64(), Some(length));
    let text = done(folder.path(), &["send", "drift", "--to", "file:stream", "--panel", "oled", "--updates", "2"]);
    assert!(text.starts_with("drift to oled (128x64): 384 frames of galpixels"), "{text}");
    assert!(text.contains("update 1, exact at frame 8: 8192 galpixels, 0 cells empty"), "{text}");
    assert_eq!(entries(folder.path()), BTreeSet::from(["stream".to_owned()]));
}
