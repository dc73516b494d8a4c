//! What metamers take means of: luma, chroma, and the motion that goes with them.

use super::steerable::LARGEST;
use super::ycbcr;
use crate::format::colour::Colour;
use crate::inpaint::kernel::Value;
use crate::inpaint::mean::signed;
use crate::inpaint::paint::OfCell;
use crate::inpaint::pyramid::Stored;

/// Luma and chroma, and the cell whose motion goes with them, see [`Moving`](crate::inpaint::paint::Moving).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tone {
    /// As [`of_rgb`](super::ycbcr::of_rgb) has them.
    pub channels: [i16; 3],
    /// The cell of the picture.
    pub source: u32,
}

impl Tone {
    /// Adds something to each channel, in quarters; no channel leaves the range of a colour's.
    #[inline(always)]
    #[must_use]
    pub fn detailed(self, detail: [i32; 3]) -> Self {
        let mut channels = [0; 3];
        for ((to, from), more) in channels.iter_mut().zip(self.channels).zip(detail) {
            *to = (i32::from(from) + more).clamp(-i32::from(LARGEST), i32::from(LARGEST)) as i16;
        }
        Self { channels, ..self }
    }
}

/// How stored colours become tones: where each channel is, and by how much it is moved down to be repeated until it has
/// eight bits. Loops by it become vector code, whatever the format.
#[derive(Clone, Copy, Debug)]
pub struct ToneOf {
    down: [u32; 3],
    mask: [u32; 3],
    up: [u32; 3],
    again: [[u32; 3]; 3],
}

impl ToneOf {
    /// Looks a format up. The one channel of a gray stands for all three.
    #[inline(always)]
    fn new(format: &Colour) -> Self {
        let mut tone = Self { down: [0; 3], mask: [0; 3], up: [0; 3], again: [[0; 3]; 3] };
        for (at, channel) in core::iter::repeat_with(|| format.channels()).flatten().take(3).enumerate() {
            let bits = channel.bits;
            tone.down[at] = channel.shift;
            tone.mask[at] = (1 << bits) - 1;
            tone.up[at] = 8 - bits;
            // Of eight bits or fewer nothing is left beyond.
            tone.again[at] = [bits, 2 * bits, if bits < 8 { 4 * bits } else { 31 }];
        }
        tone
    }

    /// Returns luma and chroma of a stored colour.
    #[inline(always)]
    #[must_use]
    pub fn channels(&self, colour: u32) -> [i16; 3] {
        let channel = |at: usize| {
            let [first, second, third] = self.again[at];
            let wide = (colour >> self.down[at] & self.mask[at]) << self.up[at];
            let wide = wide | wide >> first;
            let wide = wide | wide >> second;
            (wide | wide >> third) as u8
        };
        // The `map` of arrays would be a call.
        ycbcr::of_rgb([channel(0), channel(1), channel(2)])
    }
}

/// Puts two halves into a word.
#[inline(always)]
pub const fn packed(low: i16, high: i16) -> u32 {
    low as u16 as u32 | (high as u16 as u32) << 16
}

/// Returns the two halves of a word.
#[inline(always)]
pub const fn halves(word: u32) -> [i16; 2] {
    [word as i16, (word >> 16) as i16]
}

/// The colour, and position in the cell, motion and tag of a galpixel of the same surface.
impl OfCell for Tone {
    type Table = ToneOf;

    #[inline(always)]
    fn table(format: &Colour) -> ToneOf {
        ToneOf::new(format)
    }

    #[inline(always)]
    fn of(format: &Colour, colour: u32, cell: u32) -> Self {
        Self { channels: ycbcr::of_rgb(format.to_rgb888(colour)), source: cell }
    }

    #[inline(always)]
    fn looked_up(table: &ToneOf, colour: u32, cell: u32) -> Self {
        Self { channels: table.channels(colour), source: cell }
    }

    #[inline(always)]
    fn colour(self, format: &Colour) -> u32 {
        stored(format, ycbcr::to_rgb(self.channels.map(i32::from)))
    }

    #[inline(always)]
    fn source(self) -> Option<u32> {
        Some(self.source)
    }
}

/// Returns the stored colour nearest to one of 8 bits per channel, or one that is farther by a single code value.
#[inline(always)]
fn stored(format: &Colour, rgb: [u8; 3]) -> u32 {
    let mut rounded = [0; 3];
    for (i, (to, &level)) in rounded.iter_mut().zip(&rgb).enumerate() {
        // The one channel of a gray stands for all three.
        let bits = format.channel_bits(i);
        // A level of b bits has its high bits once more below: what they add is taken away before half a step is added.
        *to = level - (level as u32 >> bits) as u8 + ((1 << (8 - bits)) >> 1) as u8;
    }
    format.from_rgb888(rounded)
}

impl Stored for Tone {
    type Cell = [u32; 4];

    const WORDS: usize = 4;

    #[inline(always)]
    fn cells(memory: &mut [u32]) -> &mut [Self::Cell] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn encode(self, meta: u32) -> Self::Cell {
        let [luma, blue, red] = self.channels;
        [meta, packed(luma, blue), packed(red, 0), self.source]
    }

    #[inline(always)]
    fn decode(&[meta, first, second, source]: &Self::Cell) -> (u32, Self) {
        let ([luma, blue], [red, _]) = (halves(first), halves(second));
        (meta, Self { channels: [luma, blue, red], source })
    }
}

impl Value for Tone {
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        let (mut source, mut most) = (0, 0);
        for (value, &weight) in values.iter().zip(weights) {
            if weight > most {
                (source, most) = (value.source, weight);
            }
        }
        let mut channels = [0; 3];
        for (channel, to) in channels.iter_mut().enumerate() {
            *to = signed(values.map(|value| i32::from(value.channels[channel])), weights, tie) as i16;
        }
        Self { channels, source }
    }

    #[inline(always)]
    fn plain_mean([a, b, c, d]: &[Self; 4], tie: u32) -> Self {
        let mut mean = *a;
        for (channel, to) in mean.channels.iter_mut().enumerate() {
            let sum = a.channels[channel] + b.channels[channel] + c.channels[channel] + d.channels[channel];
            *to = (sum + 1 + tie as i16) >> 2;
        }
        mean
    }

    #[inline(always)]
    fn linear([a, b, c, d]: &[Self; 4], tie: u32) -> Self {
        let mut mean = *a;
        for (channel, to) in mean.channels.iter_mut().enumerate() {
            let [a, b, c, d] = [a.channels[channel], b.channels[channel], c.channels[channel], d.channels[channel]];
            *to = (9 * a + 3 * (b + c) + d + 7 + tie as i16) >> 4;
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_comes_back_from_its_cell() {
        for channels in [[0, 1, -1], [510, 1020, -1020], [-510, -1020, 1020]] {
            let tone = Tone { channels, source: 0xfedc_ba98 };
            assert_eq!(Tone::decode(&tone.encode(7)), (7, tone));
        }
    }

    #[test]
    fn details_leave_no_channel_beyond_the_range_of_a_colours() {
        let tone = Tone { channels: [510, 1020, -1020], source: 3 };
        assert_eq!(tone.detailed([510, 1, -1]), Tone { channels: [1020, 1020, -1020], ..tone });
        assert_eq!(tone.detailed([-9000, -7, 8000]), Tone { channels: [-1020, 1013, 1020], ..tone });
    }

    #[test]
    fn usual_weights_need_no_product() {
        let tone = |k: i16| Tone { channels: [k, -k, 1020 - k], source: k as u32 };
        for k in 0..500 {
            let values = [tone(k), tone(2 * k), tone(k / 3), tone(510)];
            for tie in 0..2 {
                assert_eq!(Tone::plain_mean(&values, tie), Tone::mean(&values, &[16; 4], tie));
                assert_eq!(Tone::linear(&values, tie), Tone::mean(&values, &[9, 3, 3, 1], tie));
            }
        }
    }

    fn comes_back(format: Colour, colours: impl Iterator<Item = u32>) {
        for colour in colours {
            assert_eq!(stored(&format, format.to_rgb888(colour)), colour);
        }
    }

    #[test]
    fn every_stored_colour_comes_back() {
        comes_back(Colour::RGB888, (0..1 << 24).step_by(7));
        comes_back(Colour::RGB565, 0..1 << 16);
        comes_back(Colour::GRAY8, 0..256);
        comes_back(Colour::GRAY4, 0..16);
    }

    #[test]
    fn tones_are_those_of_eight_bits() {
        for bits in 1..=8 {
            let gray = Colour::must(Colour::gray(bits));
            for format in [gray, Colour::must(Colour::rgb(bits, 9 - bits, 1 + bits / 2))] {
                for colour in 0..1 << format.bits().min(16) {
                    assert_eq!(ToneOf::new(&format).channels(colour), ycbcr::of_rgb(format.to_rgb888(colour)));
                }
            }
        }
    }

    #[test]
    fn a_near_level_is_stored() {
        for level in 0..=255u8 {
            let [red, green, blue] = Colour::RGB565.to_rgb888(stored(&Colour::RGB565, [level; 3]));
            // Steps of five bits are 8 or 9 wide, those of six 4 or 5.
            assert!(level.abs_diff(red) <= 5 && level.abs_diff(green) <= 3 && red == blue, "{level}: {red} {green}");
        }
    }
}
