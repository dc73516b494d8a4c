//! `galpix budget`.

use crate::{done, entries, folder, json, refused};

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

/// The figures that logic asks for, by hand: at 9 bits with sign and no fraction of an acceleration, 128 cells a frame.
#[test]
fn a_budget_says_what_logic_asks_first() {
    let folder = folder();
    let all = ["budget", "--layout", "velocity565", "--json", "--limit-y", "8"];
    let budget = json(folder.path(), &all);
    let logic = &budget["logic"];
    assert_eq!((logic["reach_columns"].as_u64(), logic["reach_rows"].as_u64()), (Some(128), Some(8)));
    assert_eq!((logic["band_rows"].as_u64(), logic["band_bytes"].as_u64()), (Some(19), Some(19 * 1024 * 8)));
    assert_eq!(logic["bytes_a_second"].as_u64(), Some(1024 * 768 * 60 * 8));
    assert_eq!(budget["certificate"], json(folder.path(), &all[..4])["certificate"], "only the range is cut");
    assert_eq!(json(folder.path(), &all[..4])["logic"]["reach_rows"].as_u64(), Some(128));
    refused(folder.path(), &["budget", "--limit-y", "1"], &["--limit-y"]);
    refused(folder.path(), &["budget", "--size", "0x4"], &["--size", "320x240"]);
}

/// The package says what the JSON says, and nothing else is a budget.
#[test]
fn a_budget_becomes_a_package_for_logic() {
    let folder = folder();
    let text = done(folder.path(), &["budget", "--layout", "velocity565", "--limit-y", "8", "--json"]);
    std::fs::write(folder.path().join("budget.json"), text).expect("the budget");
    let written = json(folder.path(), &["rtl", "--budget", "budget.json", "--out", "rtl", "--json"]);
    assert_eq!((written["record_bits"].as_u64(), written["reach_rows"].as_u64()), (Some(64), Some(8)));
    let package = std::fs::read_to_string(folder.path().join("rtl/galpixel.sv")).expect("the package");
    for line in
        ["package galpixel;", "localparam int X_VI = 8;", "localparam int Y_VI = 4;", "localparam int Y_REACH = 8;"]
    {
        assert!(package.lines().any(|written| written.trim() == line), "{line}: {package}");
    }
    std::fs::write(folder.path().join("other.json"), "{\"kind\": \"plan\"}").expect("another document");
    refused(
        folder.path(),
        &["rtl", "--budget", "other.json", "--out", "rtl"],
        &["is no budget", "galpix budget --json"],
    );
    refused(folder.path(), &["rtl", "--budget", "nowhere.json", "--out", "rtl"], &["is no budget"]);
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
