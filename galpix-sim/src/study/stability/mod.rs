//! The stiff and extreme suite: each case is run, its error against the exact trajectory is split by cause, and the
//! verdict follows from what was measured.
//!
//! ```text
//! cases ─▶ path ─▶ mover (the engine) ─▶ causes (exact shares) ─▶ verdict (by the law of the budget)
//!     └──▶ picture (the real controller, every fill mode) ─▶ what goes in comes out or is counted
//! ```

pub mod cases;
pub mod causes;
mod exact;
mod floats;
pub mod mover;
mod page;
pub mod path;
pub mod picture;
mod setting;
mod summary;
#[cfg(test)]
mod tests;
mod text;
pub mod verdict;

use galpix_core::{BudgetError, Demand, FillMode, Rounding};
use rayon::prelude::*;

pub use cases::{ALL, Case};
pub use exact::Px;
pub use page::html;
pub use setting::{Law, Ranges, Setting, SettingError};
pub use summary::{CaseReport, PathReport, PictureReport, Report, RoundingReport, SeriesRow, Shares};
pub use text::LEGEND;

use super::run::BudgetReport;
use super::{File, Found, NoExtra, PathPrinted, Silent, Stage, Study, StudyError, Work};
use crate::engine::EngineError;
use crate::suggest::hint;
use mover::{Mover, Strip};
use verdict::{Verdict, judge};

/// Why the suite cannot run.
#[derive(Debug, thiserror::Error)]
pub enum StabilityError {
    /// The budget.
    #[error("{0}")]
    Setting(#[from] SettingError),
    /// There is no such case.
    #[error("there is no case `{name}`{}: give one or more of {}", hint(name, names()), names().join(", "))]
    NoSuchCase {
        /// The request.
        name: String,
    },
    /// A picture cannot be laid out.
    #[error("{0}")]
    Engine(#[from] EngineError),
}

impl From<BudgetError> for StabilityError {
    fn from(error: BudgetError) -> Self {
        Self::Setting(error.into())
    }
}

/// What to run.
#[derive(Clone, Debug)]
pub struct Request {
    /// The three design numbers.
    pub demand: Demand,
    /// One rounding, or all of them.
    pub rounding: Option<Rounding>,
    /// Names of cases; all of them if there is none.
    pub cases: Vec<String>,
}

impl Default for Request {
    fn default() -> Self {
        Self { demand: Demand { extent: 1024, recog: 8, prop: 16 }, rounding: None, cases: Vec::new() }
    }
}

/// The suite, and how long it took.
pub type Document = super::Document<NoExtra, Report>;

impl Study for Request {
    /// There is only the suite.
    type Source = ();
    type Job<'s> = ();
    type Report = Report;
    type Extra = NoExtra;

    const NAME: &'static str = "stability";
    const PATH: PathPrinted = PathPrinted::Always;

    fn name<'a>(&self, (): &'a ()) -> &'a str {
        "stability"
    }

    fn resolve(&self, (): &()) -> Result<(), StudyError> {
        self.check().map_err(StudyError::unusable)
    }

    fn pieces(&self, (): &()) -> u64 {
        self.cases().count() as u64
    }

    fn study(&self, (): &(), stage: &Stage<'_>) -> Result<Found<Report>, StudyError> {
        let report = run(self, |case| (stage.notify)(Work::DoneWith(case)));
        report.map(Found::Report).map_err(StudyError::unusable)
    }

    fn text(&self, report: &Report) -> String {
        text::text(report)
    }

    fn extra(&self, _silent: &Silent) -> NoExtra {
        NoExtra {}
    }

    /// Returns the report of the suite, for there is no list of sources.
    fn json(&self, document: &Document) -> serde_json::Result<String> {
        serde_json::to_string_pretty(&document.sources.first().map(|report| document.headed(report)))
    }

    fn files(&self, document: &Document) -> Result<Vec<File>, StudyError> {
        let seconds = document.seconds.unwrap_or(0.0);
        let page = document.sources.first().map(|report| html(report, seconds));
        Ok(page.map(|page| ("stability.html".to_owned(), page.into_bytes())).into_iter().collect())
    }

    fn verdict(&self, document: &Document) -> Result<(), StudyError> {
        match document.sources.first() {
            Some(report) if !report.stable => Err(StudyError::Failed(format!(
                "{} of {} cases are unstable: see the findings above",
                report.count(Verdict::Unstable),
                report.cases.len()
            ))),
            _ => Ok(()),
        }
    }
}

/// Returns the names of all cases.
#[must_use]
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|case| case.name).collect()
}

impl Request {
    /// Returns whether it can be run at all.
    ///
    /// *Errors:* as [`run`].
    pub fn check(&self) -> Result<(), StabilityError> {
        Setting::new(self.demand)?;
        match self.cases.iter().find(|name| !names().contains(&name.as_str())) {
            Some(name) => Err(StabilityError::NoSuchCase { name: name.clone() }),
            None => Ok(()),
        }
    }

    /// Returns the requested cases.
    pub fn cases(&self) -> impl Iterator<Item = &'static Case> {
        ALL.iter().filter(|case| self.cases.is_empty() || self.cases.iter().any(|name| name == case.name))
    }
}

/// The laws of x, y and depth for one rounding.
struct Laws {
    rounding: Rounding,
    components: [Law; 3],
}

/// Runs the suite; `done` is called with each finished case.
///
/// *Errors:* a budget that cannot exist or moves too fast, a case that does not exist.
pub fn run(request: &Request, done: impl Fn(&'static str) + Sync) -> Result<Report, StabilityError> {
    request.check()?;
    let setting = Setting::new(request.demand)?;
    let budget = BudgetReport::of(request.demand, setting.bits, &setting.record);
    let chosen: Vec<&Case> = request.cases().collect();
    let longest =
        chosen.iter().flat_map(|case| (case.paths)(&setting)).map(|path| path.every.unwrap_or(path.frames)).max();
    let laws = |rounding: Rounding| {
        let law = |component: usize| Law::of(&setting, component, rounding, longest.unwrap_or(0));
        let x = law(0);
        let y = if setting.record.scales[1] == setting.record.scales[0] { x.clone() } else { law(1) };
        Laws { rounding, components: [x, y, law(2)] }
    };
    let laws: Vec<Laws> =
        request.rounding.map_or(Rounding::ALL.to_vec(), |one| vec![one]).into_iter().map(laws).collect();
    let cases = chosen
        .par_iter()
        .map(|case| {
            let roundings =
                laws.par_iter().map(|laws| run_case(case, &setting, laws)).collect::<Result<Vec<_>, _>>()?;
            done(case.name);
            Ok(CaseReport::of(case, roundings))
        })
        .collect::<Result<Vec<_>, StabilityError>>()?;
    Ok(Report::of(budget, cases))
}

/// Runs a case with one rounding.
fn run_case(case: &Case, setting: &Setting, laws: &Laws) -> Result<RoundingReport, StabilityError> {
    let mut paths = Vec::new();
    for path in (case.paths)(setting) {
        let law = &laws.components[path.component];
        let mut mover = Strip::new(setting, path.component, laws.rounding)?;
        paths.push(run_path(&path, setting, laws.rounding, law, &mut mover));
    }
    let mut pictures: Vec<picture::Outcome> = Vec::new();
    for picture in (case.pictures)(setting) {
        for fill_mode in FillMode::ALL {
            let [x, y, _] = &laws.components;
            let mut outcome = picture::run(&picture, setting, [x, y], laws.rounding, fill_mode)?;
            let twin = pictures
                .iter()
                .find(|other| picture.same_as.as_ref() == Some(&other.picture) && other.fill_mode == fill_mode.name());
            if twin.is_some_and(|twin| twin.bits != outcome.bits) {
                outcome.findings.push(format!("other bits than `{}`", picture.same_as.as_deref().unwrap_or_default()));
            }
            pictures.push(outcome);
        }
    }
    Ok(RoundingReport::of(laws.rounding, paths, pictures))
}

/// Follows a path with something that moves it, and judges it.
pub fn run_path(
    path: &path::Path,
    setting: &Setting,
    rounding: Rounding,
    law: &Law,
    mover: &mut dyn Mover,
) -> PathReport {
    let followed = causes::follow(path, setting, rounding, mover);
    PathReport::of(path, &followed, law, judge(&followed, law))
}

/// Returns the worst of some verdicts.
fn worst(verdicts: impl Iterator<Item = Verdict>) -> Verdict {
    verdicts.max().unwrap_or(Verdict::Bounded)
}
