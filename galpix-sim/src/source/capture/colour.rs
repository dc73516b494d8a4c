//! Colour pictures: PNG, JPEG, and EXR (linear light, encoded as sRGB here).

use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::Census;
use super::error::CaptureError;
use super::exr_planes::{Planes, under};
use super::png_raster;
use super::source::{Format, Size, Source};
use crate::overlay::Overlay;
use crate::picture::Picture;

/// Reads a colour picture as 8-bit sRGB; alpha is left out.
///
/// `channel` is for EXR only: the name before `.R`, `.G`, `.B`; without it the file must have plain `R G B` or exactly
/// one pass `Combined`. `expected`: the size that the picture must have.
pub(super) fn read(source: &Source, channel: Option<&str>, expected: Option<Size>) -> Result<Picture, CaptureError> {
    let format = source.format()?;
    if let (Some(channel), Format::Png | Format::Jpeg) = (channel, format) {
        return Err(source.fault(format!("is no EXR and has no channel \"{channel}\""), "leave the key channel out"));
    }
    let (size, pixels) = match format {
        Format::Png => {
            let raster = png_raster::read(source, expected)?;
            (raster.size, raster.colours())
        }
        Format::Jpeg => jpeg(source, expected)?,
        Format::Exr => combined(source, channel, expected)?,
        _ => return Err(source.fault("is not a colour picture", "name a PNG, JPEG or EXR file")),
    };
    Ok(Picture { width: size.width, height: size.height, pixels })
}

fn jpeg(source: &Source, expected: Option<Size>) -> Result<(Size, Vec<[u8; 3]>), CaptureError> {
    let damaged = |e: DecodeErrors| source.damaged(e);
    // The decoder is lenient: it paints grey what a truncated file lacks.
    if !jpeg_is_whole(&source.bytes) {
        return Err(source.damaged("it has no end marker"));
    }
    let options = DecoderOptions::default()
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(source.bytes.as_slice()), options);
    decoder.decode_headers().map_err(damaged)?;
    let (width, height) = decoder.dimensions().ok_or_else(|| source.damaged("it has no size"))?;
    let size = source.agree(width as u64, height as u64, expected)?;
    let bytes = decoder.decode().map_err(damaged)?;
    let (pixels, rest) = bytes.as_chunks::<3>();
    if pixels.len() == size.cells() && rest.is_empty() {
        Ok((size, pixels.to_vec()))
    } else {
        Err(source.damaged("its pixels do not fill its size"))
    }
}

/// Walks through the segments of a JPEG up to its end marker (ITU T.81, annex B).
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let mut at = 2;
    loop {
        // Entropy-coded bytes, stuffed zeros and restart markers up to the next true marker.
        let Some(found) = bytes.get(at..).and_then(|rest| {
            rest.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0x00 | 0xff | 0xd0..=0xd7))
        }) else {
            return false;
        };
        at += found + 2;
        match bytes[at - 1] {
            0xd9 => return true,
            0x01 | 0xd8 => {}
            _ => match super::source::array(bytes, at).map(u16::from_be_bytes) {
                Some(length @ 2..) => at += usize::from(length),
                _ => return false,
            },
        }
    }
}

fn combined(
    source: &Source,
    channel: Option<&str>,
    expected: Option<Size>,
) -> Result<(Size, Vec<[u8; 3]>), CaptureError> {
    let planes = Planes::read(source)?;
    let prefix = channel.unwrap_or(if planes.has("Combined.R") { "Combined" } else { "" });
    let names = ["R", "G", "B"].map(|name| under(prefix, name));
    let size = planes.size(&names[0], expected)?;
    let [r, g, b] = [planes.band(&names[0], size)?, planes.band(&names[1], size)?, planes.band(&names[2], size)?];
    Ok((size, r.iter().zip(&g).zip(&b).map(|((&r, &g), &b)| [r, g, b].map(srgb)).collect()))
}

/// Returns linear light (1 = white) as an 8-bit sRGB code, IEC 61966-2-1; NaN becomes black.
fn srgb(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let code = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (code * 255.0).round() as u8
}

/// Returns what is pinned over a picture of `expected` size: the pixels of a PNG whose alpha is at least one half.
/// Others that are not quite transparent, or not quite opaque, are noted.
pub(super) fn overlay(source: &Source, expected: Size, census: &mut Census) -> Result<Overlay, CaptureError> {
    if source.format()? != Format::Png {
        return Err(source.fault("is not a PNG, as an overlay must be", "save it as a PNG with alpha"));
    }
    let raster = png_raster::read(source, Some(expected))?;
    if raster.channels % 2 != 0 {
        return Err(
            source.fault("has no alpha, so that it would hide the whole picture", "save it as a PNG with alpha")
        );
    }
    let alphas: Vec<u16> = raster.band(raster.channels - 1).collect();
    let translucent = alphas.iter().filter(|&&alpha| alpha != 0 && alpha != raster.white).count();
    if translucent != 0 {
        census
            .notes
            .push(format!("{translucent} translucent pixels of the overlay: pinned from an alpha of one half on"));
    }
    let pinned = |(colour, alpha): ([u8; 3], u16)| (alpha > raster.white / 2).then_some(colour);
    let pixels = raster.colours().into_iter().zip(alphas).map(pinned).collect();
    Ok(Overlay { width: expected.width, height: expected.height, pixels })
}

/// Returns a mask of `expected` size: `true` where the comparison counts, that is, where any channel is not zero.
pub(super) fn mask(source: &Source, expected: Size) -> Result<Vec<bool>, CaptureError> {
    if source.format()? != Format::Png {
        return Err(source.fault("is not a PNG, as a mask must be", "save it as an 8-bit grey PNG"));
    }
    let raster = png_raster::read(source, Some(expected))?;
    // Alpha is no part of a mask.
    let seen = if raster.channels >= 3 { 3 } else { 1 };
    Ok(raster.values.chunks_exact(raster.channels).map(|p| p[..seen].iter().any(|&v| v != 0)).collect())
}
