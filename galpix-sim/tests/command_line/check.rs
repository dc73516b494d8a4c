//! `galpix check`.

use crate::{done, entries, folder, json, refused};

/// What is printed of a capture is a manifest that reads the same capture, with all keys that have a value.
#[test]
fn a_capture_is_described_and_its_manifest_is_whole() {
    let folder = folder();
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../captures/marbles");
    let document = json(folder.path(), &["check", source, "--json"]);
    assert!(entries(folder.path()).is_empty(), "with --json nothing is written");
    for key in ["speed_px", "depth", "acceleration_px"] {
        let of = |name: &str| document[key][name].as_f64().unwrap_or_else(|| panic!("{key} {name}"));
        assert!(of("least") <= of("quarter") && of("median") <= of("three_quarters"), "{key}");
        assert!(of("ninety_nine") <= of("most"), "{key}");
        let counts = document[key]["counts"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap());
        assert_eq!(counts.sum::<u64>(), document["known"].as_u64().unwrap(), "{key}");
    }
    let first = &document["first"];
    assert!(first["psnr_db"].as_f64() > first["psnr_hold_db"].as_f64(), "{first}");
    let manifest = document["manifest"].as_str().unwrap();
    let table: toml::Table = manifest.parse().unwrap();
    assert_eq!(table["update"]["depth"]["scale"].as_float(), Some(1.0), "{manifest}");
    assert!(table["update"].get("background").is_some(), "{manifest}");

    // The same from a copy with this manifest.
    let copy = folder.path().join("copy");
    for part in ["", "frames"] {
        std::fs::create_dir(copy.join(part)).unwrap();
        for entry in std::fs::read_dir(std::path::Path::new(source).join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                std::fs::copy(&path, copy.join(part).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    std::fs::write(copy.join("capture.toml"), manifest).unwrap();
    let again = json(folder.path(), &["check", "copy", "--json"]);
    for key in ["manifest", "speed_px", "depth", "known", "notes", "first"] {
        assert_eq!(again[key], document[key], "{key}");
    }
}

#[test]
fn a_scene_is_described_and_its_motion_painted() {
    let folder = folder();
    let text = done(folder.path(), &["check", "pan", "--out", "here"]);
    for words in ["speed, px a frame", "depth, 0 nearest", "frame 1: ", "sample-and-hold"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(folder.path().join("here/motion.png").exists());
    refused(folder.path(), &["check", "nowhere"], &["nowhere", "galpix scenes"]);
}
