//! `galpix ddoc`.

use serde_json::Value;

use crate::{done, entries, folder, json, picture, read, refused};

/// Returns a cube with colours at its corners, as some programs write them.
fn cube() -> String {
    let mut obj = String::from("o cube\n");
    for corner in 0..8 {
        let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2];
        obj += &format!("v {x} {y} {z} {x}.5 {y}.25 0.5\n");
    }
    for face in ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"] {
        obj += &format!("f {face}\n");
    }
    obj
}

#[test]
fn page_values_and_pictures_say_the_same() {
    let folder = folder();
    std::fs::write(folder.path().join("cube.obj"), cube()).unwrap();
    let printed = done(folder.path(), &["ddoc", "cube.obj", "--size", "128", "--out", "here/deep"]);
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.last(), Some(&"here/deep/ddoc.html"));
    let out = folder.path().join("here/deep");
    let document: Value = serde_json::from_str(&read(&out.join("ddoc.json"))).unwrap();
    let source = &document["sources"][0];
    assert_eq!((source["source"].as_str(), source["radius"].as_u64()), (Some("cube"), Some(4)));
    let count = |key: &str| source[key].as_u64().unwrap_or_else(|| panic!("{key}"));
    assert!(count("missing_plain") > count("missing_ddoc") && count("strict_plain") >= count("missing_plain"));
    assert!(source["seconds"]["total"].as_f64().unwrap() > 0.0);
    let ratio = count("missing_ddoc") as f64 / count("missing_plain") as f64;
    assert!((source["ratio"].as_f64().unwrap() - ratio).abs() < 1e-12);
    assert!(lines[1].starts_with("cube ") && lines[1].contains(&format!("{:.1} %", 100.0 * ratio)), "{}", lines[1]);

    let page = read(&out.join("ddoc.html"));
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    assert!(!page.contains("http:") && !page.contains("https:"), "the page loads something");
    assert_eq!(page.matches("<img ").count(), 9);
    let picture = |name: &str| picture(&out.join(format!("cube-{name}.png")));
    let size = |name: &str| (picture(name).width, picture(name).height);
    assert_eq!((size("plain"), size("ddoc")), ((128, 128), (128, 128)));
    assert_ne!(picture("plain"), picture("ddoc"));
    let white = |name: &str| picture(name).pixels.iter().filter(|&&pixel| pixel == [255; 3]).count();
    assert!(white("frame-plain") > white("frame-ddoc"), "what is missing is white");
}

#[test]
fn json_is_one_document_and_writes_nothing() {
    let folder = folder();
    let arguments = ["ddoc", "knot", "--size", "96", "--radius", "5", "--asymmetry", "1.5", "--json"];
    let document = json(folder.path(), &arguments);
    let source = &document["sources"][0];
    assert_eq!((source["size"].as_u64(), source["radius"].as_u64()), (Some(96), Some(5)));
    assert_eq!((source["asymmetry"].as_f64(), source["views"].as_u64()), (Some(1.5), Some(26)));
    assert!(entries(folder.path()).is_empty());
}

#[test]
fn what_cannot_be_used_is_refused_in_one_sentence() {
    let folder = folder();
    let hostile: [(&str, &[u8], &str); 11] = [
        ("empty.obj", b"", "no triangle with an area"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n", "no triangle with an area"),
        ("flat.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no triangle with an area"),
        ("spot.obj", b"v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "no triangle with an area"),
        ("nan.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not at a finite place"),
        ("infinite.obj", b"v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n", "not at a finite place"),
        ("beyond.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "no OBJ file that can be read"),
        ("before.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n", "no OBJ file that can be read"),
        ("words.obj", b"v a b c\n", "no OBJ file that can be read"),
        ("binary.obj", b"v \xff\xfe\x00\x01\n", "no OBJ file that can be read"),
        ("huge.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 99999999999999999999 2 3\n", "no OBJ file that can be read"),
    ];
    for (name, bytes, _) in hostile {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    std::fs::create_dir(folder.path().join("folder.obj")).unwrap();
    // More triangles than are possible, from few bytes: a fan around one corner.
    let corners = (1 << 21) + 4;
    let many = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(corners / 3 + 1));
    std::fs::write(folder.path().join("many.obj"), many).unwrap();
    let mut cases: Vec<(&str, &str)> = hostile.iter().map(|&(name, _, what)| (name, what)).collect();
    cases.extend([
        ("absent.obj", "cannot be opened"),
        ("folder.obj", "it is no file"),
        ("many.obj", "triangles, and 2097152 are possible"),
        ("nowhere", "is no world"),
        ("a\u{1b}[31m.obj", "cannot be opened"),
    ]);
    for (name, what) in cases {
        refused(folder.path(), &["ddoc", name, "--size", "64"], &[what]);
    }
    for (arguments, what) in [
        (["knot", "--size", "63"], "64 to 2048"),
        (["knot", "--size", "2049"], "64 to 2048"),
        (["knot", "--radius", "0"], "--radius"),
        (["knot", "--radius", "256"], "--radius"),
        (["knot", "--asymmetry", "0.9"], "1 to 15"),
        (["knot", "--asymmetry", "nan"], "1 to 15"),
    ] {
        refused(folder.path(), &[&["ddoc"], arguments.as_slice()].concat(), &[what]);
    }
}
