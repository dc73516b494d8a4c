//! The error of a capture that cannot be used.

use std::path::{Path, PathBuf};

/// Why a capture was refused. `Display` is one sentence: the file, what is wrong with it, and the hint.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {what}; {hint}", one_line(&file.display().to_string()))]
pub struct CaptureError {
    /// The file at fault: the manifest, or a file that it names.
    pub file: PathBuf,
    /// What is wrong, without a full stop.
    pub what: String,
    /// What the user can do about it, without a full stop.
    pub hint: String,
}

impl CaptureError {
    /// Creates an error in `file`. Line breaks in the texts (decoders write some) are turned into blanks.
    pub(super) fn new(file: &Path, what: impl AsRef<str>, hint: impl AsRef<str>) -> Self {
        Self { file: file.to_path_buf(), what: one_line(what.as_ref()), hint: one_line(hint.as_ref()) }
    }
}

/// Returns `text` (a file's name may hold line breaks, too) with every run of blanks and control characters replaced by
/// one blank.
fn one_line(text: &str) -> String {
    text.split(|c: char| c.is_whitespace() || c.is_control())
        .filter(|word| !word.is_empty())
        .collect::<Vec<_>>()
        .join(" ")
}
