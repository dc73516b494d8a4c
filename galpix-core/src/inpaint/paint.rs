//! What push-pull takes means of: colours, and the motion that goes with them.

use super::mean::divided3;
use super::push_pull::Value;
use crate::colour::Colour;

/// Bits of a channel in a pyramid: eight, and two of a fraction.
const CHANNEL_BITS: u32 = 10;

/// Fraction bits of a channel of eight bits. Narrower channels have more of them.
pub const FRACTION_BITS: u32 = CHANNEL_BITS - 8;

/// Up to three channels of ten bits, the first one highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Tint(u32);

impl Tint {
    /// The channels of a stored colour, each moved up to ten bits.
    #[inline(always)]
    #[must_use]
    pub fn of<C: Colour>(colour: u32) -> Self {
        const { assert!(C::CHANNELS.len() <= 3, "a colour has at most three channels here") }
        Self(C::CHANNELS.iter().fold(0, |tint, channel| {
            let level = colour >> channel.shift & ((1 << channel.bits) - 1);
            tint << CHANNEL_BITS | level << (CHANNEL_BITS - channel.bits)
        }))
    }

    /// The stored colour: each channel to the nearest, halves upwards.
    #[inline(always)]
    #[must_use]
    pub fn colour<C: Colour>(self) -> u32 {
        let mut tint = self.0;
        C::CHANNELS.iter().rev().fold(0, |colour, channel| {
            let down = CHANNEL_BITS - channel.bits;
            let level = ((tint & ((1 << CHANNEL_BITS) - 1)) + (1 << down >> 1)) >> down;
            tint >>= CHANNEL_BITS;
            // The largest level has no fraction: what is rounded up from below it fits.
            colour | level << channel.shift
        })
    }

    /// The three channels.
    #[inline(always)]
    #[must_use]
    pub const fn channels(self) -> [u32; 3] {
        let mask = (1 << CHANNEL_BITS) - 1;
        [self.0 >> (2 * CHANNEL_BITS), self.0 >> CHANNEL_BITS & mask, self.0 & mask]
    }

    #[inline(always)]
    const fn new([first, second, third]: [u32; 3]) -> Self {
        Self(first << (2 * CHANNEL_BITS) | second << CHANNEL_BITS | third)
    }
}

impl Value for Tint {
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        // Two channels to a word: the sums of neither reach the other.
        let (mut outer, mut middle) = (0u64, 0);
        let mask = (1u64 << CHANNEL_BITS) - 1;
        for (value, &weight) in values.iter().zip(weights) {
            let tint = u64::from(value.0);
            outer += u64::from(weight) * (tint >> (2 * CHANNEL_BITS) << 32 | tint & mask);
            middle += weight * (value.0 >> CHANNEL_BITS & mask as u32);
        }
        let weight = weights.iter().sum();
        Self::new(divided3([(outer >> 32) as u32, middle, outer as u32], weight, tie))
    }
}

/// A colour, and the cell whose motion goes with it.
///
/// Velocity and acceleration of a galpixel belong together, and with the fraction of its position: means of them would be the
/// motion of nothing. So the motion is pulled and pushed by the same weights, as the choice of the one that weighs most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Moving {
    /// The colour.
    pub tint: Tint,
    /// The cell of the picture.
    pub source: u32,
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
        Self { tint: Tint::mean(&values.map(|value| value.tint), weights, tie), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{Gray4, Gray8, Rgb565, Rgb888};

    fn comes_back<C: Colour>(colours: impl Iterator<Item = u32>) {
        for colour in colours {
            assert_eq!(Tint::of::<C>(colour).colour::<C>(), colour);
        }
    }

    #[test]
    fn every_colour_comes_back() {
        comes_back::<Rgb888>((0..1 << 24).step_by(7));
        comes_back::<Rgb565>(0..1 << 16);
        comes_back::<Gray8>(0..256);
        comes_back::<Gray4>(0..16);
    }

    #[test]
    fn channels_do_not_reach_into_each_other() {
        let [black, white] = [0, 0xff_ffff].map(Tint::of::<Rgb888>);
        for channel in 0..3 {
            let one = Tint::of::<Rgb888>(0xff << (8 * channel));
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
