//! PNG as raw numbers: depth maps, disparities, KITTI's flow, masks, and the colour of a picture.

use std::io::Cursor;

use png::{BitDepth, ColorType, DecodeOptions, Decoder, Limits, Transformations};

use super::error::CaptureError;
use super::orientation::Orientation;
use super::source::{Bands, Size, Source};

/// A decoded PNG: palettes expanded, otherwise the values as stored.
#[derive(Clone, Debug)]
pub(super) struct Raster {
    pub size: Size,
    /// 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha.
    pub channels: usize,
    /// Bits a value as stored in the file: 1, 2, 4, 8 or 16 (8 for a palette).
    pub stored_bits: u8,
    /// Row-major, channels interleaved; values of fewer than 8 bits are stretched to 8.
    pub values: Vec<u16>,
    /// The largest possible value, 255 or 65535.
    pub white: u16,
    /// Where the file says that it is not upright.
    pub turned: Option<Orientation>,
    /// Remarks on what the file says of itself and is not used.
    pub notes: Vec<String>,
}

/// Decodes a PNG of any colour type; the whole file must be there, up to its end chunk.
pub(super) fn read(source: &Source, expected: Option<Size>) -> Result<Raster, CaptureError> {
    let damaged = |e: png::DecodingError| source.damaged(e);
    let mut options = DecodeOptions::default();
    options.set_ignore_text_chunk(true);
    options.set_ignore_adler32(false);
    let mut decoder = Decoder::new_with_options(Cursor::new(source.bytes.as_slice()), options);
    let (width, height, stored) = {
        let info = decoder.read_header_info().map_err(damaged)?;
        (info.width, info.height, if info.color_type == ColorType::Indexed { BitDepth::Eight } else { info.bit_depth })
    };
    let size = source.agree(u64::from(width), u64::from(height), expected)?;
    decoder.set_limits(Limits { bytes: 64 << 20 });
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(damaged)?;
    let notes = remarks(reader.info());
    let turned = reader.info().exif_metadata.as_deref().and_then(Orientation::of);
    let length = reader.output_buffer_size().ok_or_else(|| source.damaged("its size overflows"))?;
    let mut bytes = vec![0; length];
    let frame = reader.next_frame(&mut bytes).map_err(damaged)?;
    reader.finish().map_err(damaged)?;
    bytes.truncate(frame.buffer_size());
    let (values, white) = match frame.bit_depth {
        BitDepth::Sixteen => (bytes.as_chunks::<2>().0.iter().map(|&v| u16::from_be_bytes(v)).collect(), u16::MAX),
        _ => (bytes.into_iter().map(u16::from).collect::<Vec<_>>(), 255),
    };
    let channels = frame.color_type.samples();
    if values.len() != size.cells() * channels {
        return Err(source.damaged("its pixels do not fill its size"));
    }
    Ok(Raster { size, channels, stored_bits: stored as u8, values, white, turned, notes })
}

/// Returns remarks on what a PNG says of its colours and its place, and what the importer does not follow.
fn remarks(info: &png::Info<'_>) -> Vec<String> {
    let mut notes = Vec::new();
    let gamma = info.gama_chunk.map(|gamma| f64::from(gamma.into_value()));
    if info.srgb.is_none()
        && let Some(gamma) = gamma.filter(|gamma| (gamma - 1.0 / 2.2).abs() > 0.02)
    {
        notes.push(format!("says that its gamma is {gamma:.3}; it is read as sRGB"));
    }
    if info.icc_profile.is_some() && info.srgb.is_none() {
        notes.push("has a colour profile, which is not used; it is read as sRGB".to_owned());
    }
    if info.coding_independent_code_points.is_some_and(|code| (code.color_primaries, code.transfer_function) != (1, 13))
    {
        notes.push("says that its colours are not sRGB; it is read as sRGB".to_owned());
    }
    if info.is_animated() {
        notes.push("is animated; its first picture is read".to_owned());
    }
    notes
}

impl Raster {
    /// Returns the channel `index` as raw numbers.
    pub fn band(&self, index: usize) -> impl Iterator<Item = u16> {
        self.values.iter().skip(index).step_by(self.channels).copied()
    }

    /// Returns where a mask counts: where any colour is not zero. Alpha is no part of it.
    pub fn counting(&self) -> Vec<bool> {
        let seen = if self.channels >= 3 { 3 } else { 1 };
        self.values.chunks_exact(self.channels).map(|p| p[..seen].iter().any(|&v| v != 0)).collect()
    }

    /// Returns the red, green and blue of each pixel at 8 bits, grey repeated, alpha left out.
    pub fn colours(&self) -> Vec<[u8; 3]> {
        let narrow = |v: u16| if self.white == 255 { v as u8 } else { ((u32::from(v) + 128) / 257) as u8 };
        let colour = |p: &[u16]| match *p {
            [r, g, b] | [r, g, b, _] => [r, g, b].map(narrow),
            [grey, ..] => [narrow(grey); 3],
            [] => [0; 3],
        };
        self.values.chunks_exact(self.channels).map(colour).collect()
    }
}

/// Returns raw numbers of a grey map, 8 or 16 bits; RGB is read where its three channels are equal. One band.
pub(super) fn grey(source: &Source) -> Result<Bands, CaptureError> {
    let raster = read(source, None)?;
    if raster.stored_bits < 8 {
        let what = format!("has {} bits a pixel, which is no depth or disparity", raster.stored_bits);
        return Err(source.fault(what, "save it with 8 or 16 bits"));
    }
    if raster.channels >= 3 && raster.values.chunks_exact(raster.channels).any(|p| p[0] != p[1] || p[0] != p[2]) {
        return Err(source.fault(
            "is a coloured picture, not a map of one number a pixel",
            "save it as grey, or say how it is packed with format = \"rgb24\", \"bgr24\" or \"sintel-disparity\"",
        ));
    }
    Ok(Bands::new(raster.size, vec![raster.band(0).map(f64::from).collect()]))
}

/// Sintel's disparity: 8-bit RGB, `d = 4 R + G / 64 + B / 16384` pixels. One band.
pub(super) fn sintel_disparity(source: &Source) -> Result<Bands, CaptureError> {
    let raster = read(source, None)?;
    if raster.channels < 3 || raster.stored_bits != 8 {
        return Err(
            source.fault("is not an 8-bit RGB picture, as Sintel's disparities are", "leave the key format out")
        );
    }
    let value = |p: &[u16]| f64::from(p[0]) * 4.0 + f64::from(p[1]) / 64.0 + f64::from(p[2]) / 16384.0;
    Ok(Bands::new(raster.size, vec![raster.values.chunks_exact(raster.channels).map(value).collect()]))
}

/// Numbers of 24 bits in 8-bit RGB, the low byte in `weights`' order of red, green, blue. One band.
pub(super) fn packed24(source: &Source, weights: [f64; 3]) -> Result<Bands, CaptureError> {
    let raster = read(source, None)?;
    if raster.channels < 3 || raster.stored_bits != 8 {
        return Err(source.fault("is not an 8-bit RGB picture, as packed numbers are", "leave the key format out"));
    }
    let value = |p: &[u16]| p.iter().zip(weights).map(|(&v, weight)| f64::from(v) * weight).sum();
    Ok(Bands::new(raster.size, vec![raster.values.chunks_exact(raster.channels).map(value).collect()]))
}

/// KITTI's disparity: 16-bit grey, `d = value / 256` pixels, 0 = unknown (delivered as NaN). One band.
pub(super) fn kitti_disparity(source: &Source) -> Result<Bands, CaptureError> {
    let raster = read(source, None)?;
    if raster.channels > 2 || raster.stored_bits != 16 {
        return Err(
            source.fault("is not a 16-bit grey picture, as KITTI's disparities are", "leave the key format out")
        );
    }
    let value = |v: u16| if v == 0 { f64::NAN } else { f64::from(v) / 256.0 };
    Ok(Bands::new(raster.size, vec![raster.band(0).map(value).collect()]))
}

/// KITTI's flow: 16-bit RGB, `u = (R - 32768) / 64`, `v = (G - 32768) / 64`, `B` zero = unknown (delivered as NaN).
pub(super) fn kitti_flow(source: &Source) -> Result<Bands, CaptureError> {
    let raster = read(source, None)?;
    if raster.channels < 3 || raster.stored_bits != 16 {
        let hint = "give a KITTI flow PNG, .flo, .npy or three-channel PFM";
        return Err(source.fault("is not a 16-bit RGB picture, as KITTI's flows are", hint));
    }
    let component = |index: usize| {
        let value = |p: &[u16]| if p[2] == 0 { f64::NAN } else { (f64::from(p[index]) - 32768.0) / 64.0 };
        raster.values.chunks_exact(raster.channels).map(value).collect()
    };
    Ok(Bands::new(raster.size, vec![component(0), component(1)]))
}
