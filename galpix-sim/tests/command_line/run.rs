//! `galpix run`, and what every command refuses.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::{done, entries, folder, json, marbles, output, picture, refused, text};

/// Returns a copy of the marbles whose manifest has `from` replaced by `to`.
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

/// Returns whether a value is a finite number: infinities and NaN would have become null.
fn is_number(value: &Value) -> bool {
    value.as_f64().is_some_and(f64::is_finite)
}

fn assert_report(report: &Value, frames: usize) {
    for key in ["source", "rounding", "fill", "scan_out"] {
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
        for key in ["psnr_db", "psnr_hold_db", "psnr_known_db", "psnr_inside_db", "ssim", "flip"] {
            assert!(is_number(&truth[key]), "frame {number}, {key}: {}", truth[key]);
        }
        assert!(is_number(&truth["missing_percent"]), "frame {number}: {}", truth["missing_percent"]);
        for key in ["missing", "missing_at_border", "inside"] {
            assert!(truth[key].is_u64(), "frame {number}, {key}: {}", truth[key]);
        }
        // A change is against the frame before: the first one has no displacement to compare.
        let change = truth.get("change").expect("change");
        if !change.is_null() {
            assert!(is_number(&change["error"]) && is_number(&change["truth"]), "frame {number}: {change}");
            assert!(number > 1 || change["judder_px"].is_null(), "frame 1: {change}");
        }
    }
}

fn assert_frames(folder: &Path, frames: u32, size: (usize, usize)) {
    let expected: BTreeSet<String> = (0..=frames).map(|frame| format!("{frame:04}.png")).collect();
    let pictures: BTreeSet<String> = entries(folder).into_iter().filter(|name| name.ends_with(".png")).collect();
    assert_eq!(pictures, expected);
    for name in expected {
        let picture = picture(&folder.join(&name));
        assert_eq!((picture.width, picture.height), size, "{name}");
    }
}

#[test]
fn run_as_json_is_one_document_and_writes_the_frames() {
    let folder = folder();
    let report = json(folder.path(), &["run", "still", "--json"]);
    assert_report(&report, 24);
    assert_eq!(
        [&report["source"], &report["rounding"], &report["scheme"], &report["fill"], &report["scan_out"]],
        ["still", "low-discrepancy", "source", "push-pull", "sub-cell"]
    );
    assert_eq!([&report["budget"]["extent"], &report["budget"]["recog"], &report["budget"]["prop"]], [256, 8, 32]);
    assert!(report["frames"].as_array().unwrap().iter().all(|frame| frame["truth"].is_object()), "a scene has a truth");
    assert_frames(&folder.path().join("galpix-out/still"), 24, (192, 144));
}

#[test]
fn two_runs_are_compared_frame_by_frame() {
    let folder = folder();
    for fill in ["hold", "extend"] {
        let printed = done(folder.path(), &["run", "crossing", "--frames", "3", "--fill", fill, "--json"]);
        std::fs::write(folder.path().join(format!("{fill}.json")), printed).unwrap();
    }
    let text = done(folder.path(), &["compare", "hold.json", "extend.json"]);
    assert_eq!(text.lines().last(), Some("galpix-out/compare/compare.html"));
    assert!(text.contains("fill: \"hold\" in A, \"extend\" in B"), "{text}");
    let written = folder.path().join("galpix-out/compare");
    assert_eq!(entries(&written), ["compare.csv", "compare.html"].map(String::from).into());
    let comparison = json(folder.path(), &["compare", "hold.json", "extend.json", "--json"]);
    assert_eq!((&comparison["kind"], comparison["frames"].as_array().unwrap().len()), (&"compare".into(), 3));
    let [hold, extend] = ["first", "second"].map(|run| comparison["means"][run][0].as_f64().unwrap());
    assert!(extend > hold, "{hold} {extend}");
    refused(folder.path(), &["compare", "hold.json", "nothing.json"], &["nothing.json", "correct the path"]);
    std::fs::write(folder.path().join("scenes.json"), done(folder.path(), &["scenes", "--json"])).unwrap();
    refused(folder.path(), &["compare", "hold.json", "scenes.json"], &["scenes.json", "galpix run SOURCE --json"]);
}

/// Without `--json` a run leaves its page, with a film and where the error is seen, and its figures.
#[test]
fn run_writes_a_page_and_its_figures() {
    let folder = folder();
    let text = done(folder.path(), &["run", marbles().to_str().unwrap(), "--frames", "6", "--out", "there"]);
    let page = crate::read(&folder.path().join("there/report.html"));
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(!page.contains("http:") && !page.contains("https:"), "the page loads something");
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 2, "the film, and FLIP pixel by pixel");
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 4);
    let csv = crate::read(&folder.path().join("there/frames.csv"));
    assert_eq!(csv.lines().count(), 7);
    let flip = csv.lines().next().unwrap().split(',').position(|column| column == "flip").expect("FLIP");
    let last = csv.lines().last().unwrap().split(',').nth(flip).unwrap();
    assert!(text.contains(&format!("{:.4}", last.parse::<f64>().unwrap())), "{last} is not in {text}");
    assert!(text.contains("reached dB  PSNR of the cells"), "{text}");
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
fn every_fill_mode_and_rounding_is_known_by_name() {
    let folder = folder();
    for fill in ["none", "hold", "debris", "bullet", "galdebris", "extend", "push-pull", "metamer"] {
        let report = json(folder.path(), &["run", "crossing", "--frames", "2", "--fill", fill, "--json"]);
        assert_eq!(report["fill"].as_str(), Some(fill));
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

/// Samples that stay wear nothing out: pictures come nearer to the truth, fewer cells are missing, and what moves
/// slowly slides.
#[test]
fn stationary_sources_come_nearer_to_the_truth_than_the_map() {
    let folder = folder();
    let marbles = marbles().display().to_string();
    for (source, gain) in [(&*marbles, 1.5), ("ball", 5.0), ("disc", 1.0), ("sphere", 1.0), ("near-plane", 1.0)] {
        let [map, sources] = ["map", "source"].map(|scheme| {
            let arguments = ["run", source, "--scheme", scheme, "--out", scheme, "--json"];
            let report = json(folder.path(), &arguments);
            assert_eq!(report["scheme"], scheme);
            report
        });
        assert_eq!([&map["scan_out"], &sources["scan_out"]], ["nearest", "sub-cell"]);
        assert_eq!([&map["fill"], &sources["fill"]], ["extend", "push-pull"]);
        let update = |scheme: &str| std::fs::read(folder.path().join(scheme).join("0000.png")).expect("the update");
        assert_eq!(update("map"), update("source"), "{source}");
        let mean = |report: &serde_json::Value, key: &str| {
            let frames = report["frames"].as_array().expect("frames").iter();
            let values: Vec<f64> = frames.filter_map(|frame| frame["truth"][key].as_f64()).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let [before, after] = [&map, &sources].map(|report| mean(report, "psnr_inside_db"));
        assert!(after > before + gain, "{source}: {before} dB, stationary sources {after} dB");
        let [before, after] = [&map, &sources].map(|report| mean(report, "missing"));
        assert!(after < before, "{source}: {before} cells missing, of stationary sources {after}");
    }
    let judder = |frames: &serde_json::Value| frames[1]["truth"]["change"]["judder_px"].as_f64().expect("judder");
    let [map, sources] =
        ["map", "source"].map(|scheme| json(folder.path(), &["run", &marbles, "--scheme", scheme, "--json"]));
    assert!(judder(&sources["frames"]) < judder(&map["frames"]) / 3.0);
}

#[test]
fn what_stationary_sources_do_not_have_is_refused_and_what_they_have_is_named() {
    let folder = folder();
    for fill in ["debris", "bullet", "galdebris"] {
        refused(folder.path(), &["run", "ball", "--scheme", "source", "--fill", fill], &[fill, "metamer", "map"]);
    }
    refused(folder.path(), &["run", "ball", "--scheme", "source", "--reach", "2"], &["--reach", "map"]);
    refused(folder.path(), &["run", "ball", "--scheme", "paint"], &["map", "source"]);
    for fill in ["none", "hold", "extend", "push-pull", "metamer"] {
        let report =
            json(folder.path(), &["run", "hud", "--scheme", "source", "--frames", "3", "--fill", fill, "--json"]);
        assert_eq!(report["fill"], fill);
    }
}

/// Each fill shows something else. In a fovea there is what extend shows, beyond it what is shown without one.
#[test]
fn stationary_sources_are_inpainted_outside_of_the_fovea() {
    let folder = folder();
    let frame = |name: &str, more: &[&str]| {
        let arguments = ["run", "ball", "--scheme", "source", "--frames", "8", "--out", name, "--fill"];
        json(folder.path(), &[&arguments[..], more, &["--json"]].concat());
        std::fs::read(folder.path().join(name).join("0008.png")).expect("a frame")
    };
    let extended = frame("extend", &["extend"]);
    let mut shown = std::collections::HashSet::from([extended.clone()]);
    for fill in ["push-pull", "metamer"] {
        assert_eq!(frame("all", &[fill, "--fovea", "1000"]), extended, "{fill}");
        assert!(
            shown.insert(frame("none", &[fill])) && shown.insert(frame("some", &[fill, "--fovea", "80"])),
            "{fill}"
        );
    }
}

/// The frames stay what they are, the pictures of what moves come nearer to the truth, the update stays as it is.
#[test]
fn sub_cell_scan_out_changes_what_is_shown_and_nothing_else() {
    let folder = folder();
    let source = marbles().display().to_string();
    let [nearest, resampled] = ["nearest", "sub-cell"].map(|mode| {
        let report = json(
            folder.path(),
            &["run", &source, "--frames", "4", "--prop", "32", "--scan-out", mode, "--out", mode, "--json"],
        );
        assert_eq!(report["scan_out"], mode);
        report
    });
    let update = |mode: &str| std::fs::read(folder.path().join(mode).join("0000.png")).expect("the update");
    assert_eq!(update("nearest"), update("sub-cell"));
    for number in [0, 1, 3] {
        let [near, sub] = [&nearest, &resampled].map(|report| &report["frames"][number]);
        for key in ["holes", "bullets", "lost", "collided", "edges"] {
            assert_eq!(near[key], sub[key], "{key}");
        }
        let [near, sub] = [near, sub].map(|frame| frame["truth"]["psnr_db"].as_f64().expect("a truth"));
        assert!(sub > near + 0.5, "frame {}: {near} dB, resampled {sub} dB", number + 1);
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
