//! `galpix layers`, and `galpix run --hidden`.

use serde_json::Value;

use crate::{done, entries, folder, json, output, read, refused, text};

#[test]
fn page_and_values_say_the_same() {
    let folder = folder();
    let output = output(folder.path(), &["layers", "crossing", "still", "--frames", "2", "--out", "here/deep"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).lines().last(), Some("here/deep/layers.html"));
    assert!(text(&output.stderr).contains("still: nothing is disoccluded"), "{}", text(&output.stderr));
    let read = |name: &str| read(&folder.path().join("here/deep").join(name));
    let document: Value = serde_json::from_str(&read("layers.json")).unwrap();
    let (csv, page) = (read("layers.csv"), read("layers.html"));
    assert_eq!(document["nothing_disoccluded"].as_array().unwrap().as_slice(), ["still"]);
    let strategies = document["sources"][0]["ways"].as_array().unwrap();
    assert_eq!(strategies[0]["name"], "one layer");

    // A line for each strategy and frame, one for all its frames; missing cells add up.
    let columns: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    assert_eq!(csv.lines().count(), 1 + strategies.len() * 3);
    assert!(strategies.len() > 8 && columns.len() == 17);
    for strategy in strategies {
        let frames = strategy["frames"].as_array().unwrap();
        let sum: u64 = frames.iter().map(|frame| frame["missing"].as_u64().unwrap()).sum();
        assert_eq!(Some(sum), strategy["missing"].as_u64());
        assert!(text(&output.stdout).contains(strategy["name"].as_str().unwrap()));
    }

    // The page needs nothing else; truth, warped picture, each strategy, and the map.
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(!page.contains("http:") && !page.contains("https:"), "the page loads something");
    assert_eq!(page.matches("<img ").count(), strategies.len() + 3);
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 2);
    assert_eq!(page.matches("<tr><td").count(), strategies.len());
}

#[test]
fn json_is_one_document_and_nothing_is_written() {
    let folder = folder();
    let document = json(folder.path(), &["layers", "ball", "--frames", "2", "--separation", "0.25", "--json"]);
    assert!(entries(folder.path()).is_empty());
    assert_eq!(document["separation"], 0.25);
    let hidden = &document["sources"][0]["ways"][1]["hidden"];
    assert!(
        hidden["offered"].as_u64() >= hidden["kept"].as_u64() && hidden["kept"].as_u64() >= hidden["used"].as_u64()
    );
}

/// Without `--hidden` a run reports what it did before there were layers.
#[test]
fn a_run_hands_over_what_is_hidden() {
    let folder = folder();
    let run =
        |arguments: &[&str]| json(folder.path(), &[&["run", "ball", "--frames", "4", "--json"], arguments].concat());
    let one = run(&[]);
    assert!(one.get("hidden").is_none() && one["frames"][3].get("from_hidden").is_none());
    assert_eq!(one, ignoring_time(run(&["--hidden", "none"]), &one));
    for kind in ["second", "ddoc", "unlimited"] {
        let layered = run(&["--hidden", kind]);
        let hidden = &layered["hidden"];
        assert!(hidden["used"].as_u64() > Some(0) && hidden["kept"].as_u64() <= hidden["offered"].as_u64(), "{hidden}");
        assert!(layered["frames"][3]["from_hidden"].as_u64() > Some(0));
        let missing = |report: &Value| report["frames"][3]["truth"]["missing"].as_u64().unwrap();
        assert!(missing(&layered) < missing(&one), "{kind}");
    }
    let uncut = run(&["--hidden", "second", "--uncut"]);
    assert_eq!(uncut["hidden"]["kept"], uncut["hidden"]["offered"]);
    let wide = run(&["--hidden", "second", "--separation", "0.9"]);
    assert_eq!(wide["hidden"]["offered"], 0);
    let printed = done(folder.path(), &["run", "ball", "--frames", "2", "--hidden", "second"]);
    assert!(printed.contains("samples behind the first layer"), "{printed}");
}

/// Returns a report with the times and the call of another one.
fn ignoring_time(mut report: Value, like: &Value) -> Value {
    for key in ["ns_per_galpixel", "command"] {
        report[key] = like[key].clone();
    }
    for (frame, like) in report["frames"].as_array_mut().unwrap().iter_mut().zip(like["frames"].as_array().unwrap()) {
        frame["ns_per_galpixel"] = like["ns_per_galpixel"].clone();
    }
    report
}

#[test]
fn what_cannot_be_used_is_refused_before_anything_is_written() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "in the way").unwrap();
    let marbles = concat!(env!("CARGO_MANIFEST_DIR"), "/../captures/marbles");
    for (arguments, words) in [
        (["layers", "nonsense"].as_slice(), ["nonsense", "galpix scenes"].as_slice()),
        (&["layers", "ball", "--separation", "1"], &["separation", "below 1"]),
        (&["layers", "ball", "--separation", "NaN"], &["separation", "below 1"]),
        (&["layers", "ball", "--frames", "256"], &["frames", "255"]),
        (&["layers", "ball", "--out", "file/below"], &["cannot be written", "--out"]),
        (&["run", "ball", "--hidden", "third"], &["third", "second"]),
        (&["run", "ball", "--hidden", "second", "--separation", "-1"], &["separation", "0"]),
        (&["run", marbles, "--hidden", "second"], &["marbles", "[update.hidden]"]),
        (&["run", marbles, "--hidden", "ddoc"], &["marbles", "DDOC"]),
    ] {
        refused(folder.path(), arguments, words);
        assert_eq!(entries(folder.path()), ["file".to_owned()].into(), "{arguments:?}");
    }
}
