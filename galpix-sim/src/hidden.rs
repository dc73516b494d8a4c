//! What an update has behind what is seen, and which part of it is handed over.
//!
//! ```text
//! scene, capture ─▶ offered (layers of samples) ─▶ cull (the disocclusion map of the first layer) ─▶ carried ─▶ engine
//! ```

mod cull;
mod surfaces;

use galpix_core::galpixel::Chosen;
use galpix_core::layers::Displacement;
use galpix_core::layout::Layout;
use serde::Serialize;

pub use cull::{Culling, culling};

use crate::ddoc::{self, distortion};
use crate::engine::{Beside, EngineError, NO_ORIGIN, Ran};
use crate::experiment::Source;
use crate::scene::{self, Peel, Scene};
use crate::update::{Known, Sample, Update};

/// How far a second layer lies behind the first at least, as a part of the depth range.
pub const SEPARATION: f64 = 1.0 / 64.0;

/// How far behind an edge a DDOC reaches, cells.
pub const RADIUS: u32 = 16;

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
    /// What the image of a depth discontinuity occlusion camera has around the edges of what is seen, in an anchored layer.
    Ddoc {
        /// How far behind an edge it reaches, cells.
        radius: u32,
    },
    /// Every surface, whole, in a layer of its own: a bound, no way to ship.
    Unlimited,
}

/// Which of two surfaces in a cell belongs to the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// The one that is seen. What is behind is in a layer of its own.
    Nearer,
    /// The one behind, where there is one. A surface that covers something, and leaves some of it, is in a layer of its own: it takes nothing
    /// away of what it passes in front of, and its bullet holes are closed before anything shines through.
    #[default]
    Farther,
}

/// What is handed over beside the update.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Way {
    /// Where the samples come from.
    pub kind: Kind,
    /// How they are put into layers; each of more than two surfaces has a layer of its own.
    pub arrangement: Arrangement,
    /// Whether only those are handed over that the disocclusion map of the first layer says can be uncovered before the next update.
    pub culled: bool,
}

impl Way {
    /// The first layer alone.
    pub const ONE: Self = Self { kind: Kind::None, arrangement: Arrangement::Farther, culled: false };

    /// The name in tables and files.
    #[must_use]
    pub fn name(self) -> String {
        let kind = match self.kind {
            Kind::None => "one layer",
            Kind::Second { separation: 0.0 } => "second",
            Kind::Second { .. } => "second, separated",
            Kind::Ddoc { .. } => "DDOC",
            Kind::Unlimited => "unlimited",
        };
        let behind = match self.arrangement {
            Arrangement::Nearer if matches!(self.kind, Kind::Second { .. }) => ", behind",
            _ => "",
        };
        format!("{kind}{behind}{}", if self.culled { ", culled" } else { "" })
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
        /// From there to the cells in which they are seen.
        displacements: Vec<Displacement>,
        /// Where in these cells they are.
        offsets: Vec<[f64; 2]>,
    },
}

/// What is handed over.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Layer 0.
    pub base: Update,
    /// The layers beside it.
    pub layers: Vec<Layer>,
    /// Samples that the source has behind its first layer.
    pub offered: u32,
    /// Of these, those that are handed over.
    pub kept: u32,
    /// The disocclusion map that decided, where one did.
    pub culling: Option<Culling>,
    /// For each sample, by its number in [`crate::engine::Frame::origins`], whether the first layer covers it.
    hidden: Vec<bool>,
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
        let Carried { layers, offered, kept, hidden, .. } = carried;
        let used = ran.used.iter().zip(hidden).filter(|&(&used, &hidden)| used && hidden).count() as u32;
        Self { way: way.name(), layers: layers.len(), offered: *offered, kept: *kept, used }
    }
}

impl Carried {
    /// Whether the first layer covered this sample.
    #[must_use]
    pub fn is_hidden(&self, origin: u32) -> bool {
        self.hidden.get(origin as usize).copied().unwrap_or(false)
    }

    /// The cell of the update whose sample this one is, if it is one of the first layer's.
    #[must_use]
    pub fn first(&self, origin: u32) -> Option<usize> {
        (origin != NO_ORIGIN && !self.is_hidden(origin)).then(|| origin as usize % self.base.samples.len().max(1))
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

    fn into_update(self) -> Update {
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
            Self::Anchored { update, displacements, offsets } => Beside::Anchored { update, displacements, offsets },
        }
    }

    /// The cell in which a sample is seen, before anything moves; it may lie outside of the map.
    fn seen_at(&self, stored: usize) -> Option<usize> {
        let Self::Anchored { update, displacements, .. } = self else { return Some(stored) };
        let [dx, dy] = displacements.get(stored).copied()?;
        let (x, y) = ((stored % update.width) as i64 + i64::from(dx), (stored / update.width) as i64 + i64::from(dy));
        let inside = (0..update.width as i64).contains(&x) && (0..update.height as i64).contains(&y);
        inside.then(|| y as usize * update.width + x as usize)
    }
}

/// Whether a source knows anything of this kind.
#[must_use]
pub fn has(source: &Source, kind: Kind) -> bool {
    match (source, kind) {
        (Source::Scene(_), _) | (_, Kind::None) => true,
        (Source::Capture(capture), Kind::Second { .. }) => capture.hidden.is_some(),
        (Source::Capture(_), Kind::Ddoc { .. } | Kind::Unlimited) => false,
    }
}

/// What a source has behind its first layer, or all that it has if that is unlimited; nothing if it has nothing of this kind.
///
/// *Errors:* a scene that is too large for a map.
fn offered(source: &Source, kind: Kind) -> Result<Vec<Layer>, EngineError> {
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

/// What a DDOC has of a scene that the plain picture does not show.
fn around_edges(scene: &dyn Scene, radius: u32) -> Result<Layer, EngineError> {
    let settings = galpix_core::ddoc::Settings { radius, ..distortion::settings() };
    let (samples, _) = ddoc::hidden::hidden(scene, &settings)?;
    let mut update = scene::update(scene, 0.0);
    for sample in &mut update.samples {
        *sample = Sample { known: Known::ColourOnly, ..Sample::default() };
    }
    let mut displacements = vec![[0; 2]; update.samples.len()];
    let mut offsets = vec![[0.0; 2]; update.samples.len()];
    for hidden in samples.iter().filter(|sample| sample.hidden) {
        let cell = hidden.cell[1] as usize * update.width + hidden.cell[0] as usize;
        update.samples[cell] = hidden.sample;
        displacements[cell] = hidden.displacement();
        offsets[cell] = hidden.offset();
    }
    Ok(Layer::Anchored { update, displacements, offsets })
}

/// A layer without the samples that lie less than a separation behind those of the first.
fn apart(first: &Update, second: &Update, separation: f64) -> Update {
    let keep = |(first, second): (&Sample, &Sample)| {
        let behind = first.known != Known::Motion || second.depth >= first.depth + separation;
        if behind { *second } else { Sample { known: Known::ColourOnly, ..*second } }
    };
    Update { samples: first.samples.iter().zip(&second.samples).map(keep).collect(), ..second.clone() }
}

/// What a source hands over in a way, for `frames` frames until the next update, quantised to a budget: the first layer alone if it has
/// nothing of this kind.
///
/// *Errors:* an update that cannot be laid out.
pub fn carry<L: Layout>(
    source: &Source,
    update: &Update,
    way: Way,
    budget: Chosen<L>,
    frames: u32,
) -> Result<Carried, EngineError> {
    let layers = offered(source, way.kind)?;
    let culling = if way.culled && !layers.is_empty() { Some(culling(update, budget, frames)?) } else { None };
    Ok(match way.kind {
        Kind::Unlimited if !layers.is_empty() => unlimited(update, layers, culling),
        _ => arranged(update, layers, way.arrangement, culling),
    })
}

/// A first layer and what is behind it, put into layers.
fn arranged(update: &Update, mut layers: Vec<Layer>, arrangement: Arrangement, culling: Option<Culling>) -> Carried {
    let covering = covering(&layers, update.samples.len());
    let offered = count(&layers);
    if let Some(culling) = &culling {
        layers.iter_mut().for_each(|layer| cull(layer, culling, &[]));
    }
    let kept = count(&layers);
    let mut base = update.clone();
    let mut hidden = vec![false; base.samples.len()];
    hidden.resize(base.samples.len() * (1 + layers.len()), true);
    if let (Arrangement::Farther, Some(Layer::Moving(second))) = (arrangement, layers.first_mut()) {
        let leaves: Vec<bool> = second.samples.iter().map(|sample| sample.known == Known::Motion).collect();
        let (of_base, of_layer) = hidden.split_at_mut(covering.len());
        for cell in surfaces::that_leave(update, &covering, &leaves) {
            std::mem::swap(&mut base.samples[cell], &mut second.samples[cell]);
            std::mem::swap(&mut of_base[cell], &mut of_layer[cell]);
        }
    }
    Carried { base, offered, kept, layers, culling, hidden }
}

/// Surfaces that are whole: what is seen of them is not hidden, and never left out. The largest one is the base.
fn unlimited(update: &Update, mut surfaces: Vec<Layer>, culling: Option<Culling>) -> Carried {
    surfaces.sort_by_key(|surface| std::cmp::Reverse(count(std::slice::from_ref(surface))));
    let seen = |surface: &Layer| -> Vec<bool> {
        let samples = surface.update().samples.iter().zip(&update.samples);
        samples.map(|(own, seen)| own.known == Known::Motion && own.tag == seen.tag).collect()
    };
    let seen: Vec<Vec<bool>> = surfaces.iter().map(seen).collect();
    let first: u32 = seen.iter().flatten().map(|&seen| u32::from(seen)).sum();
    let offered = count(&surfaces) - first;
    if let Some(culling) = &culling {
        for (surface, seen) in surfaces.iter_mut().zip(&seen) {
            cull(surface, culling, seen);
        }
    }
    let kept = count(&surfaces) - first;
    let mut base = surfaces.remove(0).into_update();
    // Where no surface is, the world is black and infinitely far.
    for (own, seen) in base.samples.iter_mut().zip(&update.samples).filter(|(_, seen)| seen.tag == 0) {
        *own = *seen;
    }
    let hidden = seen.into_iter().flatten().map(|seen| !seen).collect();
    Carried { base, offered, kept, layers: surfaces, culling, hidden }
}

fn count(layers: &[Layer]) -> u32 {
    let known = |layer: &Layer| layer.update().samples.iter().filter(|s| s.known == Known::Motion).count() as u32;
    layers.iter().map(known).sum()
}

/// Which cells have something behind what is seen.
fn covering(layers: &[Layer], cells: usize) -> Vec<bool> {
    let mut covering = vec![false; cells];
    for layer in layers {
        for (stored, _) in layer.update().samples.iter().enumerate().filter(|(_, s)| s.known == Known::Motion) {
            if let Some(cell) = layer.seen_at(stored).and_then(|cell| covering.get_mut(cell)) {
                *cell = true;
            }
        }
    }
    covering
}

/// Leaves out what cannot be uncovered, but for what is `seen`.
fn cull(layer: &mut Layer, culling: &Culling, seen: &[bool]) {
    let cells = 0..layer.update().samples.len();
    let keep = |stored: usize| {
        seen.get(stored) == Some(&true) || layer.seen_at(stored).is_some_and(|cell| culling.covers(cell))
    };
    let keep: Vec<bool> = cells.map(keep).collect();
    for (sample, keep) in layer.update_mut().samples.iter_mut().zip(keep) {
        if !keep {
            *sample = Sample { known: Known::ColourOnly, ..*sample };
        }
    }
}
