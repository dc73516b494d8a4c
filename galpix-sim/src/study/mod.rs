//! Studies: what is run over sources, and how it is reported.
//!
//! ```text
//! source ─▶ job (resolved once) ─▶ Study::study ─▶ report ─▶ rows ─▶ columns ─▶ csv | terminal | page
//!                                                    └─▶ Document ─▶ json
//! ```
//!
//! A [`Study`] defines what is particular to it; the driver of the command line opens the sources, shows progress,
//! prints and writes. No study imports another: what several of them use is in [`cells`], [`crops`], [`holes`],
//! [`ink`], [`job`], [`run`], [`story`] and [`timing`].

pub mod cells;
pub mod check;
pub mod compare;
pub mod crops;
pub mod ddoc;
pub mod demo;
pub mod error;
pub mod fills;
pub mod fit;
pub mod graft;
pub mod holes;
pub mod ink;
pub mod job;
pub mod layers;
pub mod plan;
pub mod run;
pub mod stability;
pub mod story;
pub mod timing;

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::output::html::Fact;

/// Why a study is not done.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The request cannot be used.
    #[error("{0}")]
    Unusable(String),
    /// Anything else.
    #[error("{0}")]
    Failed(String),
}

impl StudyError {
    /// Creates the error of a request that cannot be used.
    pub fn unusable(reason: impl ToString) -> Self {
        Self::Unusable(reason.to_string())
    }

    /// Creates the error of anything else.
    pub fn failed(reason: impl ToString) -> Self {
        Self::Failed(reason.to_string())
    }
}

/// The progress of a study.
#[derive(Clone, Copy, Debug)]
pub enum Work<'n> {
    /// So many pieces of work more are known of.
    Ahead(u64),
    /// One piece is done.
    Done,
    /// One piece is done, and this is its name.
    DoneWith(&'n str),
    /// Something to be said beside the results.
    Note(&'n str),
}

/// Where a study runs.
pub struct Stage<'s> {
    /// The folder that files go to, if any are written.
    pub out: Option<&'s Path>,
    /// Is called with the progress of the study.
    pub notify: &'s (dyn Fn(Work<'_>) + Sync),
}

/// Why there is no report on a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nothing {
    /// Nothing is disoccluded in it.
    Disoccluded,
    /// It knows nothing behind its first layer.
    Hidden,
}

impl Nothing {
    /// Returns what there is nothing of, in a sentence without its subject.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Disoccluded => "nothing is disoccluded",
            Self::Hidden => "nothing is known behind its first layer; a capture has it in [update.hidden]",
        }
    }
}

/// Sources without a report, by name, and why.
pub type Silent = Vec<(Nothing, String)>;

/// Returns the names of the sources without a report for this reason.
#[must_use]
pub fn silent(all: &[(Nothing, String)], reason: Nothing) -> Vec<String> {
    all.iter().filter(|(why, _)| *why == reason).map(|(_, name)| name.clone()).collect()
}

/// What a study found in a source.
pub enum Found<R> {
    /// Figures.
    Report(R),
    /// Nothing.
    Nothing(Nothing),
}

/// The version of the keys of every JSON document. It rises when a key goes, gets another name or another meaning; keys
/// may be added without.
pub const SCHEMA: u32 = 1;

/// Everything that was found.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Document<E, R> {
    /// The version of the keys.
    pub schema: u32,
    /// What kind of document this is: the name of the command.
    pub kind: &'static str,
    /// Of galpix.
    pub version: &'static str,
    /// The call, as it can be repeated.
    pub command: String,
    /// Where it ran.
    pub machine: String,
    /// How long it took, if that is reported.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// What is reported besides the sources.
    #[serde(flatten)]
    pub extra: E,
    /// One per source, without those that have no report.
    pub sources: Vec<R>,
}

/// A document about one thing: its head, and the keys of what it is about.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Headed<'d, B> {
    /// The version of the keys.
    pub schema: u32,
    /// What kind of document this is: the name of the command, or `error`.
    pub kind: &'static str,
    /// Of galpix.
    pub version: &'static str,
    /// The call, as it can be repeated.
    pub command: &'d str,
    /// What it is about; it has keys.
    #[serde(flatten)]
    pub body: &'d B,
}

impl<E, R> Document<E, R> {
    /// Returns the same head over one body.
    #[must_use]
    pub fn headed<'d, B>(&'d self, body: &'d B) -> Headed<'d, B> {
        Headed { schema: self.schema, kind: self.kind, version: self.version, command: &self.command, body }
    }

    /// Returns how a page was made.
    #[must_use]
    pub fn facts(&self) -> Vec<Fact> {
        let mut facts = vec![
            ("Version".to_owned(), self.version.to_owned()),
            ("Command".to_owned(), self.command.clone()),
            ("Machine".to_owned(), self.machine.clone()),
        ];
        facts.extend(self.seconds.map(|seconds| ("Took".to_owned(), format!("{seconds:.0} s"))));
        facts
    }
}

/// Nothing besides the sources.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub struct NoExtra {}

/// Where the path of a study's last file, its page, is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathPrinted {
    /// Nowhere.
    Nowhere,
    /// On standard output, unless JSON is printed there.
    Printed,
    /// On standard output, and on standard error where JSON is printed.
    Always,
}

/// A file of a study: its name and its bytes.
pub type File = (String, Vec<u8>);

/// A study: what it does with each source, and how its results are reported.
pub trait Study {
    /// A source as it was opened.
    type Source;
    /// A request, resolved for a source.
    type Job<'s>;
    /// What is found in a source.
    type Report: Serialize;
    /// What is reported besides the sources.
    type Extra: Serialize;

    /// Its name, that of its command.
    const NAME: &'static str;
    /// Whether the duration of the study is reported.
    const SECONDS: bool = true;
    /// Where the path of its last file is printed.
    const PATH: PathPrinted = PathPrinted::Printed;

    /// Returns the source's name.
    fn name<'a>(&self, source: &'a Self::Source) -> &'a str;

    /// Resolves the request for a source, before anything is run.
    ///
    /// *Errors:* what cannot be run.
    fn resolve<'s>(&self, source: &'s Self::Source) -> Result<Self::Job<'s>, StudyError>;

    /// Returns how many pieces of work a source takes, as far as that is known before.
    fn pieces(&self, job: &Self::Job<'_>) -> u64;

    /// Studies a source.
    ///
    /// *Errors:* a source that cannot be run, files that cannot be written.
    fn study(&self, job: &Self::Job<'_>, stage: &Stage<'_>) -> Result<Found<Self::Report>, StudyError>;

    /// Returns what the terminal shows before the first source.
    fn head(&self) -> Option<String> {
        None
    }

    /// Returns the legends of its tables, printed at the end.
    fn legends(&self) -> Vec<String> {
        Vec::new()
    }

    /// Returns what the terminal shows for a source.
    fn text(&self, report: &Self::Report) -> String;

    /// Returns what is reported besides the sources; `silent` are those without a report.
    fn extra(&self, silent: &Silent) -> Self::Extra;

    /// Returns the document as JSON.
    ///
    /// *Errors:* those of the serialiser; none are known.
    fn json(&self, document: &Document<Self::Extra, Self::Report>) -> serde_json::Result<String> {
        serde_json::to_string_pretty(document)
    }

    /// Returns the files, in the order in which they are written: where the last one is, the others are there too.
    ///
    /// *Errors:* a file that cannot be made.
    fn files(&self, document: &Document<Self::Extra, Self::Report>) -> Result<Vec<File>, StudyError>;

    /// Says whether what was found is as it must be.
    ///
    /// *Errors:* what is not.
    fn verdict(&self, _document: &Document<Self::Extra, Self::Report>) -> Result<(), StudyError> {
        Ok(())
    }
}

/// Returns `NAME.csv`, `NAME.json`, further files, and `NAME.html`, in this order.
///
/// *Errors:* text that cannot be made.
fn files(
    name: &str,
    csv: csv::Result<String>,
    json: serde_json::Result<String>,
    further: Vec<File>,
    page: String,
) -> Result<Vec<File>, StudyError> {
    let csv = csv.map_err(StudyError::failed)?;
    let json = json.map_err(StudyError::failed)? + "\n";
    let mut files = vec![(format!("{name}.csv"), csv.into_bytes()), (format!("{name}.json"), json.into_bytes())];
    files.extend(further);
    files.push((format!("{name}.html"), page.into_bytes()));
    Ok(files)
}
