//! Luma and chroma: the three channels that statistics are taken of, one by one.
//!
//! The reversible transform of JPEG 2000, `Y = floor((R + 2 G + B) / 4)`, `Cb = B - G`, `Cr = R - G`, here with the two
//! fraction bits that the floor drops: so it is linear, its means are means of colours, and it still is reversible
//! exactly. It removes most of what the channels of a picture have in common (section 3.2 of the paper), with additions
//! and shifts.

/// Fraction bits of all three.
pub const FRACTION_BITS: u32 = 2;

/// What stands for the luma's middle, so that luma too has a sign.
const MIDDLE: i16 = 510;

/// Returns luma less its middle (-510 to 510), and the two chromas (-1020 to 1020), in quarters of a code value. Exact.
#[inline(always)]
#[must_use]
pub const fn of_rgb([red, green, blue]: [u8; 3]) -> [i16; 3] {
    let (red, green, blue) = (red as i16, green as i16, blue as i16);
    [red + 2 * green + blue - MIDDLE, 4 * (blue - green), 4 * (red - green)]
}

/// Returns the colour: each channel to the nearest code value, halves upwards, clamped to 0 to 255. Channels lie
/// between -2^28 and 2^28.
#[inline(always)]
#[must_use]
pub const fn to_rgb([luma, blue, red]: [i32; 3]) -> [u8; 3] {
    let green = luma + MIDDLE as i32 - ((blue + red + 2) >> 2);
    [clamped(red + green), clamped(green), clamped(blue + green)]
}

#[inline(always)]
const fn clamped(quarters: i32) -> u8 {
    let value = (quarters + 2) >> 2;
    if value < 0 {
        0
    } else if value > 255 {
        255
    } else {
        value as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_comes_back() {
        for code in 0..=0xff_ffffu32 {
            let [_, red, green, blue] = code.to_be_bytes();
            let [luma, chroma_blue, chroma_red] = of_rgb([red, green, blue]).map(i32::from);
            assert!(luma.abs() <= 510 && chroma_blue.abs() <= 1020 && chroma_red.abs() <= 1020);
            // The integer part is the transform of the standard.
            let standard = (i32::from(red) + 2 * i32::from(green) + i32::from(blue)) >> 2;
            assert_eq!((luma + 510) >> FRACTION_BITS, standard);
            assert_eq!(to_rgb([luma, chroma_blue, chroma_red]), [red, green, blue]);
        }
    }

    #[test]
    fn what_no_colour_has_is_clamped() {
        assert_eq!(to_rgb([4000, 0, 0]), [255; 3]);
        assert_eq!(to_rgb([-4000, 0, 0]), [0; 3]);
        assert_eq!(to_rgb([-510, 1020, -1020]), [0, 0, 255]);
    }
}
