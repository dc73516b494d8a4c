//! Every fill side by side: how well, and at what cost, each makes up what the warp of a source leaves open.
//!
//! ```text
//! holes (the warp alone: which cells are judged) ─┬─▶ figures (of each fill's pictures) ─┐
//! case (the fills) ───────────────────────────────┼─▶ times (of each fill's frames) ─────┼─▶ report ─▶ table, csv, page
//!                                                 └─▶ export (pictures for other programs) and crops
//! ```
//!
//! Errors are measured on all processors, times afterwards on one, each beside a memory copy.

pub mod case;
pub mod crops;
pub mod csv;
pub mod export;
pub mod figures;
pub mod holes;
pub mod page;
pub mod report;
pub mod table;
pub mod times;

use rayon::prelude::*;

use crate::picture::Picture;
use crate::source::Source;
use crate::study::run::{self, ExperimentError, Request};
use case::Case;
use export::{Export, ExportError};
use figures::{Figures, TruthFigures, Weight};
use holes::{Holes, count};
use report::{FillReport, FrameCells, FrameFigures, SourceReport};

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Frames, design numbers, rounding; its fill does not count.
    pub request: Request,
    /// The fills, from cheap to rich.
    pub cases: Vec<Case>,
    /// The radius of a disc in the middle of the display, in pixels, inside of which nothing is judged.
    pub fovea: Option<u32>,
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

/// Compares the fills on a source; `None` if nothing is disoccluded in it. `done` is told of each fill that is through.
///
/// *Errors:* a budget that cannot exist or does not fit, pictures that cannot be written.
pub fn study(
    source: &Source,
    plan: &Plan,
    export: Option<&Export>,
    done: impl Fn() + Sync,
) -> Result<Option<SourceReport>, FillsError> {
    let holes = holes::of(source, &plan.request, plan.fovea)?;
    let Some(largest) = crops::largest(&holes) else { return Ok(None) };
    if let Some(export) = export {
        holes.iter().try_for_each(|holes| export.truth(source, holes))?;
    }
    let weights: Vec<Weight> = each(&holes).map(|(before, now)| Weight::of(before, now)).collect();
    let truths: Vec<TruthFigures> = each(&holes).map(|(before, now)| figures::truth(before, now)).collect();
    let judged = Judged { source, plan, holes: &holes, truths: &truths, export };
    let shown: Vec<Shown> = plan
        .cases
        .par_iter()
        .map(|case| {
            let shown = judged.show(case, largest.frame);
            done();
            shown
        })
        .collect::<Result<_, _>>()?;
    let times = times::of(source, plan)?;
    let mut crops = crops::of_truth(&holes, &largest);
    let fills = shown.into_iter().zip(&plan.cases).zip(times).map(|((shown, case), time)| {
        crops.extend(shown.largest.map(|picture| crops::crop(case.name, &picture, &largest)));
        let frames = holes.iter().zip(&shown.figures);
        FillReport {
            name: case.name,
            gamma: case.fill.inpaint().map(|inpaint| inpaint.gamma.name()),
            depth_aware: case.fill.inpaint().map(|inpaint| inpaint.depth_aware),
            time,
            summary: figures::summary(&shown.figures, &weights),
            frames: frames.map(|(holes, &figures)| FrameFigures { frame: holes.frame, figures }).collect(),
        }
    });
    let fills = fills.collect();
    let update = source.update();
    Ok(Some(SourceReport {
        source: source.name().to_owned(),
        about: source.about().to_owned(),
        width: update.display_width(),
        height: update.display_height(),
        frames: plan.request.frames.unwrap_or(source.frames()),
        cells: holes.iter().map(cells).collect(),
        truth: figures::truth_summary(&truths, &weights),
        fills,
        largest,
        crops,
    }))
}

/// Each frame with the one before it in the list.
fn each(holes: &[Holes]) -> impl Iterator<Item = (Option<&Holes>, &Holes)> {
    holes.iter().enumerate().map(|(index, now)| (index.checked_sub(1).map(|before| &holes[before]), now))
}

fn cells(holes: &Holes) -> FrameCells {
    let (width, height) = (holes.truth.width, holes.truth.height);
    let at_border = count(&crate::metric::area::at_border(&holes.all, width, height));
    FrameCells { frame: holes.frame, missing: count(&holes.all), at_border, disoccluded: count(&holes.disoccluded) }
}

/// What a fill showed.
struct Shown {
    /// In each frame with a truth.
    figures: Vec<Figures>,
    /// The picture with the largest disocclusion.
    largest: Option<Picture>,
}

/// What fills are judged by.
struct Judged<'s> {
    source: &'s Source,
    plan: &'s Plan,
    holes: &'s [Holes],
    truths: &'s [TruthFigures],
    export: Option<&'s Export>,
}

impl Judged<'_> {
    /// Runs a fill; keeps its picture of frame `wanted`.
    fn show(&self, case: &Case, wanted: u32) -> Result<Shown, FillsError> {
        let request = Request { fill: case.fill, perceptual: false, ..self.plan.request };
        let mut shown = Shown { figures: Vec::with_capacity(self.holes.len()), largest: None };
        let mut written = Ok(());
        let mut last: Option<(&Holes, Picture)> = None;
        let mut frames = self.holes.iter().zip(self.truths).peekable();
        run::run(self.source, &request, |frame| {
            let Some((holes, truth)) = frames.next_if(|(holes, _)| holes.frame == frame.frame) else { return };
            let before = last.as_ref().map(|(before, picture)| (*before, picture));
            shown.figures.push(figures::of(holes, frame.picture, before, truth));
            if let (Some(export), Ok(())) = (self.export, &written) {
                written = export.filled(self.source, holes, case.name, frame.picture);
            }
            if holes.frame == wanted {
                shown.largest = Some(frame.picture.clone());
            }
            last = Some((holes, frame.picture.clone()));
        })?;
        written?;
        Ok(shown)
    }
}
