//! One update extrapolated and compared, frame by frame, with the truth and with sample-and-hold.

mod compare;
mod report;
mod work;

use galpix_core::stages::{threshold_for_depth, threshold_for_speed};
use galpix_core::{Bits, BudgetError, Demand, Dynamic, Format, Layout, Record, Rounding, Settings, Tally};

pub use compare::compare;
pub(crate) use compare::position;
pub use report::{BudgetReport, FrameReport, PositionReport, RunReport, TruthReport};
pub use work::work_gain;

use crate::certificate::Certificate;
use crate::engine::fill::Fill;
use crate::engine::{Beside, Engine, EngineError, Frame};
use crate::picture::Picture;
use crate::source::hidden::{self, Carried, HiddenReport, Way};
use crate::source::{Source, SourceError};
use crate::update::{DepthKind, Truth, Update};

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
    /// The source knows nothing behind its first layer, or not in this way.
    #[error("{source_name} has no hidden samples of the kind `{way}`: {mend}")]
    NothingHidden {
        /// Scene or capture.
        source_name: String,
        /// What was wanted.
        way: String,
        /// What to do about it.
        mend: &'static str,
    },
}

/// What to run.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Frames to extrapolate; the source's own number if absent.
    pub frames: Option<u32>,
    /// `D`; the next power of two of the larger side if absent.
    pub extent: Option<u32>,
    /// `tau_recog`; 8 if absent.
    pub recog: Option<u32>,
    /// `tau_prop`; the next power of two of the frames if absent.
    pub prop: Option<u32>,
    /// How positions are rounded.
    pub rounding: Rounding,
    /// What is put into holes.
    pub fill: Fill,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// The Laplacian beyond which a cell is on an edge, as a part of the depth range; by depth kind if absent.
    pub edge_threshold: Option<f64>,
    /// Whether SSIM and FLIP are computed too.
    pub perceptual: bool,
    /// What is handed over beside the first layer.
    pub way: Way,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            frames: None,
            extent: None,
            recog: None,
            prop: None,
            rounding: Rounding::default(),
            fill: Fill::default(),
            reach: 1,
            edge_threshold: None,
            perceptual: true,
            way: Way::ONE,
        }
    }
}

/// What a visitor sees of each frame, the update (frame 0) included.
pub struct Shown<'s> {
    /// Frames since the update.
    pub frame: u32,
    /// What the display shows.
    pub picture: &'s Picture,
    /// The update's picture: what sample-and-hold shows.
    pub hold: &'s Picture,
    /// The true picture, where it is known.
    pub truth: Option<&'s Truth>,
    /// For each pixel, whether a galpixel of the update reached it.
    pub reached: &'s [bool],
}

/// The demand that a request makes for an update.
#[must_use]
pub fn demand(update: &Update, frames: u32, request: &Request) -> Demand {
    let side = update.display_width().max(update.display_height());
    Demand {
        extent: request.extent.unwrap_or(side.next_power_of_two() as u32),
        recog: request.recog.unwrap_or(8),
        prop: request.prop.unwrap_or(frames.max(2).checked_next_power_of_two().unwrap_or(u32::MAX)),
    }
}

/// Runs a source and compares every frame whose truth is known; `visit` sees each frame.
///
/// *Errors:* a budget that cannot exist or that does not fit.
pub fn run(
    source: &Source,
    request: &Request,
    mut visit: impl FnMut(&Shown<'_>),
) -> Result<RunReport, ExperimentError> {
    let update = source.update();
    let frames = request.frames.unwrap_or(source.frames());
    let demand = demand(&update, frames, request);
    let bits = Bits::derive(demand)?;
    let layout = layout_for(&update);
    let format = Dynamic::new(bits, layout)?;
    let settings = settings(format.record(), update.depth_kind, request);
    let engine = Engine::new(format, settings).inpainting(request.fill.inpaint());
    let carried = carried(source, &update, request.way, format, frames)?;
    let beside: Vec<Beside<'_>> = carried.layers.iter().map(hidden::Layer::beside).collect();
    let hold = update.picture();
    let mut reports = Vec::with_capacity(frames as usize);
    let ran = engine.run_layers(&carried.base, &beside, frames, |frame| {
        let picture = frame.picture();
        let truth = source.truth(frame.number);
        let reached = frame.reached();
        visit(&Shown { frame: frame.number, picture: &picture, hold: &hold, truth: truth.as_ref(), reached: &reached });
        if frame.number > 0 {
            let truth = truth.map(|truth| compare(&picture, &hold, &truth, &reached, request.perceptual));
            let position = compare::position(source, &update, frame, |origin| carried.first(origin));
            let report = report(frame, position, truth);
            let hidden = || frame.origins().filter(|&origin| carried.is_hidden(origin)).count() as u32;
            let from_hidden = (request.way != Way::ONE).then(hidden);
            reports.push(FrameReport { from_hidden, ..report });
        }
    })?;
    let mut times: Vec<f64> = reports.iter().map(|report: &FrameReport| report.ns_per_galpixel).collect();
    times.sort_by(f64::total_cmp);
    Ok(RunReport {
        source: source.name().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        budget: BudgetReport::of(demand, bits, format.record()),
        rounding: request.rounding.name(),
        fill: request.fill.name(),
        edge_threshold: settings.edge_threshold,
        ns_per_galpixel: times.get(times.len() / 2).copied().unwrap_or(0.0),
        loaded: ran.loaded,
        hidden: (request.way != Way::ONE).then(|| HiddenReport::of(request.way, &carried, &ran)),
        census: source.census().cloned(),
        certificate: Certificate::of(&format.record().scales[0], layout.acceleration, request.rounding, demand.prop),
        frames: reports,
    })
}

/// Returns what the galpixels of an update carry: shading inertia only where any of them brightens or darkens.
pub(crate) fn layout_for(update: &Update) -> Layout {
    let shaded = update.samples.iter().any(|sample| sample.luminosity_rate != 0.0);
    if shaded { Layout::SHADED } else { Layout::FULL }
}

/// Whether a source has what is wanted behind its first layer.
///
/// *Errors:* it has nothing of this kind.
pub fn check_way(source: &Source, way: Way) -> Result<(), ExperimentError> {
    if hidden::has(source, way.kind) {
        return Ok(());
    }
    let mend = match (source, way.kind) {
        (Source::Capture(_), hidden::Kind::Second { .. }) => "add an [update.hidden] to its manifest",
        _ => "choose a built-in scene, or another kind",
    };
    Err(ExperimentError::NothingHidden { source_name: source.name().to_owned(), way: way.name(), mend })
}

/// What a source hands over.
///
/// *Errors:* a source that has nothing of this kind.
pub(crate) fn carried(
    source: &Source,
    update: &Update,
    way: Way,
    format: Dynamic,
    frames: u32,
) -> Result<Carried, ExperimentError> {
    check_way(source, way)?;
    Ok(hidden::carry(source, update, way, format, frames)?)
}

/// How the frames of an update are made under a record.
pub(crate) fn settings(record: &Record, depth_kind: DepthKind, request: &Request) -> Settings {
    let depth_bits = u32::from(record.depth().bits);
    let by_kind = match depth_kind {
        DepthKind::Z | DepthKind::Disparity => threshold_for_depth(depth_bits),
        DepthKind::Speed => threshold_for_speed(depth_bits),
    };
    let edge_threshold =
        request.edge_threshold.map_or(by_kind, |part| (part * f64::from(1u32 << depth_bits.min(31))).round() as u32);
    Settings { rounding: request.rounding, fill_mode: request.fill.rung(), edge_threshold, reach: request.reach }
}

fn report(frame: &Frame<'_>, position: Option<PositionReport>, truth: Option<TruthReport>) -> FrameReport {
    let Tally { moved, lost, collided, saturated, edges, holes, bullets, debris, galdebris, .. } = frame.tally;
    FrameReport {
        frame: frame.number,
        holes,
        filled: frame.tally.filled(),
        bullets,
        debris,
        galdebris,
        lost,
        collided,
        saturated,
        edges,
        ns_per_galpixel: frame.time.as_secs_f64() * 1e9 / f64::from(moved.max(1)),
        position,
        from_hidden: None,
        truth,
    }
}
