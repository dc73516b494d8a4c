//! Portable float map: `Pf` (one band) or `PF` (three), columns, rows, a scale whose sign is the byte order (negative =
//! little endian), one blank, then 32-bit floats, rows from **bottom to top**. The size of the scale is a remark about
//! units that no reader honours; it is ignored here as well.

use super::error::CaptureError;
use super::source::{Bands, Size, Source};

/// Longest number in a header, in bytes.
const MAX_WORD: usize = 40;

/// Reads a PFM file: one or three bands, rows from top to bottom.
pub(super) fn read(source: &Source, expected: Size) -> Result<Bands, CaptureError> {
    let mut at = 2;
    let mut word = |name: &str| {
        next_word(&source.bytes, &mut at).ok_or_else(|| source.damaged(format!("the header has no {name}")))
    };
    let (width, height, scale) = (word("width")?, word("height")?, word("scale")?);
    let bands = if source.bytes.starts_with(b"PF") { 3 } else { 1 };
    let (Ok(width), Ok(height)) = (width.parse(), height.parse()) else {
        return Err(source.fault(format!("gives its size as \"{width}\" x \"{height}\""), "export it again"));
    };
    let little = match scale.parse::<f64>() {
        Ok(scale) if scale < 0.0 => true,
        Ok(scale) if scale > 0.0 => false,
        _ => return Err(source.fault(format!("has the scale \"{scale}\""), "write -1.0 for little-endian values")),
    };
    let size = source.agree(width, height, Some(expected))?;
    let body = source.body(at, (size.cells() * bands * 4) as u64)?;
    let (floats, _) = body.as_chunks::<4>();
    let value = |f: &[u8; 4]| f64::from(if little { f32::from_le_bytes(*f) } else { f32::from_be_bytes(*f) });
    let band = |b: usize| {
        floats.rchunks(size.width * bands).flat_map(|row| row.iter().skip(b).step_by(bands).map(value)).collect()
    };
    Ok(Bands { bands: (0..bands).map(band).collect() })
}

/// Returns the next word of the header, with exactly one blank after it consumed.
fn next_word<'a>(bytes: &'a [u8], at: &mut usize) -> Option<&'a str> {
    let rest = bytes.get(*at..)?;
    let start = rest.iter().take(MAX_WORD).position(|b| !b.is_ascii_whitespace())?;
    let word = &rest[start..];
    let length = word.iter().take(MAX_WORD).position(u8::is_ascii_whitespace)?;
    *at += start + length + 1;
    std::str::from_utf8(&word[..length]).ok()
}
