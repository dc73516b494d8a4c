//! Colour formats: how a colour is stored, averaged and brightened. The passes of a frame do nothing else with colours.

use crate::error::BudgetError;

/// The sum of the weights of a weighted mean of colours: a channel of 8 bits by this weight fits half a word.
pub(crate) const WEIGHTS: u32 = 1 << 8;

/// One channel of a stored colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Channel {
    /// Position of the lowest bit in the colour word.
    pub shift: u32,
    /// Bits, 1 to 8.
    pub bits: u32,
}

impl Channel {
    /// Returns the level of this channel in a colour word.
    #[inline(always)]
    pub(crate) const fn of(self, colour: u32) -> u32 {
        (colour >> self.shift) & ((1 << self.bits) - 1)
    }
}

/// A colour format: three channels (red, green, blue) or one channel of gray, packed in the low bits of a word.
///
/// ```
/// use galpix_core::Colour;
/// const RGB332: Colour = Colour::must(Colour::rgb(3, 3, 2));
/// assert_eq!(RGB332.bits(), 8);
/// assert_eq!(RGB332.from_rgb888([255, 0, 128]), 0b111_000_10);
/// assert_eq!(RGB332.to_rgb888(0b111_000_10), [255, 0, 170]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Colour {
    channels: [Channel; 3],
    count: u8,
}

impl Colour {
    /// 24 bits: red, green, blue.
    pub const RGB888: Self = Self::must(Self::rgb(8, 8, 8));
    /// 16 bits: 5 red, 6 green, 5 blue.
    pub const RGB565: Self = Self::must(Self::rgb(5, 6, 5));
    /// 8 bits of luminosity.
    pub const GRAY8: Self = Self::must(Self::gray(8));
    /// 4 bits of luminosity.
    pub const GRAY4: Self = Self::must(Self::gray(4));

    /// Makes a format of three channels from their bits; red is the most significant.
    ///
    /// *Errors:* a channel without a bit, or of more than 8.
    pub const fn rgb(red: u32, green: u32, blue: u32) -> Result<Self, BudgetError> {
        if let Err(error) = check(red) {
            return Err(error);
        }
        if let Err(error) = check(green) {
            return Err(error);
        }
        if let Err(error) = check(blue) {
            return Err(error);
        }
        let channels = [
            Channel { shift: green + blue, bits: red },
            Channel { shift: blue, bits: green },
            Channel { shift: 0, bits: blue },
        ];
        Ok(Self { channels, count: 3 })
    }

    /// Makes a format of one channel, which holds the luminosity.
    ///
    /// *Errors:* a channel without a bit, or of more than 8.
    pub const fn gray(bits: u32) -> Result<Self, BudgetError> {
        match check(bits) {
            Ok(()) => Ok(Self { channels: [Channel { shift: 0, bits }; 3], count: 1 }),
            Err(error) => Err(error),
        }
    }

    /// Returns the format, for constants; an error becomes a compile error that states the reason.
    ///
    /// *Panics* on an error if called at run time.
    #[must_use]
    pub const fn must(colour: Result<Self, BudgetError>) -> Self {
        match colour {
            Ok(colour) => colour,
            Err(_) => panic!("colour: a channel has 1 to 8 bits"),
        }
    }

    /// Returns the bits of a colour word.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.channels[0].shift + self.channels[0].bits
    }

    /// Returns the channels, most significant first.
    #[inline(always)]
    pub fn channels(&self) -> impl DoubleEndedIterator<Item = Channel> + '_ {
        self.channels.iter().take(self.count as usize).copied()
    }

    /// Returns whether the format has a single channel, the luminosity.
    #[inline(always)]
    #[must_use]
    pub const fn is_gray(self) -> bool {
        self.count == 1
    }

    /// Returns the bits of channel 0, 1 or 2; the channel of a gray format stands for all three.
    #[inline(always)]
    #[must_use]
    pub(crate) const fn channel_bits(&self, channel: usize) -> u32 {
        self.channels[channel].bits
    }

    /// Returns the channels. Those of a gray format are all the same.
    #[inline(always)]
    pub(crate) const fn three_channels(&self) -> [Channel; 3] {
        self.channels
    }

    /// Returns the bits of the narrowest channel. One step of luminosity is one step of that channel, and a power of
    /// two of steps of a wider one.
    #[inline(always)]
    #[must_use]
    pub const fn luminosity_bits(self) -> u32 {
        let [first, second, third] = self.channels;
        let least = if first.bits < second.bits { first.bits } else { second.bits };
        if least < third.bits { least } else { third.bits }
    }

    /// Converts 8-bit red, green and blue into a colour word.
    ///
    /// *Rounding:* low bits are dropped.
    #[inline(always)]
    #[must_use]
    pub const fn from_rgb888(self, rgb: [u8; 3]) -> u32 {
        let [first, second, third] = self.channels;
        if self.is_gray() {
            return luminosity(rgb) as u32 >> (8 - first.bits);
        }
        let [red, green, blue] = rgb;
        (red as u32 >> (8 - first.bits)) << first.shift
            | (green as u32 >> (8 - second.bits)) << second.shift
            | (blue as u32 >> (8 - third.bits)) << third.shift
    }

    /// Converts a colour word into 8-bit red, green and blue, by repeating the bits of each channel until they fill 8.
    #[inline(always)]
    #[must_use]
    pub const fn to_rgb888(self, colour: u32) -> [u8; 3] {
        let [first, second, third] = self.channels;
        [
            widened(first.of(colour), first.bits),
            widened(second.of(colour), second.bits),
            widened(third.of(colour), third.bits),
        ]
    }

    /// Returns the mean of four colour words, channel by channel. The mean of `p, p, q, q` is that of `p` and `q`.
    ///
    /// *Rounding:* to nearest, halves upwards.
    #[inline(always)]
    #[must_use]
    pub fn mean4(&self, colours: [u32; 4]) -> u32 {
        self.join(|channel| {
            let sum = colours.iter().fold(2, |sum, &colour| sum + channel.of(colour));
            (sum >> 2) << channel.shift
        })
    }

    /// Joins what `of` makes of each channel. Without a loop: rustc 1.95 does not unroll one for size on thumbv7m.
    #[inline(always)]
    fn join(&self, of: impl Fn(Channel) -> u32) -> u32 {
        let [first, second, third] = self.channels;
        if self.is_gray() { of(first) } else { of(first) | of(second) | of(third) }
    }

    /// Returns the mean of two colour words, as [`Self::mean4`] of `p, q, p, q`.
    #[inline(always)]
    pub(crate) fn mean2(&self, [p, q]: [u32; 2]) -> u32 {
        self.join(|channel| ((channel.of(p) + channel.of(q) + 1) >> 1) << channel.shift)
    }

    /// Returns the mean of colour words by weights whose sum must be [`WEIGHTS`], channel by channel. It is never
    /// outside of the range of the channel's levels that have a weight, and equals a colour that has all the weight.
    ///
    /// *Rounding:* once, to nearest, halves upwards.
    ///
    /// *Cost* per colour: two products, or one for gray. Two channels share a word, so that red and blue are multiplied
    /// together.
    #[inline(always)]
    pub(crate) fn weighted<const N: usize>(&self, colours: [u32; N], weights: [u32; N]) -> u32 {
        const LOG: u32 = WEIGHTS.trailing_zeros();
        const HALVES: u32 = WEIGHTS >> 1;
        let [first, second, third] = self.channels;
        let middle = sum_of(colours, weights, HALVES, |colour| second.of(colour)) >> LOG << second.shift;
        if self.is_gray() {
            return middle;
        }
        let pair = |colour| first.of(colour) << 16 | third.of(colour);
        let outer = sum_of(colours, weights, HALVES << 16 | HALVES, pair);
        outer >> (16 + LOG) << first.shift | middle | (outer & 0xffff) >> LOG << third.shift
    }

    /// Returns whether a colour word may be a mixture of two others, with an eighth of the second one at least: each
    /// channel lies between theirs or equals one of them.
    #[inline(always)]
    #[must_use]
    pub(crate) fn is_mixture(&self, colour: u32, [first, second]: [u32; 2]) -> bool {
        self.channels().all(|channel| {
            let [level, first, second] = [channel.of(colour), channel.of(first), channel.of(second)];
            let (part, whole) = if second < first {
                (first as i32 - level as i32, first - second)
            } else {
                (level as i32 - first as i32, second - first)
            };
            part << 3 >= whole as i32 && part <= whole as i32
        })
    }

    /// Returns the sum over the channels of the differences of two colour words.
    #[inline(always)]
    #[must_use]
    pub(crate) fn distance(&self, a: u32, b: u32) -> u32 {
        self.channels().map(|channel| channel.of(a).abs_diff(channel.of(b))).sum()
    }

    /// Returns the colour word after adding `steps` of luminosity, each channel clamped to its range.
    #[inline(always)]
    #[must_use]
    pub fn brightened(&self, colour: u32, steps: i32) -> u32 {
        let least = self.luminosity_bits();
        self.join(|channel| {
            let level = channel.of(colour) as i32 + (steps << (channel.bits - least));
            let most = (1 << channel.bits) - 1;
            let level = if level < 0 {
                0
            } else if level > most {
                most
            } else {
                level
            };
            (level as u32) << channel.shift
        })
    }
}

/// Returns `start` plus the levels of each colour times its weight.
#[inline(always)]
fn sum_of<const N: usize>(colours: [u32; N], weights: [u32; N], start: u32, levels: impl Fn(u32) -> u32) -> u32 {
    colours.into_iter().zip(weights).fold(start, |sum, (colour, weight)| sum + levels(colour) * weight)
}

const fn check(bits: u32) -> Result<(), BudgetError> {
    if bits == 0 || bits > 8 { Err(BudgetError::ChannelBits { bits }) } else { Ok(()) }
}

/// Returns the paper's estimate of the luminosity, with the weights 1/4, 1/2 and 1/4: `(red + 2 green + blue) / 4`.
///
/// *Rounding:* downwards.
#[inline(always)]
#[must_use]
pub const fn luminosity([red, green, blue]: [u8; 3]) -> u8 {
    ((red as u32 + ((green as u32) << 1) + blue as u32) >> 2) as u8
}

/// Returns `level`, which has `bits` bits, repeated until it fills 8 bits.
#[inline(always)]
const fn widened(level: u32, bits: u32) -> u8 {
    let (mut wide, mut filled) = (level << (8 - bits), bits);
    while filled < 8 {
        wide |= wide >> filled;
        filled <<= 1;
    }
    wide as u8
}
