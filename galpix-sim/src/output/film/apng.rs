//! Animated PNG, as small as lossless permits.
//!
//! After the first frame only the rectangle that changed is stored, and inside it what did not change may be stored as
//! a transparent code, which compresses to almost nothing. Which of the two, and which row filter, is tried out for
//! each frame. Source: the PNG specification, third edition (fcTL, fdAT, tRNS).

use super::palette::{self, Coded};
use crate::picture::Picture;
use png::{BitDepth, BlendOp, ColorType, DeflateCompression, Encoder, EncodingError, Filter};
use rayon::prelude::*;

/// How a film stores its colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Bit by bit as they are.
    Exact,
    /// At most 255, one palette for all frames, the same at each run. For looking at, not for measuring.
    Palette,
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// No frame, or frames without pixels.
    #[error("a film needs at least one frame, of at least one pixel")]
    Nothing,
    /// A frame of another size, or one whose pixels do not match its size.
    #[error("frame {frame} of the film is not {width}x{height} like the first; make all frames of one size")]
    SizesDiffer {
        /// Index of the first frame that is wrong.
        frame: usize,
        /// Columns of the first frame.
        width: usize,
        /// Rows of the first frame.
        height: usize,
    },
    /// More pixels or frames than a PNG can hold.
    #[error("the film cannot be written as PNG: {0}")]
    Encoding(#[from] EncodingError),
}

/// Returns the frames as an animated PNG that loops for ever and shows each frame for `delay_ms` milliseconds.
///
/// Viewers that know no animation show the first frame. All frames must have the size of the first.
pub fn apng(frames: &[Picture], delay_ms: u16, colours: Colours) -> Result<Vec<u8>, FilmError> {
    let (width, height) = checked_size(frames)?;
    let coded = match colours {
        Colours::Exact => palette::exact(frames),
        Colours::Palette => palette::quantised(frames),
    };
    let patches: Vec<Patch> =
        (0..frames.len()).into_par_iter().map(|n| Patch::best(&coded, width, n)).collect::<Result<_, _>>()?;
    write(&coded, &patches, [width, height], delay_ms, EFFORT)
}

/// [`apng`] with [`Colours::Exact`] if that takes at most `most_bytes`, else with [`Colours::Palette`] whatever that
/// takes; returns which it was.
pub fn apng_within(frames: &[Picture], delay_ms: u16, most_bytes: usize) -> Result<(Vec<u8>, Colours), FilmError> {
    let exact = apng(frames, delay_ms, Colours::Exact)?;
    if exact.len() <= most_bytes {
        return Ok((exact, Colours::Exact));
    }
    Ok((apng(frames, delay_ms, Colours::Palette)?, Colours::Palette))
}

fn checked_size(frames: &[Picture]) -> Result<(usize, usize), FilmError> {
    let first = frames.first().ok_or(FilmError::Nothing)?;
    let (width, height) = (first.width, first.height);
    if width == 0 || height == 0 {
        return Err(FilmError::Nothing);
    }
    let fits = |frame: &Picture| {
        (frame.width, frame.height) == (width, height) && width.checked_mul(height) == Some(frame.pixels.len())
    };
    match frames.iter().position(|frame| !fits(frame)) {
        Some(frame) => Err(FilmError::SizesDiffer { frame, width, height }),
        None => Ok((width, height)),
    }
}

/// Deflate levels: of the film, and of the trials, which need only rank the candidates.
const EFFORT: u8 = 9;
const TRIAL_EFFORT: u8 = 4;

/// The part of a frame that is stored, and how.
struct Patch {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    blend: BlendOp,
    filter: Filter,
    data: Vec<u8>,
}

impl Patch {
    /// Returns the smallest form of frame `n`.
    fn best(film: &Coded, film_width: usize, n: usize) -> Result<Self, FilmError> {
        let before = n.checked_sub(1).map(|n| film.frames[n].as_slice());
        let mut candidates = vec![Self::cut(film, film_width, n, before, None)];
        if let (Some(_), Some(clear)) = (before, &film.clear) {
            candidates.push(Self::cut(film, film_width, n, before, Some(clear)));
        }
        let mut smallest: Option<(usize, Self)> = None;
        for candidate in candidates {
            for filter in [Filter::NoFilter, Filter::Adaptive, Filter::MinEntropy] {
                let trial = Self { filter, data: candidate.data.clone(), ..candidate };
                let whole = [trial.width, trial.height];
                let bytes =
                    write(film, std::slice::from_ref(&Self { left: 0, top: 0, ..trial }), whole, 0, TRIAL_EFFORT)?
                        .len();
                if smallest.as_ref().is_none_or(|(least, _)| bytes < *least) {
                    smallest = Some((bytes, Self { filter, data: candidate.data.clone(), ..candidate }));
                }
            }
        }
        smallest.map(|(_, patch)| patch).ok_or(FilmError::Nothing)
    }

    /// Creates the rectangle of frame `n` that differs from `before` (all of it without one, one pixel if nothing
    /// differs). With `clear`, pixels in it that do not differ are that code.
    fn cut(film: &Coded, film_width: usize, n: usize, before: Option<&[u8]>, clear: Option<&Vec<u8>>) -> Self {
        let (frame, depth) = (film.frames[n].as_slice(), film.depth);
        let pixel = |cell: usize| cell * depth..(cell + 1) * depth;
        let changed = |cell: usize| before.is_none_or(|before| before[pixel(cell)] != frame[pixel(cell)]);
        let (mut x, mut y) = ([usize::MAX, 0], [usize::MAX, 0]);
        for cell in (0..frame.len() / depth).filter(|&cell| changed(cell)) {
            x = [x[0].min(cell % film_width), x[1].max(cell % film_width)];
            y = [y[0].min(cell / film_width), y[1].max(cell / film_width)];
        }
        if x[0] == usize::MAX {
            (x, y) = ([0, 0], [0, 0]);
        }
        let mut data = Vec::with_capacity((x[1] - x[0] + 1) * (y[1] - y[0] + 1) * depth);
        for cell in (y[0]..=y[1]).flat_map(|y| (x[0]..=x[1]).map(move |x| y * film_width + x)) {
            match clear {
                Some(clear) if !changed(cell) => data.extend_from_slice(clear),
                _ => data.extend_from_slice(&frame[pixel(cell)]),
            }
        }
        let blend = if clear.is_some() { BlendOp::Over } else { BlendOp::Source };
        let (width, height) = (x[1] - x[0] + 1, y[1] - y[0] + 1);
        Self { left: x[0], top: y[0], width, height, blend, filter: Filter::NoFilter, data }
    }
}

/// Writes the patches, the first of which covers `size`, as one file.
fn write(film: &Coded, patches: &[Patch], size: [usize; 2], delay_ms: u16, effort: u8) -> Result<Vec<u8>, FilmError> {
    let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX); // refused by the encoder
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side(size[0]), side(size[1]));
    encoder.set_depth(BitDepth::Eight);
    encoder.set_color(if film.palette.is_some() { ColorType::Indexed } else { ColorType::Rgb });
    if let Some(palette) = &film.palette {
        encoder.set_palette(palette.clone());
    }
    if let Some(clear) = &film.clear {
        encoder.set_trns(transparency(clear));
    }
    encoder.set_deflate_compression(DeflateCompression::Level(effort));
    encoder.set_animated(side(patches.len()), 0)?;
    encoder.set_frame_delay(delay_ms, 1000)?;
    encoder.validate_sequence(true);
    let mut writer = encoder.write_header()?;
    for patch in patches {
        writer.reset_frame_position()?;
        writer.set_frame_dimension(side(patch.width), side(patch.height))?;
        writer.set_frame_position(side(patch.left), side(patch.top))?;
        writer.set_blend_op(patch.blend)?;
        writer.set_filter(patch.filter);
        writer.write_image_data(&patch.data)?;
    }
    writer.finish()?;
    Ok(bytes)
}

/// Returns the tRNS chunk that makes the code `clear` transparent: opacity of each index up to it, or the colour in
/// 16-bit samples.
fn transparency(clear: &[u8]) -> Vec<u8> {
    match clear {
        &[index] => {
            let mut opacities = vec![255; usize::from(index)];
            opacities.push(0);
            opacities
        }
        colour => colour.iter().flat_map(|&sample| [0, sample]).collect(),
    }
}

#[cfg(test)]
#[path = "apng_tests.rs"]
mod tests;
