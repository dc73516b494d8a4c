//! What an update has behind what is seen, and which part of it is handed over.
//!
//! ```text
//! scene, capture ─▶ offered (layers of samples) ─▶ cull (the disocclusion map of the first layer) ─▶ carried ─▶ engine
//! ```

mod cull;

use std::time::{Duration, Instant};

use galpix_core::galpixel::Chosen;
use galpix_core::layers::Displacement;
use galpix_core::layout::Layout;
use serde::Serialize;

pub use cull::{Culling, culling};

use crate::engine::{Beside, EngineError, MAX_BESIDE, Ran};
use crate::experiment::Source;
use crate::scene::{self, Peel};
use crate::update::{Known, Sample, Update};

/// How far a second layer lies behind the first at least, as a part of the depth range.
pub const SEPARATION: f64 = 1.0 / 64.0;

/// Where the samples behind the first layer come from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Kind {
    /// There are none: one layer.
    #[default]
    None,
    /// A second layer of depth, that lies behind the first by a least separation in normalised depth; 0: the next surface, whatever it is.
    Second {
        /// The separation.
        separation: f64,
    },
    /// Every surface behind the first one, each in a layer of its own: a bound, no way to ship.
    Unlimited,
}

/// What is handed over beside the update.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Way {
    /// Where the samples come from.
    pub kind: Kind,
    /// Whether only those are handed over that the disocclusion map of the first layer says can be uncovered before the next update.
    pub culled: bool,
}

impl Way {
    /// The first layer alone.
    pub const ONE: Self = Self { kind: Kind::None, culled: false };

    /// The name in tables and files.
    #[must_use]
    pub fn name(self) -> String {
        let kind = match self.kind {
            Kind::None => "one layer",
            Kind::Second { separation: 0.0 } => "second",
            Kind::Second { .. } => "second, separated",
            Kind::Unlimited => "unlimited",
        };
        if self.culled { format!("{kind}, culled") } else { kind.to_owned() }
    }
}

/// A layer as it is handed over.
#[derive(Clone, Debug)]
pub enum Layer {
    /// See [`Beside::Moving`].
    Moving(Update),
    /// See [`Beside::Anchored`].
    Anchored {
        /// The samples, where they are stored.
        update: Update,
        /// From there to where they are seen.
        displacements: Vec<Displacement>,
    },
}

/// What is handed over.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// From near to far.
    pub layers: Vec<Layer>,
    /// Samples that the source has behind its first layer.
    pub offered: u32,
    /// Of these, those that are handed over.
    pub kept: u32,
    /// The disocclusion map that decided, where one did.
    pub culling: Option<Culling>,
    /// Processor time of the map and of leaving out what it says; the update is not shown before.
    pub time: Duration,
}

/// What a run with samples behind the first layer reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HiddenReport {
    /// What was handed over.
    pub way: String,
    /// Layers beside the update.
    pub layers: usize,
    /// Samples that the source has behind its first layer.
    pub offered: u32,
    /// Of these, those that were handed over.
    pub kept: u32,
    /// Of these, those that the display ever showed.
    pub used: u32,
}

impl HiddenReport {
    /// Of what was handed over, and of the run with it.
    #[must_use]
    pub fn of(way: Way, carried: &Carried, ran: &Ran) -> Self {
        let Carried { layers, offered, kept, .. } = carried;
        Self { way: way.name(), layers: layers.len(), offered: *offered, kept: *kept, used: ran.used.iter().sum() }
    }
}

impl Layer {
    /// Its samples.
    #[must_use]
    pub const fn update(&self) -> &Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    const fn update_mut(&mut self) -> &mut Update {
        match self {
            Self::Moving(update) | Self::Anchored { update, .. } => update,
        }
    }

    /// As the engine takes it.
    #[must_use]
    pub fn beside(&self) -> Beside<'_> {
        match self {
            Self::Moving(update) => Beside::Moving(update),
            Self::Anchored { update, displacements } => Beside::Anchored { update, displacements },
        }
    }

    /// The cell in which a sample is seen, before anything moves; it may lie outside of the map.
    fn seen_at(&self, stored: usize) -> Option<usize> {
        let Self::Anchored { update, displacements } = self else { return Some(stored) };
        let [dx, dy] = displacements.get(stored).copied()?;
        let (x, y) = ((stored % update.width) as i64 + i64::from(dx), (stored / update.width) as i64 + i64::from(dy));
        let inside = (0..update.width as i64).contains(&x) && (0..update.height as i64).contains(&y);
        inside.then(|| y as usize * update.width + x as usize)
    }
}

/// What a source has behind its first layer; `None` if it has nothing of this kind.
#[must_use]
pub fn offered(source: &Source, kind: Kind) -> Option<Vec<Layer>> {
    let layers = match (kind, source) {
        (Kind::None, _) => Vec::new(),
        (Kind::Second { separation }, Source::Scene(scene)) => {
            scene::behind(*scene, 0.0, &Peel { layers: 1, separation, backs: true })
        }
        (Kind::Unlimited, Source::Scene(scene)) => {
            scene::behind(*scene, 0.0, &Peel { layers: MAX_BESIDE, separation: 0.0, backs: true })
        }
        (Kind::Second { separation }, Source::Capture(capture)) => {
            vec![apart(&capture.update, capture.hidden.as_ref()?, separation)]
        }
        (Kind::Unlimited, Source::Capture(_)) => return None,
    };
    Some(layers.into_iter().map(Layer::Moving).collect())
}

/// A layer without the samples that lie less than a separation behind those of the first.
fn apart(first: &Update, second: &Update, separation: f64) -> Update {
    let keep = |(first, second): (&Sample, &Sample)| {
        let behind = first.known != Known::Motion || second.depth >= first.depth + separation;
        if behind { *second } else { Sample { known: Known::ColourOnly, ..*second } }
    };
    Update { samples: first.samples.iter().zip(&second.samples).map(keep).collect(), ..second.clone() }
}

/// What a source hands over beside its update in a way, for `frames` frames until the next one, quantised to a budget; `None` if it
/// has nothing of this kind.
///
/// *Errors:* an update that cannot be laid out.
pub fn carry<L: Layout>(
    source: &Source,
    update: &Update,
    way: Way,
    budget: Chosen<L>,
    frames: u32,
) -> Result<Option<Carried>, EngineError> {
    let Some(mut layers) = offered(source, way.kind) else { return Ok(None) };
    let count = |layers: &[Layer]| -> u32 {
        let known = |layer: &Layer| layer.update().samples.iter().filter(|s| s.known == Known::Motion).count() as u32;
        layers.iter().map(known).sum()
    };
    let offered = count(&layers);
    let started = Instant::now();
    let culling = if way.culled && !layers.is_empty() { Some(culling(update, budget, frames)?) } else { None };
    if let Some(culling) = &culling {
        for layer in &mut layers {
            let uncovered: Vec<bool> = (0..layer.update().samples.len())
                .map(|stored| layer.seen_at(stored).is_some_and(|cell| culling.covers(cell)))
                .collect();
            for (sample, uncovered) in layer.update_mut().samples.iter_mut().zip(uncovered) {
                if !uncovered {
                    sample.known = Known::ColourOnly;
                }
            }
        }
    }
    let time = started.elapsed();
    Ok(Some(Carried { offered, kept: count(&layers), layers, culling, time }))
}
