//! Writing a file so that an interrupted run leaves either the old one or the new one.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Writes `bytes` to `path` by way of a temporary file in the same folder that is renamed when it is complete and on disk.
///
/// On an error what was at `path` is as it was, and no temporary file is left. The folder must exist.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("{} does not name a file; give a file name", path.display()),
        )
    })?;
    let mut draft_name = std::ffi::OsString::from(".");
    draft_name.push(name);
    draft_name.push(format!(".{}.part", std::process::id()));
    let draft = path.with_file_name(draft_name);
    let written = write_through(&draft, bytes).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        let _ = fs::remove_file(&draft); // the first error is the one to tell
    }
    written
}

fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// An empty folder of its own for each test, removed at the end.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("galpix-save-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).expect("a folder for temporary files");
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).expect("the folder");
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn the_new_file_replaces_the_old_one_and_stands_alone() {
        let folder = Folder::new("replace");
        let path = folder.0.join("report.html");
        for text in ["the old report, which is longer", "the new one"] {
            write_atomically(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(folder.names(), ["report.html"]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let folder = Folder::new("failure");
        // a folder in the place of the file: the draft can be written, the renaming fails
        let path = folder.0.join("report.html");
        fs::create_dir_all(path.join("kept")).expect("a folder");
        assert!(write_atomically(&path, b"new").is_err());
        assert!(path.join("kept").is_dir());
        assert_eq!(folder.names(), ["report.html"], "a draft was left");
    }

    #[test]
    fn no_folder_or_no_name_is_an_error() {
        let folder = Folder::new("absent");
        assert!(write_atomically(&folder.0.join("absent/report.html"), b"new").is_err());
        assert!(write_atomically(Path::new("/"), b"new").is_err());
        assert!(folder.names().is_empty());
    }
}
