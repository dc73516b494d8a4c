//! A manifest for a folder that has none: looks at what each file is, tries what the files leave open, and keeps what
//! comes nearest to the first later picture.

mod draft;
mod role;
mod series;

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use super::folder::Folder;
use super::manifest::Manifest;
use super::plausible;
use super::source::Source;
use super::{CaptureError, ImportOptions, MANIFEST, assembled, checked};
use draft::Draft;
use role::Role;
use series::Series;

/// How much better, in dB, another way to read the files must be to be preferred to one that stands before it.
const BETTER: f64 = 0.05;

/// What the files cannot say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitOptions {
    /// Display frames between two numbers of the pictures; at least 1.
    pub step: u32,
    /// `fx fy cx cy` in pixels.
    pub intrinsics: Option<[f64; 4]>,
}

/// A manifest that runs.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Proposal {
    /// The manifest, in TOML, with comments.
    pub manifest: String,
    /// The update moved to the first later picture, where nothing arrives unchanged, in dB; nothing without one.
    pub moved_db: Option<f64>,
    /// The update unchanged, against the same picture.
    pub still_db: Option<f64>,
    /// Files that are not used.
    pub unused: Vec<String>,
    /// What the importer remarks.
    pub notes: Vec<String>,
}

/// Looks at the files of a folder, and of its own folders, and returns a manifest that runs.
///
/// What the files leave open (the place of the update among poses, scales, signs, which of several files) is tried
/// with the first later picture of the same series: what brings the update nearest to it is taken, and said in a
/// comment. Nothing is written. Cost: tens of imports.
///
/// *Errors:* a folder that cannot be listed; no picture, no motion, or no intrinsics for poses; files of which none
/// makes an update, with the importer's sentence.
pub fn init(folder: &Path, options: &InitOptions) -> Result<Proposal, CaptureError> {
    let series = series::list(folder)?;
    let files = Folder::on_disk(folder);
    let found: Vec<(&Series, Vec<Role>)> = series.iter().map(|series| (series, role::roles(series, files))).collect();
    let picture = draft::picture(&found, options.step, folder)?;
    let mut tried = Tried { folder, best: None, refusal: None };
    for draft in draft::drafts(&found, &picture, options, folder)? {
        tried.descend(draft);
    }
    let Some(best) = tried.best else {
        return Err(tried.refusal.unwrap_or_else(|| CaptureError::new(folder, "holds no update", "add its files")));
    };
    let text = best.draft.text(&picture.later);
    let capture = checked(&written(folder, &text), files, &ImportOptions::default())?;
    let first = capture.truths.first();
    let named: Vec<&str> = best.draft.files().chain(picture.files()).collect();
    let names = series.iter().flat_map(Series::names);
    let unused: Vec<String> = names.filter(|name| !named.contains(name)).map(str::to_owned).collect();
    let (moved_db, still_db) = (
        first.and_then(|truth| plausible::shown_db(&capture.update, truth, true)),
        first.and_then(|truth| plausible::shown_db(&capture.update, truth, false)),
    );
    let manifest = draft::commented(&text, &best, moved_db.zip(still_db), &unused);
    // What is proposed is what runs, comments and all.
    Manifest::read(&written(folder, &manifest))?;
    Ok(Proposal { manifest, moved_db, still_db, unused, notes: capture.census.notes })
}

/// What was tried, and what came nearest.
struct Tried<'f> {
    folder: &'f Path,
    best: Option<Best>,
    /// The first.
    refusal: Option<CaptureError>,
}

/// A manifest that was read, and how near it comes.
struct Best {
    draft: Draft,
    score: f64,
    /// What was chosen by the first later picture, with what it was better than.
    chosen: Vec<String>,
}

impl Tried<'_> {
    /// Tries a draft, and in turn each thing that it leaves open.
    fn descend(&mut self, draft: Draft) {
        let mut here: Option<Best> = None;
        for axis in draft.open() {
            let from = here.as_ref().map_or_else(|| draft.clone(), |best| best.draft.clone());
            let mut scores: Vec<(f64, Draft, String)> = Vec::new();
            for option in &axis.options {
                let mut draft = from.clone();
                option.iter().for_each(|set| draft.set(set));
                if let Some(score) = self.score(&draft) {
                    scores.push((score, draft, option.iter().map(draft::Set::text).collect::<Vec<_>>().join(", ")));
                }
            }
            let Some(mut best) = scores.first().cloned() else { continue };
            for other in &scores[1..] {
                if other.0 > best.0 + BETTER {
                    best = other.clone();
                }
            }
            let next = scores.iter().filter(|other| other.2 != best.2).map(|other| other.0).max_by(f64::total_cmp);
            let mut chosen = here.map_or_else(Vec::new, |best| best.chosen);
            if let (Some(next), true) = (next, best.0.is_finite() && !best.2.is_empty()) {
                chosen.push(format!("{}: {} at {:.2} dB, the next best at {next:.2} dB", axis.what, best.2, best.0));
            }
            here = Some(Best { draft: best.1, score: best.0, chosen });
        }
        if let Some(here) = here
            && self.best.as_ref().is_none_or(|best| here.score > best.score + BETTER)
        {
            self.best = Some(here);
        }
    }

    /// Returns how near a draft comes to the first later picture, in dB; without one, 0 if it is read at all.
    fn score(&mut self, draft: &Draft) -> Option<f64> {
        let source = written(self.folder, &draft.text(draft.judge.as_slice()));
        match assembled(&source, Folder::on_disk(self.folder), &ImportOptions::default()) {
            Ok((capture, _)) if capture.census.known == 0 => None,
            Ok((capture, _)) => match capture.truths.first() {
                Some(truth) => plausible::shown_db(&capture.update, truth, true),
                None => Some(0.0),
            },
            Err(refusal) => {
                self.refusal.get_or_insert(refusal);
                None
            }
        }
    }
}

/// Returns a manifest that is not written yet, as if it were.
fn written(folder: &Path, manifest: &str) -> Source {
    Source { path: folder.join(MANIFEST), bytes: manifest.as_bytes().to_vec() }
}
