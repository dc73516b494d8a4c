//! `galpix scenes`.

use crate::{SCENES, done, folder, json};

#[test]
fn scenes_lists_all_eleven() {
    let folder = folder();
    let text = done(folder.path(), &["scenes"]);
    let names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, SCENES);
    let list = json(folder.path(), &["scenes", "--json"]);
    let names: Vec<&str> =
        list["scenes"].as_array().unwrap().iter().filter_map(|scene| scene["name"].as_str()).collect();
    assert_eq!(names, SCENES);
    assert!(
        list["scenes"]
            .as_array()
            .unwrap()
            .iter()
            .all(|scene| scene["about"].as_str().is_some_and(|about| about.len() > 20))
    );
}
