//! A file's bytes, the size limits of every importer, and the numbers that an importer delivers.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::error::CaptureError;
use super::manifest::Rows;

/// Most columns or rows of a picture.
const MAX_SIDE: u64 = 16_384;
/// Most pixels of a picture.
const MAX_CELLS: u64 = 64 << 20;
/// Most bytes of one file.
const MAX_BYTES: u64 = 2 << 30;

/// What to do about a file that ends too early.
pub(super) const COPY_AGAIN: &str = "copy or export the file again";

/// Columns and rows, both at least 1 and within the importers' limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub width: usize,
    pub height: usize,
}

impl Size {
    /// Returns the number of cells.
    pub const fn cells(self) -> usize {
        self.width * self.height
    }

    /// Returns the cells as (column, row), row by row.
    pub fn positions(self) -> impl Iterator<Item = (usize, usize)> {
        (0..self.height).flat_map(move |y| (0..self.width).map(move |x| (x, y)))
    }
}

/// Raw numbers as a file stores them: one or more bands, each row by row.
#[derive(Clone, Debug)]
pub(super) struct Bands {
    pub size: Size,
    pub bands: Vec<Vec<f64>>,
    /// Which row comes first.
    pub rows: Rows,
    /// Remarks on what the file says of itself.
    pub notes: Vec<String>,
}

impl Bands {
    /// Creates bands whose rows run from top to bottom, without remarks.
    pub const fn new(size: Size, bands: Vec<Vec<f64>>) -> Self {
        Self { size, bands, rows: Rows::TopDown, notes: Vec::new() }
    }
}

/// The file formats of the importers, recognised by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Png,
    Jpeg,
    Exr,
    Npy,
    Npz,
    Pfm,
    /// Middlebury `.flo` and Sintel `.dpt` share their tag.
    Pieh,
}

/// One file in memory.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub path: PathBuf,
    pub bytes: Vec<u8>,
}

impl Source {
    /// Reads a whole regular file of at most 2 GiB.
    pub fn open(path: &Path) -> Result<Self, CaptureError> {
        let unreadable = |e: std::io::Error| {
            CaptureError::new(path, format!("cannot be read ({e})"), "correct the path or add the file")
        };
        // A device or a pipe has no length that could be checked before reading, and merely opening a pipe may wait
        // forever.
        let about = std::fs::metadata(path).map_err(unreadable)?;
        if !about.is_file() {
            return Err(CaptureError::new(path, "is not a regular file", "name a file"));
        }
        if about.len() > MAX_BYTES {
            let what = format!("has {} bytes, more than the {MAX_BYTES} that are read", about.len());
            return Err(CaptureError::new(path, what, "crop or scale the capture down"));
        }
        let file = File::open(path).map_err(unreadable)?;
        let mut bytes = Vec::new();
        file.take(MAX_BYTES).read_to_end(&mut bytes).map_err(unreadable)?;
        Ok(Self { path: path.to_path_buf(), bytes })
    }

    /// Returns an error about this file.
    pub fn fault(&self, what: impl AsRef<str>, hint: impl AsRef<str>) -> CaptureError {
        CaptureError::new(&self.path, what, hint)
    }

    /// Returns an error about a file that ends too early or is damaged; `why` names the place.
    pub fn damaged(&self, why: impl std::fmt::Display) -> CaptureError {
        self.fault(format!("is truncated or damaged ({why})"), COPY_AGAIN)
    }

    /// Returns the file as text, without a byte order mark.
    pub fn text(&self) -> Result<&str, CaptureError> {
        if self.bytes.starts_with(b"\xff\xfe") || self.bytes.starts_with(b"\xfe\xff") {
            return Err(self.fault(
                "is not a text file in UTF-8 (it begins with a byte order mark of UTF-16)",
                "save it as UTF-8",
            ));
        }
        let text = self.bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&self.bytes);
        std::str::from_utf8(text).map_err(|e| self.fault(format!("is not a text file ({e})"), "save it as UTF-8 text"))
    }

    /// Returns the format, from the first bytes; the name's ending does not matter.
    pub fn format(&self) -> Result<Format, CaptureError> {
        const TAGS: [(&[u8], Format); 8] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"\x76\x2f\x31\x01", Format::Exr),
            (b"\x93NUMPY", Format::Npy),
            (b"PK\x03\x04", Format::Npz),
            (b"Pf", Format::Pfm),
            (b"PF", Format::Pfm),
            (b"PIEH", Format::Pieh),
        ];
        TAGS.iter().find(|(tag, _)| self.bytes.starts_with(tag)).map(|&(_, format)| format).ok_or_else(|| {
            self.fault(
                "does not begin like a PNG, JPEG, EXR, .npy, .npz, PFM, .flo or .dpt file",
                "convert it to one of these, or copy it again if it was cut off",
            )
        })
    }

    /// Checks a header's dimensions, before anything of that size is allocated.
    ///
    /// Errors: no pixels, more than 16384 on a side, more than 64 Mi pixels, or another size than `expected` (the size
    /// of the colour picture).
    pub fn agree(&self, width: u64, height: u64, expected: Option<Size>) -> Result<Size, CaptureError> {
        if width == 0 || height == 0 {
            return Err(self.fault(format!("is {width}x{height}, without a pixel"), "export it again"));
        }
        if width > MAX_SIDE || height > MAX_SIDE || width * height > MAX_CELLS {
            let what =
                format!("says that it is {width}x{height}, beyond {MAX_SIDE} on a side or {MAX_CELLS} pixels in all");
            return Err(self.fault(what, "crop or scale the capture down"));
        }
        let size = Size { width: width as usize, height: height as usize };
        match expected {
            Some(wanted) if wanted != size => Err(self.fault(
                format!("is {width}x{height} but the update's colour is {}x{}", wanted.width, wanted.height),
                "export both at the same size",
            )),
            _ => Ok(size),
        }
    }

    /// Checks that exactly `wanted` bytes follow a header that ends at `start`, and returns them.
    pub fn body(&self, start: usize, wanted: u64) -> Result<&[u8], CaptureError> {
        let body = self.bytes.get(start..).unwrap_or_default();
        if body.len() as u64 == wanted {
            return Ok(body);
        }
        let what = format!("holds {} bytes of values where its header promises {wanted}", body.len());
        Err(self.fault(what, COPY_AGAIN))
    }
}

/// Returns `N` consecutive bytes at `start`, if there are so many.
pub(super) fn array<const N: usize>(bytes: &[u8], start: usize) -> Option<[u8; N]> {
    bytes.get(start..start.checked_add(N)?)?.try_into().ok()
}
