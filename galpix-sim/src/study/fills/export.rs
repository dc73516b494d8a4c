//! The pictures as files, for programs that fill the same holes in another way or judge them by another measure.
//!
//! `SOURCE/FRAME/` holds `truth.png`, `mask.png` (white: disoccluded, what is judged), `mask_all.png` (white: all that
//! nothing reached), `warped.png` (those cells black) and `NAME.png` for each fill, of stationary sources
//! `source-NAME.png`. `index.json` lists them; it is written last, so that where it is, the pictures are.

use std::path::{Component, Path, PathBuf};

use serde::Serialize;

use super::Document;
use super::report::FrameCells;
use crate::output::save::file_name;
use crate::picture::Picture;
use crate::source::Source;
use crate::study::holes::Holes;

/// A file that cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{} cannot be written ({error}): choose another folder with --out", path.display())]
pub struct ExportError {
    path: PathBuf,
    error: std::io::Error,
}

/// A folder that pictures are written to.
#[derive(Clone, Debug)]
pub struct Export {
    root: PathBuf,
}

#[derive(Serialize)]
struct Index<'d> {
    version: &'static str,
    command: &'d str,
    fovea: Option<u32>,
    sources: Vec<IndexSource<'d>>,
}

#[derive(Serialize)]
struct IndexSource<'d> {
    source: &'d str,
    width: usize,
    height: usize,
    frames: Vec<IndexFrame>,
}

/// Paths are relative to the index.
#[derive(Serialize)]
struct IndexFrame {
    #[serde(flatten)]
    cells: FrameCells,
    truth: String,
    mask: String,
    mask_all: String,
    warped: String,
    fills: Vec<IndexFill>,
}

#[derive(Serialize)]
struct IndexFill {
    name: &'static str,
    scheme: &'static str,
    file: String,
}

impl Export {
    /// Into a folder that can be written to.
    #[must_use]
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// Removes the pictures that an earlier run listed, and its list; returns how many there were.
    pub fn clear(&self) -> usize {
        let list = self.root.join("index.json");
        let index: Option<serde_json::Value> =
            std::fs::read_to_string(&list).ok().and_then(|text| serde_json::from_str(&text).ok());
        let Some(sources) = index.as_ref().and_then(|index| index["sources"].as_array()) else { return 0 };
        let frames = sources.iter().filter_map(|source| source["frames"].as_array()).flatten();
        let files = frames.flat_map(|frame| {
            let own = ["truth", "mask", "mask_all", "warped"].into_iter().filter_map(|key| frame[key].as_str());
            own.chain(frame["fills"].as_array().into_iter().flatten().filter_map(|fill| fill["file"].as_str()))
        });
        // A list may come from elsewhere: what is removed lies inside of the folder and is a picture.
        let inside = |file: &&str| {
            let path = Path::new(file);
            path.extension().is_some_and(|extension| extension == "png")
                && path.components().all(|part| matches!(part, Component::Normal(_)))
        };
        let removed = files.filter(inside).filter(|file| {
            let path = self.root.join(file);
            let gone = std::fs::remove_file(&path).is_ok();
            // Only folders that are empty go.
            path.ancestors().skip(1).take(2).for_each(|folder| drop(std::fs::remove_dir(folder)));
            gone
        });
        let removed = removed.count();
        // Where it stays, the next one replaces it.
        let _ = std::fs::remove_file(&list);
        removed
    }

    /// Writes what there is of a frame besides the fills.
    ///
    /// *Errors:* a file or folder that cannot be written.
    pub fn truth(&self, source: &Source, holes: &Holes) -> Result<(), ExportError> {
        let folder = self.root.join(frame_folder(source.name(), holes.frame));
        std::fs::create_dir_all(&folder).map_err(|error| ExportError { path: folder.clone(), error })?;
        let mask = |cells: &[bool]| Picture {
            width: holes.truth.width,
            height: holes.truth.height,
            pixels: cells.iter().map(|&set| [if set { 255 } else { 0 }; 3]).collect(),
        };
        self.write(&folder.join("truth.png"), &holes.truth)?;
        self.write(&folder.join("mask.png"), &mask(&holes.disoccluded))?;
        self.write(&folder.join("mask_all.png"), &mask(&holes.all))?;
        self.write(&folder.join("warped.png"), &holes.warped)
    }

    /// Writes what a fill shows in a frame.
    ///
    /// *Errors:* a file that cannot be written.
    pub fn filled(&self, source: &Source, holes: &Holes, label: &str, shown: &Picture) -> Result<(), ExportError> {
        self.write(&self.root.join(frame_folder(source.name(), holes.frame)).join(format!("{label}.png")), shown)
    }

    /// Thousands of small pictures: not one by one through to the disk. The index comes when all are there.
    fn write(&self, path: &Path, picture: &Picture) -> Result<(), ExportError> {
        let written = picture.png().and_then(|bytes| std::fs::write(path, bytes));
        written.map_err(|error| ExportError { path: path.to_owned(), error })
    }
}

/// Returns `index.json`: what was written.
///
/// *Errors:* those of the serialiser; none for a document.
pub fn index(document: &Document) -> serde_json::Result<String> {
    let source = |report: &'_ super::report::SourceReport| -> Vec<IndexFrame> {
        let frame = |&cells: &FrameCells| {
            let at = |name: &str| format!("{}/{name}.png", frame_folder(&report.source, cells.frame));
            let fills = report.fills.iter().map(|fill| IndexFill {
                name: fill.name,
                scheme: fill.scheme,
                file: at(&fill.label),
            });
            IndexFrame {
                truth: at("truth"),
                mask: at("mask"),
                mask_all: at("mask_all"),
                warped: at("warped"),
                fills: fills.collect(),
                cells,
            }
        };
        report.cells.iter().map(frame).collect()
    };
    let sources = document.sources.iter().map(|report| IndexSource {
        source: &report.source,
        width: report.width,
        height: report.height,
        frames: source(report),
    });
    let index = Index {
        version: document.version,
        command: &document.command,
        fovea: document.extra.fovea,
        sources: sources.collect(),
    };
    Ok(serde_json::to_string_pretty(&index)? + "\n")
}

/// Returns the folder of a frame, from the root. A capture's name comes from outside.
fn frame_folder(source: &str, frame: u32) -> String {
    format!("{}/{frame:04}", file_name(source))
}
