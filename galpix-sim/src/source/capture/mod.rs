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
mod coarse;
mod colour;
mod depth;
mod dpt;
mod error;
mod exr_planes;
mod flo;
mod folder;
mod hidden;
mod init;
mod manifest;
mod mixed;
mod motion;
mod npy;
mod orientation;
mod pfm;
mod plausible;
mod png_raster;
mod poses;
mod raster;
mod samples;
mod source;
#[cfg(test)]
mod tests;
mod vectors;

use std::path::Path;

use serde::Serialize;

pub use acceleration::AccelerationPolicy;
pub use error::CaptureError;
pub use folder::Files;
pub use init::{InitOptions, Proposal, init};

use crate::picture::Picture;
use crate::update::{Truth, Update};
use camera::{Distance, Track};
use coarse::Steps;
use folder::Folder;
use manifest::Manifest;
use raster::Canvas;
use source::{Size, Source};
use vectors::Moved;

/// The manifest's name in its folder.
const MANIFEST: &str = "capture.toml";

/// How a capture is imported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// What becomes of its accelerations.
    pub acceleration: AccelerationPolicy,
}

/// What was known of the cells of an update. Nothing is guessed silently.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
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
    /// Cells under an overlay that is drawn into the picture, too: they start empty, and are among `unknown_motion`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub under_overlay: Option<usize>,
    /// Cells whose requested acceleration is unknown: they move with their velocity.
    pub unknown_acceleration: usize,
    /// The step in which the motion comes, in pixels per display frame, where it comes in steps: a velocity is off by
    /// half of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion_step_px: Option<f64>,
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
    manifest: Manifest,
}

impl Capture {
    /// Returns the manifest as it was read, in TOML: with the values of all keys that have one, given or not.
    #[must_use]
    pub fn resolved(&self) -> String {
        self.manifest.resolved(&self.name)
    }
}

/// A capture while it is read: its manifest, where its files are, and what is known of its first layer.
#[derive(Clone, Copy)]
struct Opened<'c> {
    manifest: &'c Manifest,
    folder: Folder<'c>,
    size: Size,
    distances: &'c Distances,
}

/// Reads a colour picture of a capture: PNG, JPEG, or EXR with plain or `Combined` colours.
///
/// *Errors:* a file that cannot be read, is damaged, or is no such picture.
pub fn picture(file: &Path) -> Result<Picture, CaptureError> {
    colour::read(&Source::open(file)?, None, None, &mut Vec::new())
}

/// Reads a capture from its manifest, or from the folder that holds a `capture.toml`.
///
/// *Errors:* anything that cannot be read, does not fit together, or is not named in the format; see the module's text.
pub fn load(manifest: &Path, options: &ImportOptions) -> Result<Capture, CaptureError> {
    let path = if manifest.is_dir() { manifest.join(MANIFEST) } else { manifest.to_path_buf() };
    checked(&Source::open(&path)?, Folder::on_disk(path.parent().unwrap_or(Path::new("."))), options)
}

/// Reads a capture whose files are in memory; its manifest is the file `capture.toml`.
///
/// *Errors:* as of [`load`].
pub fn load_files(files: &Files, options: &ImportOptions) -> Result<Capture, CaptureError> {
    let folder = Folder::in_memory(files);
    checked(&folder.open(MANIFEST)?, folder, options)
}

/// Reads what a manifest names, and adds what its plausibility gives cause to remark.
fn checked(source: &Source, folder: Folder<'_>, options: &ImportOptions) -> Result<Capture, CaptureError> {
    let (mut capture, distances) = assembled(source, folder, options)?;
    let Capture { manifest, update, truths, census, .. } = &mut capture;
    let size = Size { width: update.width, height: update.height };
    let opened = Opened { manifest, folder, size, distances: &distances };
    plausible::check(opened, update, truths, census).map_err(|(what, hint)| source.fault(what, hint))?;
    Ok(capture)
}

/// The distance of each cell; nothing if there is no depth at all.
type Distances = Option<Vec<Distance>>;

/// Reads what a manifest names.
fn assembled(
    source: &Source,
    folder: Folder<'_>,
    options: &ImportOptions,
) -> Result<(Capture, Distances), CaptureError> {
    let manifest = Manifest::read(source)?;
    let update = &manifest.update;
    let channel = update.color.channel.as_deref().or(update.channel.as_deref());
    let mut census = Census::default();
    let file = folder.open(&update.color.file)?;
    let mut picture = colour::read(&file, channel, None, &mut census.notes)?;
    let size = Size { width: picture.width, height: picture.height };

    let canvas = &mut Canvas { size, notes: &mut census.notes };
    let distances = depth::read(&update.depth, update, folder, canvas)?;
    let opened = Opened { manifest: &manifest, folder, size, distances: &distances };
    let mut motion = moved(opened, options, &mut census)?;
    let unit = samples::Unit::of(&update.depth, &distances, &motion, &mut census.notes);
    let pinned = match &update.overlay {
        Some(overlay) => Some(colour::overlay(&folder.open(&overlay.file)?, size, &mut census.notes)?),
        None => None,
    };
    if let Some(touched) = pinned.as_ref().and_then(|pinned| pinned.drawn_into(&picture)) {
        colour::cover(&mut picture, touched);
        let covered = motion.iter_mut().zip(touched).filter(|(track, touched)| **touched && track.is_some());
        let count = covered.map(|(track, _)| *track = None).count();
        census.under_overlay = Some(count);
        census.notes.push(format!("the overlay is drawn into the colour, too: {count} cells under it start empty"));
    }
    let hidden = hidden::read(opened, unit, options, &mut census)?;
    let mut update = samples::assemble(unit, &picture, &distances, &motion, &mut census);
    update.overlay = pinned.map(|pinned| pinned.overlay);
    let truths = truths(&manifest, folder, size, &mut census)?;
    let name = manifest.name.clone().unwrap_or_else(|| folder.name());
    let (about, frames) = (manifest.about.clone(), manifest.frames);
    Ok((Capture { name, about, frames, update, hidden, truths, census, manifest }, distances))
}

/// Returns the motion of each cell with its acceleration, as the manifest and the user want it.
fn moved(opened: Opened<'_>, options: &ImportOptions, census: &mut Census) -> Result<Vec<Option<Track>>, CaptureError> {
    let Opened { manifest, distances, size, .. } = opened;
    let update = &manifest.update;
    let Moved { tracks: mut motion, steps } = motion::read(opened, census)?;
    let frames = f64::from(update.motion.frames());
    let mut left_out = 0;
    match &update.acceleration {
        Some(manifest::Acceleration::NextFlow(next)) => {
            let second = acceleration::chain(&mut motion, opened, next, census)?;
            let span = frames + f64::from(next.frames);
            let feigned = Steps([0, 1].map(|i| (steps.0[i] + second.0[i]) / span));
            left_out = acceleration::leave_out_feigned(&mut motion, feigned, frames);
        }
        Some(manifest::Acceleration::No) => acceleration::leave_out(&mut motion),
        Some(manifest::Acceleration::AsMotion) | None => {
            if matches!(update.motion, manifest::Motion::BlenderVector(_)) {
                let feigned = Steps(steps.0.map(|step| step / frames));
                left_out = acceleration::leave_out_feigned(&mut motion, feigned, 0.0);
            }
        }
    }
    let off = steps.largest() / 2.0 * f64::from(manifest.frames);
    if off > 0.5 {
        let [x, y] = steps.0;
        census.motion_step_px = Some(steps.largest());
        census.notes.push(format!(
            "the motion comes in steps of {x:.4} px in x and {y:.4} px in y a frame: after {} frames a position is off \
             by up to {off:.2} px because of it",
            manifest.frames
        ));
        if left_out > 0 {
            census.notes.push(format!(
                "{left_out} cells have an acceleration that such steps can feign: they move with their velocity"
            ));
        }
    }
    acceleration::apply(options.acceleration, &mut motion, distances, size, manifest.frames);
    Ok(motion)
}

fn truths(
    manifest: &Manifest,
    folder: Folder<'_>,
    size: Size,
    census: &mut Census,
) -> Result<Vec<Truth>, CaptureError> {
    /// Most remarks about truths: each of them would have the same.
    const MOST_NOTES: usize = 2;
    let mut notes = Vec::new();
    let mut truth = |truth: &manifest::Truth| {
        let channel = truth.color.channel.as_deref().or(truth.channel.as_deref());
        let picture = colour::read(&folder.open(&truth.color.file)?, channel, Some(size), &mut notes)?;
        let mask = match &truth.mask {
            Some(file) => Some(colour::mask(&folder.open(file)?, size)?),
            None => None,
        };
        Ok(Truth { frame: truth.frame, picture, mask })
    };
    let truths = manifest.truth.iter().map(&mut truth).collect();
    notes.retain(|note| !census.notes.contains(note));
    let more = notes.len().saturating_sub(MOST_NOTES);
    census.notes.extend(notes.into_iter().take(MOST_NOTES));
    if more > 0 {
        census.notes.push(format!("{more} more remarks of this kind about pictures of the truth"));
    }
    truths
}
