//! Middlebury `.flo`: the tag "PIEH" (202021.25 as a little-endian float), two 32-bit integers (columns, rows), then a
//! pair (u, v) of 32-bit floats for each pixel, rows from top to bottom. Pixels, y down; a size of 1e9 and
//! more means unknown.

use super::error::CaptureError;
use super::source::{Bands, Source, array};

/// Reads a `.flo` file: two bands, u and v.
pub(super) fn read(source: &Source) -> Result<Bands, CaptureError> {
    read_tagged(source, 2)
}

/// Reads the layout that `.flo` and `.dpt` share: a tag, the size, and `bands` interleaved floats per pixel.
pub(super) fn read_tagged(source: &Source, bands: usize) -> Result<Bands, CaptureError> {
    let side = |start| array(&source.bytes, start).map(i32::from_le_bytes);
    let (Some(width), Some(height)) = (side(4), side(8)) else {
        return Err(source.damaged("the size is missing"));
    };
    let size = source.agree(width.max(0) as u64, height.max(0) as u64, None)?;
    let body = source.body(12, (size.cells() * bands * 4) as u64)?;
    let (floats, _) = body.as_chunks::<4>();
    let band = |b: usize| floats.iter().skip(b).step_by(bands).map(|&f| f64::from(f32::from_le_bytes(f))).collect();
    Ok(Bands::new(size, (0..bands).map(band).collect()))
}
