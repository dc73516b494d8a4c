//! Cases as files: JSON, `$readmemh`, and their hashes.

use std::fmt::Write as _;

use crate::case::{Case, Content, Entry, FileHash, Manifest, schema};
use crate::hash::{crc32, hashes, json, sha256};
use crate::logic;

/// The format's name and version: another number where an old reader would go wrong.
pub const FORMAT: &str = "galpix-vectors-1";

/// What of the vectors is written.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Cases of these kinds; of all if there are none here.
    pub kinds: Vec<String>,
    /// Cases of these layouts and budgets, by the second part of a case's name; of all if there are none here.
    pub layouts: Vec<String>,
    /// What the stages of each frame of a frame case gave.
    pub stages: bool,
    /// Maps once more with a record a line.
    pub records: bool,
}

impl Choice {
    /// Returns whether a case is written.
    #[must_use]
    pub fn has(&self, case: &Case) -> bool {
        let listed = |list: &[String], name: &str| list.is_empty() || list.iter().any(|listed| listed == name);
        listed(&self.kinds, case.content.kind())
            && listed(&self.layouts, case.name.split('-').nth(1).unwrap_or_default())
    }
}

/// Gives the cases of a choice, the schema, the hashes of all cases and last the manifest to `save`, each with its path
/// in the folder of vectors and its text.
///
/// *Errors:* the first one of `save`.
pub fn write<E>(
    seed: u64,
    cases: &[Case],
    choice: &Choice,
    mut save: impl FnMut(&str, &str) -> Result<(), E>,
) -> Result<Manifest, E> {
    let mut put = |path: &str, text: &str| {
        save(path, text)?;
        Ok(FileHash { path: path.to_owned(), sha256: sha256(text.as_bytes()) })
    };
    put("schema.json", &json(&schema()))?;
    put("hashes.txt", &hashes(cases))?;
    let mut entries = Vec::with_capacity(cases.len());
    for case in cases.iter().filter(|case| choice.has(case)) {
        let name = &case.name;
        let mut files = vec![put(&format!("{name}/case.json"), &json(case))?];
        for (array, words) in arrays(&case.content) {
            files.push(put(&format!("{name}/{array}.hex"), &readmemh(name, &array, &words, 1))?);
        }
        for (array, words, a_line) in logic::arrays(&case.content, choice) {
            files.push(put(&format!("{name}/{array}.hex"), &readmemh(name, &array, &words, a_line))?);
        }
        if let Some(text) = logic::parameters(case) {
            files.push(put(&format!("{name}/params.svh"), &text)?);
        }
        let frames = match &case.content {
            Content::Frame(frames) => frames.frames.as_slice(),
            _ => &[],
        };
        entries.push(Entry {
            name: name.clone(),
            kind: case.content.kind().to_owned(),
            files,
            frames: frames.iter().map(|frame| frame.sha256.clone()).collect(),
            crc32: frames.iter().map(|frame| crc32(&frame.map)).collect(),
        });
    }
    let manifest = Manifest { format: FORMAT.to_owned(), seed, cases: entries };
    put("manifest.json", &json(&manifest))?;
    Ok(manifest)
}

/// Returns words as `$readmemh` reads them, so many on a line as make a number.
fn readmemh(case: &str, name: &str, words: &[u32], a_line: usize) -> String {
    let mut text = format!("// {case}: {name}, {} words\n", words.len());
    for number in words.chunks(a_line) {
        for word in number {
            let _ = write!(text, "{word:08x}");
        }
        text.push('\n');
    }
    text
}

/// Returns the arrays of a case by their names.
fn arrays(content: &Content) -> Vec<(String, Vec<u32>)> {
    let named = |list: Vec<(&str, Vec<u32>)>| list.into_iter().map(|(name, words)| (name.to_owned(), words)).collect();
    match content {
        Content::Step(step) => {
            let (inputs, results) = (&step.steps, &step.results);
            named(vec![
                ("frame", inputs.iter().map(|&(frame, ..)| frame).collect()),
                ("r", inputs.iter().map(|&(_, r, ..)| r as u32).collect()),
                ("v", inputs.iter().map(|&(_, _, v, _)| v as u32).collect()),
                ("a", inputs.iter().map(|&(.., a)| a as u32).collect()),
                ("position", results.iter().map(|&(position, ..)| position as u32).collect()),
                ("cells", results.iter().map(|&(_, cells, ..)| cells as u32).collect()),
                ("offset", results.iter().map(|&(_, _, offset, ..)| offset as u32).collect()),
                ("velocity", results.iter().map(|&(_, _, _, velocity, _)| velocity as u32).collect()),
                ("saturated", results.iter().map(|&(.., saturated)| saturated).collect()),
            ])
        }
        Content::Propagate(propagate) => named(vec![
            ("frame", propagate.galpixels.iter().map(|galpixel| galpixel.frame).collect()),
            ("before", propagate.galpixels.iter().flat_map(|galpixel| galpixel.words.iter().copied()).collect()),
            ("after", propagate.results.iter().flat_map(|moved| moved.words.iter().copied()).collect()),
            ("x_cells", propagate.results.iter().map(|moved| moved.cells[0] as u32).collect()),
            ("y_cells", propagate.results.iter().map(|moved| moved.cells[1] as u32).collect()),
            ("saturated", propagate.results.iter().map(|moved| moved.saturated).collect()),
        ]),
        Content::Resolve(resolve) => {
            let arrivals = &resolve.arrivals;
            named(vec![
                ("source", arrivals.iter().map(|arrival| arrival.source).collect()),
                ("cell", arrivals.iter().map(|arrival| arrival.cell.unwrap_or(u32::MAX)).collect()),
                ("arrivals", arrivals.iter().flat_map(|arrival| arrival.words.iter().copied()).collect()),
                ("map", resolve.map.clone()),
                ("winners", resolve.winners.clone()),
            ])
        }
        Content::Edge(edge) => named(vec![("front", edge.front.clone()), ("edges", edge.edges.clone())]),
        Content::Fill(fill) => named(vec![
            ("front", fill.front.clone()),
            ("resolved", fill.resolved.clone()),
            ("winners", fill.winners.clone()),
            ("edges", fill.edges.clone()),
            ("map", fill.map.clone()),
            ("winners_after", fill.winners_after.clone()),
        ]),
        Content::Inpaint(inpaint) => named(vec![
            ("front", inpaint.front.clone()),
            ("edges", inpaint.edges.clone()),
            ("mask", inpaint.mask.clone()),
            ("after", inpaint.after.clone()),
            ("map", inpaint.map.clone()),
        ]),
        Content::Layers(layers) => layers.arrays(),
        Content::Objects(objects) => objects.arrays(),
        Content::Disocclusion(map) => named(vec![
            ("front", map.front.clone()),
            ("marked", map.marked.clone()),
            ("spread", map.spread.clone()),
            ("mask", map.mask.clone()),
        ]),
        Content::SubCell(scan_out) => named(vec![("front", scan_out.front.clone()), ("shown", scan_out.shown.clone())]),
        Content::Source(sources) => sources.arrays(),
        Content::Frame(frames) => {
            let first = ("front".to_owned(), frames.front.clone());
            let after = (1..).zip(&frames.frames).map(|(n, frame)| (format!("map_{n}"), frame.map.clone()));
            std::iter::once(first).chain(after).collect()
        }
    }
}
