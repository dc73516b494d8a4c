//! Files that are whole or not there: an interrupted run leaves either the old one or the new one, and nothing else.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, NamedTempFile};

/// Writes `bytes` to `path` through a temporary file in the same folder that is renamed when it is complete and on
/// disk.
///
/// On an error what was at `path` is as it was, and no temporary file is left. The folder must exist.
///
/// *Errors:* a path without a file name, a folder that is absent or cannot be written to.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (Some(_), Some(folder)) = (path.file_name(), path.parent()) else {
        let reason = format!("{} does not name a file; give a file name", path.display());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
    };
    let mut draft = {
        let mut drafts = drafts();
        let draft = draft(folder)?;
        drafts.push(draft.path().to_owned());
        draft
    };
    let place = draft.path().to_owned();
    let written = draft.write_all(bytes).and_then(|()| draft.as_file().sync_all());
    let written = written.and_then(|()| Ok(draft.persist(path).map(drop)?));
    drafts().retain(|other| *other != place);
    written
}

/// The temporary files that there are now.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn drafts() -> MutexGuard<'static, Vec<PathBuf>> {
    DRAFTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files and ends the program: no other can be made meanwhile.
pub fn leave(code: i32) -> ! {
    let drafts = drafts();
    for draft in drafts.iter() {
        // What is gone already is as it should be.
        let _ = std::fs::remove_file(draft);
    }
    std::process::exit(code)
}

/// Removes from a folder the temporary files of processes that were killed. Does nothing where it cannot be told
/// whether a process lives.
pub fn tidy(folder: &Path) {
    let processes = Path::new("/proc");
    if !processes.join("self").exists() {
        return;
    }
    for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let process = name.strip_prefix(PREFIX).and_then(|rest| rest.strip_suffix(SUFFIX)?.split_once('.'));
        if process.is_some_and(|(id, _)| id.parse::<u32>().is_ok() && !processes.join(id).exists()) {
            // Another process may tidy too.
            let _ = std::fs::remove_file(&path);
        }
    }
}

/// What the names of temporary files begin and end with; between them are the process and something random.
const PREFIX: &str = ".galpix.";
const SUFFIX: &str = ".part";

/// Makes a temporary file in a folder, with the rights that any new file gets.
///
/// *Errors:* a folder that is absent or cannot be written to.
pub fn draft(folder: &Path) -> io::Result<NamedTempFile> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let prefix = format!("{PREFIX}{}.", std::process::id());
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666)); // less what the user masks
    }
    builder.tempfile_in(folder)
}

/// Returns a name that is safe as a file's: a capture's name comes from outside.
#[must_use]
pub fn file_name(name: &str) -> String {
    let safe: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).take(64).collect();
    if safe.is_empty() { "capture".to_owned() } else { safe }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn the_new_file_replaces_the_old_one_and_stands_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.html");
        for text in ["the old report, which is longer", "the new one"] {
            write_atomically(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(names(folder.path()), ["report.html"]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        // a folder in the place of the file: the draft can be written, the renaming fails
        let path = folder.path().join("report.html");
        fs::create_dir_all(path.join("kept")).expect("a folder");
        assert!(write_atomically(&path, b"new").is_err());
        assert!(path.join("kept").is_dir());
        assert_eq!(names(folder.path()), ["report.html"], "a draft was left");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn drafts_of_dead_processes_go_and_those_of_living_ones_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let own = format!(".galpix.{}.abc.part", std::process::id());
        // Beyond the largest number that a process can have.
        for name in [".galpix.4194305.abc.part", &own, ".galpix.x.part", "4194305.part"] {
            fs::write(folder.path().join(name), "").expect("written");
        }
        tidy(folder.path());
        let mut left = names(folder.path());
        left.sort();
        assert_eq!(left, [&own, ".galpix.x.part", "4194305.part"]);
    }

    #[test]
    fn no_folder_or_no_name_is_an_error() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(write_atomically(&folder.path().join("absent/report.html"), b"new").is_err());
        assert!(write_atomically(Path::new("/"), b"new").is_err());
        assert!(names(folder.path()).is_empty());
    }
}
