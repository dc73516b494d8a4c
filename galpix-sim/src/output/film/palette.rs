//! How the pixels of a film are stored: 24-bit colours, or indices into one palette for all frames.

use crate::picture::Picture;
use color_quant::NeuQuant;
use std::collections::HashMap;

/// Colours of a palette: of 256 indices one means "as in the frame before".
pub const PALETTE_COLOURS: usize = 255;

/// About how many pixels a palette is trained on; more take longer and change little.
const TRAINING_PIXELS: usize = 200_000;

/// All frames of a film as raw PNG samples.
pub struct Coded {
    /// Bytes per pixel: 3 (red, green, blue) or 1 (index).
    pub depth: usize,
    /// The frames, row-major, `depth` bytes per pixel.
    pub frames: Vec<Vec<u8>>,
    /// The code that stands for "as in the frame before" and that no frame uses; absent if every 24-bit colour occurs.
    pub clear: Option<Vec<u8>>,
    /// Red, green, blue of each index, where pixels are indices.
    pub palette: Option<Vec<u8>>,
}

/// Returns the frames without loss: as indices if they have few enough colours, else as they are.
pub fn exact(frames: &[Picture]) -> Coded {
    indexed_exactly(frames).unwrap_or_else(|| Coded {
        depth: 3,
        frames: frames.iter().map(|frame| frame.bytes().to_vec()).collect(),
        clear: unused_colour(frames).map(Vec::from),
        palette: None,
    })
}

/// Returns the frames in at most [`PALETTE_COLOURS`] colours, without loss if they have no more than that.
///
/// One palette serves the whole film, so that what stands still does not flicker. It is trained (NeuQuant) on pixels
/// taken in a fixed order: equal films give equal bytes.
pub fn quantised(frames: &[Picture]) -> Coded {
    indexed_exactly(frames).unwrap_or_else(|| {
        let opaque = |&[r, g, b]: &[u8; 3]| [r, g, b, 255];
        let pixels: Vec<u8> = frames.iter().flat_map(|frame| frame.pixels.iter().flat_map(opaque)).collect();
        let every = (pixels.len() / 4 / TRAINING_PIXELS).clamp(1, 30) as i32;
        let net = NeuQuant::new(every, PALETTE_COLOURS, &pixels);
        let mut known = HashMap::new();
        let mut index = |pixel: &[u8; 3]| *known.entry(*pixel).or_insert_with(|| net.index_of(&opaque(pixel)) as u8);
        let frames = frames.iter().map(|frame| frame.pixels.iter().map(&mut index).collect()).collect();
        indexed(frames, net.color_map_rgb())
    })
}

/// Returns the indices into a palette of the colours that occur, in the order in which they do; `None` if they are too
/// many.
fn indexed_exactly(frames: &[Picture]) -> Option<Coded> {
    let (mut known, mut palette) = (HashMap::new(), Vec::new());
    let mut coded = Vec::with_capacity(frames.len());
    for frame in frames {
        let mut indices = Vec::with_capacity(frame.pixels.len());
        for pixel in &frame.pixels {
            let next = known.len();
            let index = *known.entry(*pixel).or_insert(next);
            if index == PALETTE_COLOURS {
                return None;
            }
            if index == next {
                palette.extend_from_slice(pixel);
            }
            indices.push(index as u8);
        }
        coded.push(indices);
    }
    Some(indexed(coded, palette))
}

/// Adds the clear index behind the colours.
fn indexed(frames: Vec<Vec<u8>>, mut palette: Vec<u8>) -> Coded {
    let clear = (palette.len() / 3) as u8;
    palette.extend_from_slice(&[0; 3]);
    Coded { depth: 1, frames, clear: Some(vec![clear]), palette: Some(palette) }
}

/// Returns the first 24-bit colour that no frame has.
fn unused_colour(frames: &[Picture]) -> Option<[u8; 3]> {
    let mut used = vec![false; 1 << 24];
    let number = |[r, g, b]: [u8; 3]| u32::from_be_bytes([0, r, g, b]) as usize;
    frames.iter().flat_map(|frame| &frame.pixels).for_each(|&pixel| used[number(pixel)] = true);
    let [_, r, g, b] = (used.iter().position(|&used| !used)? as u32).to_be_bytes();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a film of one frame with `colours` colours.
    fn ramp(colours: usize) -> Vec<Picture> {
        let pixels = (0..colours).map(|n| [(n % 256) as u8, (n / 256) as u8, 9]).collect();
        vec![Picture { width: colours, height: 1, pixels }]
    }

    #[test]
    fn few_colours_become_indices_without_loss() {
        for coded in [exact(&ramp(255)), quantised(&ramp(255))] {
            let palette = coded.palette.expect("few colours");
            assert_eq!((coded.depth, palette.len(), coded.clear), (1, 256 * 3, Some(vec![255])));
            let back: Vec<u8> =
                coded.frames[0].iter().flat_map(|&n| palette[3 * usize::from(n)..][..3].to_vec()).collect();
            assert_eq!(back, ramp(255)[0].bytes());
        }
    }

    #[test]
    fn one_colour_more_stays_as_it_is() {
        let coded = exact(&ramp(256));
        assert_eq!((coded.depth, coded.frames[0].as_slice()), (3, ramp(256)[0].bytes()));
        assert_eq!(coded.clear, Some(vec![0, 0, 0])); // black does not occur: blue is 9 everywhere
    }

    #[test]
    fn the_clear_colour_is_one_that_no_frame_has() {
        let frame = Picture { width: 3, height: 1, pixels: vec![[0, 0, 1], [0, 0, 0], [0, 0, 3]] };
        assert_eq!(unused_colour(&[frame]), Some([0, 0, 2]));
    }

    #[test]
    fn a_quantised_film_is_near_and_repeats_itself() {
        let film = ramp(2000);
        let (coded, again) = (quantised(&film), quantised(&film));
        assert_eq!(coded.frames, again.frames);
        let palette = coded.palette.expect("a palette");
        assert!(coded.clear.is_some_and(|clear| !coded.frames[0].contains(&clear[0])));
        let error = |(&index, pixel): (&u8, &[u8; 3])| {
            (0..3).map(|c| palette[3 * usize::from(index) + c].abs_diff(pixel[c])).max().unwrap_or(0)
        };
        let worst = coded.frames[0].iter().zip(&film[0].pixels).map(error).max();
        assert!(worst <= Some(24), "off by {worst:?}");
    }
}
