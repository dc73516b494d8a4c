//! What metamers take means of: luma, chroma, and the motion that goes with them.

use super::steerable::LARGEST;
use crate::inpaint::kernel::Value;
use crate::inpaint::mean::signed;
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
}
