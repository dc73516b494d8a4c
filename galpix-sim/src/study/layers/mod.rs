//! The ways to know what was hidden side by side: how much of what the warp leaves open each of them fills, for how
//! many samples and at what cost, and how far the picture is from the truth after the fill ladder did the rest.
//!
//! ```text
//! holes (the warp of the first layer alone) ─┬─▶ shown (each way's frames) ─┬─▶ report ─▶ columns, page
//! ways ──────────────────────────────────────┴─▶ times (each way's frames) ─┘
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each beside a memory copy.

mod columns;
mod map;
mod page;
pub mod report;
mod times;

use rayon::prelude::*;
use serde::Serialize;

use super::crops;
use super::holes::{self, Holes, count};
use super::job::{ExperimentError, Job, Request};
use super::{File, Found, Nothing, Silent, Stage, StudyError, Work, run, silent};
use crate::metric;
use crate::output::column;
use crate::picture::Picture;
use crate::source::Source;
use crate::source::hidden::{self, Arrangement, Kind, RADIUS, SEPARATION, Way};
use report::{FrameCells, SourceReport, WayFrame, WayReport};

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, design numbers, rounding, fill; its way does not count.
    pub request: Request,
    /// The ways; the first one is [`Way::ONE`], that the others are compared with.
    pub ways: Vec<Way>,
}

/// All of them: the first layer alone, and each kind as it comes and culled.
#[must_use]
pub fn ways(separation: f64) -> Vec<Way> {
    let whole = Way { kind: Kind::Second { separation }, ..Way::ONE };
    let ways = [
        Way { kind: Kind::Second { separation: 0.0 }, ..whole },
        Way { arrangement: Arrangement::Nearer, ..whole },
        whole,
        Way { kind: Kind::Ddoc { radius: RADIUS }, arrangement: Arrangement::Nearer, ..whole },
        Way { kind: Kind::Ddoc { radius: RADIUS }, ..whole },
        Way { kind: Kind::Unlimited, ..whole },
    ];
    let both = ways.iter().flat_map(|&way| [false, true].map(|culled| Way { culled, ..way }));
    std::iter::once(Way::ONE).chain(both).collect()
}

impl Default for Plan {
    fn default() -> Self {
        Self { request: Request::default(), ways: ways(SEPARATION) }
    }
}

/// What is said beside the sources.
#[derive(Clone, Debug, Serialize)]
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
    /// Returns the separation of the separated ways.
    fn separation(&self) -> f64 {
        let separations = self.ways.iter().filter_map(|way| match way.kind {
            Kind::Second { separation } => Some(separation),
            _ => None,
        });
        separations.fold(0.0, f64::max)
    }
}

impl super::Study for Plan {
    type Source = Source;
    type Job<'s> = Job<'s>;
    type Report = SourceReport;
    type Extra = Extra;

    const LEGEND: Option<&'static str> = Some(columns::LEGEND);

    fn name<'a>(&self, source: &'a Source) -> &'a str {
        source.name()
    }

    fn resolve<'s>(&self, source: &'s Source) -> Result<Job<'s>, StudyError> {
        Job::resolve(source, &self.request).map_err(StudyError::unusable)
    }

    fn pieces(&self, _job: &Job<'_>) -> u64 {
        self.ways.len() as u64
    }

    fn study(&self, job: &Job<'_>, stage: &Stage<'_>) -> Result<Found<SourceReport>, StudyError> {
        Ok(match compare(job, self, || (stage.tell)(Work::Done)).map_err(StudyError::unusable)? {
            Study::NothingDisoccluded => Found::Nothing(Nothing::Disoccluded),
            Study::NothingHidden => Found::Nothing(Nothing::Hidden),
            Study::Compared(report) => Found::Report(*report),
        })
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

/// What a source had to say.
pub enum Study {
    /// Nothing is disoccluded in it.
    NothingDisoccluded,
    /// It knows nothing behind its first layer.
    NothingHidden,
    /// How the ways compare, without those that it does not have.
    Compared(Box<SourceReport>),
}

/// Compares the ways on a source. `done` is told of each way that is through.
///
/// *Errors:* a budget that cannot exist or does not fit.
pub fn study(source: &Source, plan: &Plan, done: impl Fn() + Sync) -> Result<Study, ExperimentError> {
    compare(&Job::resolve(source, &plan.request)?, plan, done)
}

/// Compares the ways on a job, as [`study`] does.
fn compare(job: &Job<'_>, plan: &Plan, done: impl Fn() + Sync) -> Result<Study, ExperimentError> {
    let ways: Vec<Way> = plan.ways.iter().copied().filter(|way| hidden::has(job.source, way.kind)).collect();
    if ways.iter().all(|way| way.kind == Kind::None) {
        return Ok(Study::NothingHidden);
    }
    let holes = holes::of(&job.with_way(Way::ONE), None)?;
    let Some(largest) = crops::largest(&holes) else { return Ok(Study::NothingDisoccluded) };
    let shown: Vec<Shown> = ways
        .par_iter()
        .map(|&way| {
            let shown = show(job, way, &holes, largest.frame);
            done();
            shown
        })
        .collect::<Result<_, _>>()?;
    let times = times::of(job, &ways)?;
    let of_one = times.first().and_then(|(time, _)| *time);
    let mut crops = crops::of_truth(&holes, &largest);
    let reports = shown.into_iter().zip(&ways).zip(times).map(|((shown, &way), (time, update_us))| {
        crops.extend(shown.largest.map(|picture| crops::crop(way.name(), &picture, &largest)));
        let x_one = time.zip(of_one).map(|(time, one)| time.frame_us / one.frame_us.max(1e-9));
        WayReport { hidden: shown.hidden, time, x_one, update_us, ..WayReport::of(way, shown.frames) }
    });
    let ways = reports.collect();
    Ok(Study::Compared(Box::new(SourceReport {
        source: job.source.name().to_owned(),
        about: job.source.about().to_owned(),
        width: job.update.display_width(),
        height: job.update.display_height(),
        frames: job.frames,
        cells: holes.iter().map(cells).collect(),
        ways,
        largest,
        crops,
        map: Some(map::picture(job)?),
    })))
}

fn cells(holes: &Holes) -> FrameCells {
    FrameCells { frame: holes.frame, missing: count(&holes.all), disoccluded: count(&holes.disoccluded) }
}

/// What a way showed.
struct Shown {
    frames: Vec<WayFrame>,
    hidden: Option<hidden::HiddenReport>,
    /// The picture with the largest disocclusion.
    largest: Option<Picture>,
}

fn show(job: &Job<'_>, way: Way, holes: &[Holes], wanted: u32) -> Result<Shown, ExperimentError> {
    let (mut frames, mut largest) = (Vec::with_capacity(holes.len()), None);
    let mut rest = holes.iter().peekable();
    let report = run::job(&job.with_way(way).without_perception(), |frame| {
        let Some(holes) = rest.next_if(|holes| holes.frame == frame.frame) else { return };
        let counts = |cell: usize| frame.truth.is_none_or(|truth| truth.mask.as_ref().is_none_or(|mask| mask[cell]));
        let missing: Vec<bool> = (0..frame.reached.len()).map(|cell| !frame.reached[cell] && counts(cell)).collect();
        let inside: Vec<bool> = missing.iter().zip(&holes.disoccluded).map(|(&a, &b)| a && b).collect();
        let mask = frame.truth.and_then(|truth| truth.mask.as_deref());
        frames.push(WayFrame {
            frame: holes.frame,
            missing: count(&missing),
            disoccluded: count(&inside),
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
