//! Where captures are.

use std::path::{Path, PathBuf};

/// Returns the folder of shared captures next to the project, if it exists.
#[must_use]
pub fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    folder.is_dir().then_some(folder)
}

/// Returns the manifests below a folder, sorted; without those below a folder `field`, which holds inputs that
/// importers misread: some of them must be refused.
///
/// Panics if a folder cannot be read.
#[must_use]
pub fn manifests(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder that can be read") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default();
        if path.is_dir() && name != "field" {
            found.extend(manifests(&path));
        } else if name == "capture.toml" {
            found.push(path);
        }
    }
    found.sort();
    found
}
