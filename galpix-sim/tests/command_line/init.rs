//! `galpix init`.

use crate::{done, entries, folder, refused};

/// The frames and passes of the capture that comes with the program, without its manifest.
fn marbles(folder: &std::path::Path) {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../captures/marbles");
    for part in ["", "frames"] {
        std::fs::create_dir_all(folder.join("m").join(part)).unwrap();
        for entry in std::fs::read_dir(std::path::Path::new(source).join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() && path.extension().is_none_or(|ending| ending != "toml") {
                std::fs::copy(&path, folder.join("m").join(part).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
}

#[test]
fn what_it_writes_runs_and_is_never_overwritten() {
    let folder = folder();
    marbles(folder.path());
    let before = entries(&folder.path().join("m"));
    let printed = done(folder.path(), &["init", "m", "--print"]);
    assert_eq!(entries(&folder.path().join("m")), before);
    let said = done(folder.path(), &["init", "m"]);
    assert!(said.contains("is written") && said.contains("galpix check m"), "{said}");
    let written = std::fs::read_to_string(folder.path().join("m/capture.toml")).unwrap();
    assert_eq!(written, printed);
    let checked = done(folder.path(), &["check", "m", "--out", "here"]);
    assert!(checked.contains("frame 1: "), "{checked}");
    refused(folder.path(), &["init", "m"], &["capture.toml is there already", "--print"]);
    refused(folder.path(), &["init", "m", "--json"], &["capture.toml is there already"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("m/capture.toml")).unwrap(), written);
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    refused(folder.path(), &["init", "empty"], &["no picture in colour"]);
    refused(folder.path(), &["init", "nowhere"], &["nowhere", "cannot be listed"]);
    refused(folder.path(), &["init", "empty", "--step", "0"], &["--step"]);
    refused(folder.path(), &["init", "empty", "--intrinsics", "1,2,3"], &["--intrinsics"]);
    refused(folder.path(), &["init", "empty", "--intrinsics", "0,1,2,3"], &["--intrinsics", "above 0"]);
    assert!(entries(&folder.path().join("empty")).is_empty());
}
