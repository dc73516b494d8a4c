//! A comparison of strategies for hidden samples: how many of the missing cells each of them fills, with how many
//! samples and at what cost, and how far the picture is from the truth after the fill mode.
//!
//! ```text
//! holes (the warp of the first layer alone) ─┬─▶ shown (each strategy's frames) ─┬─▶ report ─▶ columns, page
//! strategies ───────────────────────────────┴─▶ times (each strategy's frames) ─┘
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each relative to a memory copy.

mod columns;
mod map;
mod page;
pub mod report;
mod times;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::cells::{Cells, count};
use super::crops;
use super::holes::{self, Holes};
use super::job::{ExperimentError, Job, Request};
use super::{File, Found, Nothing, Silent, Stage, StudyError, Work, run, silent};
use crate::metric;
use crate::output::column;
use crate::picture::Picture;
use crate::source::Source;
use crate::source::hidden::{self, Arrangement, Kind, RADIUS, SEPARATION, Strategy};
use report::{FrameCells, SourceReport, StrategyFrame, StrategyReport};

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, design numbers, rounding, fill; its strategy does not count.
    pub request: Request,
    /// The strategies; the first one is [`Strategy::ONE`], that the others are compared with.
    pub strategies: Vec<Strategy>,
}

/// Returns all of them: the first layer alone, and each kind as it comes and culled.
#[must_use]
pub fn strategies(separation: f64) -> Vec<Strategy> {
    let whole = Strategy { kind: Kind::Second { separation }, ..Strategy::ONE };
    let strategies = [
        Strategy { kind: Kind::Second { separation: 0.0 }, ..whole },
        Strategy { arrangement: Arrangement::Nearer, ..whole },
        whole,
        Strategy { kind: Kind::Ddoc { radius: RADIUS }, arrangement: Arrangement::Nearer, ..whole },
        Strategy { kind: Kind::Ddoc { radius: RADIUS }, ..whole },
        Strategy { kind: Kind::Unlimited, ..whole },
    ];
    let both = strategies.iter().flat_map(|&strategy| [false, true].map(|culled| Strategy { culled, ..strategy }));
    std::iter::once(Strategy::ONE).chain(both).collect()
}

impl Default for Plan {
    fn default() -> Self {
        Self { request: Request::default(), strategies: strategies(SEPARATION) }
    }
}

/// What is reported besides the sources.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Extra {
    /// How far a separated second layer lies behind the first at least, as a part of the depth range.
    pub separation: f64,
    /// The sources in which nothing is disoccluded.
    pub nothing_disoccluded: Vec<String>,
    /// The sources that know nothing behind their first layer.
    pub nothing_hidden: Vec<String>,
}

/// Everything that was measured.
pub type Document = super::Document<Extra, SourceReport>;

impl Plan {
    /// Returns the separation of the separated strategies.
    fn separation(&self) -> f64 {
        let separations = self.strategies.iter().filter_map(|strategy| match strategy.kind {
            Kind::Second { separation } => Some(separation),
            _ => None,
        });
        separations.fold(0.0, f64::max)
    }
}

/// Returns what the columns are.
#[must_use]
pub fn legend() -> String {
    column::legend(&columns::columns())
}

impl super::Study for Plan {
    type Source = Source;
    type Job<'s> = Job<'s>;
    type Report = SourceReport;
    type Extra = Extra;

    const NAME: &'static str = "layers";

    fn name<'a>(&self, source: &'a Source) -> &'a str {
        source.name()
    }

    fn resolve<'s>(&self, source: &'s Source) -> Result<Job<'s>, StudyError> {
        Job::resolve(source, &self.request).map_err(StudyError::unusable)
    }

    fn pieces(&self, _job: &Job<'_>) -> u64 {
        self.strategies.len() as u64
    }

    fn study(&self, job: &Job<'_>, stage: &Stage<'_>) -> Result<Found<SourceReport>, StudyError> {
        Ok(match compare(job, self, || (stage.notify)(Work::Done)).map_err(StudyError::unusable)? {
            Study::NothingDisoccluded => Found::Nothing(Nothing::Disoccluded),
            Study::NothingHidden => Found::Nothing(Nothing::Hidden),
            Study::Compared(report) => Found::Report(*report),
        })
    }

    fn legends(&self) -> Vec<String> {
        vec![legend()]
    }

    fn text(&self, report: &SourceReport) -> String {
        columns::text(report)
    }

    fn extra(&self, all: &Silent) -> Extra {
        let [nothing_disoccluded, nothing_hidden] =
            [Nothing::Disoccluded, Nothing::Hidden].map(|reason| silent(all, reason));
        Extra { separation: self.separation(), nothing_disoccluded, nothing_hidden }
    }

    fn files(&self, document: &Document) -> Result<Vec<File>, StudyError> {
        let csv = column::csv(&columns::columns(), document.sources.iter().flat_map(columns::rows));
        super::files("layers", csv, self.json(document), Vec::new(), page::html(document))
    }
}

/// The result for a source.
pub enum Study {
    /// Nothing is disoccluded in it.
    NothingDisoccluded,
    /// It knows nothing behind its first layer.
    NothingHidden,
    /// How the strategies compare, without those that it does not have.
    Compared(Box<SourceReport>),
}

/// Compares the strategies on a source. `done` is called after each strategy.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn study(source: &Source, plan: &Plan, done: impl Fn() + Sync) -> Result<Study, ExperimentError> {
    compare(&Job::resolve(source, &plan.request)?, plan, done)
}

/// Compares the strategies on a job, as [`study`] does.
fn compare(job: &Job<'_>, plan: &Plan, done: impl Fn() + Sync) -> Result<Study, ExperimentError> {
    let strategies: Vec<Strategy> =
        plan.strategies.iter().copied().filter(|strategy| hidden::has(job.source, strategy.kind)).collect();
    if strategies.iter().all(|strategy| strategy.kind == Kind::None) {
        return Ok(Study::NothingHidden);
    }
    let holes = holes::of(&job.with_strategy(Strategy::ONE), None)?;
    let Some(largest) = crops::largest(&holes) else { return Ok(Study::NothingDisoccluded) };
    let shown: Vec<Shown> = strategies
        .par_iter()
        .map(|&strategy| {
            let shown = show(job, strategy, &holes, largest.frame);
            done();
            shown
        })
        .collect::<Result<_, _>>()?;
    let (times, noise) = times::of(job, &strategies)?;
    let of_one = times.first().and_then(|(time, _)| *time);
    let mut crops = crops::of_truth(&holes, &largest);
    let reports = shown.into_iter().zip(&strategies).zip(times).map(|((shown, &strategy), (time, update_us))| {
        crops.extend(shown.largest.map(|picture| crops::crop(strategy.name(), &picture, &largest)));
        let x_one = time.zip(of_one).map(|(time, one)| time.frame_us / one.frame_us.max(1e-9));
        StrategyReport { hidden: shown.hidden, time, x_one, update_us, ..StrategyReport::of(strategy, shown.frames) }
    });
    let strategies = reports.collect();
    Ok(Study::Compared(Box::new(SourceReport {
        source: job.source.name().to_owned(),
        about: job.source.about().to_owned(),
        width: job.update.display_width(),
        height: job.update.display_height(),
        frames: job.frames,
        cells: holes.iter().map(cells).collect(),
        noise,
        strategies,
        largest,
        crops,
        map: Some(map::picture(job)?),
    })))
}

fn cells(holes: &Holes) -> FrameCells {
    FrameCells { frame: holes.frame, missing: count(&holes.all), disoccluded: count(&holes.disoccluded) }
}

/// What a strategy showed.
struct Shown {
    frames: Vec<StrategyFrame>,
    hidden: Option<hidden::HiddenReport>,
    /// The picture with the largest disocclusion.
    largest: Option<Picture>,
}

fn show(job: &Job<'_>, strategy: Strategy, holes: &[Holes], wanted: u32) -> Result<Shown, ExperimentError> {
    let (mut frames, mut largest) = (Vec::with_capacity(holes.len()), None);
    let mut rest = holes.iter().peekable();
    let report = run::job(&job.with_strategy(strategy).without_perception(), |frame| {
        let Some(holes) = rest.next_if(|holes| holes.frame == frame.frame) else { return };
        let Some(truth) = frame.truth else { return };
        let missing = Cells::of(truth, frame.reached).missing;
        let disoccluded: Vec<bool> = missing.iter().zip(&holes.disoccluded).map(|(&a, &b)| a && b).collect();
        let mask = truth.mask.as_deref();
        frames.push(StrategyFrame {
            frame: holes.frame,
            missing: count(&missing),
            disoccluded: count(&disoccluded),
            psnr_db: metric::psnr_db(frame.picture, &holes.truth, mask),
            flip: metric::flip(frame.picture, &holes.truth, mask),
            disoccluded_db: metric::psnr_db(frame.picture, &holes.truth, Some(&holes.disoccluded)),
        });
        if holes.frame == wanted {
            largest = Some(frame.picture.clone());
        }
    })?;
    Ok(Shown { frames, hidden: report.hidden, largest })
}
