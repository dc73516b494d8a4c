//! The disocclusion map as a picture.

use galpix_core::disocclusion::Extents;
use galpix_core::{Dynamic, Layout};

use crate::engine::EngineError;
use crate::picture::Picture;
use crate::source::hidden::{Culling, culling};
use crate::study::crops::Crop;
use crate::study::job::{ExperimentError, Job};
use crate::update::{Sample, Update};

/// Extents of so many cells and more have a full colour.
const FULL: u32 = 16;

/// Returns the update's luma, and over it what may be uncovered: red from the left, green from the right, blue from
/// above or below; the stronger the farther what is uncovered reaches from the cell. The margin is shown too.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn picture(job: &Job<'_>) -> Result<Crop, ExperimentError> {
    // The map does not know what brightens.
    let format = Dynamic::new(job.bits, Layout::FULL).map_err(EngineError::from)?;
    let map = culling(&job.update, format, job.frames)?;
    Ok(Crop { name: "what may be uncovered".into(), picture: coloured(&job.update, &map) })
}

fn coloured(update: &Update, map: &Culling) -> Picture {
    let strength = |cells: u32| cells.saturating_sub(1).min(FULL) * 255 / FULL;
    let pixel = |(&word, sample): (&u32, &Sample)| {
        let [r, g, b] = sample.colour.map(u32::from);
        let grey = (2 * r + 5 * g + b) / 16;
        let extents = Extents::of(word);
        if !extents.covered() {
            return [grey as u8; 3];
        }
        let [left, right] = [extents.left, extents.right].map(u32::from);
        let across = u32::from(extents.above).max(u32::from(extents.below));
        [left, right, across].map(|cells| (grey / 2 + 64 + strength(cells) / 2).min(255) as u8)
    };
    let pixels = map.extents.iter().zip(&update.samples).map(pixel).collect();
    Picture { width: update.width, height: update.height, pixels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Source, scene};
    use crate::study::job::Request;

    /// The ball leaves to the right and upwards: all of it may leave what is behind, and nothing is uncovered on its
    /// strategy.
    #[test]
    fn what_leaves_is_coloured_and_what_it_goes_to_is_not() {
        let source = Source::Scene(scene::find("ball").unwrap());
        let shown = picture(&Job::resolve(&source, &Request::default()).unwrap()).unwrap().picture;
        let update = source.update();
        for (cell, (pixel, sample)) in shown.pixels.iter().zip(&update.samples).enumerate() {
            let grey = pixel[0] == pixel[1] && pixel[1] == pixel[2];
            assert!(sample.tag != 2 || !grey, "{cell}: {pixel:?}");
            assert!(cell % update.width < 45 || grey, "{cell}: {pixel:?}");
        }
    }
}
