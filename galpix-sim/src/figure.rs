//! The pictures in the documents, made by the engine itself.

use crate::output::film::{self, Colours};
use crate::picture::Picture;
use crate::source::{Source, SourceError};
use crate::study::ddoc::{self, DdocError};
use crate::study::run::{self, ExperimentError, Request};

/// The names of the pictures.
pub const NAMES: [&str; 4] = ["crossing", "pan", "ddoc-pillars", "ddoc-portal"];

/// What the name of a picture of the DDOC begins with; its world follows.
const DDOC: &str = "ddoc-";

/// Why there is no such picture.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// A film cannot be made.
    #[error("{0}")]
    Film(#[from] ExperimentError),
    /// A picture of the DDOC cannot be made.
    #[error("{0}")]
    Ddoc(#[from] DdocError),
}

/// Returns the picture with this name, as a PNG.
///
/// *Errors:* no such scene or world.
pub fn made(name: &str) -> Result<Vec<u8>, FigureError> {
    match name.strip_prefix(DDOC) {
        Some(world) => Ok(around_edges(world)?),
        None => Ok(before_and_after(name)?),
    }
}

/// Returns a world's depth image, its DDOC image and distortion map, and below a pair of frames and the truth,
/// magnified.
///
/// *Errors:* no such world.
///
/// # Panics
/// If a picture in memory cannot be encoded, which would be a defect.
pub fn around_edges(world: &str) -> Result<Vec<u8>, DdocError> {
    let (_, pictures) = ddoc::study(&ddoc::open(world)?, &ddoc::Request::new(256))?;
    let panel = |name: &str, label: &str| {
        let picture = pictures.named(name).cloned().unwrap_or_else(|| Picture::filled(1, 1, film::GROUND));
        film::labelled(&picture, label)
    };
    let panels = [
        panel("plain", "depth image"),
        panel("ddoc", "DDOC image"),
        panel("map", "directions of the distortion"),
        panel("part-plain", "frame from the depth image"),
        panel("part-ddoc", "frame from the DDOC image"),
        panel("part-truth", "frame from geometry"),
    ];
    Ok(film::grid(&panels.each_ref(), 3, 4).png().expect("a picture in memory can be encoded"))
}

/// Returns a film of a built-in scene: sample-and-hold and galpix side by side, from one update.
///
/// *Errors:* no such scene.
///
/// # Panics
/// If a film of pictures of one size cannot be encoded, which would be a defect.
pub fn before_and_after(scene: &str) -> Result<Vec<u8>, ExperimentError> {
    let Some(source) = crate::source::scene::find(scene).map(Source::Scene) else {
        return Err(SourceError::NoSuchSource(scene.to_owned()).into());
    };
    let mut pictures = Vec::new();
    let request = Request { perceptual: false, ..Request::default() };
    run::run(&source, &request, |shown| {
        let panels = [film::labelled(shown.hold, "sample-and-hold"), film::labelled(shown.picture, "galpix")];
        pictures.push(film::side_by_side(&panels.each_ref(), 4));
    })?;
    Ok(film::apng(&pictures, 120, Colours::Palette).expect("pictures of one size make a film"))
}
