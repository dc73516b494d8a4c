//! Where the files of a capture are: in a folder, or in memory.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::CaptureError;
use super::source::Source;

/// Files in memory by the names that a manifest gives them; the manifest itself is `capture.toml`.
pub type Files = BTreeMap<String, Vec<u8>>;

/// The folder of a manifest.
#[derive(Clone, Copy)]
pub(super) struct Folder<'f> {
    path: &'f Path,
    /// What stands for it; nothing if it is on disk.
    files: Option<&'f Files>,
}

impl<'f> Folder<'f> {
    /// A folder on disk.
    pub const fn on_disk(path: &'f Path) -> Self {
        Self { path, files: None }
    }

    /// Files in memory.
    pub fn in_memory(files: &'f Files) -> Self {
        Self { path: Path::new(""), files: Some(files) }
    }

    /// Returns where a file is, for messages.
    pub fn path(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Returns whether there is a file of this name.
    pub fn holds(&self, name: &str) -> bool {
        match self.files {
            Some(files) => files.contains_key(name),
            None => self.path(name).is_file(),
        }
    }

    /// Reads a whole file.
    pub fn open(&self, name: &str) -> Result<Source, CaptureError> {
        let path = self.path(name);
        match self.files {
            Some(files) => match files.get(name) {
                Some(bytes) => Ok(Source { path, bytes: bytes.clone() }),
                None => Err(CaptureError::new(&path, "is not among the files", "correct the name or add the file")),
            },
            None => Source::open(&path),
        }
    }

    /// Returns its own name.
    pub fn name(&self) -> String {
        let absolute = self.path.canonicalize().unwrap_or_else(|_| self.path.to_path_buf());
        absolute.file_name().map_or_else(|| "capture".to_owned(), |name| name.to_string_lossy().into_owned())
    }
}
