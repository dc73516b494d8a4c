//! A request for a source and what follows from it, resolved once, before anything is run.

use std::sync::Arc;

use galpix_core::record::Component;
use galpix_core::stages::{threshold_for_depth, threshold_for_speed};
use galpix_core::{Bits, BudgetError, Demand, Dynamic, Format, Layout, Record, Rounding, Settings};

use crate::engine::fill::Fill;
use crate::engine::{Engine, EngineError, ScanOut, Scheme};
use crate::source::hidden::{self, Carried, Kind, Strategy};
use crate::source::{Source, SourceError};
use crate::update::{DepthKind, Update};

/// Why a run cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The source cannot be opened.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// The engine cannot be set up.
    #[error("{0}")]
    Engine(#[from] EngineError),
    /// The budget cannot exist.
    #[error("this budget cannot exist: {0}")]
    Budget(#[from] BudgetError),
    /// The source knows nothing behind its first layer, or not in this strategy.
    #[error("{source_name} has no hidden samples of the kind `{strategy}`: {hint}")]
    NothingHidden {
        /// Scene or capture.
        source_name: String,
        /// What was wanted.
        strategy: String,
        /// What to do about it.
        hint: &'static str,
    },
}

/// A request.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Frames to extrapolate; the source's own number if absent.
    pub frames: Option<u32>,
    /// `D`; the next power of two of the larger side if absent.
    pub extent: Option<u32>,
    /// `tau_recog`; 8 if absent.
    pub recog: Option<u32>,
    /// `tau_prop`; if absent, the next power of two of the frames that the source is meant for: what is asked for does
    /// not change the frames before it.
    pub prop: Option<u32>,
    /// The fewest fraction bits of positions in x and y, if equation (11) asks for less.
    pub position_frac: u32,
    /// How positions are rounded.
    pub rounding: Rounding,
    /// What is put into holes.
    pub fill: Fill,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// The Laplacian beyond which a cell is on an edge, as a part of the depth range; by depth kind if absent.
    pub edge_threshold: Option<f64>,
    /// How galpixels move.
    pub scheme: Scheme,
    /// How cells become pixels.
    pub scan_out: ScanOut,
    /// Whether SSIM and FLIP are computed too.
    pub perceptual: bool,
    /// Which hidden samples are handed over.
    pub strategy: Strategy,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            frames: None,
            extent: None,
            recog: None,
            prop: None,
            position_frac: 0,
            rounding: Rounding::default(),
            fill: Fill::default(),
            reach: 1,
            edge_threshold: None,
            scheme: Scheme::default(),
            scan_out: Scheme::default().scan_out(),
            perceptual: true,
            strategy: Strategy::ONE,
        }
    }
}

impl Request {
    /// Returns the same in a scheme, with its usual fill and scan-out.
    #[must_use]
    pub fn in_scheme(self, scheme: Scheme) -> Self {
        Self { scheme, fill: scheme.fill(), scan_out: scheme.scan_out(), ..self }
    }

    /// Returns the frames to extrapolate: the requested number, else the source's own.
    #[must_use]
    pub fn frames(&self, source: &Source) -> u32 {
        self.frames.unwrap_or(source.frames())
    }

    /// Returns the demand that is made for an update over so many frames.
    #[must_use]
    pub fn demand(&self, update: &Update, frames: u32) -> Demand {
        let side = update.display_width().max(update.display_height());
        Demand {
            extent: self.extent.unwrap_or(side.next_power_of_two() as u32),
            recog: self.recog.unwrap_or(8),
            prop: self.prop.unwrap_or(frames.max(2).checked_next_power_of_two().unwrap_or(u32::MAX)),
        }
    }

    /// Returns how the frames of an update are made under a record.
    #[must_use]
    pub fn settings(&self, record: &Record, depth_kind: DepthKind) -> Settings {
        let depth_bits = u32::from(record.depth().bits);
        let by_kind = match depth_kind {
            DepthKind::Z | DepthKind::Disparity => threshold_for_depth(depth_bits),
            DepthKind::Speed => threshold_for_speed(depth_bits),
        };
        let edge_threshold =
            self.edge_threshold.map_or(by_kind, |part| (part * f64::from(1u32 << depth_bits.min(31))).round() as u32);
        Settings { rounding: self.rounding, fill_mode: self.fill.mode(), edge_threshold, reach: self.reach }
    }
}

/// Returns widths whose positions in x and y have so many fraction bits at least.
#[must_use]
pub fn finer(bits: Bits, position_frac: u32) -> Bits {
    let [x, y] =
        [bits.x, bits.y].map(|plane| Component { position_frac: plane.position_frac.max(position_frac), ..plane });
    bits.with_xy(x, y)
}

/// A source, its update, and how it is extrapolated. Copies share the update.
#[derive(Clone)]
pub struct Job<'s> {
    /// Scene or capture.
    pub source: &'s Source,
    /// Its update.
    pub update: Arc<Update>,
    /// Frames to extrapolate.
    pub frames: u32,
    /// The three design numbers.
    pub demand: Demand,
    /// The widths that they give.
    pub bits: Bits,
    /// What a galpixel carries, in these widths.
    pub format: Dynamic,
    /// How frames are made.
    pub settings: Settings,
    /// The request.
    pub request: Request,
}

impl<'s> Job<'s> {
    /// Resolves a request for a source. Its galpixels carry what its update has.
    ///
    /// *Errors:* a budget that cannot exist.
    pub fn resolve(source: &'s Source, request: &Request) -> Result<Self, ExperimentError> {
        Self::with_layout(source, request, layout_for)
    }

    /// Resolves a request for a source, with galpixels that carry those fields of its update that `layout` has. Without
    /// acceleration its widths are those of [`Bits::derive_without_acceleration`].
    ///
    /// *Errors:* a budget that cannot exist.
    pub fn with_layout(
        source: &'s Source,
        request: &Request,
        layout: impl FnOnce(&Update) -> Layout,
    ) -> Result<Self, ExperimentError> {
        let update = Arc::new(source.update());
        let frames = request.frames(source);
        let demand = request.demand(&update, source.frames());
        let layout = layout(&update);
        let bits = if layout.acceleration { Bits::derive(demand)? } else { Bits::derive_without_acceleration(demand)? };
        let bits = finer(bits, request.position_frac);
        let format = Dynamic::new(bits, layout)?;
        let settings = request.settings(format.record(), update.depth_kind);
        Ok(Self { source, update, frames, demand, bits, format, settings, request: *request })
    }

    /// Returns the same job with something else put into holes.
    #[must_use]
    pub fn with_fill(&self, fill: Fill) -> Self {
        let request = Request { fill, ..self.request };
        let settings = request.settings(self.format.record(), self.update.depth_kind);
        Self { settings, request, ..self.clone() }
    }

    /// Returns the same job in another scheme, with its usual fill and scan-out.
    #[must_use]
    pub fn with_scheme(&self, scheme: Scheme) -> Self {
        let request = self.request.in_scheme(scheme);
        Self { request, ..self.clone() }.with_fill(request.fill)
    }

    /// Returns the same job with positions rounded in another strategy.
    #[must_use]
    pub fn with_rounding(&self, rounding: Rounding) -> Self {
        let settings = Settings { rounding, ..self.settings };
        Self { settings, request: Request { rounding, ..self.request }, ..self.clone() }
    }

    /// Returns the same job with other hidden samples handed over.
    #[must_use]
    pub fn with_strategy(&self, strategy: Strategy) -> Self {
        Self { request: Request { strategy, ..self.request }, ..self.clone() }
    }

    /// Returns the same job without SSIM and FLIP.
    #[must_use]
    pub fn without_perception(&self) -> Self {
        Self { request: Request { perceptual: false, ..self.request }, ..self.clone() }
    }

    /// Returns the engine that makes its frames.
    #[must_use]
    pub fn engine(&self) -> Engine {
        let Request { fill, scheme, scan_out, .. } = self.request;
        Engine::new(self.format, self.settings).inpainting(fill.inpaint()).showing(scheme, scan_out)
    }

    /// Returns what the source hands over.
    ///
    /// *Errors:* a source that has nothing of this kind.
    pub fn carried(&self) -> Result<Carried, ExperimentError> {
        check_strategy(self.source, self.request.strategy)?;
        Ok(hidden::carry(self.source, &self.update, self.request.strategy, self.format, self.frames)?)
    }
}

/// Returns what the galpixels of an update carry: shading inertia only where any of them brightens or darkens.
fn layout_for(update: &Update) -> Layout {
    let shaded = update.samples.iter().any(|sample| sample.luminosity_rate != 0.0);
    if shaded { Layout::SHADED } else { Layout::FULL }
}

/// Checks that a source has the requested hidden samples.
///
/// *Errors:* it has none of this kind.
pub fn check_strategy(source: &Source, strategy: Strategy) -> Result<(), ExperimentError> {
    if hidden::has(source, strategy.kind) {
        return Ok(());
    }
    let hint = match (source, strategy.kind) {
        (Source::Capture(_), Kind::Second { .. }) => "add an [update.hidden] to its manifest",
        _ => "choose a built-in scene, or another kind",
    };
    Err(ExperimentError::NothingHidden { source_name: source.name().to_owned(), strategy: strategy.name(), hint })
}
