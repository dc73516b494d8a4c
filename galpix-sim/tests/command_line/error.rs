//! `galpix error`.

use serde_json::Value;

use crate::{done, entries, folder, json, marbles, read, refused};

/// A run of a few points over a few frames.
const TINY: [&str; 10] = [
    "error",
    "crossing",
    "--quick",
    "--frames",
    "3",
    "--lanes=still,full",
    "--roundings=truncate,low-discrepancy",
    "--rungs=none,hold",
    "--out",
    "here/deep",
];

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

/// A cell and a value are the same figure, up to what reading JSON rounds, or both are nothing.
fn same(cell: &str, value: &Value, what: &str) {
    match (cell.parse::<f64>().ok(), number(value)) {
        (Some(cell), Some(value)) => assert!((cell - value).abs() <= 1e-12 * value.abs(), "{what}: {cell}, {value}"),
        (cell, value) => assert_eq!(cell, value, "{what}"),
    }
}

#[test]
fn page_values_and_document_say_the_same() {
    let folder = folder();
    assert_eq!(done(folder.path(), &TINY).lines().last(), Some("here/deep/error.html"));
    let out = folder.path().join("here/deep");
    assert_eq!(entries(&out), ["error.csv", "error.html", "error.json"].map(String::from).into());
    let (csv, page) = (read(&out.join("error.csv")), read(&out.join("error.html")));
    let document: Value = serde_json::from_str(&read(&out.join("error.json"))).unwrap();
    let source = &document["sources"][0];
    let points = source["points"].as_array().unwrap();
    assert!(document["command"].as_str().unwrap().starts_with("galpix error crossing --quick"));
    assert_eq!(document["version"], env!("CARGO_PKG_VERSION"));

    // Comma-separated values: a line per point, and sample-and-hold.
    let mut lines = csv.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), points.len() + 1);
    let column = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    for (row, point) in rows.iter().zip(points) {
        assert_eq!(row.len(), columns.len());
        for (name, value) in [
            ("id", &point["id"]),
            ("bytes", &point["bytes"]),
            ("compile_time_us", &point["compile_time"]["frame_us"]),
            ("run_time_x_copy", &point["run_time"]["x_copy"]),
            ("worst_px", &point["summary"]["worst_px"]),
            ("bound_px", &point["summary"]["bound_px"]),
            ("flip", &point["summary"]["flip"]),
            ("psnr_inside_db", &point["summary"]["psnr_inside_db"]),
            ("change_error", &point["summary"]["change_error"]),
            ("judder_px", &point["summary"]["judder_px"]),
            ("missing_percent", &point["summary"]["missing_percent"]),
        ] {
            same(row[column(name)], value, &format!("{name} of {}", point["id"]));
        }
        assert_eq!(row[column("lanes")], point["lanes"].as_str().unwrap());
        let on_front = source["fronts"]["picture"].as_array().unwrap().contains(&point["id"]);
        assert_eq!(row[column("front_picture")], on_front.to_string());
    }
    let hold = rows.last().unwrap();
    assert_eq!((hold.len(), hold[column("scheme")]), (columns.len(), "hold"));
    same(hold[column("flip")], &source["hold"]["flip"], "sample-and-hold");
    same(hold[column("psnr_inside_db")], &source["hold"]["psnr_inside_db"], "sample-and-hold");
    assert!(source["hold"]["psnr_inside_db"].is_f64() && source["hold"]["missing_percent"].is_null());
    assert_eq!(hold[column("saturated")], "");

    // The page: needs nothing else, and has a row for each point and for each place on a front.
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("src="), "the page loads something");
    assert_eq!(page.matches("<svg class=\"plot\"").count(), 7);
    let floats = points.iter().filter(|point| point["scheme"] == "f32").count();
    let fronts: usize =
        ["position", "picture", "bytes"].map(|front| source["fronts"][front].as_array().unwrap().len()).iter().sum();
    assert_eq!(page.matches("<tr><td>").count(), points.len() + fronts + floats);
    for point in points.iter().filter(|point| point["scheme"] == "galpix") {
        let flip = format!("<td>{:.4}</td>", point["summary"]["flip"].as_f64().unwrap());
        assert!(page.contains(&flip), "FLIP of point {} is not on the page", point["id"]);
    }
}

#[test]
fn points_are_what_was_asked_for_and_fronts_are_not_beaten() {
    let folder = folder();
    let document = json(folder.path(), &[&TINY[..8], &["--json"]].concat());
    assert!(entries(folder.path()).is_empty(), "without --out nothing is written");
    let source = &document["sources"][0];
    let points = source["points"].as_array().unwrap();
    let mut galpix = Vec::new();
    for point in points {
        assert!(["still", "full"].contains(&point["lanes"].as_str().unwrap()));
        assert!(["none", "hold"].contains(&point["rung"].as_str().unwrap()));
        assert!(point["compile_time"]["frame_us"].as_f64().unwrap() > 0.0);
        if point["scheme"] == "galpix" {
            assert!(point["run_time"]["x_copy"].as_f64().unwrap() > 0.0);
            assert!(point["stand_in"].as_str().unwrap().starts_with(point["lanes"].as_str().unwrap()));
            let worst = point["summary"]["worst_px"].as_f64().unwrap();
            assert_eq!(point["saturated"], 0);
            assert!(worst <= point["summary"]["bound_px"].as_f64().unwrap() + 1e-6, "{point}");
            let [low, high] = [0, 1].map(|end| point["compile_time"]["frame_us_range"][end].as_f64().unwrap());
            let time = point["compile_time"]["frame_us"].as_f64().unwrap();
            assert!(low <= time && time <= high, "{point}");
            let at_most = point["summary"]["bound_px"].as_f64().unwrap();
            galpix.push((point["id"].as_u64().unwrap(), time, at_most.max(worst)));
        } else {
            assert!(point["rounding"].is_null() && point["run_time"].is_null());
        }
    }
    assert!(galpix.iter().any(|point| point.2 == 0.0) || galpix.len() >= 6, "{} points", galpix.len());
    let front: Vec<u64> =
        source["fronts"]["position"].as_array().unwrap().iter().map(|id| id.as_u64().unwrap()).collect();
    assert!(!front.is_empty());
    for &(id, time, error) in &galpix {
        let beaten =
            galpix.iter().any(|other| other.1 <= time && other.2 <= error && (other.1 < time || other.2 < error));
        assert!(!(front.contains(&id) && beaten), "{id} is on the front and beaten");
        let equal = galpix.iter().any(|other| front.contains(&other.0) && other.1 == time && other.2 == error);
        assert!(beaten || equal, "{id} is not on the front and not beaten");
    }
    // Every cause is there for every frame, and the update itself is without error at each rate.
    assert_eq!(source["causes"].as_array().unwrap().len(), 3);
    let rates = source["rates"].as_array().unwrap();
    assert_eq!(rates.iter().map(|rate| rate["every"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2, 4]);
    assert_eq!((number(&rates[0]["flip"]), number(&rates[0]["flip_hold"])), (Some(0.0), Some(0.0)));
    for rate in &rates[1..] {
        assert_eq!(rate["frames"], 4);
        assert!(
            number(&rate["flip"]) < number(&rate["flip_hold"]),
            "galpix is worse than holding a moving scene: {rate}"
        );
    }
    // The causes of a frame add up to at least the error.
    for frame in source["causes"].as_array().unwrap() {
        let part = |name: &str| frame[name].as_f64().unwrap();
        let parts = ["taylor_px", "left_out_px", "quantisation_px", "drift_px", "saturation_px", "snap_px"];
        let sum: f64 = parts.iter().map(|name| part(name)).sum();
        assert!(part("all_px") <= sum + 1e-9 && part("all_px") > 0.0, "{frame}");
        assert!(part("taylor_px") < 1e-6 && part("snap_px") <= 0.5, "{frame}");
    }
}

/// The point of the derived budget has what `galpix run` says of the same frames, in each scheme; what is inside is the
/// same for all points.
#[test]
fn a_point_has_the_measures_of_a_run() {
    let folder = folder();
    let marbles = marbles().display().to_string();
    for (source, frames) in [("crossing", "8"), (&*marbles, "16")] {
        let few = ["--quick", "--lanes=full", "--roundings=low-discrepancy", "--rungs=hold,bullet,extend"];
        let arguments = [&["error", source, "--frames", frames, "--scheme=map,source", "--json"][..], &few].concat();
        let document = json(folder.path(), &arguments);
        let points = document["sources"][0]["points"].as_array().unwrap();
        let pictures = |point: &Value| -> Vec<(usize, Value)> {
            let frames = point["frames"].as_array().unwrap().iter().filter(|frame| frame["picture"].is_object());
            frames.map(|frame| (frame["frame"].as_u64().unwrap() as usize, frame["picture"].clone())).collect()
        };
        let inside =
            |point: &Value| pictures(point).into_iter().map(|(_, truth)| truth["inside"].as_u64()).collect::<Vec<_>>();
        for (name, scheme) in [("galpix", "map"), ("source", "source")] {
            let arguments = ["run", source, "--frames", frames, "--scheme", scheme, "--fill", "extend", "--json"];
            let run = json(folder.path(), &arguments);
            let derived = |point: &&Value| {
                [("scheme", name), ("budget", "derived"), ("rounding", "low-discrepancy"), ("rung", "extend")]
                    .iter()
                    .all(|(key, value)| point[key] == *value)
                    && point["lanes"] == "full"
            };
            let point = points.iter().find(derived).expect("the derived budget");
            let pictures = pictures(point);
            assert!(pictures.iter().any(|(_, truth)| truth["change"]["judder_px"].is_f64()), "{source}");
            for (frame, truth) in pictures {
                assert_eq!(truth, run["frames"][frame - 1]["truth"], "{source} {scheme} frame {frame}");
            }
        }
        let same_for_all = inside(&points[0]);
        assert!(same_for_all.iter().flatten().count() > 1 && points.iter().all(|point| inside(point) == same_for_all));
        let of_sources = |key: &str, value: &str| points.iter().any(|p| p["scheme"] == "source" && p[key] == value);
        assert!(of_sources("rung", "hold") && !of_sources("rung", "bullet"));
        for point in points.iter().filter(|point| point["scheme"] == "source") {
            assert!(point["run_time"]["x_copy"].as_f64().unwrap() > 0.0 && point["compile_time"].is_null());
            let worst = point["summary"]["worst_px"].as_f64().unwrap();
            assert!(source != "crossing" || worst <= point["summary"]["bound_px"].as_f64().unwrap() + 1e-6, "{point}");
        }
    }
}

/// Whoever measures a point, it has the same number and the same errors; parts together are the whole, and a part may
/// be without any point.
#[test]
fn parts_are_the_whole() {
    let folder = folder();
    let few = ["error", "crossing", "--quick", "--frames=2", "--lanes=still,full", "--roundings=truncate", "--json"];
    let errors = |part: &str| -> Vec<Value> {
        let document = json(folder.path(), &[&few[..], &["--shard", part]].concat());
        let points = document["sources"][0]["points"].as_array().unwrap().clone();
        let without_times = |mut point: Value| {
            let times = ["run_time", "compile_time"];
            point.as_object_mut().unwrap().retain(|key, _| !times.contains(&key.as_str()));
            point
        };
        points.into_iter().map(without_times).collect()
    };
    let whole = errors("1/1");
    let mut parts: Vec<Value> = ["1/3", "2/3", "3/3"].into_iter().flat_map(errors).collect();
    parts.sort_by_key(|point| point["id"].as_u64());
    assert!(whole.len() > 6, "{} points", whole.len());
    assert_eq!(parts, whole);
    assert!(errors("99/99").is_empty());
}

#[test]
fn inpainting_is_a_fill_that_can_be_asked_for() {
    let folder = folder();
    let arguments = ["error", "crossing", "--quick", "--frames", "2", "--lanes=full", "--rungs=hold,metamer", "--json"];
    let document = json(folder.path(), &arguments);
    let points = document["sources"][0]["points"].as_array().unwrap();
    let of = |fill: &str| points.iter().find(|point| point["rung"] == fill).expect("a point");
    let flip = |fill: &str| of(fill)["summary"]["flip"].as_f64().unwrap();
    assert_ne!(flip("metamer"), flip("hold"));
    assert!(of("metamer")["compile_time"]["frame_us"].as_f64().unwrap() > 0.0);
}

/// Fields that no format is compiled for have the time of the form chosen at run time, and no other.
#[test]
fn fields_without_a_stand_in_have_one_time() {
    let folder = folder();
    let arguments =
        ["error", "crossing", "--quick", "--frames=2", "--lanes=velocity,acceleration", "--rungs=hold", "--json"];
    let document = json(folder.path(), &arguments);
    let source = &document["sources"][0];
    let (mut with, mut without) = (0, 0);
    for point in source["points"].as_array().unwrap().iter().filter(|point| point["scheme"] == "galpix") {
        assert!(point["run_time"]["frame_us"].as_f64().unwrap() > 0.0);
        if point["lanes"] == "velocity" {
            assert_eq!(point["stand_in"], "velocity in 3 words");
            assert!(point["compile_time"]["frame_us"].as_f64().unwrap() > 0.0);
            with += 1;
        } else {
            assert!(point["stand_in"].is_null() && point["compile_time"].is_null(), "{point}");
            without += 1;
        }
    }
    assert!(with > 0 && without > 0);
    let left_out: Vec<&str> =
        source["left_out"].as_array().unwrap().iter().filter_map(|sentence| sentence.as_str()).collect();
    assert!(
        left_out.iter().any(|sentence| sentence.contains("stand-in") && sentence.contains("acceleration")),
        "{left_out:?}"
    );
}

#[test]
fn a_capture_is_compared_by_age() {
    let folder = folder();
    let marbles = marbles();
    let arguments = ["error", marbles.to_str().unwrap(), "--quick", "--lanes=velocity", "--rungs=hold", "--json"];
    let document = json(folder.path(), &arguments);
    let source = &document["sources"][0];
    assert!(source["rates"].as_array().unwrap().is_empty());
    assert!(!source["ages"].as_array().unwrap().is_empty());
    assert!(source["points"][0]["summary"]["truth_worst_px"].is_null());
    assert!(source["causes"][0]["taylor_px"].is_null());
    let left_out = source["left_out"].as_array().unwrap();
    assert!(left_out.iter().any(|text| text.as_str().unwrap().contains("not known")), "{left_out:?}");
}

#[test]
fn what_cannot_be_used_is_refused_before_anything_is_written() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "in the way").unwrap();
    std::fs::write(folder.path().join("capture.toml"), "this is no manifest").unwrap();
    for (arguments, words) in [
        (["crossing", "nonsense"].as_slice(), ["nonsense", "galpix scenes"].as_slice()),
        (&["crossing", "./capture.toml"], &["capture.toml"]),
        (&["crossing", "--prop", "1"], &["this budget cannot exist", "2 frames or more"]),
        (&["crossing", "--extent", "0"], &["this budget cannot exist"]),
        (&["crossing", "--extent", "4000000000"], &["this budget cannot exist"]),
        (&["crossing", "--rungs", "paint"], &["paint"]),
        (&["crossing", "--scheme", "source", "--rungs", "bullet"], &["--rungs bullet", "push-pull"]),
        (&["crossing", "--lanes", "wheels"], &["wheels"]),
        (&["crossing", "--quick", "--full"], &["cannot be used with"]),
        (&["crossing", "--shard", "3/2"], &["--shard", "K from 1 to N"]),
        (&["crossing", "--shard", "0/2"], &["--shard", "K from 1 to N"]),
        (&["crossing", "--quick", "--out", "file/below"], &["cannot be written", "--out"]),
        (&[], &["SOURCE"]),
    ] {
        refused(folder.path(), &[&["error"], arguments].concat(), words);
        assert_eq!(entries(folder.path()), ["capture.toml", "file"].map(String::from).into(), "{arguments:?}");
    }
}
