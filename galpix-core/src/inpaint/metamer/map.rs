//! A galpixmap as a scene for metamers.

use super::scene::Scene;
use super::steerable::COLUMNS;
use super::surroundings::Row;
use super::tone::Tone;
use super::ycbcr;
use crate::format::Format;
use crate::format::colour::Colour;
use crate::format::record::Words;
use crate::inpaint::map::{OfGalpixel, Uncovered, moving_as, pyramid_depth};
use crate::map::Galpixmap;
use crate::map::galpixel::Class;

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
    fn channels(&self, colour: u32) -> [i16; 3] {
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

/// The colour, and position in the cell, motion and tag of a galpixel of the same surface.
impl OfGalpixel for Tone {
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
    fn put_into<F: Format>(self, map: &Galpixmap<'_, F>, words: Words) -> Words {
        let mut moving = moving_as(map, self.source, words);
        map.record()
            .colour()
            .set(&mut moving, stored(map.record().colour_format(), ycbcr::to_rgb(self.channels.map(i32::from))));
        moving
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

impl<F: Format> Scene for Uncovered<'_, '_, F, Tone> {
    fn each_hole(&mut self, mut hole: impl FnMut(u32, u32)) {
        Uncovered::each_hole(self, |_, x, y, _| hole(x, y));
    }

    #[inline]
    fn row(&self, left: u32, y: u32, cells: &mut Row) {
        let Some(row) = self.map.grid().row(y as i32) else { return };
        let count = ((self.map.grid().width() - left) as usize).min(COLUMNS);
        let (first, bits) = ((row + left) as usize, u32::from(self.map.record().depth().bits));
        let (mut keys, mut colours) = ([0; COLUMNS], [0; COLUMNS]);
        for (to, key) in keys.iter_mut().zip(self.map.keys(first..first + count)) {
            *to = key;
        }
        for (to, colour) in colours.iter_mut().zip(self.map.colours(first..first + count)) {
            *to = colour;
        }
        let read = self.reader();
        for x in 0..COLUMNS {
            let depth = pyramid_depth(keys[x] & ((1 << bits) - 1), bits);
            let class = keys[x] >> bits;
            cells.depths[x] = if class == Class::Empty as u32 { 0 } else { depth as i32 };
            // Galpixels and debris: the classes without the lower bit.
            cells.known[x] = (class & 1) as i32 - 1;
            let [luma, blue, red] = read(colours[x], 0).channels;
            cells.channels[0][x] = luma;
            cells.channels[1][x] = blue;
            cells.channels[2][x] = red;
        }
    }

    #[inline]
    fn depth(&self, x: u32, y: u32) -> u32 {
        let bits = u32::from(self.map.record().depth().bits);
        let key = self.map.grid().cell(x as i32, y as i32).and_then(|cell| self.map.key_at(cell));
        key.map_or(0, |key| pyramid_depth(key & ((1 << bits) - 1), bits))
    }

    #[inline]
    fn source(&self, x: u32, y: u32) -> u32 {
        self.map.grid().cell(x as i32, y as i32).unwrap_or_default()
    }

    fn displacement(&self, source: u32, age: u32) -> [i32; 2] {
        if !self.map.record().layout().velocity {
            return [0; 2];
        }
        let Some(words) = self.map.words_at(source) else { return [0; 2] };
        let (record, age) = (self.map.record(), i64::from(age.min(0xffff)));
        [0, 1].map(|component| {
            let scale = &record.scales[component];
            let v = i64::from(record.velocity(component).signed(&words));
            let a = i64::from(record.acceleration(component).signed(&words)) << scale.acceleration_up;
            let twice = 2 * v * age - a * age * age;
            ((twice + (1 << scale.velocity_frac)) >> (scale.velocity_frac + 1)) as i32
        })
    }

    fn put(&mut self, x: u32, y: u32, tone: Tone) {
        let Some(cell) = self.map.grid().cell(x as i32, y as i32) else { return };
        let words = self.map.words_at(cell).unwrap_or_default();
        let words = OfGalpixel::put_into(tone, self.map, words);
        self.map.put(cell, &words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
