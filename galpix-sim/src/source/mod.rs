//! Sources of updates: built-in scenes with exact truth, and captures.

pub mod capture;
pub mod ddoc;
pub mod fit;
pub mod hidden;
pub mod scene;

use std::path::Path;

use crate::suggest;
use crate::update::{Truth, Update};
use capture::{Capture, Census, ImportOptions};
use scene::Scene;

/// Where an update and its truth come from.
pub enum Source {
    /// A built-in scene.
    Scene(&'static dyn Scene),
    /// A capture from a manifest.
    Capture(Box<Capture>),
}

/// Why a source cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum SourceError {
    /// Neither a scene nor a file.
    #[error(
        "`{0}` is neither a built-in scene nor a capture{hint}: `galpix scenes` lists the scenes, or give the path of a \
         capture.toml",
        hint = suggest::hint(.0, scene::all().iter().map(|scene| scene.name()))
    )]
    NoSuchSource(String),
    /// The capture cannot be read.
    #[error("{0}")]
    Capture(#[from] capture::CaptureError),
}

impl Source {
    /// Opens a built-in scene by its name, or a capture by the path of its manifest or folder.
    ///
    /// *Errors:* one sentence that says what, where and how to correct it.
    pub fn open(name: &str, options: &ImportOptions) -> Result<Self, SourceError> {
        if let Some(scene) = scene::find(name) {
            return Ok(Self::Scene(scene));
        }
        let looks_like_a_path = name.contains(['/', '\\', '.']) || Path::new(name).exists();
        if !looks_like_a_path {
            return Err(SourceError::NoSuchSource(name.to_owned()));
        }
        Ok(Self::Capture(Box::new(capture::load(Path::new(name), options)?)))
    }

    /// Returns the scene's or the capture's name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Scene(scene) => scene.name(),
            Self::Capture(capture) => &capture.name,
        }
    }

    /// Returns what it shows.
    #[must_use]
    pub fn about(&self) -> &str {
        match self {
            Self::Scene(scene) => scene.about(),
            Self::Capture(capture) => &capture.about,
        }
    }

    /// Returns how many frames it is meant to be extrapolated.
    #[must_use]
    pub fn frames(&self) -> u32 {
        match self {
            Self::Scene(scene) => scene.frames(),
            Self::Capture(capture) => capture.frames,
        }
    }

    /// Returns the update.
    #[must_use]
    pub fn update(&self) -> Update {
        match self {
            Self::Scene(scene) => scene::update(*scene, 0.0),
            Self::Capture(capture) => capture.update.clone(),
        }
    }

    /// Returns the true picture of a frame, where it is known.
    #[must_use]
    pub fn truth(&self, frame: u32) -> Option<Truth> {
        match self {
            Self::Scene(scene) => Some(Truth { frame, picture: scene::render(*scene, f64::from(frame)), mask: None }),
            Self::Capture(capture) => capture.truths.iter().find(|truth| truth.frame == frame).cloned(),
        }
    }

    /// Returns those of the first `frames` frames whose true picture is known, in their order; none is rendered.
    #[must_use]
    pub fn truth_frames(&self, frames: u32) -> Vec<u32> {
        match self {
            Self::Scene(_) => (1..=frames).collect(),
            Self::Capture(capture) => {
                capture.truths.iter().map(|truth| truth.frame).filter(|frame| (1..=frames).contains(frame)).collect()
            }
        }
    }

    /// Returns what was known of the cells of a capture.
    #[must_use]
    pub fn census(&self) -> Option<&Census> {
        match self {
            Self::Scene(_) => None,
            Self::Capture(capture) => Some(&capture.census),
        }
    }
}
