//! `galpix fit`.

use std::path::Path;

use crate::{done, entries, folder, json, refused};

#[test]
fn a_board_has_each_layout_with_each_fill() {
    let folder = folder();
    let document = json(folder.path(), &["fit", "rp2040", "--json"]);
    let boards = document["boards"].as_array().expect("boards");
    let rows = boards[0]["rows"].as_array().expect("rows");
    assert_eq!((boards.len(), rows.len()), (1, 6 * 7));
    for row in rows {
        assert!(row["sixty"].as_str().is_some_and(|text| text.contains("60 Hz needs") || text.contains("not fit")));
    }
    assert_eq!(json(folder.path(), &["fit", "all", "--json"])["boards"].as_array().map(Vec::len), Some(14));
    assert!(done(folder.path(), &["fit", "rp2350"]).contains("60 Hz needs"));
    assert!(done(folder.path(), &["fit", "stm32f407"]).contains("does not fit into the memory"));
    assert!(entries(folder.path()).is_empty(), "nothing is written");
    refused(folder.path(), &["fit", "z80"], &["is no board", "rp2040"]);
    refused(folder.path(), &["fit"], &["--help"]);
}

#[test]
fn a_source_gives_the_map_its_size() {
    let folder = folder();
    let [size, own] = [["fit", "rp2350", "crossing", "--json"].as_slice(), &["fit", "rp2350", "--json"]]
        .map(|arguments| json(folder.path(), arguments)["boards"][0]["map_width"].clone());
    assert_ne!(size, own);
}

#[test]
fn the_page_is_what_is_printed() {
    let folder = folder();
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/fit.md")).expect("a page");
    assert!(done(folder.path(), &["fit", "--page"]) == page, "docs/fit.md: make it anew with `galpix fit --page`");
}
