//! What the suite found, as it goes into the JSON document, the tables and the page.

mod shares;

use galpix_core::Rounding;
use schemars::JsonSchema;
use serde::Serialize;

use super::cases::Case;
use super::causes::Followed;
use super::path::Path;
use super::picture::Outcome;
use super::setting::Law;
use super::verdict::{Judged, Uncovered, Verdict};
use super::worst;
use crate::study::run::BudgetReport;

use shares::series;
pub use shares::{SeriesRow, Shares};

/// The whole suite.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    /// The budget.
    pub budget: BudgetReport,
    /// Whether no case is unstable.
    pub stable: bool,
    /// Case by case.
    pub cases: Vec<CaseReport>,
}

/// One case with each rounding.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CaseReport {
    /// Its name.
    pub name: &'static str,
    /// What it stresses.
    pub stress: &'static str,
    /// The worst verdict of all roundings.
    pub verdict: Verdict,
    /// Rounding by rounding.
    pub roundings: Vec<RoundingReport>,
}

/// One case with one rounding. Errors are the largest of any path in any frame, in pixels.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RoundingReport {
    /// The rounding.
    pub rounding: &'static str,
    /// How the case came out with it.
    pub verdict: Verdict,
    /// What the certificate does not cover.
    pub uncovered: Uncovered,
    /// What the engine did and may not do.
    pub findings: Vec<String>,
    /// Frames followed.
    pub frames: u32,
    /// Fields that were clamped.
    pub clamped: u64,
    /// The paths together; nothing if the case has none.
    pub worst: Option<Shares>,
    /// The largest drift of any path up to each frame, in pixels.
    pub drift_up_to_px: Vec<f64>,
    /// Path by path.
    pub paths: Vec<PathReport>,
    /// Picture by picture, all fill modes together.
    pub pictures: Vec<PictureReport>,
}

/// One path.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PathReport {
    /// What distinguishes it from the others.
    pub name: String,
    /// `x`, `y` or `depth`; depths are in bins, which are of the size of pixels.
    pub component: &'static str,
    /// How it came out.
    pub verdict: Verdict,
    /// What the certificate does not cover.
    pub uncovered: Uncovered,
    /// What the engine did and may not do.
    pub findings: Vec<String>,
    /// Fields that were clamped.
    pub clamped: u32,
    /// The largest error by cause.
    #[serde(flatten)]
    pub worst: Shares,
    /// Frame by frame: of the path of a case that is farthest off only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub series: Vec<SeriesRow>,
}

/// One picture, all fill modes together.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
#[allow(missing_docs)] // as in `picture::Outcome`
pub struct PictureReport {
    pub name: String,
    pub cells: u32,
    pub frames: u32,
    pub moved: u64,
    pub settled: u64,
    pub lost: u64,
    pub collided: u64,
    pub holes: u64,
    pub clamped: u64,
    pub followed: u64,
    pub worst_px: f64,
    pub bound_px: f64,
    /// Frame by frame, with the richest fill mode: settled, lost, collided, holes.
    pub tallies: Vec<[u32; 4]>,
}

impl Report {
    /// Creates the cases under a budget.
    pub fn of(budget: BudgetReport, cases: Vec<CaseReport>) -> Self {
        Self { budget, stable: worst(cases.iter().map(|case| case.verdict)) != Verdict::Unstable, cases }
    }

    /// Returns the cases that came out like this.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.cases.iter().filter(|case| case.verdict == verdict).count()
    }
}

impl CaseReport {
    /// Creates a case with its roundings.
    #[must_use]
    pub fn of(case: &Case, roundings: Vec<RoundingReport>) -> Self {
        let verdict = worst(roundings.iter().map(|rounding| rounding.verdict));
        Self { name: case.name, stress: case.stress, verdict, roundings }
    }

    /// Returns what the tables show: the default rounding, or the only one.
    #[must_use]
    pub fn shown(&self) -> Option<&RoundingReport> {
        let default = self.roundings.iter().find(|rounding| rounding.rounding == Rounding::default().name());
        default.or(self.roundings.first())
    }
}

impl RoundingReport {
    /// Creates the paths and pictures of a case.
    #[must_use]
    pub fn of(rounding: Rounding, mut paths: Vec<PathReport>, pictures: Vec<Outcome>) -> Self {
        let frames = pictures.iter().map(|picture| picture.frames);
        let frames = frames.chain(paths.iter().filter_map(|path| Some(path.series.last()?.frame))).max().unwrap_or(0);
        let clamped = paths.iter().map(|path| u64::from(path.clamped)).sum::<u64>()
            + pictures.iter().map(|picture| picture.clamped).sum::<u64>();
        let broken = pictures.iter().any(|picture| !picture.findings.is_empty());
        let of_pictures = match (broken, pictures.iter().any(|picture| picture.clamped > 0)) {
            (true, _) => Verdict::Unstable,
            (false, true) => Verdict::NotCovered,
            (false, false) => Verdict::Bounded,
        };
        let verdict = worst(paths.iter().map(|path| path.verdict)).max(of_pictures);
        let uncovered = paths.iter().fold(Uncovered::default(), |sum, path| sum.with(path.uncovered));
        let in_paths = paths.iter().flat_map(|path| path.findings.iter().map(|text| format!("{}: {text}", path.name)));
        let in_pictures = pictures.iter().flat_map(|picture| {
            picture.findings.iter().map(|text| format!("{}, {}: {text}", picture.picture, picture.fill_mode))
        });
        let findings = in_paths.chain(in_pictures).collect();
        let all = paths.iter().map(|path| path.worst).reduce(Shares::with);
        let mut drift_up_to_px: Vec<f64> = Vec::new();
        for row in paths.iter().flat_map(|path| &path.series) {
            let frame = row.frame as usize;
            drift_up_to_px.resize(drift_up_to_px.len().max(frame + 1), 0.0);
            drift_up_to_px[frame] = drift_up_to_px[frame].max(row.drift_px.abs());
        }
        (1..drift_up_to_px.len())
            .for_each(|frame| drift_up_to_px[frame] = drift_up_to_px[frame].max(drift_up_to_px[frame - 1]));
        // One path per case is reported frame by frame.
        let farthest = (0..paths.len()).max_by(|&one, &two| {
            let key = |path: &PathReport| (path.verdict == Verdict::Unstable, path.worst.total_px);
            let (one, two) = (key(&paths[one]), key(&paths[two]));
            one.0.cmp(&two.0).then(one.1.total_cmp(&two.1))
        });
        for (index, path) in paths.iter_mut().enumerate() {
            if Some(index) != farthest {
                path.series = Vec::new();
            }
        }
        Self {
            rounding: rounding.name(),
            verdict,
            uncovered,
            findings,
            frames,
            clamped,
            worst: all,
            drift_up_to_px,
            paths,
            pictures: together(&pictures),
        }
    }

    /// Returns the path that is reported frame by frame.
    #[must_use]
    pub fn reported(&self) -> Option<&PathReport> {
        self.paths.iter().find(|path| !path.series.is_empty())
    }
}

/// Returns the fill modes of each picture together.
fn together(outcomes: &[Outcome]) -> Vec<PictureReport> {
    let mut reports: Vec<PictureReport> = Vec::new();
    for outcome in outcomes {
        if reports.last().is_none_or(|last| last.name != outcome.picture) {
            let Outcome { cells, frames, bound_px, .. } = *outcome;
            let name = outcome.picture.clone();
            reports.push(PictureReport { name, cells, frames, bound_px, ..PictureReport::default() });
        }
        if let Some(report) = reports.last_mut() {
            report.moved += outcome.moved;
            report.settled += outcome.settled;
            report.lost += outcome.lost;
            report.collided += outcome.collided;
            report.holes += outcome.holes;
            report.clamped += outcome.clamped;
            report.followed += outcome.followed;
            report.worst_px = report.worst_px.max(outcome.worst_px);
            report.tallies.clone_from(&outcome.tallies);
        }
    }
    reports
}

impl PathReport {
    /// Creates a path that was followed and judged.
    #[must_use]
    pub fn of(path: &Path, followed: &Followed, law: &Law, judged: Judged) -> Self {
        let shares = followed.rows.iter().map(|row| Shares::of(row, law, followed.aligned));
        Self {
            name: path.name.clone(),
            component: ["x", "y", "depth"][path.component],
            verdict: judged.verdict,
            uncovered: judged.uncovered,
            findings: judged.findings,
            clamped: followed.clamped,
            worst: shares.reduce(Shares::with).unwrap_or_default(),
            series: followed.rows.iter().map(|row| series(row, law, followed.aligned)).collect(),
        }
    }
}
