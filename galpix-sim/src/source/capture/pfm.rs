//! Portable float map: `Pf` (one band) or `PF` (three), columns, rows, a scale whose sign is the byte order (negative
//! = little endian), one blank, then 32-bit floats, rows from **bottom to top**. The size of the scale is a factor to
//! the physical unit; Middlebury's writer puts 1/255 there without meaning it. One writer gives columns and rows in
//! lines of their own, and stores rows from top to bottom. Lines that begin with `#` are comments.

use super::error::CaptureError;
use super::manifest::Rows;
use super::source::{Bands, Source};

/// Longest number in a header, in bytes.
const MAX_WORD: usize = 40;

/// Longest header, in bytes: comments are of any length.
const MAX_HEADER: usize = 4096;

/// What Middlebury's writer puts into the scale.
const MIDDLEBURY: f64 = 1.0 / 255.0;

/// Reads a PFM file: one or three bands.
pub(super) fn read(source: &Source) -> Result<Bands, CaptureError> {
    let mut at = 2;
    let mut word = |name: &str| {
        next_word(&source.bytes, &mut at).ok_or_else(|| source.damaged(format!("the header has no {name}")))
    };
    let ((width, after_width), (height, _), (scale, _)) = (word("width")?, word("height")?, word("scale")?);
    let bands = if source.bytes.starts_with(b"PF") { 3 } else { 1 };
    let (Ok(columns), Ok(rows)) = (width.parse(), height.parse()) else {
        return Err(source.fault(format!("gives its size as \"{width}\" x \"{height}\""), "export it again"));
    };
    let little = match scale.parse::<f64>() {
        Ok(scale) if scale < 0.0 => true,
        Ok(scale) if scale > 0.0 => false,
        _ => return Err(source.fault(format!("has the scale \"{scale}\""), "write -1.0 for little-endian values")),
    };
    let factor = scale.parse::<f64>().map_or(1.0, f64::abs);
    let size = source.agree(columns, rows, None)?;
    let body = source.body(at, (size.cells() * bands * 4) as u64)?;
    let (floats, _) = body.as_chunks::<4>();
    let mut notes = Vec::new();
    let factor = if (factor / MIDDLEBURY - 1.0).abs() < 1e-3 {
        notes.push(format!("gives the scale {factor}, which Middlebury's files do not mean: it is not used"));
        1.0
    } else {
        if factor != 1.0 {
            notes.push(format!("gives the scale {factor}, by which its values are multiplied"));
        }
        factor
    };
    let value = |f: &[u8; 4]| factor * f64::from(if little { f32::from_le_bytes(*f) } else { f32::from_be_bytes(*f) });
    let band = |b: usize| floats.iter().skip(b).step_by(bands).map(value).collect();
    let rows = if after_width == b'\n' { Rows::TopDown } else { Rows::BottomUp };
    Ok(Bands { rows, notes, ..Bands::new(size, (0..bands).map(band).collect()) })
}

/// Returns the next word of the header and the blank after it, which is consumed; comments are skipped.
fn next_word<'a>(bytes: &'a [u8], at: &mut usize) -> Option<(&'a str, u8)> {
    loop {
        let rest = bytes.get(*at..MAX_HEADER.min(bytes.len()))?;
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let word = &rest[start..];
        if word[0] == b'#' {
            *at += start + word.iter().position(|&b| b == b'\n')? + 1;
            continue;
        }
        let length = word.iter().take(MAX_WORD).position(u8::is_ascii_whitespace)?;
        *at += start + length + 1;
        return Some((std::str::from_utf8(&word[..length]).ok()?, word[length]));
    }
}
