//! `galpix stability`.

use std::path::Path;

use serde_json::Value;

use crate::{done, entries, folder, json, read, refused};

/// What must be there, whatever else is.
const CASES: [&str; 22] = [
    "turn-round",
    "rotation",
    "oscillators",
    "near-plane",
    "bounce",
    "sub-lsb",
    "in-step",
    "re-anchored",
    "extremes-plane",
    "extremes-depth",
    "edge-of-overflow",
    "saturating",
    "depth-ends",
    "counter-wrap",
    "every-field",
    "checkerboard",
    "one-cell",
    "off-screen",
    "empty",
    "sizes",
    "wings",
    "old-debris",
];

#[test]
fn the_whole_suite_as_json_holds_every_case_and_every_rounding() {
    let folder = folder();
    let suite = json(folder.path(), &["stability", "--json"]);
    assert_eq!(suite["stable"], true);
    assert_eq!(suite["budget"]["extent"], 1024);
    let names: Vec<&str> = suite["cases"].as_array().unwrap().iter().filter_map(|case| case["name"].as_str()).collect();
    assert_eq!(names, CASES);
    for case in suite["cases"].as_array().unwrap() {
        let roundings: Vec<&str> =
            case["roundings"].as_array().unwrap().iter().filter_map(|one| one["rounding"].as_str()).collect();
        assert_eq!(roundings, ["truncate", "nearest", "low-discrepancy", "searched"], "{}", case["name"]);
        assert!(["bounded", "not-covered"].iter().any(|word| case["verdict"] == *word), "{}", case["name"]);
        for one in case["roundings"].as_array().unwrap() {
            assert_eq!(one["findings"], Value::Array(Vec::new()));
            let (paths, pictures) = (one["paths"].as_array().unwrap(), one["pictures"].as_array().unwrap());
            assert!(!paths.is_empty() || !pictures.is_empty());
            let detailed: Vec<&Value> = paths.iter().filter(|path| path.get("series").is_some()).collect();
            assert_eq!(detailed.len(), usize::from(!paths.is_empty()), "one path is reported frame by frame");
            for row in detailed.iter().flat_map(|path| path["series"].as_array().unwrap()) {
                let px = |name: &str| row[name].as_f64().unwrap();
                let shares = ["taylor_px", "quantisation_px", "drift_px", "snapping_px", "saturation_px"].map(px);
                let whole = px("true_px") - px("shown_px");
                let tiny = 1e-9 * whole.abs().max(shares.iter().fold(1.0, |most: f64, share| most.max(share.abs())));
                assert!((shares.iter().sum::<f64>() - whole).abs() < tiny, "{}: {row}", case["name"]);
            }
            for picture in pictures {
                let count = |name: &str| picture[name].as_u64().unwrap();
                assert_eq!(count("moved"), count("settled") + count("lost") + count("collided"), "{picture}");
            }
        }
    }
    let case =
        |name: &str| suite["cases"].as_array().unwrap().iter().find(|case| case["name"] == name).unwrap().clone();
    // A full turn-round: the positive end of one field is one step too large for it.
    assert_eq!(case("turn-round")["roundings"][2]["clamped"], 6);
    assert_eq!(case("turn-round")["verdict"], "not-covered");
    for name in [
        "re-anchored",
        "counter-wrap",
        "checkerboard",
        "one-cell",
        "off-screen",
        "empty",
        "sizes",
        "wings",
        "old-debris",
    ] {
        assert_eq!(case(name)["verdict"], "bounded", "{name}");
    }
    assert!(folder.path().join("galpix-out/stability.html").exists(), "the page is written all the same");
}

#[test]
fn tables_and_the_path_of_the_page() {
    let folder = folder();
    let printed = done(folder.path(), &["stability", "sub-lsb", "sizes", "--out", "there/deeper"]);
    let last = printed.lines().last().unwrap();
    assert_eq!(Path::new(last), Path::new("there/deeper/stability.html"));
    let page = read(&folder.path().join(last));
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("-sub-lsb\"") && page.contains("-sizes\"") && !page.contains("-empty\""));
    assert!(page.matches("<svg class=\"plot\"").count() >= 4);
    for outside in ["http:", "https:", "//", "url(", "@import", "<link", "<script", "NaN"] {
        assert!(!page.contains(outside), "the page contains {outside}");
    }
    assert!(printed.lines().all(|line| line.chars().count() <= 120), "{printed}");
    let row =
        |first: &str| printed.lines().find(|line| line.split_whitespace().next() == Some(first)).unwrap_or_default();
    assert!(row("sub-lsb").ends_with("not covered: late"), "{printed}");
    assert!(row("sizes").ends_with("bounded"), "{printed}");
    let drift = printed.lines().filter(|line| line.starts_with("sub-lsb")).nth(1).expect("drift with each rounding");
    assert_eq!(drift.split_whitespace().count(), 5, "{drift}");
    assert_eq!(entries(&folder.path().join("there/deeper")).len(), 1, "one file and no draft");
}

#[test]
fn one_rounding_and_other_demands() {
    let folder = folder();
    for demand in [["64", "8", "8"], ["1000", "7", "11"], ["2048", "16", "32"]] {
        let [extent, recog, prop] = demand;
        let arguments = [
            "stability",
            "saturating",
            "near-plane",
            "one-cell",
            "--rounding",
            "nearest",
            "--json",
            "--extent",
            extent,
            "--recog",
            recog,
            "--prop",
            prop,
        ];
        let suite = json(folder.path(), &arguments);
        assert_eq!(suite["stable"], true, "{demand:?}");
        for case in suite["cases"].as_array().unwrap() {
            assert_eq!(case["roundings"].as_array().unwrap().len(), 1);
            assert_eq!(case["roundings"][0]["rounding"], "nearest");
        }
    }
}

#[test]
fn what_cannot_be_used_is_refused_in_one_sentence() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "not a folder").unwrap();
    for (arguments, words) in [
        (["nowhere"].as_slice(), ["`nowhere`", "turn-round", "old-debris"].as_slice()),
        (&["empty", "--extent", "0"], &["positive number"]),
        (&["empty", "--recog", "1", "--extent", "32768"], &["lower --extent or raise --recog"]),
        (&["empty", "--prop", "1"], &["2 frames or more"]),
        (&["empty", "--rounding", "up"], &["truncate", "low-discrepancy"]),
        (&["empty", "--out", "file"], &["file cannot be written", "--out"]),
        (&["empty", "--json", "--out", "file/deeper"], &["cannot be written"]),
    ] {
        refused(folder.path(), &[&["stability"], arguments].concat(), words);
    }
    assert_eq!(entries(folder.path()), ["file".to_owned()].into(), "nothing is written");
}
