//! Colour pictures: PNG, JPEG, and EXR (linear light, encoded as sRGB here).

use std::collections::VecDeque;

use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::error::CaptureError;
use super::exr_planes::{Planes, under};
use super::orientation::Orientation;
use super::png_raster;
use super::raster::Canvas;
use super::source::{Format, Size, Source};
use crate::overlay::Overlay;
use crate::picture::Picture;

/// Reads a colour picture as 8-bit sRGB; alpha is left out, and what the file says of itself and is not used is noted.
///
/// `channel` is for EXR only: the name before `.R`, `.G`, `.B`; without it the file must have plain `R G B` or exactly
/// one pass `Combined`. `expected`: the size that the picture must have.
pub(super) fn read(
    source: &Source,
    channel: Option<&str>,
    expected: Option<Size>,
    notes: &mut Vec<String>,
) -> Result<Picture, CaptureError> {
    let format = source.format()?;
    if let (Some(channel), Format::Png | Format::Jpeg) = (channel, format) {
        return Err(source.fault(format!("is no EXR and has no channel \"{channel}\""), "leave the key channel out"));
    }
    let mut canvas = Canvas { size: expected.unwrap_or(Size { width: 1, height: 1 }), notes };
    let (size, pixels) = match format {
        Format::Png => {
            let raster = png_raster::read(source, None)?;
            raster.notes.iter().for_each(|note| canvas.note(source, note));
            let alpha = (raster.channels % 2 == 0).then(|| raster.band(raster.channels - 1));
            let translucent = alpha.map_or(0, |alpha| alpha.filter(|&alpha| alpha != raster.white).count());
            if translucent > 0 {
                let what = format!("has {translucent} pixels that are not opaque; its alpha is left out");
                canvas.note(source, &what);
            }
            turned(source, raster.turned, (raster.size, raster.colours()), &mut canvas)
        }
        Format::Jpeg => jpeg(source, &mut canvas)?,
        Format::Exr => combined(source, channel, expected, &mut canvas)?,
        _ => return Err(source.fault("is not a colour picture", "name a PNG, JPEG or EXR file")),
    };
    source.agree(size.width as u64, size.height as u64, expected)?;
    Ok(Picture { width: size.width, height: size.height, pixels })
}

/// Returns a picture upright, and notes it if it was not stored so.
fn turned(
    source: &Source,
    orientation: Option<Orientation>,
    (size, pixels): (Size, Vec<[u8; 3]>),
    canvas: &mut Canvas<'_>,
) -> (Size, Vec<[u8; 3]>) {
    let Some(orientation) = orientation else { return (size, pixels) };
    let what = format!(
        "says that it is {}, and is read upright: its depth and motion must be so, too (save it without Exif if they are \
         as it is stored)",
        orientation.text()
    );
    canvas.note(source, &what);
    orientation.upright(size, &pixels)
}

/// Most pixels that a byte of a JPEG can hold: a block of 8x8 takes a bit at least.
const PIXELS_A_BYTE: usize = 8 * 64;

fn jpeg(source: &Source, canvas: &mut Canvas<'_>) -> Result<(Size, Vec<[u8; 3]>), CaptureError> {
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
    let size = source.agree(width as u64, height as u64, None)?;
    if size.cells() > PIXELS_A_BYTE * source.bytes.len() {
        let what = format!("it is too short for the {width}x{height} pixels that its header promises");
        return Err(source.damaged(what));
    }
    let bytes = decoder.decode().map_err(damaged)?;
    let orientation = decoder.exif().and_then(|exif| Orientation::of(exif));
    let is_srgb = |profile: &[u8]| profile.windows(4).any(|name| name == b"sRGB");
    if decoder.icc_profile().is_some_and(|profile| !is_srgb(&profile)) {
        canvas.note(source, "has a colour profile, which is not used; it is read as sRGB");
    }
    let (pixels, rest) = bytes.as_chunks::<3>();
    if pixels.len() == size.cells() && rest.is_empty() {
        Ok(turned(source, orientation, (size, pixels.to_vec()), canvas))
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
    canvas: &mut Canvas<'_>,
) -> Result<(Size, Vec<[u8; 3]>), CaptureError> {
    let planes = Planes::read(source)?;
    let prefix = channel.unwrap_or(if planes.has("Combined.R") { "Combined" } else { "" });
    let names = ["R", "G", "B"].map(|name| under(prefix, name));
    planes.note_primaries(canvas);
    let size = expected.map_or_else(|| planes.display(), Ok)?;
    let bands = planes.bands(&names, &mut Canvas { size, notes: canvas.notes })?;
    let [r, g, b] = &bands.bands[..] else { return Err(source.damaged("it lacks a colour")) };
    Ok((bands.size, r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b].map(srgb)).collect()))
}

/// Returns linear light (1 = white) as an 8-bit sRGB code, IEC 61966-2-1; NaN becomes black.
fn srgb(linear: f64) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let code = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (code * 255.0).round() as u8
}

/// What is pinned over a picture, and where anything of it is seen.
pub(super) struct Pinned {
    pub overlay: Overlay,
    /// Whether the overlay is not quite transparent, for each pixel.
    pub touched: Vec<bool>,
}

/// Returns what is pinned over a picture of `expected` size: the pixels of a PNG whose alpha is at least one half.
/// Others that are not quite transparent, or not quite opaque, are noted.
pub(super) fn overlay(source: &Source, expected: Size, notes: &mut Vec<String>) -> Result<Pinned, CaptureError> {
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
        notes.push(format!("{translucent} translucent pixels of the overlay: pinned from an alpha of one half on"));
    }
    let touched = alphas.iter().map(|&alpha| alpha != 0).collect();
    let pinned = |(colour, alpha): ([u8; 3], u16)| (alpha > raster.white / 2).then_some(colour);
    let pixels = raster.colours().into_iter().zip(alphas).map(pinned).collect();
    Ok(Pinned { overlay: Overlay { width: expected.width, height: expected.height, pixels }, touched })
}

impl Pinned {
    /// Returns which cells are unknown because the instruments are drawn into the picture, too; nothing if they are
    /// left out of it. A pixel shows them where it has their colour, up to what compression changes.
    pub fn drawn_into(&self, picture: &Picture) -> Option<&[bool]> {
        /// Of a channel, in 8-bit code values.
        const SAME: u8 = 16;
        /// The part of the pinned pixels that must agree.
        const MOST: f64 = 0.75;
        let pinned = self.overlay.pixels.iter().zip(&picture.pixels).filter_map(|(pin, seen)| Some(((*pin)?, seen)));
        let same = pinned.clone().filter(|(pin, seen)| pin.iter().zip(*seen).all(|(a, b)| a.abs_diff(*b) <= SAME));
        let (count, same) = (pinned.count(), same.count());
        (count > 0 && same as f64 >= MOST * count as f64).then_some(&self.touched)
    }
}

/// Gives marked cells the colour of the nearest one that is not: what they showed was nothing of the scene.
pub(super) fn cover(picture: &mut Picture, marked: &[bool]) {
    let (width, height) = (picture.width, picture.height);
    let mut open = marked.to_vec();
    let mut found: VecDeque<usize> = (0..open.len()).filter(|&cell| !open[cell]).collect();
    while let Some(cell) = found.pop_front() {
        let (x, y) = (cell % width, cell / width);
        let beside = [
            (x > 0).then(|| cell - 1),
            (x + 1 < width).then(|| cell + 1),
            (y > 0).then(|| cell - width),
            (y + 1 < height).then(|| cell + width),
        ];
        for next in beside.into_iter().flatten() {
            if std::mem::take(&mut open[next]) {
                picture.pixels[next] = picture.pixels[cell];
                found.push_back(next);
            }
        }
    }
}

/// Returns a mask of `expected` size: `true` where the comparison counts, that is, where any channel is not zero.
pub(super) fn mask(source: &Source, expected: Size) -> Result<Vec<bool>, CaptureError> {
    if source.format()? != Format::Png {
        return Err(source.fault("is not a PNG, as a mask must be", "save it as an 8-bit grey PNG"));
    }
    Ok(png_raster::read(source, Some(expected))?.counting())
}
