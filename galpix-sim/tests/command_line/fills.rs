//! `galpix fills`.

use galpix_sim::picture::Picture;
use serde_json::Value;

use crate::{done, entries, folder, json, marbles, picture, read, refused};

#[test]
fn page_values_and_pictures_say_the_same() {
    let folder = folder();
    let stdout = done(
        folder.path(),
        &["fills", "crossing", "still", "--frames", "2", "--scheme=map,source", "--out", "here/deep"],
    );
    assert_eq!(stdout.lines().last(), Some("here/deep/fills.html"));
    let out = folder.path().join("here/deep");
    let read = |name: &str| read(&out.join(name));
    let json = |name: &str| serde_json::from_str::<Value>(&read(name)).unwrap();
    let (document, index, csv, page) = (json("fills.json"), json("index.json"), read("fills.csv"), read("fills.html"));
    assert_eq!(document["nothing_disoccluded"].as_array().unwrap().as_slice(), ["still"]);
    let source = &document["sources"][0];
    let fills = source["fills"].as_array().unwrap();

    // A line for each fill and frame, one for all its frames.
    let columns: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    assert_eq!(csv.lines().count(), 1 + fills.len() * 3);
    assert!(csv.lines().all(|line| line.split(',').count() == columns.len()));

    // The page needs nothing else, and shows the truth, the warped picture and each fill.
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(!page.contains("http:") && !page.contains("https:"), "the page loads something");
    assert_eq!(page.matches("src=").count(), page.matches("src=\"data:image/png;base64,").count());
    assert_eq!(page.matches("<img ").count(), fills.len() + 2);
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 3);
    assert_eq!(page.matches("<tr><td").count(), fills.len());

    // The pictures: those that the index lists, the mask as large as in the document, and what no mask covers is the
    // same in all.
    let mut listed = 0;
    for (frame, cells) in
        index["sources"][0]["frames"].as_array().unwrap().iter().zip(source["cells"].as_array().unwrap())
    {
        let at = |name: &str| picture(&out.join(frame[name].as_str().unwrap()));
        let white = |mask: &Picture| mask.pixels.iter().filter(|&&pixel| pixel == [255; 3]).count() as u64;
        let (truth, mask, all, warped) = (at("truth"), at("mask"), at("mask_all"), at("warped"));
        assert_eq!((truth.width, truth.height), (192, 144));
        for of in [frame, cells] {
            assert_eq!(Some(white(&mask)), of["disoccluded"].as_u64());
            assert_eq!(Some(white(&all)), of["missing"].as_u64());
        }
        assert!(all.pixels.iter().zip(&warped.pixels).all(|(&all, &warped)| all == [0; 3] || warped == [0; 3]));
        for fill in frame["fills"].as_array().unwrap() {
            let shown = picture(&out.join(fill["file"].as_str().unwrap()));
            let pairs = all.pixels.iter().zip(shown.pixels.iter().zip(&warped.pixels));
            let differing = pairs.filter(|&(&all, (shown, warped))| all == [0; 3] && shown != warped).count();
            // What was filled takes no cell from a galpixel of the update. Stationary sources are resampled.
            let name = &fill["name"];
            assert!(fill["scheme"] == "source" || differing == 0, "{name}: {differing} cells outside of the mask");
            listed += 1;
        }
    }
    assert_eq!(listed, 2 * fills.len());
}

#[test]
fn one_document_and_only_the_fills_that_were_asked_for() {
    let folder = folder();
    let arguments =
        ["fills", "fovea", "--fills=extend,push-pull,push-pull-classic", "--gamma=1", "--fovea=60", "--json"];
    let document = json(folder.path(), &arguments);
    assert!(entries(folder.path()).is_empty(), "without --out nothing is written");
    assert_eq!(document["fovea"], 60);
    let fills = document["sources"][0]["fills"].as_array().unwrap();
    let values = |key: &str| fills.iter().map(|fill| fill[key].to_string()).collect::<Vec<_>>().join(" ");
    assert_eq!(values("name"), "\"extend\" \"push-pull-classic\" \"push-pull\"");
    assert_eq!(values("gamma"), "null \"0\" \"1\"");
    assert_eq!(values("depth_aware"), "null false true");
    for fill in fills {
        assert!(fill["time"]["x_copy"].as_f64().unwrap() > 0.0);
        assert_eq!(fill["frames"].as_array().unwrap().len(), 3);
    }
}

/// Every row has what `galpix run` says of the same fill in the same scheme; what is inside is the same for all.
#[test]
fn a_row_has_the_measures_of_a_run() {
    let folder = folder();
    let marbles = marbles().display().to_string();
    for (source, frames) in [("near-plane", "3"), (&*marbles, "5")] {
        let run = |scheme: &str, fill: &str| {
            let report =
                json(folder.path(), &["run", source, "--frames", frames, "--scheme", scheme, "--fill", fill, "--json"]);
            let truths = report["frames"].as_array().unwrap().iter().map(|frame| frame["truth"].clone());
            truths.filter(Value::is_object).collect::<Vec<_>>()
        };
        let arguments = [
            "fills",
            source,
            "--frames",
            frames,
            "--scheme=source,map",
            "--fills=none,bullet,extend,push-pull",
            "--json",
        ];
        let document = json(folder.path(), &arguments);
        let report = &document["sources"][0];
        let fills = report["fills"].as_array().unwrap();
        let rows: Vec<[&str; 2]> =
            fills.iter().map(|fill| ["scheme", "name"].map(|key| fill[key].as_str().unwrap())).collect();
        let map = ["none", "bullet", "extend", "push-pull"].map(|name| ["map", name]);
        assert_eq!(rows, [&map[..], &["none", "extend", "push-pull"].map(|name| ["source", name])].concat());
        assert_eq!(document["left_out"][0], "Stationary sources do not have bullet: left out.");
        let inside = |truth: &Value| truth["inside"].as_u64().unwrap();
        let same_for_all: Vec<u64> = run("map", "none").iter().map(inside).collect();
        for fill in fills {
            let [scheme, name] = ["scheme", "name"].map(|key| fill[key].as_str().unwrap());
            let truths = run(scheme, name);
            let frames = fill["frames"].as_array().unwrap();
            assert_eq!(frames.len(), truths.len());
            for (frame, truth) in frames.iter().zip(&truths) {
                for (key, value) in frame["truth"].as_object().unwrap() {
                    // SSIM and FLIP of the whole picture are left out here.
                    assert!(value == &truth[key] || ["ssim", "flip"].contains(&key.as_str()), "{scheme} {name}: {key}");
                }
            }
            assert_eq!(truths.iter().map(inside).collect::<Vec<_>>(), same_for_all, "{scheme} {name}");
            let mean = |of: &dyn Fn(&Value) -> Option<f64>| {
                let values: Vec<f64> = truths.iter().filter_map(of).collect();
                values.iter().sum::<f64>() / values.len() as f64
            };
            for (key, value) in [
                ("psnr_db", mean(&|truth| truth["psnr_db"].as_f64())),
                ("psnr_inside_db", mean(&|truth| truth["psnr_inside_db"].as_f64())),
                ("change_error", mean(&|truth| truth["change"]["error"].as_f64())),
                ("judder_px", mean(&|truth| truth["change"]["judder_px"].as_f64())),
                ("missing_percent", mean(&|truth| truth["missing_percent"].as_f64())),
            ] {
                let measure = fill["measures"][key].as_f64().unwrap();
                assert!((measure - value).abs() < 1e-9, "{scheme} {name}: {key} {measure}, of the run {value}");
            }
        }
        // What is judged is what the map leaves open.
        for (cells, truth) in report["cells"].as_array().unwrap().iter().zip(run("map", "none")) {
            assert_eq!([&cells["missing"], &cells["at_border"]], [&truth["missing"], &truth["missing_at_border"]]);
        }
    }
}

#[test]
fn what_cannot_be_used_is_refused_before_anything_is_written() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "in the way").unwrap();
    for (arguments, words) in [
        (["crossing", "nonsense"].as_slice(), ["nonsense", "galpix scenes"].as_slice()),
        (&["crossing", "./absent/capture.toml"], &["absent/capture.toml"]),
        (&["crossing", "--fills", "extend,paint"], &["`paint`", "push-pull"]),
        (&["crossing", "--gamma", "0.7"], &["gamma", "1/2"]),
        (&["crossing", "--fovea", "0"], &["fovea"]),
        (&["crossing", "--scheme", "source", "--fills", "bullet,debris"], &["--fills bullet,debris", "push-pull"]),
        (&["crossing", "--scheme", "paint"], &["map", "source"]),
        (&["crossing", "--frames", "0"], &["frames"]),
        (&["crossing", "--out", "file/below"], &["cannot be written", "--out"]),
    ] {
        refused(folder.path(), &[&["fills"], arguments].concat(), words);
        assert_eq!(entries(folder.path()), ["file".to_owned()].into(), "{arguments:?}");
    }
}
