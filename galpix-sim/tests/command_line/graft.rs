//! `galpix graft`.

use serde_json::Value;

use crate::{folder, json, read, refused};

fn strategy<'v>(report: &'v Value, name: &str) -> &'v Value {
    let strategies = report["ways"].as_array().expect("ways");
    strategies.iter().find(|strategy| strategy["way"] == name).unwrap_or_else(|| panic!("no strategy {name}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// At a lower rate than updates of the whole view, objects at their own rates are nearer to the truth in every figure,
/// and what a queue refuses is counted.
#[test]
fn objects_at_rates_of_their_own_are_nearer_to_the_truth() {
    let folder = folder();
    let report = json(folder.path(), &["graft", "hud", "--frames", "40", "--json", "--out", "out"]);
    assert_eq!(report["scene"], "hud");
    assert_eq!(report["objects"].as_array().unwrap().len(), 4);
    let (view, layers, grafts) =
        (strategy(&report, "whole-view"), strategy(&report, "whole-layers"), strategy(&report, "grafts"));
    for other in [view, layers] {
        assert!(number(&grafts["psnr_db"]) > number(&other["psnr_db"]) + 3.0, "{other}");
        assert!(number(&grafts["flip"]) < 0.8 * number(&other["flip"]), "{other}");
        assert!(number(&grafts["objects_px"]) < 0.1 * number(&other["objects_px"]), "{other}");
    }
    // By the period of an update: what of it lies within the run depends on where the run ends.
    let rate = |strategy: &Value| {
        let [objects, background] = ["objects_every", "background_every"].map(|key| number(&strategy[key]));
        let cells: Vec<f64> = report["objects"].as_array().unwrap().iter().map(number).collect();
        cells[0] / background + cells[1..].iter().sum::<f64>() / objects
    };
    let limit = number(&report["cells"]) / 16.0;
    assert!(rate(grafts) <= limit && rate(layers) <= limit, "{} {} {limit}", rate(grafts), rate(layers));
    assert!(number(&view["missing"]) > 0.0 && number(&grafts["missing"]) == 0.0, "nothing is lost behind an object");

    let grafted = &grafts["grafted"];
    let sum: f64 = ["put", "behind", "lost"].iter().map(|key| number(&grafted[key])).sum();
    let sent = 40.0 * number(&grafts["galpixels_per_frame"]);
    assert!((sum - sent).abs() < 0.5, "every galpixel that was sent is accounted for: {sum} of {sent}");
    assert_eq!(grafts["refused"]["total"], 0);
    assert_eq!(grafted["renderings"], grafts["renderings"]);
    let small = strategy(&report, "grafts-small-queue");
    let refused = number(&small["refused"]["total"]);
    assert!(refused > 0.0 && small["refused"]["cells"] == small["refused"]["total"], "{small}");
    assert_eq!(number(&small["grafted"]["renderings"]), number(&small["renderings"]) - refused);

    // Over sources the places are the same, and the picture is nearer to the truth.
    for (map, sources) in [("grafts", "grafts-sources"), ("grafts-late", "grafts-late-sources")] {
        let (map, sources) = (strategy(&report, map), strategy(&report, sources));
        for key in ["cells_per_frame", "renderings", "late", "missing"] {
            assert_eq!(map[key], sources[key], "{key}");
        }
        assert!((number(&map["objects_px"]) - number(&sources["objects_px"])).abs() < 0.01, "{map} {sources}");
        assert!(number(&sources["psnr_db"]) > number(&map["psnr_db"]), "{map} {sources}");
        assert!(number(&sources["flip"]) < number(&map["flip"]), "{map} {sources}");
    }
    let view_sources = strategy(&report, "whole-view-sources");
    assert!(number(&view_sources["missing"]) < number(&view["missing"]), "{view_sources}");

    let pinned = report["pinned"]["ways"].as_array().expect("the scene has an overlay");
    assert_eq!(pinned[0]["way"], "pinned");
    assert!(number(&pinned[0]["pinned_wrong"]) == 0.0 && number(&pinned[0]["others_smeared"]) == 0.0);
    assert!(number(&pinned[1]["others_smeared"]) > 1000.0, "{}", pinned[1]);
    assert!(number(&pinned[2]["pinned_wrong"]) > 1000.0, "{}", pinned[2]);

    let written = read(&folder.path().join("out/graft.json"));
    assert_eq!(serde_json::from_str::<Value>(&written).unwrap(), report);
    for name in ["whole-view", "grafts", "truth"] {
        assert!(folder.path().join(format!("out/{name}.png")).exists(), "{name}");
    }
}

#[test]
fn what_cannot_be_compared_is_said_in_a_sentence() {
    let folder = folder();
    for (arguments, words) in [
        (&["graft", "nowhere"][..], &["`nowhere`", "galpix scenes"][..]),
        (&["graft", "a\u{1b}[2Jb"], &["there is no scene"]),
        (&["graft", "drift"], &["drift", "no objects"]),
        (&["graft", "--objects", "1", "--global", "40"], &["every 1 frames", "--global"]),
        (&["graft", "--frames", "20"], &["every 22 frames", "a run has 20", "--frames"]),
        (&["graft", "--objects", "0"], &["--objects"]),
        (&["graft", "--global", "65"], &["--global"]),
        (&["graft", "--frames", "129"], &["--frames"]),
        (&["graft", "--out", "file"], &["file", "--out"]),
    ] {
        std::fs::write(folder.path().join("file"), []).unwrap();
        refused(folder.path(), arguments, words);
    }
}
