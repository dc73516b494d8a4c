//! What an update has behind what is seen, and which part of it is handed over.
//!
//! ```text
//! scene, capture ─▶ offered (layers of samples) ─▶ cull (the disocclusion map of the first layer) ─▶ carried ─▶ engine
//! ```

mod arrange;
mod cull;
mod layer;
mod offered;
mod surfaces;

use galpix_core::Dynamic;
use schemars::JsonSchema;
use serde::Serialize;

pub use cull::{Culling, culling};
pub use layer::Layer;

use crate::engine::{EngineError, HiddenLayer, NO_ORIGIN, Ran};
use crate::source::Source;
use crate::update::Update;

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
    /// A second layer of depth, that lies behind the first by a least separation in normalised depth; 0: the next
    /// surface, whatever it is.
    Second {
        /// The separation.
        separation: f64,
    },
    /// What the image of a depth discontinuity occlusion camera has around the edges of what is seen, in an anchored
    /// layer.
    Ddoc {
        /// How far behind an edge it reaches, cells.
        radius: u32,
    },
    /// Every surface, whole, in a layer of its own: a bound, no strategy to ship.
    Unlimited,
}

/// Which of two surfaces in a cell belongs to the base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// The one that is seen. What is behind is in a layer of its own.
    Nearer,
    /// The one behind, where there is one. A surface that covers something, and leaves some of it, is in a layer of its
    /// own: it takes nothing away of what it passes in front of, and its bullet holes are closed before anything shines
    /// through.
    #[default]
    Farther,
}

/// Which hidden samples are handed over with an update.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strategy {
    /// Where the samples come from.
    pub kind: Kind,
    /// How they are put into layers; each of more than two surfaces has a layer of its own.
    pub arrangement: Arrangement,
    /// Whether only those are handed over that the disocclusion map of the first layer says can be uncovered before the
    /// next update.
    pub culled: bool,
}

impl Strategy {
    /// The first layer alone.
    pub const ONE: Self = Self { kind: Kind::None, arrangement: Arrangement::Farther, culled: false };

    /// Returns the name in tables and files.
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
            Arrangement::Nearer if self.kind != Kind::None => ", behind",
            _ => "",
        };
        format!("{kind}{behind}{}", if self.culled { ", culled" } else { "" })
    }
}

/// What is handed over.
#[derive(Clone, Debug)]
pub struct Carried {
    /// Layer 0.
    pub base: Update,
    /// The hidden layers.
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
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct HiddenReport {
    /// What was handed over.
    #[serde(rename = "way")]
    pub strategy: String,
    /// Hidden layers.
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
    pub fn of(strategy: Strategy, carried: &Carried, ran: &Ran) -> Self {
        let Carried { layers, offered, kept, hidden, .. } = carried;
        let used = ran.used.iter().zip(hidden).filter(|&(&used, &hidden)| used && hidden).count() as u32;
        Self { strategy: strategy.name(), layers: layers.len(), offered: *offered, kept: *kept, used }
    }
}

impl Carried {
    /// Returns the hidden layers as the engine takes them.
    #[must_use]
    pub fn hidden_layers(&self) -> Vec<HiddenLayer<'_>> {
        self.layers.iter().map(Layer::for_engine).collect()
    }

    /// Returns whether the first layer covered this sample.
    #[must_use]
    pub fn is_hidden(&self, origin: u32) -> bool {
        self.hidden.get(origin as usize).copied().unwrap_or(false)
    }

    /// Returns the cell of the update whose sample this one is, if it is one of the first layer's.
    #[must_use]
    pub fn first(&self, origin: u32) -> Option<usize> {
        (origin != NO_ORIGIN && !self.is_hidden(origin)).then(|| origin as usize % self.base.samples.len().max(1))
    }
}

/// Returns whether a source knows anything of this kind.
#[must_use]
pub fn has(source: &Source, kind: Kind) -> bool {
    match (source, kind) {
        (Source::Scene(_), _) | (_, Kind::None) => true,
        (Source::Capture(capture), Kind::Second { .. }) => capture.hidden.is_some(),
        (Source::Capture(_), Kind::Ddoc { .. } | Kind::Unlimited) => false,
    }
}

/// Returns what a source hands over by a strategy, for `frames` frames until the next update, quantised to a format:
/// the first layer alone if it has nothing of this kind.
///
/// *Errors:* an update that cannot be laid out.
pub fn carry(
    source: &Source,
    update: &Update,
    strategy: Strategy,
    format: Dynamic,
    frames: u32,
) -> Result<Carried, EngineError> {
    let layers = offered::offered(source, strategy.kind)?;
    let culling = if strategy.culled && !layers.is_empty() { Some(culling(update, format, frames)?) } else { None };
    Ok(match strategy.kind {
        Kind::Unlimited if !layers.is_empty() => arrange::unlimited(update, layers, culling),
        _ => arrange::arranged(update, layers, strategy.arrangement, culling),
    })
}
