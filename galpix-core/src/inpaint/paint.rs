//! What push-pull takes means of: colours, and the motion that goes with them.

use super::kernel::{Value, each};
use super::mean::divided3;
use super::pyramid::Stored;
use crate::format::colour::Colour;

/// Bits of a channel in a pyramid: eight, and two of a fraction. Narrower channels have more bits of a fraction.
const CHANNEL_BITS: u32 = 10;

/// What of a cell is filled in, as it follows from its colour.
pub trait OfCell: Stored {
    /// A colour format looked up: how values are taken from colours whose format is no constant.
    type Table: Copy;

    /// Looks a format up.
    fn table(format: &Colour) -> Self::Table;

    /// Returns what a cell of this colour holds, for a format that is a constant.
    fn of(format: &Colour, colour: u32, cell: u32) -> Self;

    /// Returns what a cell of this colour holds, for any format.
    fn looked_up(table: &Self::Table, colour: u32, cell: u32) -> Self;

    /// Returns the stored colour nearest to it.
    fn colour(self, format: &Colour) -> u32;

    /// Returns the cell whose motion goes with the colour; none where a hole keeps the one that the fill mode gave.
    fn source(self) -> Option<u32>;
}

/// Up to three channels of ten bits, the first one highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tint(u32);

/// How stored colours become tints: where each channel is, and where it goes. Loops by it become vector code, whatever
/// the format.
#[derive(Clone, Copy, Debug, Default)]
pub struct TintOf {
    down: [u32; 3],
    mask: [u32; 3],
    up: [u32; 3],
}

impl TintOf {
    /// Looks a format up. The one channel of a gray goes into the place of the last one.
    #[inline(always)]
    #[must_use]
    pub fn new(format: &Colour) -> Self {
        let mut tint = Self::default();
        for (place, channel) in format.channels().rev().enumerate() {
            let at = 2 - place;
            tint.down[at] = channel.shift;
            tint.mask[at] = (1 << channel.bits) - 1;
            tint.up[at] = place as u32 * CHANNEL_BITS + CHANNEL_BITS - channel.bits;
        }
        tint
    }

    /// Returns the channels of a stored colour, each moved up to ten bits.
    #[inline(always)]
    #[must_use]
    pub fn tint(&self, colour: u32) -> Tint {
        let channel = |at: usize| (colour >> self.down[at] & self.mask[at]) << self.up[at];
        Tint(channel(0) | channel(1) | channel(2))
    }
}

impl Tint {
    /// Returns what [`TintOf::tint`] returns: quicker where the format is a constant.
    #[inline(always)]
    #[must_use]
    pub fn of(format: &Colour, colour: u32) -> Self {
        Self(format.channels().fold(0, |tint, channel| {
            let level = colour >> channel.shift & ((1 << channel.bits) - 1);
            tint << CHANNEL_BITS | level << (CHANNEL_BITS - channel.bits)
        }))
    }

    /// Returns the stored colour: each channel to the nearest, halves upwards.
    #[inline(always)]
    #[must_use]
    pub fn colour(self, format: &Colour) -> u32 {
        let mut tint = self.0;
        format.channels().rev().fold(0, |colour, channel| {
            let down = CHANNEL_BITS - channel.bits;
            let level = ((tint & ((1 << CHANNEL_BITS) - 1)) + (1 << down >> 1)) >> down;
            tint >>= CHANNEL_BITS;
            // The largest level has no fraction: what is rounded up from below it fits.
            colour | level << channel.shift
        })
    }

    /// Returns the three channels.
    #[cfg(test)]
    pub const fn channels(self) -> [u32; 3] {
        let mask = (1 << CHANNEL_BITS) - 1;
        [self.0 >> (2 * CHANNEL_BITS), self.0 >> CHANNEL_BITS & mask, self.0 & mask]
    }

    #[inline(always)]
    const fn new([first, second, third]: [u32; 3]) -> Self {
        Self(first << (2 * CHANNEL_BITS) | second << CHANNEL_BITS | third)
    }
}

/// The first and the third channel, which have room for sums of four between them.
const OUTER: u32 = 0x3ff0_03ff;

/// A one in each of these two.
const OUTER_ONES: u32 = 0x0010_0001;

/// The second channel, moved down.
const MIDDLE: u32 = 0x3ff;

/// Moves the first and the third channel apart: sums by weights up to 64 have sixteen bits each.
#[inline(always)]
const fn apart(tint: u32) -> u32 {
    tint >> 4 & 0x03ff_0000 | tint & 0x3ff
}

impl Stored for Tint {
    type Cell = [u32; 2];

    const WORDS: usize = 2;

    #[inline(always)]
    fn cells(memory: &mut [u32]) -> &mut [Self::Cell] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn encode(self, meta: u32) -> Self::Cell {
        [meta, self.0]
    }

    #[inline(always)]
    fn decode(&[meta, tint]: &Self::Cell) -> (u32, Self) {
        (meta, Self(tint))
    }
}

/// The colour alone.
impl OfCell for Tint {
    type Table = TintOf;

    #[inline(always)]
    fn table(format: &Colour) -> TintOf {
        TintOf::new(format)
    }

    #[inline(always)]
    fn of(format: &Colour, colour: u32, _: u32) -> Self {
        Self::of(format, colour)
    }

    #[inline(always)]
    fn looked_up(table: &TintOf, colour: u32, _: u32) -> Self {
        table.tint(colour)
    }

    #[inline(always)]
    fn colour(self, format: &Colour) -> u32 {
        self.colour(format)
    }

    #[inline(always)]
    fn source(self) -> Option<u32> {
        None
    }
}

impl Value for Tint {
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        let (mut outer, mut middle) = (0, 0);
        for (value, &weight) in values.iter().zip(weights) {
            outer += apart(value.0) * weight;
            middle += (value.0 >> CHANNEL_BITS & MIDDLE) * weight;
        }
        let weight = weights.iter().sum();
        let sums = [outer >> 16, middle, outer & 0xffff];
        Self::new(divided3(sums, weight, tie))
    }

    #[inline(always)]
    fn plain_mean(values: &[Self; 4], tie: u32) -> Self {
        // Four channels of ten bits fit into twelve. A half that goes up is two quarters more.
        let bias = 1 + tie;
        let outer = values.iter().fold(OUTER_ONES * bias, |sum, value| sum + (value.0 & OUTER));
        let middle = values.iter().fold(bias, |sum, value| sum + (value.0 >> CHANNEL_BITS & MIDDLE));
        Self(outer >> 2 & OUTER | (middle >> 2) << CHANNEL_BITS)
    }

    #[inline(always)]
    fn linear(values: &[Self; 4], tie: u32) -> Self {
        let bias = 7 + tie;
        let [own, beside, above, across] = each(*values, |value| apart(value.0));
        let outer = 0x0001_0001 * bias + 9 * own + 3 * (beside + above) + across;
        let [own, beside, above, across] = each(*values, |value| value.0 >> CHANNEL_BITS & MIDDLE);
        let middle = bias + 9 * own + 3 * (beside + above) + across;
        Self(outer & 0x3ff0_0000 | outer >> 4 & 0x3ff | (middle >> 4) << CHANNEL_BITS)
    }
}

/// A colour, and the cell whose motion goes with it.
///
/// Velocity and acceleration of a galpixel belong together, and with the fraction of its position: means of them would
/// be the motion of nothing. So the motion is pulled and pushed by the same weights, as the choice of the one that
/// weighs most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Moving {
    /// The colour.
    pub tint: Tint,
    /// The cell of the picture.
    pub source: u32,
}

impl Stored for Moving {
    type Cell = [u32; 3];

    const WORDS: usize = 3;

    #[inline(always)]
    fn cells(memory: &mut [u32]) -> &mut [Self::Cell] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn encode(self, meta: u32) -> Self::Cell {
        [meta, self.tint.0, self.source]
    }

    #[inline(always)]
    fn decode(&[meta, tint, source]: &Self::Cell) -> (u32, Self) {
        (meta, Self { tint: Tint(tint), source })
    }
}

/// The colour, and position in the cell, motion and tag of a galpixel of the same surface.
impl OfCell for Moving {
    type Table = TintOf;

    #[inline(always)]
    fn table(format: &Colour) -> TintOf {
        TintOf::new(format)
    }

    #[inline(always)]
    fn of(format: &Colour, colour: u32, cell: u32) -> Self {
        Self { tint: Tint::of(format, colour), source: cell }
    }

    #[inline(always)]
    fn looked_up(table: &TintOf, colour: u32, cell: u32) -> Self {
        Self { tint: table.tint(colour), source: cell }
    }

    #[inline(always)]
    fn colour(self, format: &Colour) -> u32 {
        self.tint.colour(format)
    }

    #[inline(always)]
    fn source(self) -> Option<u32> {
        Some(self.source)
    }
}

impl Value for Moving {
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        let (mut source, mut most) = (0, 0);
        for (value, &weight) in values.iter().zip(weights) {
            if weight > most {
                (source, most) = (value.source, weight);
            }
        }
        Self { tint: Tint::mean(&each(*values, |value| value.tint), weights, tie), source }
    }

    #[inline(always)]
    fn plain_mean(values: &[Self; 4], tie: u32) -> Self {
        Self { tint: Tint::plain_mean(&each(*values, |value| value.tint), tie), ..values[0] }
    }

    #[inline(always)]
    fn linear(values: &[Self; 4], tie: u32) -> Self {
        Self { tint: Tint::linear(&each(*values, |value| value.tint), tie), ..values[0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn comes_back(format: Colour, colours: impl Iterator<Item = u32>) {
        for colour in colours {
            assert_eq!(Tint::of(&format, colour).colour(&format), colour);
            assert_eq!(Tint::of(&format, colour), TintOf::new(&format).tint(colour));
        }
    }

    #[test]
    fn every_colour_comes_back() {
        comes_back(Colour::RGB888, (0..1 << 24).step_by(7));
        comes_back(Colour::RGB565, 0..1 << 16);
        comes_back(Colour::GRAY8, 0..256);
        comes_back(Colour::GRAY4, 0..16);
        comes_back(Colour::must(Colour::rgb(1, 7, 3)), 0..1 << 11);
        comes_back(Colour::must(Colour::gray(1)), 0..2);
    }

    #[test]
    fn means_by_usual_weights_are_means() {
        let mut bits = 1u32;
        let mut next = || {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            Moving { tint: Tint(bits >> 2), source: bits }
        };
        for round in 0..10_000 {
            let values = [next(), next(), next(), next()];
            for tie in 0..2 {
                assert_eq!(Moving::plain_mean(&values, tie), Moving::mean(&values, &[16; 4], tie), "{round}");
                assert_eq!(Moving::linear(&values, tie), Moving::mean(&values, &[9, 3, 3, 1], tie), "{round}");
            }
        }
    }

    #[test]
    fn channels_do_not_reach_into_each_other() {
        let [black, white] = [0, 0xff_ffff].map(|colour| TintOf::new(&Colour::RGB888).tint(colour));
        for channel in 0..3 {
            let one = TintOf::new(&Colour::RGB888).tint(0xff << (8 * channel));
            for weights in [[1, 0, 0, 0], [16; 4], [1, 2, 3, 4], [0, 0, 15, 1]] {
                let mean = Tint::mean(&[one, one, one, one], &weights, 1);
                assert_eq!(mean, one);
                let mean = Tint::mean(&[one, white, black, one], &weights, 1);
                let sums = [one, white, black, one].map(Tint::channels);
                for (lane, level) in mean.channels().into_iter().enumerate() {
                    let sum: u32 = sums.iter().zip(weights).map(|(levels, weight)| levels[lane] * weight).sum();
                    let weight: u32 = weights.iter().sum();
                    assert_eq!(level, (2 * sum + weight) / (2 * weight));
                }
            }
        }
    }
}
