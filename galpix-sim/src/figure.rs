//! The pictures in the documents, made by the engine itself.

use crate::experiment::{self, ExperimentError, Request, Source};
use crate::film::{self, Colours};

/// A film of a built-in scene: sample-and-hold beside galpix, from one update.
///
/// *Errors:* no such scene.
///
/// # Panics
/// If a film of pictures of one size cannot be encoded, which would be a defect.
pub fn before_and_after(scene: &str) -> Result<Vec<u8>, ExperimentError> {
    let Some(source) = crate::scene::find(scene).map(Source::Scene) else {
        return Err(ExperimentError::NoSuchSource(scene.to_owned()));
    };
    let mut pictures = Vec::new();
    let request = Request { perceptual: false, ..Request::default() };
    experiment::run(&source, &request, |shown| {
        let panels = [film::labelled(shown.hold, "sample-and-hold"), film::labelled(shown.picture, "galpix")];
        pictures.push(film::side_by_side(&panels.each_ref(), 4));
    })?;
    Ok(film::apng(&pictures, 120, Colours::Palette).expect("pictures of one size make a film"))
}
