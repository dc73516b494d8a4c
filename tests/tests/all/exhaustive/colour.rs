//! Colour formats: means, luminosity and round trips over all channel values.

use galpix_core::Colour;
use galpix_core::record::{Channel, luminosity};

fn level(channel: Channel, colour: u32) -> u32 {
    colour >> channel.shift & top(channel)
}

fn top(channel: Channel) -> u32 {
    (1 << channel.bits) - 1
}

/// Returns a colour with `level` in one channel, and in all others its complement (clamped), so that nothing may leak.
fn with_level(format: Colour, index: usize, wanted: u32) -> u32 {
    let own = format.channels().nth(index).unwrap();
    format.channels().enumerate().fold(0, |colour, (other, channel)| {
        let level = if other == index { wanted } else { top(own).abs_diff(wanted) & top(channel) };
        colour | level << channel.shift
    })
}

/// Returns all levels of a channel if there are at most 64, else the ends, the middle and every 17th.
fn levels(channel: Channel) -> Vec<u32> {
    let all = 0..=top(channel);
    if channel.bits <= 6 {
        all.collect()
    } else {
        all.filter(|n| n % 17 == 0 || [1, 127, 128, 254].contains(n)).collect()
    }
}

fn channels_cover_the_word(format: Colour) {
    let mut covered = 0u32;
    for channel in format.channels() {
        assert_eq!(covered & (top(channel) << channel.shift), 0, "channels overlap");
        covered |= top(channel) << channel.shift;
    }
    assert_eq!(u64::from(covered), (1u64 << format.bits()) - 1);
    assert_eq!(format.luminosity_bits(), format.channels().map(|channel| channel.bits).min().unwrap());
}

fn mean2_is_the_mean(format: Colour) {
    for (index, own) in format.channels().enumerate() {
        let all = || 0..=top(own);
        for (a, b) in all().flat_map(|a| all().map(move |b| (a, b))) {
            let colours = [a, b].map(|level| with_level(format, index, level));
            let mean = format.mean4([colours[0], colours[1], colours[0], colours[1]]);
            assert_eq!(u64::from(mean) >> format.bits(), 0);
            for channel in format.channels() {
                let exact = colours.iter().map(|&colour| f64::from(level(channel, colour))).sum::<f64>() / 2.0;
                assert_eq!(f64::from(level(channel, mean)), (exact + 0.5).floor(), "{a} {b} {channel:?}");
            }
        }
    }
}

fn mean4_is_the_mean(format: Colour) {
    for (index, own) in format.channels().enumerate() {
        let all = levels(own);
        let colours: Vec<u32> = all.iter().map(|&level| with_level(format, index, level)).collect();
        for &a in &colours {
            for &b in &colours {
                for &c in &colours {
                    for &d in &colours {
                        let mean = format.mean4([a, b, c, d]);
                        for channel in format.channels() {
                            let sum: u32 = [a, b, c, d].iter().map(|&colour| level(channel, colour)).sum();
                            let exact = (sum + 2) / 4;
                            assert!(level(channel, mean) == exact, "{a:x} {b:x} {c:x} {d:x} {channel:?}: {mean:x}");
                        }
                    }
                }
            }
        }
    }
}

fn brightened_adds_alike_and_clamps(format: Colour) {
    let range = 2 << format.luminosity_bits();
    let far = [-(1 << 24), -(1 << 15), 1 << 15, 1 << 24];
    for (index, own) in format.channels().enumerate() {
        for wanted in 0..=top(own) {
            let colour = with_level(format, index, wanted);
            for steps in (-range..=range).chain(far) {
                let bright = format.brightened(colour, steps);
                assert_eq!(u64::from(bright) >> format.bits(), 0);
                for channel in format.channels() {
                    // One step of the narrowest channel is as much light in every channel.
                    let step = i64::from(steps) * (1 << (channel.bits - format.luminosity_bits()));
                    let exact = (i64::from(level(channel, colour)) + step).clamp(0, i64::from(top(channel)));
                    assert_eq!(i64::from(level(channel, bright)), exact, "{colour:x} {steps} {channel:?}");
                }
            }
        }
    }
}

/// Storing keeps the high bits; reading a stored colour and storing it again changes nothing.
fn round_trip(format: Colour, colours: impl Iterator<Item = u32>) {
    for colour in colours {
        assert_eq!(format.from_rgb888(format.to_rgb888(colour)), colour, "{colour:x}");
    }
    assert_eq!(format.to_rgb888(0), [0; 3]);
    assert_eq!(format.to_rgb888(((1u64 << format.bits()) - 1) as u32), [255; 3], "white is white");
}

/// The built-in formats, and one with three different channels.
const FORMATS: [Colour; 5] =
    [Colour::RGB888, Colour::RGB565, Colour::GRAY8, Colour::GRAY4, Colour::must(Colour::rgb(3, 4, 1))];

#[test]
fn the_channels_of_every_format_cover_its_word() {
    FORMATS.into_iter().for_each(channels_cover_the_word);
}

#[test]
fn the_mean_of_two_of_every_format() {
    FORMATS.into_iter().for_each(mean2_is_the_mean);
}

#[test]
fn the_mean_of_four_of_every_format() {
    FORMATS.into_iter().for_each(mean4_is_the_mean);
}

#[test]
fn luminosity_of_every_format() {
    FORMATS.into_iter().for_each(brightened_adds_alike_and_clamps);
}

#[test]
fn every_stored_colour_survives_being_read_and_stored() {
    round_trip(Colour::GRAY4, 0..=15);
    round_trip(Colour::GRAY8, 0..=255);
    round_trip(Colour::RGB565, 0..=0xffff);
    round_trip(Colour::RGB888, (0..=0xff_ffff).step_by(61));
}

/// A stored level differs from the true one by less than a step, and widening is exact at both ends.
#[test]
fn rgb565_keeps_the_high_bits_of_every_level() {
    for n in 0..=255u8 {
        let [red, green, blue] = Colour::RGB565.to_rgb888(Colour::RGB565.from_rgb888([n; 3]));
        assert_eq!([red >> 3, green >> 2, blue >> 3], [n >> 3, n >> 2, n >> 3]);
        assert_eq!([red & 7, green & 3, blue & 7], [n >> 5, n >> 6, n >> 5], "high bits are repeated in the low ones");
    }
}

#[test]
fn gray_is_a_quarter_half_quarter_of_red_green_blue() {
    for red in (0..=255).step_by(5) {
        for green in 0..=255 {
            for blue in (0..=255).step_by(5) {
                let exact = (f64::from(red) / 4.0 + f64::from(green) / 2.0 + f64::from(blue) / 4.0).floor();
                let rgb = [red, green, blue].map(|n| n as u8);
                assert_eq!(f64::from(luminosity(rgb)), exact);
                assert_eq!(f64::from(Colour::GRAY8.from_rgb888(rgb)), exact);
                assert_eq!(f64::from(Colour::GRAY4.from_rgb888(rgb)), (exact / 16.0).floor());
            }
        }
    }
}
