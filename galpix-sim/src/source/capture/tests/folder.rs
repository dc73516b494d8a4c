//! A capture in a temporary folder, and what every refusal must look like.

use std::path::PathBuf;

use super::super::manifest::MapFormat;
use super::super::raster::{self, Canvas, Layout};
use super::super::source::{Size, Source};
use super::super::{AccelerationPolicy, Capture, CaptureError, ImportOptions, colour, load};
use super::encode;
use crate::picture::Picture;
use crate::update::{Known, Sample};

/// Size of the pictures in most tests: not square, so that rows and columns cannot be mixed up.
pub const W: usize = 4;
pub const H: usize = 3;
pub const SIZE: Size = Size { width: W, height: H };

/// A folder with `color.png` (4x3, each pixel another colour) in it.
pub struct Folder(tempfile::TempDir);

/// Returns the colour of pixel (x, y) of `color.png`.
pub fn colour(x: usize, y: usize) -> [u8; 3] {
    [40 * x as u8, 60 * y as u8, 200]
}

/// Returns a value for each cell from its column and row.
pub fn cells<T>(value: impl Fn(usize, usize) -> T) -> Vec<T> {
    SIZE.positions().map(|(x, y)| value(x, y)).collect()
}

/// Returns the bytes as if they had been read from `name`.
pub fn source(name: &str, bytes: impl Into<Vec<u8>>) -> Source {
    Source { path: PathBuf::from(name), bytes: bytes.into() }
}

/// Reads a map of numbers without the remarks about it.
pub fn numbers(source: &Source, channel: Option<&str>, format: MapFormat) -> Result<Vec<f64>, CaptureError> {
    let layout = Layout { channel, format, ..Layout::default() };
    let canvas = &mut Canvas { size: SIZE, notes: &mut Vec::new() };
    raster::numbers(source, &layout, canvas).map(|mut fitted| fitted.bands.swap_remove(0))
}

/// Reads a flow of a size without the remarks about it.
pub fn flow_of(source: &Source, size: Size) -> Result<Vec<Option<[f64; 2]>>, CaptureError> {
    let canvas = &mut Canvas { size, notes: &mut Vec::new() };
    raster::flow(source, &Layout::default(), canvas).map(|flow| flow.vectors)
}

/// Reads a picture without the remarks about it.
pub fn picture(source: &Source, channel: Option<&str>, expected: Option<Size>) -> Result<Picture, CaptureError> {
    colour::read(source, channel, expected, &mut Vec::new())
}

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let rgb: Vec<u8> = cells(self::colour).concat();
        folder.with("color.png", encode::png8(W as u32, H as u32, png::ColorType::Rgb, &rgb))
    }

    /// Adds a file.
    pub fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        self.write(name, bytes);
        self
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.0.path().join(name), bytes).unwrap();
    }

    pub fn path(&self) -> &std::path::Path {
        self.0.path()
    }

    /// Loads with this manifest.
    pub fn load(&self, manifest: &str) -> Result<Capture, CaptureError> {
        self.load_with(manifest, AccelerationPolicy::AsGiven)
    }

    pub fn load_with(&self, manifest: &str, acceleration: AccelerationPolicy) -> Result<Capture, CaptureError> {
        self.write("capture.toml", manifest);
        load(self.path(), &ImportOptions { acceleration })
    }

    /// Loads with `color.png` and these `depth`, `motion` and further lines of `[update]`.
    pub fn update(&self, depth: &str, motion: &str, more: &str) -> Result<Capture, CaptureError> {
        self.load(&manifest(depth, motion, more))
    }

    /// Returns the refusal of this manifest, checked: one line that names `file`, says `what` and gives a hint.
    pub fn refused(&self, manifest: &str, file: &str, what: &str) -> String {
        match self.load(manifest) {
            Ok(_) => panic!("accepted, although {file} {what}:\n{manifest}"),
            Err(error) => check_refusal(&error, file, what),
        }
    }
}

/// Returns a manifest over eight frames.
pub fn manifest(depth: &str, motion: &str, more: &str) -> String {
    format!("frames = 8\n[update]\ncolor = \"color.png\"\ndepth = {depth}\nmotion = {motion}\n{more}\n")
}

/// Checks that `error` is one line `file: what; hint`, and returns it.
pub fn check_refusal(error: &CaptureError, file: &str, what: &str) -> String {
    let text = error.to_string();
    assert!(!text.contains(|c: char| c.is_control()), "more than one line: {text:?}");
    assert!(text.contains(file), "does not name {file}: {text}");
    assert!(text.contains(what), "does not say {what:?}: {text}");
    assert!(!error.what.is_empty() && !error.hint.is_empty(), "no hint: {text}");
    assert!(text.ends_with(&format!("; {}", error.hint)), "the hint is not at the end: {text}");
    text
}

/// Returns the sample of column `x`, row `y`, which must be known.
pub fn known(capture: &Capture, x: usize, y: usize) -> Sample {
    let sample = capture.update.samples[y * capture.update.width + x];
    assert_eq!(sample.known, Known::Motion, "cell ({x}, {y}) is empty");
    sample
}

/// Returns whether the cell in column `x`, row `y` starts empty.
pub fn empty(capture: &Capture, x: usize, y: usize) -> bool {
    capture.update.samples[y * capture.update.width + x].known == Known::ColourOnly
}

/// Asserts that two lists of numbers agree to `tolerance`, NaN with NaN.
#[track_caller]
pub fn near(found: &[f64], wanted: &[f64], tolerance: f64) {
    assert_eq!(found.len(), wanted.len(), "{found:?} is not {wanted:?}");
    for (f, w) in found.iter().zip(wanted) {
        assert!((f - w).abs() <= tolerance || (f.is_nan() && w.is_nan()), "{found:?} is not {wanted:?}");
    }
}
