//! Every rule of section 21 has something to do in one of the cases.

use std::collections::{BTreeMap, BTreeSet};

use super::*;
use crate::case::{Case, Content};
use crate::choice::models;

/// The key of a cell without an entry.
const EMPTY: u32 = u16::MAX as u32;

/// An entry of a case.
struct Entry {
    cell: usize,
    point: bool,
    /// Layer and cell of the sample.
    sample: (usize, usize),
    residual: [i32; 2],
}

fn entries(sources: &StationarySources) -> Vec<Entry> {
    let sample = |mut number: usize| {
        let mut layers = sources.layers.iter().enumerate();
        let found = layers.find_map(|(layer, of)| match number.checked_sub(of.displacements.len()) {
            Some(beyond) => {
                number = beyond;
                None
            }
            None => Some((layer, number)),
        });
        found.expect("a number of a sample")
    };
    let shown = sources.keys.iter().zip(&sources.entries).enumerate().filter(|(_, (key, _))| **key != EMPTY);
    let signed = |part: u32| (part << 27) as i32 >> 27;
    shown
        .map(|(cell, (&key, &word))| {
            let residual = [signed(word >> 5), signed(word)];
            Entry { cell, point: key & 1 != 0, sample: sample((word >> 10) as usize), residual }
        })
        .collect()
}

/// Returns the name of a crack's direction. The sample that is nearest to a cell is at most half a cell away.
fn crack(Entry { point, residual: [u, v], .. }: &Entry) -> Option<&'static str> {
    match (point, u.abs() > 8, v.abs() > 8) {
        (true, true, false) => Some("a crack closed across"),
        (true, false, true) => Some("a crack closed down"),
        (true, true, true) if u.signum() == v.signum() => Some("a crack closed along the falling diagonal"),
        (true, true, true) => Some("a crack closed along the rising diagonal"),
        _ => None,
    }
}

/// Returns what happened in a case.
fn happened(name: &str, sources: &StationarySources) -> BTreeSet<String> {
    let mut happened = BTreeSet::new();
    let mut saw = |what: &str, so: bool| {
        if so {
            happened.insert(what.to_owned());
        }
    };
    let counts = serde_json::to_value(sources.counts).expect("counts");
    let count = |name: &str| counts[name].as_u64().expect("a count") as usize;
    let entries = entries(sources);
    saw("a quad drawn", entries.iter().any(|entry| !entry.point));
    let cracks: Vec<&str> = entries.iter().filter_map(crack).collect();
    for crack in &cracks {
        saw(crack, true);
    }
    saw("a crack closed that something was seen through", cracks.len() > count("bullets"));
    saw("a crack closed that was empty", count("bullets") > 0);
    saw("a sample lost", count("lost") > 0);
    saw("a collision", count("collided") > 0);
    // No field of these layouts saturates.
    let plain = name.contains("velocity565") || name.contains("plain565") || name.contains("gray8");
    saw("a displacement clamped", plain && count("saturated") > 0);
    let links = sources.layers.iter().flat_map(|layer| &layer.links);
    for pair in links.flat_map(|bits| [bits & 3, bits >> 2]) {
        saw(["no link", "the first one ends", "the second one ends", "a link"][pair as usize], true);
    }
    let bare = |entry: &&Entry| sources.sub_cell && entry.residual == [0, 0];
    let colours: Vec<Vec<u32>> = sources.layers.iter().map(|layer| colours(sources, layer)).collect();
    let stored = |(layer, cell): (usize, usize)| colours[layer][cell];
    let replaced = |entry: &Entry| sources.gathered[entry.cell] != stored(entry.sample);
    saw("a mixed rim replaced", entries.iter().filter(bare).any(replaced));
    saw("a colour between samples", entries.iter().any(|entry| sources.sub_cell && replaced(entry)));
    saw("a silhouette blended", sources.sub_cell && sources.shown != sources.gathered);
    for (cell, _) in sources.keys.iter().enumerate().filter(|(_, key)| **key == EMPTY) {
        let colour = sources.gathered[cell];
        saw(&format!("a hole of {}", sources.fill_mode), true);
        saw("a hole extended", sources.fill_mode == "extend" && colour != stored((0, cell)));
        saw("a hole with the colour that was there", sources.fill_mode == "hold" && colour == stored((0, cell)));
    }
    saw("equal depths in two layers", equal_depths(sources));
    for entry in entries.iter().filter(|entry| sources.layers[entry.sample.0].grid.is_some()) {
        saw("a sample of a layer with a grid of its own", true);
        saw("a quad of one", !entry.point);
        saw("a crack of one closed", crack(entry).is_some());
        saw("a colour between samples of one", sources.sub_cell && replaced(entry));
    }
    saw("no steps", sources.frames == 0);
    saw(&format!("{} layers", sources.layers.len()), true);
    happened
}

/// Returns the colours of a layer's cells after the steps.
fn colours(sources: &StationarySources, layer: &SourceLayer) -> Vec<u32> {
    let map = &layer.galpixels_after;
    let record = serde_json::to_value(&sources.setting.record).expect("a record");
    let field = record["fields"].as_array().expect("fields").iter().find(|field| field["name"] == "colour");
    let of = |key: &str| field.expect("a colour")[key].as_u64().expect("a number");
    let (word, cells) = (of("word") as usize, layer.displacements.len());
    let low = |cell| u64::from(map.get((word + 1) * cells + cell).copied().unwrap_or_default());
    let both = |cell: usize| u64::from(map[word * cells + cell]) << 32 | low(cell);
    (0..cells).map(|cell| (both(cell) >> (32 + of("shift") - of("spill")) & ((1 << of("bits")) - 1)) as u32).collect()
}

/// Whether entries of two layers have the same depth and kind.
fn equal_depths(sources: &StationarySources) -> bool {
    let mut keys: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    for entry in entries(sources) {
        keys.entry(sources.keys[entry.cell]).or_default().insert(entry.sample.0);
    }
    keys.values().any(|layers| layers.len() > 1)
}

fn of_seed(seed: u64) -> Vec<Case> {
    cases(seed, &models().expect("layouts")).expect("cases")
}

#[test]
fn every_rule_has_something_to_do() {
    let cases = of_seed(0);
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "two cases have one name");
    let mut seen: BTreeMap<String, u32> = BTreeMap::new();
    for case in &cases {
        let Content::Source(sources) = &case.content else { panic!("{} is of another kind", case.name) };
        for what in happened(&case.name, sources) {
            *seen.entry(what).or_default() += 1;
        }
    }
    for what in [
        "a quad drawn",
        "a crack closed across",
        "a crack closed down",
        "a crack closed along the falling diagonal",
        "a crack closed along the rising diagonal",
        "a crack closed that something was seen through",
        "a crack closed that was empty",
        "a sample lost",
        "a collision",
        "a displacement clamped",
        "no link",
        "a link",
        "the first one ends",
        "the second one ends",
        "a mixed rim replaced",
        "a colour between samples",
        "a silhouette blended",
        "a hole of none",
        "a hole of hold",
        "a hole of extend",
        "a hole extended",
        "a hole with the colour that was there",
        "equal depths in two layers",
        "no steps",
        "1 layers",
        "2 layers",
        "3 layers",
        "a sample of a layer with a grid of its own",
        "a quad of one",
        "a crack of one closed",
        "a colour between samples of one",
    ] {
        assert!(seen.contains_key(what), "in no case there is {what}: {seen:#?}");
    }
}
