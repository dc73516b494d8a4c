//! One update extrapolated and compared, frame by frame, with the truth and with sample-and-hold.

use std::collections::VecDeque;
use std::path::Path;

use galpix_core::budget::{Bits, Demand};
use galpix_core::colour::Colour;
use galpix_core::edge;
use galpix_core::error::BudgetError;
use galpix_core::fill::Rung;
use galpix_core::frame::Settings;
use galpix_core::layout::{Full, Layout, Shaded};
use galpix_core::record::Record;
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;
use serde::Serialize;

use crate::capture::{self, Capture, Census, ImportOptions};
use crate::certificate::Certificate;
use crate::engine::{Engine, EngineError, Frame, LoadTally};
use crate::metric;
use crate::picture::Picture;
use crate::scene::{self, Scene};
use crate::update::{DepthKind, Truth, Update};

/// Where an update and its truth come from.
pub enum Source {
    /// A built-in scene.
    Scene(&'static dyn Scene),
    /// A capture from a manifest.
    Capture(Box<Capture>),
}

/// Why a run cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// Neither a scene nor a file.
    #[error(
        "`{0}` is neither a built-in scene nor a capture: `galpix scenes` lists the scenes, or give the path of a capture.toml"
    )]
    NoSuchSource(String),
    /// The capture cannot be read.
    #[error("{0}")]
    Capture(#[from] capture::CaptureError),
    /// The engine cannot be set up.
    #[error("{0}")]
    Engine(#[from] EngineError),
    /// The budget cannot exist.
    #[error("this budget cannot exist: {0}")]
    Budget(#[from] BudgetError),
}

impl Source {
    /// Opens a built-in scene by its name, or a capture by the path of its manifest or folder.
    ///
    /// *Errors:* one sentence that says what, where and how to mend it.
    pub fn open(name: &str, options: &ImportOptions) -> Result<Self, ExperimentError> {
        if let Some(scene) = scene::find(name) {
            return Ok(Self::Scene(scene));
        }
        let looks_like_a_path = name.contains(['/', '\\', '.']) || Path::new(name).exists();
        if !looks_like_a_path {
            return Err(ExperimentError::NoSuchSource(name.to_owned()));
        }
        Ok(Self::Capture(Box::new(capture::load(Path::new(name), options)?)))
    }

    /// The scene's or the capture's name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Scene(scene) => scene.name(),
            Self::Capture(capture) => &capture.name,
        }
    }

    /// What it shows.
    #[must_use]
    pub fn about(&self) -> &str {
        match self {
            Self::Scene(scene) => scene.about(),
            Self::Capture(capture) => &capture.about,
        }
    }

    /// How many frames it is meant to be extrapolated.
    #[must_use]
    pub fn frames(&self) -> u32 {
        match self {
            Self::Scene(scene) => scene.frames(),
            Self::Capture(capture) => capture.frames,
        }
    }

    /// The update.
    #[must_use]
    pub fn update(&self) -> Update {
        match self {
            Self::Scene(scene) => scene::update(*scene, 0.0),
            Self::Capture(capture) => capture.update.clone(),
        }
    }

    /// The true picture of a frame, where it is known.
    #[must_use]
    pub fn truth(&self, frame: u32) -> Option<Truth> {
        match self {
            Self::Scene(scene) => Some(Truth { frame, picture: scene::render(*scene, f64::from(frame)), mask: None }),
            Self::Capture(capture) => capture.truths.iter().find(|truth| truth.frame == frame).cloned(),
        }
    }

    /// What was known of the cells of a capture.
    #[must_use]
    pub fn census(&self) -> Option<&Census> {
        match self {
            Self::Scene(_) => None,
            Self::Capture(capture) => Some(&capture.census),
        }
    }
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
    pub fill: Rung,
    /// Rounds of bullet filling.
    pub reach: u32,
    /// The Laplacian beyond which a cell is on an edge, as a part of the depth range; by depth kind if absent.
    pub edge_threshold: Option<f64>,
    /// Whether SSIM and FLIP are computed too.
    pub perceptual: bool,
}

impl Default for Request {
    fn default() -> Self {
        Self {
            frames: None,
            extent: None,
            recog: None,
            prop: None,
            rounding: Rounding::default(),
            fill: Rung::default(),
            reach: 1,
            edge_threshold: None,
            perceptual: true,
        }
    }
}

/// The widths in use, as they are reported.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BudgetReport {
    /// `D` in pixels.
    pub extent: u32,
    /// `tau_recog` in frames.
    pub recog: u32,
    /// `tau_prop` in frames.
    pub prop: u32,
    /// Equation (11).
    pub position_frac_bits: u32,
    /// Equation (8).
    pub velocity_int_bits: u32,
    /// Equation (13).
    pub velocity_frac_bits: u32,
    /// Equation (9).
    pub acceleration_int_bits: u32,
    /// Equation (12).
    pub acceleration_frac_bits: u32,
    /// Equation (14).
    pub motion_bits_per_component: u32,
    /// Three components, in bytes.
    pub motion_bytes_per_galpixel: f64,
    /// With colour, depth and flags, in whole words.
    pub stored_bytes_per_galpixel: usize,
}

impl BudgetReport {
    /// The report of a budget for a layout.
    ///
    /// *Errors:* a budget that does not fit the layout.
    pub fn of<L: Layout>(demand: Demand, bits: Bits) -> Result<Self, BudgetError> {
        let record = Record::plan(bits, L::LANES, L::Colour::BITS)?;
        Ok(Self {
            extent: demand.extent,
            recog: demand.recog,
            prop: demand.prop,
            position_frac_bits: bits.x.position_frac,
            velocity_int_bits: bits.x.velocity_int,
            velocity_frac_bits: bits.x.velocity_frac,
            acceleration_int_bits: bits.x.acceleration_int,
            acceleration_frac_bits: bits.x.acceleration_frac,
            motion_bits_per_component: bits.x.motion_bits(),
            motion_bytes_per_galpixel: f64::from(bits.x.motion_bits() + bits.y.motion_bits() + bits.z.motion_bits())
                / 8.0,
            stored_bytes_per_galpixel: record.bytes(),
        })
    }
}

/// What the comparison with a truth gave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TruthReport {
    /// Of the whole picture.
    pub psnr_db: Option<f64>,
    /// Of the unmoved picture of the update.
    pub psnr_hold_db: Option<f64>,
    /// Of the cells that a galpixel of the update reached.
    pub psnr_known_db: Option<f64>,
    /// Structural similarity.
    pub ssim: Option<f64>,
    /// Mean FLIP.
    pub flip: Option<f64>,
    /// Cells of the truth that no galpixel of the update reached.
    pub missing: u64,
    /// Of these, how many are connected with the border: what enters the picture.
    pub missing_at_border: u64,
}

/// How far galpixels of the update are from where they should be, in pixels, before the snap to a cell; of each galpixel
/// the worse of x and y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PositionReport {
    /// The worst, against the exact second-order path of the update's motion: what the certificate bounds.
    pub worst_px: f64,
    /// The mean, against the same path.
    pub mean_px: f64,
    /// The worst, against the true motion, where that is known: with what second order cannot know.
    pub truth_worst_px: Option<f64>,
    /// The mean, against the true motion.
    pub truth_mean_px: Option<f64>,
}

/// One frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameReport {
    /// Frames since the update.
    pub frame: u32,
    /// Cells that nothing reached in this frame.
    pub holes: u32,
    /// Of these, how many something was put into.
    pub filled: u32,
    /// Filled as bullet holes.
    pub bullets: u32,
    /// Just unobscured: filled with debris.
    pub debris: u32,
    /// Just unobscured: filled with a delayed galpixel.
    pub galdebris: u32,
    /// Left the map over its border.
    pub lost: u32,
    /// Discarded in collisions.
    pub collided: u32,
    /// Fields clamped to their range.
    pub saturated: u32,
    /// Cells on the edge of a surface.
    pub edges: u32,
    /// Time of the engine for each galpixel moved.
    pub ns_per_galpixel: f64,
    /// Of the galpixels of the update that are still on the map.
    pub position: Option<PositionReport>,
    /// Where a truth is known.
    pub truth: Option<TruthReport>,
}

/// A whole run.
#[derive(Clone, Debug, Serialize)]
pub struct RunReport {
    /// Scene or capture.
    pub source: String,
    /// Columns of the display.
    pub width: usize,
    /// Rows of the display.
    pub height: usize,
    /// The widths.
    pub budget: BudgetReport,
    /// Rounding of positions.
    pub rounding: &'static str,
    /// Rung of the fill ladder.
    pub fill: &'static str,
    /// Laplacian threshold, in units of the depth's last bit.
    pub edge_threshold: u32,
    /// Median over the frames.
    pub ns_per_galpixel: f64,
    /// What entered with the update.
    pub loaded: LoadTally,
    /// What was known of a capture's cells.
    pub census: Option<Census>,
    /// The certificate in x and y.
    pub certificate: Certificate,
    /// The frames from 1 on.
    pub frames: Vec<FrameReport>,
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
pub fn run(source: &Source, request: &Request, visit: impl FnMut(&Shown<'_>)) -> Result<RunReport, ExperimentError> {
    let update = source.update();
    if update.samples.iter().any(|sample| sample.luminosity_rate != 0.0) {
        run_as::<Shaded>(source, &update, request, visit)
    } else {
        run_as::<Full>(source, &update, request, visit)
    }
}

fn run_as<L: Layout>(
    source: &Source,
    update: &Update,
    request: &Request,
    mut visit: impl FnMut(&Shown<'_>),
) -> Result<RunReport, ExperimentError> {
    let frames = request.frames.unwrap_or(source.frames());
    let demand = demand(update, frames, request);
    let bits = Bits::derive(demand)?;
    let record = Record::plan(bits, L::LANES, L::Colour::BITS)?;
    let settings = settings(&record, update.depth_kind, request);
    let engine = Engine::<L>::new(bits, settings)?;
    let hold = update.picture();
    let mut reports = Vec::with_capacity(frames as usize);
    let loaded = engine.run(update, frames, |frame| {
        let picture = frame.picture();
        let truth = source.truth(frame.number);
        let reached = frame.reached();
        visit(&Shown { frame: frame.number, picture: &picture, hold: &hold, truth: truth.as_ref(), reached: &reached });
        if frame.number > 0 {
            let truth = truth.map(|truth| compare(&picture, &hold, &truth, &reached, request.perceptual));
            reports.push(report(frame, position(source, update, frame), truth));
        }
    })?;
    let mut times: Vec<f64> = reports.iter().map(|report: &FrameReport| report.ns_per_galpixel).collect();
    times.sort_by(f64::total_cmp);
    Ok(RunReport {
        source: source.name().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        budget: BudgetReport::of::<L>(demand, bits)?,
        rounding: request.rounding.name(),
        fill: request.fill.name(),
        edge_threshold: settings.edge_threshold,
        ns_per_galpixel: times.get(times.len() / 2).copied().unwrap_or(0.0),
        loaded,
        census: source.census().cloned(),
        certificate: Certificate::of(&record.scales[0], L::LANES.acceleration, request.rounding, demand.prop),
        frames: reports,
    })
}

fn settings(record: &Record, depth_kind: DepthKind, request: &Request) -> Settings {
    let depth_bits = u32::from(record.depth().bits);
    let by_kind = match depth_kind {
        DepthKind::Z | DepthKind::Disparity => edge::threshold_for_depth(depth_bits),
        DepthKind::Speed => edge::threshold_for_speed(depth_bits),
    };
    let edge_threshold =
        request.edge_threshold.map_or(by_kind, |part| (part * f64::from(1u32 << depth_bits.min(31))).round() as u32);
    Settings { rounding: request.rounding, rung: request.fill, edge_threshold, reach: request.reach }
}

fn report<L: Layout>(
    frame: &Frame<'_, L>,
    position: Option<PositionReport>,
    truth: Option<TruthReport>,
) -> FrameReport {
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
        truth,
    }
}

/// The worst and the mean of some errors.
#[derive(Default)]
struct Errors {
    worst: f64,
    sum: f64,
    count: u32,
}

impl Errors {
    fn add(&mut self, place: [f64; 2], should: [f64; 2]) {
        let error = (place[0] - should[0]).abs().max((place[1] - should[1]).abs());
        self.worst = self.worst.max(error);
        self.sum += error;
        self.count += 1;
    }

    fn mean(&self) -> f64 {
        self.sum / f64::from(self.count)
    }
}

/// How far the galpixels of a frame are from where they should be.
fn position<L: Layout>(source: &Source, update: &Update, frame: &Frame<'_, L>) -> Option<PositionReport> {
    let wings = [update.wings.left as f64, update.wings.top as f64];
    let time = f64::from(frame.number);
    let (mut second_order, mut truth) = (Errors::default(), Errors::default());
    for (origin, place) in frame.places() {
        let sample = update.samples.get(origin as usize)?;
        let from = [(origin as usize % update.width) as f64, (origin as usize / update.width) as f64];
        let along = |i: usize| from[i] + sample.velocity[i] * time + sample.acceleration[i] / 2.0 * time * time;
        second_order.add(place, [along(0), along(1)]);
        if let Source::Scene(scene) = source {
            let [x, y, _] = scene.track(from[0] - wings[0], from[1] - wings[1], 0.0, time);
            truth.add(place, [x + wings[0], y + wings[1]]);
        }
    }
    (second_order.count > 0).then(|| PositionReport {
        worst_px: second_order.worst,
        mean_px: second_order.mean(),
        truth_worst_px: (truth.count > 0).then_some(truth.worst),
        truth_mean_px: (truth.count > 0).then(|| truth.mean()),
    })
}

/// Compares a shown picture with the truth.
#[must_use]
pub fn compare(picture: &Picture, hold: &Picture, truth: &Truth, reached: &[bool], perceptual: bool) -> TruthReport {
    let counted = |index: usize| truth.mask.as_ref().is_none_or(|mask| mask[index]);
    let known: Vec<bool> = reached.iter().enumerate().map(|(index, &reached)| reached && counted(index)).collect();
    let missing: Vec<bool> = reached.iter().enumerate().map(|(index, &reached)| !reached && counted(index)).collect();
    let mask = truth.mask.as_deref();
    let perceptual = |measure: fn(&Picture, &Picture, Option<&[bool]>) -> Option<f64>| {
        perceptual.then(|| measure(picture, &truth.picture, mask)).flatten()
    };
    TruthReport {
        psnr_db: metric::psnr_db(picture, &truth.picture, mask),
        psnr_hold_db: metric::psnr_db(hold, &truth.picture, mask),
        psnr_known_db: metric::psnr_db(picture, &truth.picture, Some(&known)),
        ssim: perceptual(metric::ssim),
        flip: perceptual(metric::flip),
        missing: missing.iter().filter(|&&missing| missing).count() as u64,
        missing_at_border: connected_with_border(&missing, truth.picture.width, truth.picture.height),
    }
}

/// How many of the set cells are connected with the border by set cells that share a side.
fn connected_with_border(set: &[bool], width: usize, height: usize) -> u64 {
    let mut seen = vec![false; set.len()];
    let mut queue: VecDeque<usize> = VecDeque::new();
    let mut reach = |cell: usize, queue: &mut VecDeque<usize>| {
        if set[cell] && !seen[cell] {
            seen[cell] = true;
            queue.push_back(cell);
        }
    };
    for cell in 0..width * height {
        let (x, y) = (cell % width, cell / width);
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            reach(cell, &mut queue);
        }
    }
    while let Some(cell) = queue.pop_front() {
        let (x, y) = (cell % width, cell / width);
        if x > 0 {
            reach(cell - 1, &mut queue);
        }
        if x + 1 < width {
            reach(cell + 1, &mut queue);
        }
        if y > 0 {
            reach(cell - width, &mut queue);
        }
        if y + 1 < height {
            reach(cell + width, &mut queue);
        }
    }
    seen.iter().filter(|&&seen| seen).count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_touches_the_border_is_connected_with_it() {
        let art = ["#..#.", "#.#..", "..#..", ".....", ".##.#"];
        let set: Vec<bool> = art.iter().flat_map(|row| row.chars().map(|c| c == '#')).collect();
        // The two cells in the middle touch no border cell by a side; everything else does.
        assert_eq!(connected_with_border(&set, 5, 5), 6);
    }
}
