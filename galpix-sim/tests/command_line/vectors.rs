//! `galpix vectors`.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::{done, folder, json, refused};

#[test]
fn vectors_are_written_whole_and_again_the_same() {
    let folder = folder();
    let read = |path: &str| -> Value {
        let text = std::fs::read_to_string(folder.path().join(path)).expect("the manifest");
        serde_json::from_str(&text).expect("JSON")
    };
    let manifest = |out: &str| read(done(folder.path(), &["vectors", "--out", out]).trim());
    let (one, again) = (manifest("a"), manifest("b"));
    let written = json(folder.path(), &["vectors", "--out", "c", "--seed", "1", "--json"]);
    let other = read(written["manifest"].as_str().expect("its path"));
    assert_eq!((&written["kind"], &written["seed"]), (&"vectors".into(), &1.into()));
    assert_eq!(written["cases"].as_u64(), other["cases"].as_array().map(|cases| cases.len() as u64));
    assert_eq!(one, again);
    assert_ne!(one["cases"], other["cases"]);
    let kinds: BTreeSet<&str> =
        one["cases"].as_array().expect("cases").iter().filter_map(|case| case["kind"].as_str()).collect();
    let known = [
        "step",
        "propagate",
        "resolve",
        "edge",
        "fill",
        "frame",
        "inpaint",
        "layers",
        "objects",
        "disocclusion",
        "subcell",
        "source",
    ];
    assert_eq!(kinds, BTreeSet::from(known));
    for case in one["cases"].as_array().expect("cases") {
        for file in case["files"].as_array().expect("files") {
            assert!(folder.path().join("a").join(file["path"].as_str().expect("a path")).is_file(), "{file}");
        }
    }
    assert!(folder.path().join("a/schema.json").is_file() && folder.path().join("a/hashes.txt").is_file());
    let few =
        manifest_of(&read, done(folder.path(), &["vectors", "--out", "d", "--kind", "frame", "--layout", "gray4"]));
    assert!(few.iter().all(|name| name.starts_with("frame-gray4-")) && few.len() > 10, "{few:?}");
    refused(folder.path(), &["vectors", "--out", "d", "--kind", "none"], &["no such case", "--kind"]);
    std::fs::write(folder.path().join("file"), "kept").expect("a file");
    refused(folder.path(), &["vectors", "--out", "file"], &["cannot be written", "--out"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("file")).expect("the file"), "kept");
}

/// Returns the names of the cases of a manifest.
fn manifest_of(read: &impl Fn(&str) -> Value, printed: String) -> Vec<String> {
    let manifest = read(printed.trim());
    let cases = manifest["cases"].as_array().expect("cases");
    cases.iter().filter_map(|case| case["name"].as_str().map(str::to_owned)).collect()
}
