//! What a source has behind its first layer.

use super::{Kind, Layer};
use crate::engine::EngineError;
use crate::source::Source;
use crate::source::ddoc::{self, distortion};
use crate::source::scene::{self, Peel, Scene};
use crate::update::{Known, Sample, Update};

/// Returns what a source has behind its first layer, or all that it has if that is unlimited; nothing if it has nothing
/// of this kind.
///
/// *Errors:* a scene that is too large for a map.
pub(super) fn offered(source: &Source, kind: Kind) -> Result<Vec<Layer>, EngineError> {
    let layers = match (kind, source) {
        (Kind::None, _) => Vec::new(),
        (Kind::Second { separation }, Source::Scene(scene)) => {
            scene::behind(*scene, 0.0, &Peel { layers: 1, separation, backs: true })
        }
        (Kind::Unlimited, Source::Scene(scene)) => scene::each(*scene, 0.0),
        (Kind::Second { separation }, Source::Capture(capture)) => {
            capture.hidden.iter().map(|second| apart(&capture.update, second, separation)).collect()
        }
        (Kind::Ddoc { radius }, Source::Scene(scene)) => return Ok(vec![around_edges(*scene, radius)?]),
        (Kind::Ddoc { .. } | Kind::Unlimited, Source::Capture(_)) => Vec::new(),
    };
    Ok(layers.into_iter().map(Layer::Moving).collect())
}

/// Returns what a DDOC has of a scene that the plain picture does not show.
fn around_edges(scene: &dyn Scene, radius: u32) -> Result<Layer, EngineError> {
    let settings = galpix_core::ddoc::Settings { radius, ..distortion::settings() };
    let (samples, _) = ddoc::hidden::hidden(scene, &settings)?;
    let mut update = empty(&scene::update(scene, 0.0));
    let mut displacements = vec![[0; 2]; update.samples.len()];
    let mut offsets = vec![[0.0; 2]; update.samples.len()];
    for hidden in samples.iter().filter(|sample| sample.hidden) {
        let cell = hidden.cell[1] as usize * update.width + hidden.cell[0] as usize;
        update.samples[cell] = hidden.sample;
        displacements[cell] = hidden.displacement();
        offsets[cell] = hidden.offset();
    }
    Ok(Layer::Stationary { update, displacements, offsets })
}

/// Returns a layer without the samples that lie less than a separation behind those of the first.
fn apart(first: &Update, second: &Update, separation: f64) -> Update {
    let keep = |(first, second): (&Sample, &Sample)| {
        let behind = first.known != Known::Motion || second.depth >= first.depth + separation;
        if behind { *second } else { Sample { known: Known::ColourOnly, ..*second } }
    };
    Update { samples: first.samples.iter().zip(&second.samples).map(keep).collect(), ..second.clone() }
}

/// Returns an update over the same cells with nothing in it.
pub(super) fn empty(update: &Update) -> Update {
    let nothing = Sample { known: Known::ColourOnly, ..Sample::default() };
    Update { samples: vec![nothing; update.samples.len()], ..update.clone() }
}
