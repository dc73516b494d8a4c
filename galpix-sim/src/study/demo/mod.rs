//! The demonstration: all built-in scenes, each as a film, in plots, and as a line of a table.

mod columns;

use rayon::prelude::*;
use serde::Serialize;

use super::job::{ExperimentError, Job, Request};
use super::run::{self, FrameReport, RunReport, Shown};
use super::{File, Found, NoExtra, Silent, Stage, Study, StudyError, Work};
use crate::certificate::FrameBound;
use crate::engine::Scheme;
use crate::output::column::Table;
use crate::output::film::{self, Colours};
use crate::output::html::{self, CertificateLine, Report, Row, Story};
use crate::output::measures::{self, Measured};
use crate::picture::Picture;
use crate::source::Source;

/// A film's frame is shown for this long.
const FRAME_MS: u16 = 120;

/// A film may be this large before its colours are counted.
const FILM_BYTES: usize = 1_000_000;

/// Frames of each scene that are made again in both modes, to compare their times.
const FRAMES_FOR_GAIN: u32 = 5;

/// The scene in which what turns is shown in both schemes.
const IN_BOTH_SCHEMES: &str = "disc";

/// What is demonstrated.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// How the scenes are extrapolated.
    pub request: Request,
}

/// All sources after their runs.
#[derive(Serialize)]
pub struct Demonstration {
    #[serde(skip)]
    scenes: Vec<SceneReport>,
}

impl Study for Plan {
    /// All of them are shown together.
    type Source = Vec<Source>;
    type Job<'s> = Vec<Job<'s>>;
    type Report = Demonstration;
    type Extra = NoExtra;

    fn name<'a>(&self, _sources: &'a Vec<Source>) -> &'a str {
        "demo"
    }

    fn resolve<'s>(&self, sources: &'s Vec<Source>) -> Result<Vec<Job<'s>>, StudyError> {
        let resolve = |source| Job::resolve(source, &self.request).map_err(StudyError::unusable);
        sources.iter().map(resolve).collect()
    }

    fn pieces(&self, jobs: &Vec<Job<'_>>) -> u64 {
        jobs.iter().map(|job| u64::from(job.frames) + 1).sum()
    }

    fn study(&self, jobs: &Vec<Job<'_>>, stage: &Stage<'_>) -> Result<Found<Demonstration>, StudyError> {
        let scenes = jobs.par_iter().map(|job| report(job, stage.notify)).collect::<Result<_, _>>();
        Ok(Found::Report(Demonstration { scenes: scenes.map_err(StudyError::unusable)? }))
    }

    fn legends(&self) -> Vec<String> {
        vec![columns::LEGEND.to_owned(), measures::legend()]
    }

    fn text(&self, report: &Demonstration) -> String {
        let columns = columns::columns();
        Table::new(&columns, &report.scenes).lines(&report.scenes).collect::<Vec<_>>().join("\n")
    }

    fn extra(&self, _silent: &Silent) -> NoExtra {
        NoExtra {}
    }

    fn files(&self, document: &super::Document<NoExtra, Demonstration>) -> Result<Vec<File>, StudyError> {
        let page = html::html(&Report {
            title: "galpix: pictures that keep moving between updates".to_owned(),
            intro: vec![
                "Each scene below was rendered once, with the motion of every pixel. From that one picture the engine made \
                 all the frames that follow, and moved every galpixel with additions and shifts only; a conventional \
                 display would have shown the first picture until the next one came."
                    .to_owned(),
            ],
            facts: vec![
                ("Version".to_owned(), document.version.to_owned()),
                ("Rounding".to_owned(), self.request.rounding.name().to_owned()),
                ("Holes".to_owned(), self.request.fill.name().to_owned()),
                ("ns a galpixel".to_owned(), "a budget chosen at run time, scenes side by side".to_owned()),
                ("Time".to_owned(), format!("{:.1} s", document.seconds.unwrap_or(0.0))),
            ],
            stories: document.sources.iter().flat_map(|all| &all.scenes).map(|scene| scene.story.clone()).collect(),
        });
        Ok(vec![("report.html".to_owned(), page.into_bytes())])
    }
}

/// A source after its run.
struct SceneReport {
    run: RunReport,
    story: Story,
    /// The time of a constant-time frame divided by that of a data-dependent one; `None` in the scheme of stationary
    /// sources, which has no constant-time frame.
    gain: Option<f64>,
}

/// Runs a source and makes its story.
fn report(job: &Job<'_>, done: &(dyn Fn(Work<'_>) + Sync)) -> Result<SceneReport, ExperimentError> {
    let other = (job.source.name() == IN_BOTH_SCHEMES).then_some(job.request.scheme.other());
    let mut in_other = Vec::new();
    if let Some(scheme) = other {
        run::job(&job.with_scheme(scheme), |shown| in_other.push(shown.picture.clone()))?;
    }
    let mut pictures = Vec::new();
    let run = run::job(job, |shown| {
        let in_other = other.zip(in_other.get(shown.frame as usize));
        pictures.extend(panels(shown, in_other.map(|(scheme, picture)| (picture, scheme.name()))));
        done(Work::Done);
    })?;
    let gain = match job.request.scheme {
        Scheme::Map => Some(run::work_gain(job, run.frames.len().min(FRAMES_FOR_GAIN as usize) as u32)?),
        Scheme::Source => None,
    };
    let mut notes = Vec::new();
    if let Some(gain) = gain {
        notes.push(format!(
            "Constant work, the mode whose instructions do not depend on the picture, takes {gain:.1} times as long as a \
             frame that skips what this picture does not need (medians of the first {FRAMES_FOR_GAIN} frames)."
        ));
    }
    if let Some(scheme) = other {
        notes.push(format!(
            "The fourth picture of the film is the same update in the other scheme (galpix run {} --scheme {}): in a map \
             who loses a collision is lost and pixels show whole cells, with stationary sources neither is so.",
            run.source,
            scheme.name()
        ));
    }
    if run.loaded.saturated > 0 {
        notes.push(format!("{} fields of the update were clamped to their range.", run.loaded.saturated));
    }
    let film_apng = match film::apng_within(&pictures, FRAME_MS, FILM_BYTES) {
        Ok((film, colours)) => {
            if matches!(colours, Colours::Palette) {
                notes.push("The film above has 256 colours; every figure comes from the full ones.".to_owned());
            }
            film
        }
        Err(error) => {
            notes.push(format!("There is no film: {error}."));
            Vec::new()
        }
    };
    let story = Story {
        name: run.source.clone(),
        about: job.source.about().to_owned(),
        width: run.width,
        height: run.height,
        budget_line: budget_line(&run),
        rounding: run.rounding.to_owned(),
        fill: run.fill.to_owned(),
        certificate: Some(CertificateLine {
            quantisation_px: run.certificate.quantisation_px,
            drift_px: run.certificate.drift_px,
            total_px: run.certificate.total_px,
            holds: run.certificate.keeps_one_pixel(),
            per_frame_px: std::iter::once(0.0).chain(run.certificate.frames.iter().map(FrameBound::total_px)).collect(),
        }),
        film_apng,
        rows: run.frames.iter().map(row).collect(),
        notes,
    };
    Ok(SceneReport { run, story, gain })
}

fn budget_line(run: &RunReport) -> String {
    let budget = &run.budget;
    format!(
        "D = {} px, tau_recog = {}, tau_prop = {}: velocity {}+{}, acceleration {}+{}, position +{} bits; {} bytes a galpixel",
        budget.extent,
        budget.recog,
        budget.prop,
        budget.velocity_int_bits,
        budget.velocity_frac_bits,
        budget.acceleration_int_bits,
        budget.acceleration_frac_bits,
        budget.position_frac_bits,
        budget.stored_bytes_per_galpixel
    )
}

/// Truth, sample-and-hold, galpix, the other scheme where there is one, and the difference of galpix, side by side;
/// frames without a truth are left out.
fn panels<'p>(shown: &Shown<'p>, in_other: Option<(&'p Picture, &'p str)>) -> Option<Picture> {
    let truth = &shown.truth?.picture;
    let difference = film::difference(shown.picture, truth);
    let pictures = [
        Some((truth, "truth")),
        Some((shown.hold, "sample-and-hold")),
        Some((shown.picture, "galpix")),
        in_other,
        Some((&difference, "difference x4")),
    ];
    let panels: Vec<Picture> =
        pictures.into_iter().flatten().map(|(picture, label)| film::labelled(picture, label)).collect();
    Some(film::side_by_side(&panels.iter().collect::<Vec<_>>(), 4))
}

fn row(frame: &FrameReport) -> Row {
    let truth = frame.truth.as_ref();
    Row {
        frame: frame.frame,
        measures: frame.measures(),
        psnr_hold_db: truth.and_then(|truth| truth.psnr_hold_db),
        psnr_known_db: truth.and_then(|truth| truth.psnr_known_db),
        position_error_px: frame.position.map(|position| position.worst_px),
        mean_position_error_px: frame.position.map(|position| position.mean_px),
        truth_error_px: frame.position.and_then(|position| position.truth_worst_px),
        holes: frame.holes.into(),
        filled: frame.filled.into(),
        lost: frame.lost.into(),
        collided: frame.collided.into(),
        saturated: frame.saturated.into(),
        bullets: frame.bullets.into(),
        unobscured: (frame.debris + frame.galdebris).into(),
        ns_per_galpixel: Some(frame.ns_per_galpixel),
    }
}
