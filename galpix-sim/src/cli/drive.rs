//! Runs a study: its jobs are resolved before anything is made, each source's figures are printed as they are there,
//! and the files are written at the end, the page last.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::call::{command, machine, spare, writable};
use super::{CliError, note, print, printable, printable_lines, progress, remarks};
use crate::output::save::write_atomically;
use crate::source::Source;
use crate::study::{Document, File, Found, PathPrinted, SCHEMA, Silent, Stage, Study, StudyError, Work};

impl From<StudyError> for CliError {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Unusable(reason) => Self::Unusable(reason),
            StudyError::Failed(reason) => Self::Failed(reason),
        }
    }
}

/// What becomes of what a study finds.
pub struct Publication {
    /// The folder that files go to; no files are written without it.
    pub out: Option<PathBuf>,
    /// Whether JSON is printed in place of tables.
    pub json: bool,
    /// What is read, as it was given: no file of it is replaced.
    pub reads: Vec<String>,
    /// What is noteworthy of the sources: said once nothing is refused any more.
    pub remarks: Vec<String>,
}

impl Publication {
    /// Puts files into the requested folder, else into `galpix-out/NAME`, and nowhere where only JSON is
    /// printed.
    pub fn usual(out: Option<&PathBuf>, json: bool, name: &str) -> Self {
        let usual = (!json).then(|| Path::new("galpix-out").join(name));
        Self::to(out.cloned().or(usual).as_ref(), json)
    }

    /// Puts files into this folder, if any.
    pub fn to(out: Option<&PathBuf>, json: bool) -> Self {
        Self { out: out.cloned(), json, reads: Vec::new(), remarks: Vec::new() }
    }

    /// Returns the same, for something that is read from there.
    pub fn reading(self, given: &[String]) -> Self {
        Self { reads: given.to_vec(), ..self }
    }

    /// Returns the same, for sources.
    pub fn of(self, sources: &[Source]) -> Self {
        Self { remarks: sources.iter().flat_map(remarks).collect(), ..self }
    }
}

/// Studies the sources, prints, and writes.
pub fn drive<S: Study>(study: &S, sources: &[S::Source], to: &Publication) -> Result<(), CliError> {
    let started = Instant::now();
    let jobs = sources.iter().map(|source| study.resolve(source)).collect::<Result<Vec<_>, _>>()?;
    if let Some(out) = &to.out {
        writable(out)?;
        let files = ["csv", "json", "html"].map(|kind| out.join(format!("{}.{kind}", S::NAME)));
        to.reads.iter().try_for_each(|given| spare(given, files.clone()))?;
    }
    to.remarks.iter().for_each(|text| note(text));
    if let (Some(head), false) = (study.head(), to.json) {
        print(&head)?;
    }
    let mut reports = Vec::with_capacity(sources.len());
    let mut silent: Silent = Vec::new();
    for (source, job) in sources.iter().zip(&jobs) {
        let name = printable(study.name(source));
        match one(study, job, &name, to)? {
            Found::Report(report) => {
                if !to.json {
                    print(&printable_lines(&study.text(&report)))?;
                }
                reports.push(report);
            }
            Found::Nothing(reason) => {
                note(&format!("{name}: {}", reason.text()));
                silent.push((reason, study.name(source).to_owned()));
            }
        }
    }
    let document = Document {
        schema: SCHEMA,
        kind: S::NAME,
        version: env!("CARGO_PKG_VERSION"),
        command: command(),
        machine: machine(),
        seconds: S::SECONDS.then(|| started.elapsed().as_secs_f64()),
        extra: study.extra(&silent),
        sources: reports,
    };
    if !to.json {
        study.legends().iter().try_for_each(|legend| print(legend))?;
    }
    publish(study, &document, to)?;
    Ok(study.verdict(&document)?)
}

/// Studies a source while a bar shows how it gets on.
fn one<S: Study>(study: &S, job: &S::Job<'_>, name: &str, to: &Publication) -> Result<Found<S::Report>, CliError> {
    let bar = progress::bar(study.pieces(job), name);
    let notify = |work: Work<'_>| match work {
        Work::Ahead(more) => bar.inc_length(more),
        Work::Done => bar.inc(1),
        Work::DoneWith(name) => {
            bar.set_message(name.to_owned());
            bar.inc(1);
        }
        Work::Note(text) => bar.suspend(|| note(&printable(text))),
    };
    let found = study.study(job, &Stage { out: to.out.as_deref(), notify: &notify })?;
    bar.finish_and_clear();
    Ok(found)
}

/// Writes the files; then prints the document if JSON was requested, else the path of the page.
fn publish<S: Study>(study: &S, document: &Document<S::Extra, S::Report>, to: &Publication) -> Result<(), CliError> {
    let mut page = None;
    if let Some(out) = &to.out {
        let files = study.files(document)?;
        to.reads.iter().try_for_each(|given| spare(given, files.iter().map(|(name, _)| out.join(name))))?;
        files.iter().try_for_each(|file| write(out, file))?;
        page = files.last().map(|(name, _)| out.join(name)).filter(|_| S::PATH != PathPrinted::Nowhere);
    }
    if to.json {
        print(&study.json(document).map_err(|error| CliError::Failed(error.to_string()))?)?;
        if let (Some(page), PathPrinted::Always) = (page, S::PATH) {
            note(&format!("the report is in {}", page.display()));
        }
        return Ok(());
    }
    page.map_or(Ok(()), |page| print(&page.display().to_string()))
}

fn write(out: &Path, (name, bytes): &File) -> Result<(), CliError> {
    let path = out.join(name);
    write_atomically(&path, bytes).map_err(|error| CliError::unwritable(&path, &error))
}
