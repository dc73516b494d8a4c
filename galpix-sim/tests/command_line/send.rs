//! `galpix send` into a file.

use std::collections::BTreeSet;

use crate::{done, entries, folder, json, marbles, refused};

#[test]
fn send_keeps_a_stream_in_a_file() {
    let folder = folder();
    let marbles = marbles();
    let marbles = marbles.to_string_lossy();
    let more = ["send", &marbles, "--to", "file:stream", "--panel", "lcd", "--updates", "2"];
    refused(folder.path(), &more, &["marbles", "one update", "--updates 2"]);
    let report = json(folder.path(), &["send", &marbles, "--to", "file:stream", "--panel", "lcd", "--json"]);
    assert_eq!((report["source"].as_str(), report["panel"].as_str()), (Some("marbles"), Some("lcd")));
    assert_eq!((report["width"].as_u64(), report["height"].as_u64()), (Some(320), Some(240)));
    assert_eq!(report["frames"].as_u64(), Some(18 * 240));
    assert!(report["device"].is_null());
    let length = std::fs::metadata(folder.path().join("stream")).unwrap().len();
    assert_eq!(report["bytes"].as_u64(), Some(length));
    let text = done(folder.path(), &["send", "drift", "--to", "file:stream", "--panel", "oled", "--updates", "2"]);
    assert!(text.starts_with("drift to oled (128x64): 384 frames of galpixels"), "{text}");
    assert!(text.contains("update 1, exact at frame 8: 8192 galpixels, 0 cells empty"), "{text}");
    assert_eq!(entries(folder.path()), BTreeSet::from(["stream".to_owned()]));
}
