//! Error against run time: what each bit, field, rounding and fill mode costs and gains on a scene or a capture.
//!
//! ```text
//! design (configurations) ─┬─▶ measure (error of each) ──┐
//!                          ├─▶ timing (time of each) ────┼─▶ report ─▶ pareto ─▶ columns, text, page
//!                          └─▶ float (the same in f32) ──┘
//!            causes (frame by frame) and rates (updates every N frames) for the middle configuration
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each relative to a memory copy.

pub mod causes;
mod columns;
pub mod design;
mod figures;
pub mod float;
pub mod frames;
mod legend;
pub mod measure;
mod page;
pub mod pareto;
mod points;
pub mod ranges;
pub mod rates;
pub mod reference;
pub mod report;
pub mod stand_in;
mod text;

use galpix_core::{Bits, BudgetError, Dynamic, Layout, Rounding};

use super::job::{ExperimentError, Job, Request};
use super::timing::Effort;
use super::{File, Found, NoExtra, Silent, Stage, Study, StudyError, Work};
use crate::engine;
use crate::engine::fill::Fill;
use crate::output::column;
use crate::source::Source;
use crate::update::{Known, Update};
use design::{Axes, Extent, Kept, Step};
use ranges::Ranges;
use reference::Reference;
use report::{DemandReport, Fronts, Point, Scheme, SourceReport};

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, the design numbers, and the edge threshold; its rounding and its fill mode do not count.
    pub request: Request,
    /// Fields to choose from; those that the source has no use for are dropped unless nothing else is left.
    pub kept: Vec<Kept>,
    /// Roundings to choose from.
    pub roundings: Vec<Rounding>,
    /// Fill modes to choose from.
    pub fills: Vec<Fill>,
    /// Schemes to choose from, each for the fill modes that it takes.
    pub schemes: Vec<engine::Scheme>,
    /// How many configurations.
    pub extent: Extent,
    /// Which of them, and of the floats.
    pub shard: Shard,
}

/// A part of the points, so that several machines share them: of `of` parts the one that is counted `number`, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part.
    pub number: usize,
    /// Of how many.
    pub of: usize,
}

impl Shard {
    /// All points.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Returns whether the point of this number, counted from 1, is in the part.
    #[must_use]
    pub const fn takes(self, id: usize) -> bool {
        id % self.of == self.number % self.of
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("give K/N with K from 1 to N, as 3/16 for the third of sixteen parts".to_owned()),
        }
    }
}

/// Everything that was measured.
pub type Document = super::Document<NoExtra, SourceReport>;

/// Returns what the columns are.
#[must_use]
pub fn legend() -> String {
    column::legend(&columns::columns())
}

impl Study for Plan {
    type Source = Source;
    type Job<'s> = Job<'s>;
    type Report = SourceReport;
    type Extra = NoExtra;

    const NAME: &'static str = "error";

    fn name<'a>(&self, source: &'a Source) -> &'a str {
        source.name()
    }

    fn resolve<'s>(&self, source: &'s Source) -> Result<Job<'s>, StudyError> {
        self.job(source).map_err(StudyError::unusable)
    }

    fn pieces(&self, _job: &Job<'_>) -> u64 {
        0
    }

    fn study(&self, job: &Job<'_>, stage: &Stage<'_>) -> Result<Found<SourceReport>, StudyError> {
        study(job, self, stage.notify).map(Found::Report).map_err(StudyError::unusable)
    }

    fn legends(&self) -> Vec<String> {
        vec![legend()]
    }

    fn text(&self, report: &SourceReport) -> String {
        text::text(report)
    }

    fn extra(&self, _silent: &Silent) -> NoExtra {
        NoExtra {}
    }

    fn files(&self, document: &Document) -> Result<Vec<File>, StudyError> {
        let csv = column::csv(&columns::columns(), document.sources.iter().flat_map(columns::rows));
        super::files("error", csv, self.json(document), Vec::new(), page::html(document))
    }
}

impl Plan {
    /// Resolves what is asked of a source, with the fields of the middle configuration, and checks that the fields of
    /// the others have a budget too.
    ///
    /// *Errors:* a demand or fields that give no budget.
    fn job<'s>(&self, source: &'s Source) -> Result<Job<'s>, ExperimentError> {
        let job = Job::with_layout(source, &self.request, |update| self.axes(update).middle().kept.layout())?;
        for kept in self.axes(&job.update).kept {
            let bits = Step::DERIVED.bits(job.demand, kept.layout(), &Ranges::default())?;
            Dynamic::new(bits, kept.layout())?;
        }
        Ok(job)
    }

    /// Returns what is measured of an update: luminosity only where it has a rate.
    fn axes(&self, update: &Update) -> Axes {
        let lit = update.samples.iter().any(|sample| sample.known == Known::Motion && sample.luminosity_rate != 0.0);
        let useful: Vec<Kept> = self.kept.iter().copied().filter(|&kept| lit || kept != Kept::Luminosity).collect();
        let kept = if useful.is_empty() { self.kept.clone() } else { useful };
        Axes { kept, roundings: self.roundings.clone(), fills: self.fills.clone(), schemes: self.schemes.clone() }
    }
}

/// Cells that are timed in a round, for one configuration.
const TIMED_CELLS: usize = 1_000_000;
/// A source with at least so many cells is measured sparingly unless more is requested.
const LARGE: usize = 100_000;

/// A source while it is measured.
pub(crate) struct Run<'s> {
    job: &'s Job<'s>,
    reference: Reference<'s>,
    ranges: Ranges,
    effort: Effort,
}

impl Run<'_> {
    fn bits(&self, kept: Kept, step: Step) -> Result<Bits, BudgetError> {
        step.bits(self.job.demand, kept.layout(), &self.ranges)
    }
}

/// Measures a source; `notify` is called with the progress.
fn study(job: &Job<'_>, plan: &Plan, notify: &(dyn Fn(Work<'_>) + Sync)) -> Result<SourceReport, ExperimentError> {
    let Job { source, frames, demand, .. } = *job;
    let reference = Reference::of(job)?;
    let update = &reference.update;
    let axes = plan.axes(update);
    let cells = update.samples.len();
    let effort = Effort {
        rounds: if cells > LARGE { 3 } else { 5 },
        frames: frames.min((TIMED_CELLS / cells.max(1)).clamp(4, 12) as u32),
    };
    let ranges = Ranges::of(update, frames);
    let run = Run { job, ranges, effort, reference };
    let mut left_out = Vec::new();
    let extent = match plan.extent {
        Extent::Sensible if cells > LARGE => {
            left_out
                .push("Large pictures: budgets were varied by all fractions together, by -2 to +1 bits; --full varies each field.".to_owned());
            Extent::Sparing
        }
        extent => extent,
    };
    let (points, noise) = run.points((&axes.design(extent), plan.shard), &mut left_out, notify)?;
    if plan.shard != Shard::WHOLE {
        let Shard { number, of } = plan.shard;
        left_out.push(format!("These are the points of part {number} of {of}; fronts are of these alone."));
    }

    let middle = axes.middle();
    let job = job.with_rounding(middle.rounding).with_scheme(middle.scheme).with_fill(middle.fill);
    notify(Work::Ahead(1));
    let (causes, shown) = causes::causes(&run.reference, &middle, job.bits, job.settings)?;
    let rates = match source {
        Source::Scene(scene) => rates::rates(*scene, frames, &job.engine())?,
        Source::Capture(_) => Vec::new(),
    };
    notify(Work::Done);
    let ages = if rates.is_empty() { rates::ages(&run.reference.hold, &shown) } else { Vec::new() };
    let hold = measure::hold(&run.reference);
    left_out.extend(omissions(&run, source, &axes));
    let alone: Vec<&str> =
        axes.kept.iter().filter(|&&kept| stand_in::of(kept).is_none()).map(|kept| kept.name()).collect();
    if !alone.is_empty() {
        left_out.push(format!(
            "Lanes {} have no stand-in: they were timed in the run-time form alone, and are on no front of time.",
            alone.join(", ")
        ));
    }
    let reference = &run.reference;
    Ok(SourceReport {
        source: source.name().to_owned(),
        about: source.about().to_owned(),
        width: reference.update.display_width(),
        height: reference.update.display_height(),
        cells,
        frames,
        demand: DemandReport { extent: demand.extent, recog: demand.recog, prop: demand.prop },
        looked_at: reference.looked.clone(),
        pictures: reference.pictures(),
        effort,
        noise,
        fronts: fronts(&points),
        points,
        hold,
        causes,
        rates,
        ages,
        left_out,
    })
}

/// Returns the three fronts, as numbers of points. Floats are not among them. Position errors are ranked by what they
/// can be at most: what was measured on one source may have been luck.
fn fronts(points: &[Point]) -> Fronts {
    type Cost<'c> = &'c dyn Fn(&Point) -> (Option<f64>, Option<f64>);
    let front = |cost: Cost<'_>| {
        let cost = |point: &Point| if point.scheme == Scheme::F32 { (None, None) } else { cost(point) };
        let costs: Vec<_> = points.iter().map(cost).collect();
        pareto::front(&costs).into_iter().map(|index| points[index].id).collect::<Vec<usize>>()
    };
    let time = |point: &Point| point.compile_time.map(|time| time.frame_us);
    let position = front(&|point| (time(point), point.at_most_px()));
    let picture = front(&|point| (time(point), point.summary.flip));
    Fronts {
        position_not_told_apart: not_told_apart(points, &position),
        picture_not_told_apart: not_told_apart(points, &picture),
        position,
        picture,
        bytes: front(&|point| (Some(point.bytes as f64), point.at_most_px())),
    }
}

/// Returns the neighbours on a front of time whose times overlap: which of the two is quicker is not known.
fn not_told_apart(points: &[Point], front: &[usize]) -> Vec<[usize; 2]> {
    let time = |id: usize| points.iter().find(|point| point.id == id)?.compile_time;
    let overlap = |pair: &[usize; 2]| {
        time(pair[0]).zip(time(pair[1])).is_some_and(|(first, second)| !first.is_told_apart(&second))
    };
    front.windows(2).map(|pair| [pair[0], pair[1]]).filter(overlap).collect()
}

/// Returns what was left out and what cannot be known, a sentence each.
fn omissions(run: &Run<'_>, source: &Source, axes: &Axes) -> Vec<String> {
    let reference = &run.reference;
    let mut left_out = vec![format!(
        "Positions were looked at in {} of {} frames, pictures in {}.",
        reference.looked.len(),
        reference.frames,
        reference.pictures().len()
    )];
    if run.effort.frames < reference.frames {
        left_out.push(format!("The first {} frames were timed.", run.effort.frames));
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
    if axes.schemes.contains(&engine::Scheme::Source) {
        let not: Vec<&str> =
            axes.fills.iter().filter(|&&fill| !engine::Scheme::Source.takes(fill)).map(|fill| fill.name()).collect();
        if !not.is_empty() {
            left_out.push(format!("Stationary sources do not have {}.", not.join(", ")));
        }
        left_out.push(
            "Stationary sources have no stand-in: they were timed in the run-time form alone, with the picture, and are \
             on no front of time."
                .to_owned(),
        );
    }
    left_out.push("Floats have the fill modes hold and, with the richest fields, none.".to_owned());
    let middle = axes.middle();
    if middle.kept.layout() != Layout::FULL && middle.kept != Kept::Luminosity {
        left_out.push(format!("The causes and the rates are those of fields {}.", middle.kept.name()));
    }
    left_out
}
