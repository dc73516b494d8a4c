//! Error against run time: what each bit, lane, rounding and rung costs and gains on a scene or a capture.
//!
//! ```text
//! design (configurations) ─┬─▶ measure (error of each) ──┐
//!                          ├─▶ timing (time of each) ────┼─▶ report ─▶ pareto ─▶ table, csv, page
//!                          └─▶ float (the same in f32) ──┘
//!            causes (frame by frame) and rates (updates every N frames) for the middle configuration
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each beside a memory copy.

pub mod causes;
pub mod csv;
pub mod design;
mod figures;
pub mod float;
mod legend;
pub mod measure;
pub mod page;
pub mod pareto;
pub mod ranges;
pub mod rates;
pub mod reference;
pub mod report;
pub mod stand_in;
pub mod table;
pub mod timing;

mod points;

pub(crate) use legend::fill_ink;

use galpix_core::{Bits, BudgetError, Demand, Dynamic, Format, Layout, Rounding};

use crate::engine::Engine;
use crate::source::Source;
use crate::study::run::{ExperimentError, Request, demand};
use crate::update::Known;
use design::{Axes, Configuration, Extent, Kept, Step};
use ranges::Ranges;
use reference::Reference;
use report::{DemandReport, Fronts, Point, Scheme, SourceReport, Summary};
use timing::Effort;

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, the design numbers, and the edge threshold; its rounding and its rung do not count.
    pub request: Request,
    /// Lanes to choose from; those that the source has no use for are dropped unless nothing else is left.
    pub kept: Vec<Kept>,
    /// Roundings to choose from.
    pub roundings: Vec<Rounding>,
    /// Rungs to choose from.
    pub rungs: Vec<crate::engine::fill::Fill>,
    /// How many configurations.
    pub extent: Extent,
}

/// What a study tells of its progress.
#[derive(Clone, Copy, Debug)]
pub enum Work {
    /// So many pieces of work more.
    Ahead(u64),
    /// One piece is done.
    Done,
}

/// Cells that are timed in a round, for one configuration.
const TIMED_CELLS: usize = 1_500_000;
/// From so many cells on, a source is measured sparingly unless more is asked for.
const LARGE: usize = 100_000;

/// A source on its way to a report.
pub(crate) struct Study<'s> {
    reference: Reference<'s>,
    request: Request,
    demand: Demand,
    ranges: Ranges,
    effort: Effort,
}

impl Study<'_> {
    fn bits(&self, kept: Kept, step: Step) -> Result<Bits, BudgetError> {
        step.bits(self.demand, kept.layout(), &self.ranges)
    }
}

/// The lanes that are measured for an update: luminosity only where it has a rate.
fn useful(update: &crate::update::Update, kept: &[Kept]) -> Vec<Kept> {
    let lit = update.samples.iter().any(|sample| sample.known == Known::Motion && sample.luminosity_rate != 0.0);
    let useful: Vec<Kept> = kept.iter().copied().filter(|&kept| lit || kept != Kept::Luminosity).collect();
    if useful.is_empty() { kept.to_vec() } else { useful }
}

/// Checks that the budget of a source exists, without running anything.
///
/// *Errors:* a demand or lanes that give no budget.
pub fn check(source: &Source, plan: &Plan) -> Result<(), ExperimentError> {
    let update = source.update();
    let demand = demand(&update, plan.request.frames.unwrap_or(source.frames()), &plan.request);
    for kept in useful(&update, &plan.kept) {
        let bits = Step::DERIVED.bits(demand, kept.layout(), &Ranges::default())?;
        Dynamic::new(bits, kept.layout())?;
    }
    Ok(())
}

/// Measures a source; `tell` is told how it gets on.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn study(source: &Source, plan: &Plan, tell: impl Fn(Work) + Sync) -> Result<SourceReport, ExperimentError> {
    let frames = plan.request.frames.unwrap_or(source.frames());
    let reference = Reference::new(source, frames);
    let update = &reference.update;
    let demand = demand(update, frames, &plan.request);
    let axes = Axes { kept: useful(update, &plan.kept), roundings: plan.roundings.clone(), rungs: plan.rungs.clone() };
    let cells = update.samples.len();
    let effort = Effort {
        rounds: if cells > LARGE { 2 } else { 3 },
        frames: frames.min((TIMED_CELLS / cells.max(1)).clamp(4, 12) as u32),
    };
    let ranges = Ranges::of(update, frames);
    let study = Study { request: plan.request, demand, ranges, effort, reference };
    let mut left_out = Vec::new();
    let extent = match plan.extent {
        Extent::Sensible if cells > LARGE => {
            left_out
                .push("Large pictures: budgets were varied by all fractions together, by -2 to +1 bits; --full varies each field.".to_owned());
            Extent::Sparing
        }
        extent => extent,
    };
    let points = study.points(&axes.design(extent), &mut left_out, &tell)?;

    let middle = axes.middle();
    let bits = study.bits(middle.kept, middle.step)?;
    let format = Dynamic::new(bits, middle.kept.layout())?;
    let settings = study.settings(&middle, format.record());
    tell(Work::Ahead(1));
    let (causes, shown) = causes::causes(&study.reference, &middle, bits, settings)?;
    let rates = match source {
        Source::Scene(scene) => {
            let engine = Engine::new(format, settings).inpainting(middle.rung.inpaint());
            rates::rates(*scene, frames, &engine)?
        }
        Source::Capture(_) => Vec::new(),
    };
    tell(Work::Done);
    let ages = if rates.is_empty() { rates::ages(&study.reference.hold, &shown) } else { Vec::new() };
    let hold = Summary::of(&measure::hold(&study.reference));
    left_out.extend(omissions(&study, source, middle));
    let alone: Vec<&str> =
        axes.kept.iter().filter(|&&kept| stand_in::of(kept).is_none()).map(|kept| kept.name()).collect();
    if !alone.is_empty() {
        left_out.push(format!(
            "Lanes {} have no stand-in: they were timed in the run-time form alone, and are on no front of time.",
            alone.join(", ")
        ));
    }
    let reference = &study.reference;
    Ok(SourceReport {
        source: source.name().to_owned(),
        about: source.about().to_owned(),
        width: reference.update.display_width(),
        height: reference.update.display_height(),
        cells,
        frames,
        demand: DemandReport { extent: demand.extent, recog: demand.recog, prop: demand.prop },
        looked_at: reference.looked.clone(),
        pictures: reference.truths.iter().map(|truth| truth.frame).collect(),
        effort,
        fronts: fronts(&points),
        points,
        hold,
        causes,
        rates,
        ages,
        left_out,
    })
}

/// The three fronts, as numbers of points. The floats are beside them, not on them.
fn fronts(points: &[Point]) -> Fronts {
    type Cost<'c> = &'c dyn Fn(&Point) -> (Option<f64>, Option<f64>);
    let front = |cost: Cost<'_>| {
        let cost = |point: &Point| if point.scheme == Scheme::Galpix { cost(point) } else { (None, None) };
        let costs: Vec<_> = points.iter().map(cost).collect();
        pareto::front(&costs).into_iter().map(|index| points[index].id).collect()
    };
    let time = |point: &Point| point.compile_time.map(|time| time.frame_us);
    Fronts {
        position: front(&|point| (time(point), point.summary.worst_px)),
        picture: front(&|point| (time(point), point.summary.flip)),
        bytes: front(&|point| (Some(point.bytes as f64), point.summary.worst_px)),
    }
}

/// What was left out and what cannot be known, a sentence each.
fn omissions(study: &Study<'_>, source: &Source, middle: Configuration) -> Vec<String> {
    let reference = &study.reference;
    let mut left_out = vec![format!(
        "Positions were looked at in {} of {} frames, pictures in {}.",
        reference.looked.len(),
        reference.frames,
        reference.truths.len()
    )];
    if study.effort.frames < reference.frames {
        left_out.push(format!("The first {} frames were timed.", study.effort.frames));
    }
    match source {
        Source::Capture(_) => {
            left_out.push(
                "The true motion of a capture is not known: what second order leaves out of it (Taylor) shows in the \
                 pictures only, where it cannot be told from the snap and from shading. Positions are held against the \
                 exact second-order path."
                    .to_owned(),
            );
            left_out.push(
                "A capture has one update: the renderer cannot be run at other rates, so the true pictures are compared \
                 with by age."
                    .to_owned(),
            );
        }
        Source::Scene(scene) => {
            if rates::length(reference.frames) > scene.frames() {
                left_out.push(format!(
                    "The rates are compared over {} frames, beyond the {} that the scene is made for.",
                    rates::length(reference.frames),
                    scene.frames()
                ));
            }
        }
    }
    left_out.push("Floats have the rungs hold and, with the richest lanes, none.".to_owned());
    if middle.kept.layout() != Layout::FULL && middle.kept != Kept::Luminosity {
        left_out.push(format!("The causes and the rates are those of lanes {}.", middle.kept.name()));
    }
    left_out
}
