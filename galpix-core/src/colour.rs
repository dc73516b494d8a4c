//! Colour formats: how a colour is stored, averaged and brightened. The core never interprets a colour beyond that.

/// One packed channel: its lowest bit and its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Position of the lowest bit.
    pub shift: u32,
    /// Bits.
    pub bits: u32,
}

impl Channel {
    #[inline(always)]
    const fn of(self, colour: u32) -> u32 {
        (colour >> self.shift) & ((1 << self.bits) - 1)
    }
}

/// A colour format, as a type that has no values.
pub trait Colour {
    /// Bits of a stored colour.
    const BITS: u32;
    /// The channels, most significant first.
    const CHANNELS: &'static [Channel];
    /// The narrowest channel's bits: one step of luminosity is one step of that channel, and correspondingly more of a
    /// wider one.
    const LUMINOSITY_BITS: u32;

    /// From 8-bit red, green and blue, by dropping low bits.
    fn from_rgb888(rgb: [u8; 3]) -> u32;

    /// To 8-bit red, green and blue, by repeating the high bits in the low ones.
    fn to_rgb888(colour: u32) -> [u8; 3];

    /// The mean of two colours, channel by channel, halves upwards.
    #[inline(always)]
    fn mean2(colours: [u32; 2]) -> u32 {
        Self::CHANNELS.iter().fold(0, |mean, channel| {
            mean | ((channel.of(colours[0]) + channel.of(colours[1]) + 1) >> 1) << channel.shift
        })
    }

    /// The mean of four colours, channel by channel, halves upwards.
    #[inline(always)]
    fn mean4(colours: [u32; 4]) -> u32 {
        Self::CHANNELS.iter().fold(0, |mean, channel| {
            let sum = colours.iter().fold(2, |sum, &colour| sum + channel.of(colour));
            mean | (sum >> 2) << channel.shift
        })
    }

    /// The colour after `steps` of luminosity, each channel clamped to its range.
    #[inline(always)]
    fn brightened(colour: u32, steps: i32) -> u32 {
        Self::CHANNELS.iter().fold(0, |bright, channel| {
            let level = channel.of(colour) as i32 + (steps << (channel.bits - Self::LUMINOSITY_BITS));
            let most = (1 << channel.bits) - 1;
            let level = if level < 0 {
                0
            } else if level > most {
                most
            } else {
                level
            };
            bright | (level as u32) << channel.shift
        })
    }
}

/// The paper's estimate of luminosity by the fractions 1/2 and 1/4: `(red + 2 green + blue) / 4`.
#[inline(always)]
#[must_use]
pub const fn luminosity([red, green, blue]: [u8; 3]) -> u8 {
    ((red as u32 + ((green as u32) << 1) + blue as u32) >> 2) as u8
}

/// Repeats the `bits` high bits of `level` until they fill 8.
const fn widened(level: u32, bits: u32) -> u8 {
    match bits {
        4 => (level << 4 | level) as u8,
        5 => (level << 3 | level >> 2) as u8,
        6 => (level << 2 | level >> 4) as u8,
        _ => level as u8,
    }
}

/// 24 bits: red, green, blue.
#[derive(Clone, Copy, Debug)]
pub enum Rgb888 {}

/// 16 bits: 5 red, 6 green, 5 blue.
#[derive(Clone, Copy, Debug)]
pub enum Rgb565 {}

/// 8 bits of luminosity.
#[derive(Clone, Copy, Debug)]
pub enum Gray8 {}

/// 4 bits of luminosity.
#[derive(Clone, Copy, Debug)]
pub enum Gray4 {}

impl Colour for Rgb888 {
    const BITS: u32 = 24;
    const CHANNELS: &'static [Channel] =
        &[Channel { shift: 16, bits: 8 }, Channel { shift: 8, bits: 8 }, Channel { shift: 0, bits: 8 }];
    const LUMINOSITY_BITS: u32 = 8;

    #[inline(always)]
    fn from_rgb888([red, green, blue]: [u8; 3]) -> u32 {
        (red as u32) << 16 | (green as u32) << 8 | blue as u32
    }

    #[inline(always)]
    fn to_rgb888(colour: u32) -> [u8; 3] {
        [(colour >> 16) as u8, (colour >> 8) as u8, colour as u8]
    }
}

impl Colour for Rgb565 {
    const BITS: u32 = 16;
    const CHANNELS: &'static [Channel] =
        &[Channel { shift: 11, bits: 5 }, Channel { shift: 5, bits: 6 }, Channel { shift: 0, bits: 5 }];
    const LUMINOSITY_BITS: u32 = 5;

    #[inline(always)]
    fn from_rgb888([red, green, blue]: [u8; 3]) -> u32 {
        (red as u32 >> 3) << 11 | (green as u32 >> 2) << 5 | blue as u32 >> 3
    }

    #[inline(always)]
    fn to_rgb888(colour: u32) -> [u8; 3] {
        [widened(colour >> 11 & 31, 5), widened(colour >> 5 & 63, 6), widened(colour & 31, 5)]
    }
}

impl Colour for Gray8 {
    const BITS: u32 = 8;
    const CHANNELS: &'static [Channel] = &[Channel { shift: 0, bits: 8 }];
    const LUMINOSITY_BITS: u32 = 8;

    #[inline(always)]
    fn from_rgb888(rgb: [u8; 3]) -> u32 {
        luminosity(rgb) as u32
    }

    #[inline(always)]
    fn to_rgb888(colour: u32) -> [u8; 3] {
        [colour as u8; 3]
    }
}

impl Colour for Gray4 {
    const BITS: u32 = 4;
    const CHANNELS: &'static [Channel] = &[Channel { shift: 0, bits: 4 }];
    const LUMINOSITY_BITS: u32 = 4;

    #[inline(always)]
    fn from_rgb888(rgb: [u8; 3]) -> u32 {
        luminosity(rgb) as u32 >> 4
    }

    #[inline(always)]
    fn to_rgb888(colour: u32) -> [u8; 3] {
        [widened(colour & 15, 4); 3]
    }
}
