//! The demonstration: all built-in scenes, each as a film, in plots, and as a line of a table.

mod columns;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::job::{ExperimentError, Job, Request};
use super::run::{self, RunReport};
use super::story::Film;
use super::{File, Found, NoExtra, Silent, Stage, Study, StudyError, Work};
use crate::engine::Scheme;
use crate::output::column::{self, Table};
use crate::output::html::{self, Report, Story};
use crate::source::Source;

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
#[derive(Serialize, JsonSchema)]
pub struct Demonstration {
    scenes: Vec<SceneReport>,
}

/// Returns what the columns are.
#[must_use]
pub fn legend() -> String {
    column::legend(&columns::columns())
}

impl Study for Plan {
    /// All of them are shown together.
    type Source = Vec<Source>;
    type Job<'s> = Vec<Job<'s>>;
    type Report = Demonstration;
    type Extra = NoExtra;

    const NAME: &'static str = "demo";

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
        vec![legend()]
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
#[derive(Serialize, JsonSchema)]
struct SceneReport {
    #[serde(flatten)]
    run: RunReport,
    #[serde(skip)]
    story: Story,
    /// The time of a constant-time frame divided by that of a data-dependent one; `None` in the scheme of stationary
    /// sources, which has no constant-time frame.
    #[serde(rename = "x_constant")]
    gain: Option<f64>,
}

/// Runs a source and makes its story.
fn report(job: &Job<'_>, done: &(dyn Fn(Work<'_>) + Sync)) -> Result<SceneReport, ExperimentError> {
    let other = (job.source.name() == IN_BOTH_SCHEMES).then_some(job.request.scheme.other());
    let mut film = Film::default();
    if let Some(scheme) = other {
        let mut pictures = Vec::new();
        run::job(&job.with_scheme(scheme), |shown| pictures.push(shown.picture.clone()))?;
        film = Film::beside(scheme, pictures);
    }
    let run = run::job(job, |shown| {
        film.see(shown);
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
    let story = film.story(job.source.about(), &run, notes);
    Ok(SceneReport { run, story, gain })
}
