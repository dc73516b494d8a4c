//! The folder that the frames of a run are written to: over frames of galpix only, and none of a longer run stays.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use super::save::{tidy, write_atomically};
use crate::picture::Picture;

/// The keywords of what is written into a picture: that galpix made it, and of which source.
const SOFTWARE: &str = "Software";
const SOURCE: &str = "Source";

/// Why frames cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum FramesError {
    /// A file that galpix did not write would be overwritten.
    #[error("{} is there and galpix did not write it: choose another folder with --out", .0.display())]
    Foreign(PathBuf),
    /// The folder or a file in it.
    #[error("{} cannot be written ({error}): choose another folder with --out", path.display())]
    Unwritable {
        /// Which.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

/// A folder of frames.
#[derive(Debug)]
pub struct Frames {
    folder: PathBuf,
    source: String,
    /// Whether galpix wrote frames there before.
    pub again: bool,
}

impl Frames {
    /// Returns `NAME` in a folder, or the first of `NAME-2`, `NAME-3`... that holds no frames of another source.
    #[must_use]
    pub fn usual(folder: &Path, name: &str, source: &str) -> PathBuf {
        let named = |number: u32| folder.join(if number == 1 { name.to_owned() } else { format!("{name}-{number}") });
        let free = |folder: &PathBuf| {
            let first = path(folder, 0);
            !first.exists() || marks(&first).is_some_and(|of| of == source)
        };
        (1..).map(named).find(free).unwrap_or_else(|| named(1))
    }

    /// Makes the folder, and removes what galpix wrote there of a run that was longer than `frames`; returns that too.
    ///
    /// *Errors:* a file in the place of a frame that galpix did not write, a folder that cannot be written to.
    pub fn open(folder: &Path, source: &str, frames: u32) -> Result<(Self, Vec<PathBuf>), FramesError> {
        let unwritable = |error| FramesError::Unwritable { path: folder.to_owned(), error };
        std::fs::create_dir_all(folder).map_err(unwritable)?;
        tidy(folder);
        let again = marks(&path(folder, 0)).is_some();
        let mut stale = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(unwritable)? {
            let path = entry.map_err(unwritable)?.path();
            match number(&path) {
                Some(number) if marks(&path).is_some() => stale.extend((number > frames).then_some(path)),
                Some(number) if number <= frames => return Err(FramesError::Foreign(path)),
                _ => {}
            }
        }
        stale.sort();
        for path in &stale {
            std::fs::remove_file(path).map_err(|error| FramesError::Unwritable { path: path.clone(), error })?;
        }
        Ok((Self { folder: folder.to_owned(), source: source.to_owned(), again }, stale))
    }

    /// Writes a frame.
    ///
    /// *Errors:* a file that cannot be written.
    pub fn write(&self, number: u32, picture: &Picture) -> Result<(), FramesError> {
        let path = path(&self.folder, number);
        let written = marked(picture, &self.source).and_then(|bytes| write_atomically(&path, &bytes));
        written.map_err(|error| FramesError::Unwritable { path, error })
    }
}

/// Returns a picture as a PNG that says of which source galpix made it.
fn marked(picture: &Picture, source: &str) -> io::Result<Vec<u8>> {
    picture.png_with(&[(SOFTWARE, "galpix"), (SOURCE, source)])
}

/// Returns the path of a frame.
#[must_use]
pub fn path(folder: &Path, number: u32) -> PathBuf {
    folder.join(format!("{number:04}.png"))
}

/// Returns the number of a frame whose file has such a name.
fn number(path: &Path) -> Option<u32> {
    let name = path.file_name()?.to_str()?.strip_suffix(".png")?;
    let number = name.parse().ok()?;
    (name == format!("{number:04}")).then_some(number)
}

/// Returns of which source a picture is that galpix wrote; `None` if it did not write it.
fn marks(path: &Path) -> Option<String> {
    let reader = png::Decoder::new(BufReader::new(File::open(path).ok()?)).read_info().ok()?;
    let texts = &reader.info().uncompressed_latin1_text;
    let text = |keyword: &str| texts.iter().find(|text| text.keyword == keyword).map(|text| text.text.clone());
    text(SOFTWARE).filter(|software| software == "galpix").and_then(|_| text(SOURCE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn run(folder: &Path, source: &str, frames: u32) -> Result<usize, FramesError> {
        let (open, removed) = Frames::open(folder, source, frames)?;
        (0..=frames).try_for_each(|number| open.write(number, &Picture::filled(2, 1, [7; 3])))?;
        Ok(removed.len())
    }

    #[test]
    fn a_shorter_run_leaves_no_frame_of_a_longer_one_and_touches_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        assert_eq!(run(folder.path(), "a", 4).expect("written"), 0);
        for (name, bytes) in [("0009.png", "the user's"), ("00003.png", "not a frame"), ("notes.txt", "")] {
            fs::write(folder.path().join(name), bytes).expect("written");
        }
        assert_eq!(run(folder.path(), "a", 2).expect("written"), 2);
        assert_eq!(names(folder.path()), ["0000.png", "00003.png", "0001.png", "0002.png", "0009.png", "notes.txt"]);
    }

    #[test]
    fn what_galpix_did_not_write_is_not_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let theirs = Picture::filled(2, 1, [9; 3]).png().expect("a picture");
        fs::write(folder.path().join("0003.png"), &theirs).expect("written");
        assert!(matches!(run(folder.path(), "a", 3), Err(FramesError::Foreign(path)) if path.ends_with("0003.png")));
        assert_eq!(fs::read(folder.path().join("0003.png")).expect("read"), theirs);
        assert_eq!(names(folder.path()), ["0003.png"]);
        run(folder.path(), "a", 2).expect("beside it");
    }

    #[test]
    fn sources_of_one_name_have_folders_of_their_own() {
        let root = tempfile::tempdir().expect("a folder");
        for (source, folder) in [("a", "pan"), ("b", "pan-2"), ("c", "pan-3"), ("b", "pan-2"), ("a", "pan")] {
            let usual = Frames::usual(root.path(), "pan", source);
            assert_eq!(usual, root.path().join(folder));
            run(&usual, source, 1).expect("written");
        }
    }
}
