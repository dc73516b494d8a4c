//! A comparison of fills: how well, and at what cost, each fills what the warp of a source leaves open.
//!
//! ```text
//! holes (the warp alone: which cells are judged) ─┬─▶ figures (of each fill's pictures) ─┐
//! case (the fills) ───────────────────────────────┼─▶ times (of each fill's frames) ─────┼─▶ report ─▶ columns, page
//!                                                 └─▶ export (pictures for other programs) and crops
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each relative to a memory copy.

pub mod case;
mod columns;
pub mod export;
pub mod figures;
mod page;
pub mod report;
mod times;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::cells::count;
use super::crops;
use super::holes::{self, Holes};
use super::job::{ExperimentError, Job, Request};
use super::run::{self, TruthReport};
use super::timing::Race;
use super::{File, Found, Nothing, Silent, Stage, Study, StudyError, Work, silent};
use crate::metric::measures::Measures;
use crate::output::column;
use crate::picture::Picture;
use crate::source::Source;
use case::Case;
use export::{Export, ExportError};
use figures::{Figures, TruthFigures, Weight};
use report::{FillReport, FrameCells, FrameFigures, SourceReport};

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, design numbers, rounding; its scheme and its fill do not count.
    pub request: Request,
    /// The fills, from cheap to rich, in each scheme.
    pub cases: Vec<Case>,
    /// What a scheme does not have of them, a sentence each.
    pub left_out: Vec<String>,
    /// The radius of a disc in the middle of the display, in pixels, inside of which nothing is judged.
    pub fovea: Option<u32>,
}

/// What is reported besides the sources.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Extra {
    /// The radius of the disc inside of which nothing is judged.
    pub fovea: Option<u32>,
    /// The sources in which nothing is disoccluded.
    pub nothing_disoccluded: Vec<String>,
    /// What a scheme does not have of the fills, a sentence each.
    pub left_out: Vec<String>,
}

/// Everything that was measured.
pub type Document = super::Document<Extra, SourceReport>;

/// Returns what the columns are.
#[must_use]
pub fn legend() -> String {
    column::legend(&columns::columns())
}

impl Study for Plan {
    type Source = Source;
    type Job<'s> = Job<'s>;
    type Report = SourceReport;
    type Extra = Extra;

    const NAME: &'static str = "fills";

    fn name<'a>(&self, source: &'a Source) -> &'a str {
        source.name()
    }

    fn resolve<'s>(&self, source: &'s Source) -> Result<Job<'s>, StudyError> {
        Job::resolve(source, &self.request).map_err(StudyError::unusable)
    }

    fn pieces(&self, _job: &Job<'_>) -> u64 {
        self.cases.len() as u64
    }

    fn study(&self, job: &Job<'_>, stage: &Stage<'_>) -> Result<Found<SourceReport>, StudyError> {
        let export = stage.out.map(Export::new);
        let removed = export.as_ref().map_or(0, Export::clear);
        if removed > 0 {
            (stage.notify)(Work::Note(&format!(
                "{removed} pictures of an earlier run removed: its index.json lists them"
            )));
        }
        let report =
            compare(job, self, export.as_ref(), || (stage.notify)(Work::Done)).map_err(StudyError::unusable)?;
        Ok(report.map_or(Found::Nothing(Nothing::Disoccluded), Found::Report))
    }

    fn head(&self) -> Option<String> {
        (!self.left_out.is_empty()).then(|| self.left_out.join("\n"))
    }

    fn legends(&self) -> Vec<String> {
        vec![legend()]
    }

    fn text(&self, report: &SourceReport) -> String {
        columns::text(report)
    }

    fn extra(&self, all: &Silent) -> Extra {
        let nothing_disoccluded = silent(all, Nothing::Disoccluded);
        Extra { fovea: self.fovea, nothing_disoccluded, left_out: self.left_out.clone() }
    }

    fn files(&self, document: &Document) -> Result<Vec<File>, StudyError> {
        let csv = column::csv(&columns::columns(), document.sources.iter().flat_map(columns::rows));
        let index = export::index(document).map_err(StudyError::failed)?;
        let further = vec![("index.json".to_owned(), index.into_bytes())];
        super::files("fills", csv, self.json(document), further, page::html(document))
    }
}

/// Why a study cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FillsError {
    /// The source cannot be run.
    #[error("{0}")]
    Experiment(#[from] ExperimentError),
    /// Pictures cannot be written.
    #[error("{0}")]
    Export(#[from] ExportError),
}

/// Compares the fills on a source; `None` if nothing is disoccluded in it. `done` is called after each fill.
///
/// *Errors:* a budget that cannot exist or does not fit, pictures that cannot be written.
pub fn study(
    source: &Source,
    plan: &Plan,
    export: Option<&Export>,
    done: impl Fn() + Sync,
) -> Result<Option<SourceReport>, FillsError> {
    compare(&Job::resolve(source, &plan.request)?, plan, export, done)
}

/// Compares the fills on a job, as [`study`] does.
fn compare(
    job: &Job<'_>,
    plan: &Plan,
    export: Option<&Export>,
    done: impl Fn() + Sync,
) -> Result<Option<SourceReport>, FillsError> {
    let holes = holes::of(job, plan.fovea)?;
    let Some(largest) = crops::largest(&holes) else { return Ok(None) };
    if let Some(export) = export {
        holes.iter().try_for_each(|holes| export.truth(job.source, holes))?;
    }
    let weights: Vec<Weight> = each(&holes).map(|(before, now)| Weight::of(before, now)).collect();
    let truths: Vec<TruthFigures> = each(&holes).map(|(before, now)| figures::truth(before, now)).collect();
    let open: Vec<Holes> = holes.iter().map(|holes| holes.with_border(plan.fovea)).collect();
    let open_weights: Vec<Weight> = each(&open).map(|(before, now)| Weight::of(before, now)).collect();
    let judged = Judged { job, holes: &holes, open: &open, truths: &truths, export };
    let shown: Vec<Shown> = plan
        .cases
        .par_iter()
        .map(|case| {
            let shown = judged.show(case, largest.frame);
            done();
            shown
        })
        .collect::<Result<_, _>>()?;
    let Race { times, noise } = times::of(job, &plan.cases);
    let mut crops = crops::of_truth(&holes, &largest);
    let fills = shown.into_iter().zip(&plan.cases).zip(times).map(|((shown, case), time)| {
        crops.extend(shown.largest.map(|picture| crops::crop(case.label(), &picture, &largest)));
        let frames = holes.iter().zip(&shown.figures).zip(&shown.open).zip(&shown.truths);
        let frame = |(((holes, &figures), &open), &truth): (((&Holes, &Figures), &Figures), &TruthReport)| {
            FrameFigures { frame: holes.frame, figures, open, truth }
        };
        FillReport {
            name: case.name,
            label: case.label(),
            scheme: case.scheme.name(),
            gamma: case.fill.inpaint().map(|inpaint| inpaint.gamma.name()),
            depth_aware: case.fill.inpaint().map(|inpaint| inpaint.depth_aware),
            time,
            summary: figures::summary(&shown.figures, &weights),
            open: figures::summary(&shown.open, &open_weights),
            measures: Measures::mean(shown.truths.iter().map(TruthReport::measures)),
            frames: frames.map(frame).collect(),
        }
    });
    let fills = fills.collect();
    Ok(Some(SourceReport {
        source: job.source.name().to_owned(),
        about: job.source.about().to_owned(),
        width: job.update.display_width(),
        height: job.update.display_height(),
        frames: job.frames,
        noise,
        cells: holes.iter().map(cells).collect(),
        truth: figures::truth_summary(&truths, &weights),
        fills,
        largest,
        crops,
    }))
}

/// Returns each frame with the one before it in the list.
fn each(holes: &[Holes]) -> impl Iterator<Item = (Option<&Holes>, &Holes)> {
    holes.iter().enumerate().map(|(index, now)| (index.checked_sub(1).map(|before| &holes[before]), now))
}

fn cells(holes: &Holes) -> FrameCells {
    FrameCells {
        frame: holes.frame,
        missing: count(&holes.all),
        at_border: count(&holes.at_border),
        disoccluded: count(&holes.disoccluded),
    }
}

/// What a fill showed.
struct Shown {
    /// In each frame with a truth.
    figures: Vec<Figures>,
    /// The same over all cells that the warp leaves open.
    open: Vec<Figures>,
    /// The same frames against the truth.
    truths: Vec<TruthReport>,
    /// The picture with the largest disocclusion.
    largest: Option<Picture>,
}

/// The measures of fills.
struct Judged<'s> {
    job: &'s Job<'s>,
    holes: &'s [Holes],
    /// The same frames where all cells are judged that the warp leaves open.
    open: &'s [Holes],
    truths: &'s [TruthFigures],
    export: Option<&'s Export>,
}

impl Judged<'_> {
    /// Runs a fill; keeps its picture of frame `wanted`.
    fn show(&self, case: &Case, wanted: u32) -> Result<Shown, FillsError> {
        let mut shown = Shown { figures: Vec::new(), open: Vec::new(), truths: Vec::new(), largest: None };
        let mut written = Ok(());
        let mut last: Option<(&Holes, Picture)> = None;
        let mut frames = self.holes.iter().zip(self.open).zip(self.truths).peekable();
        let job = self.job.with_scheme(case.scheme).with_fill(case.fill).without_perception();
        let report = run::job(&job, |frame| {
            let next = frames.next_if(|((holes, _), _)| holes.frame == frame.frame);
            let Some(((holes, open), truth)) = next else { return };
            let before = last.as_ref().map(|(before, picture)| (*before, picture));
            shown.figures.push(figures::of(holes, frame.picture, before, truth));
            shown.open.push(figures::open(open, frame.picture));
            if let (Some(export), Ok(())) = (self.export, &written) {
                written = export.filled(self.job.source, holes, &case.label(), frame.picture);
            }
            if holes.frame == wanted {
                shown.largest = Some(frame.picture.clone());
            }
            last = Some((holes, frame.picture.clone()));
        })?;
        written?;
        shown.truths = report.frames.iter().filter_map(|frame| frame.truth).collect();
        Ok(shown)
    }
}
