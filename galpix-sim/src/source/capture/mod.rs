//! Captures: real input from a folder with a `capture.toml`.
//!
//! ```text
//! manifest ─▶ source (bytes, limits) ─▶ colour, raster formats ─▶ depth ─▶ motion ─▶ samples ─▶ Update
//! ```
//!
//! Positions are in pixels, x to the right, y down; frame 0 is the update; times are in display frames. Whatever is
//! read is hostile: sizes are checked before anything of that size is allocated, and every refusal is one sentence that
//! names the file and the hint.

mod acceleration;
mod camera;
mod colour;
mod depth;
mod dpt;
mod error;
mod exr_planes;
mod flo;
mod hidden;
mod manifest;
mod mixed;
mod motion;
mod npy;
mod pfm;
mod png_raster;
mod poses;
mod raster;
mod samples;
mod source;
#[cfg(test)]
mod tests;

use std::path::Path;

use serde::Serialize;

pub use acceleration::AccelerationPolicy;
pub use error::CaptureError;

use crate::picture::Picture;
use crate::update::{Truth, Update};
use camera::Distance;
use manifest::Manifest;
use source::{Size, Source};

/// How a capture is imported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// What becomes of its accelerations.
    pub acceleration: AccelerationPolicy,
}

/// What was known of the cells of an update. Nothing is guessed silently.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Census {
    /// Cells with depth and motion.
    pub known: usize,
    /// Cells without a usable depth: they start empty.
    pub unknown_depth: usize,
    /// Cells with a depth but without a usable motion: they start empty.
    pub unknown_motion: usize,
    /// Cells that are infinitely far; they are among `known`, unless the background is empty.
    pub far: usize,
    /// Cells behind whose sample another one is known, if that was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hidden: Option<usize>,
    /// Cells whose requested acceleration is unknown: they move with their velocity.
    pub unknown_acceleration: usize,
    /// Remarks, one sentence each.
    pub notes: Vec<String>,
}

/// An update from a capture, and the true pictures that came later.
#[derive(Clone, Debug)]
pub struct Capture {
    /// Its name; the folder's if it gives none.
    pub name: String,
    /// What it shows.
    pub about: String,
    /// Display frames from the update to the last truth.
    pub frames: u32,
    /// The update.
    pub update: Update,
    /// What is known behind the update's samples, over the same cells; cells without are empty.
    pub hidden: Option<Update>,
    /// In ascending frames.
    pub truths: Vec<Truth>,
    /// What was known.
    pub census: Census,
}

/// A capture while it is read: its manifest, where its files are, and what is known of its first layer.
#[derive(Clone, Copy)]
struct Opened<'c> {
    manifest: &'c Manifest,
    folder: &'c Path,
    size: Size,
    /// Of each cell; nothing if there is no depth at all.
    distances: &'c Option<Vec<Distance>>,
}

/// Reads a colour picture of a capture: PNG, JPEG, or EXR with plain or `Combined` colours.
///
/// *Errors:* a file that cannot be read, is damaged, or is no such picture.
pub fn picture(file: &Path) -> Result<Picture, CaptureError> {
    colour::read(&Source::open(file)?, None, None)
}

/// Reads a capture from its manifest, or from the folder that holds a `capture.toml`.
///
/// *Errors:* anything that cannot be read, does not fit together, or is not named in the format; see the module's text.
pub fn load(manifest: &Path, options: &ImportOptions) -> Result<Capture, CaptureError> {
    let path = if manifest.is_dir() { manifest.join("capture.toml") } else { manifest.to_path_buf() };
    let manifest = Manifest::read(&path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let update = &manifest.update;
    let channel = update.color.channel.as_deref().or(update.channel.as_deref());
    let picture = colour::read(&Source::open(&folder.join(&update.color.file))?, channel, None)?;
    let size = Size { width: picture.width, height: picture.height };

    let mut census = Census::default();
    let distances = depth::read(&update.depth, folder, size)?;
    let opened = Opened { manifest: &manifest, folder, size, distances: &distances };
    let mut motion = motion::read(opened, &mut census)?;
    if let Some(manifest::Acceleration::NextFlow(flow)) = &update.acceleration {
        acceleration::chain(&mut motion, opened, flow, &mut census)?;
    }
    if matches!(update.acceleration, Some(manifest::Acceleration::No)) {
        acceleration::leave_out(&mut motion);
    }
    acceleration::apply(options.acceleration, &mut motion, &distances, size, manifest.frames);
    let unit = samples::Unit::of(&update.depth, &distances, &motion);
    let overlay = match &update.overlay {
        Some(overlay) => Some(colour::overlay(&Source::open(&folder.join(&overlay.file))?, size, &mut census)?),
        None => None,
    };
    let hidden = hidden::read(opened, unit, options, &mut census)?;
    let mut update = samples::assemble(unit, &picture, &distances, &motion, &mut census);
    update.overlay = overlay;
    let name = manifest.name.clone().unwrap_or_else(|| folder_name(folder));
    let truths = truths(&manifest, folder, size)?;
    Ok(Capture { name, about: manifest.about.clone(), frames: manifest.frames, update, hidden, truths, census })
}

fn truths(manifest: &Manifest, folder: &Path, size: Size) -> Result<Vec<Truth>, CaptureError> {
    let truth = |truth: &manifest::Truth| {
        let channel = truth.color.channel.as_deref().or(truth.channel.as_deref());
        let picture = colour::read(&Source::open(&folder.join(&truth.color.file))?, channel, Some(size))?;
        let mask = match &truth.mask {
            Some(file) => Some(colour::mask(&Source::open(&folder.join(file))?, size)?),
            None => None,
        };
        Ok(Truth { frame: truth.frame, picture, mask })
    };
    manifest.truth.iter().map(truth).collect()
}

fn folder_name(folder: &Path) -> String {
    let absolute = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    absolute.file_name().map_or_else(|| "capture".to_owned(), |name| name.to_string_lossy().into_owned())
}
