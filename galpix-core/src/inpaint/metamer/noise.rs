//! White noise that has a place and no state, and the bands of it.
//!
//! Each cell's noise follows from its coordinates, its level and a seed alone: so any part of it can be made in any
//! order, on any machine, with the same bits, and it can move with a surface (section 3.4.1 of the paper).

use super::steerable::{APRON, Bands, COLUMNS, Cells, LARGEST, LARGEST_RESPONSE, ROWS, TILE, bands, row_of};

/// To what the bands of the noise are scaled before they take the deviation of what is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Scale {
    /// To -1 to 1, as the paper does. Its deviation is then 0.238: what is made up varies less than what is known.
    Interval,
    /// To a deviation of 1: what is made up varies as much as what is known.
    #[default]
    Deviation,
}

/// Fraction bits of scaled noise.
pub const FRACTION_BITS: u32 = 10;

/// Fraction bits of the factors.
const FACTOR_BITS: u32 = 16;

impl Scale {
    /// All scales.
    pub const ALL: [Self; 2] = [Self::Interval, Self::Deviation];

    /// Returns the name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Interval => "interval",
            Self::Deviation => "deviation",
        }
    }

    /// Scales a response of a band to [`white`], to [`FRACTION_BITS`].
    ///
    /// The response's largest value is 5104. Its deviation is that of white noise, `4 sqrt((256^2 - 1)/3)`, times the
    /// root of the sum of the kernel's squares, `sqrt(518 134) / 512`, with two fraction bits more: 1216.9.
    #[inline(always)]
    #[must_use]
    pub(super) const fn scaled(self, response: i16) -> i32 {
        let factor = match self {
            Self::Interval => (1 << (FRACTION_BITS + FACTOR_BITS)) / LARGEST_RESPONSE as i32,
            Self::Deviation => 55_147,
        };
        (response as i32 * factor + (1 << (FACTOR_BITS - 1))) >> FACTOR_BITS
    }
}

/// Odd factors that keep the coordinates, the level and the seed apart.
const COLUMN: u32 = 0x9e37_79b1;
const ROW: u32 = 0x85eb_ca77;
const LEVEL: u32 = 0xc2b2_ae3d;
const SEED: u32 = 0x27d4_eb2f;

/// Mixes all bits of a number into all bits, without losing one: the finaliser "lowbias32".
#[inline(always)]
const fn mixed(mut bits: u32) -> u32 {
    bits ^= bits >> 16;
    bits = bits.wrapping_mul(0x7feb_352d);
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0x846c_a68b);
    bits ^ bits >> 16
}

/// Returns the number that a row's noise begins with.
#[inline(always)]
const fn row_start(x: i32, y: i32, level: u32, seed: u32) -> u32 {
    (x as u32)
        .wrapping_mul(COLUMN)
        .wrapping_add((y as u32).wrapping_mul(ROW))
        .wrapping_add(level.wrapping_mul(LEVEL))
        .wrapping_add(seed.wrapping_mul(SEED))
}

/// Returns a byte as a number that is as often positive as negative: -1020 to 1020 in steps of 8.
#[inline(always)]
const fn centred(byte: u32) -> i16 {
    // Four times (2 byte - 255).
    ((byte & 255) << 3) as i16 - LARGEST
}

/// Returns the white noise of a place, three channels: each of 256 values from -1020 to 1020 equally often.
#[cfg(any(test, feature = "check"))]
#[must_use]
pub const fn white(x: i32, y: i32, level: u32, seed: u32) -> [i16; 3] {
    let bits = mixed(row_start(x, y, level, seed));
    [centred(bits), centred(bits >> 8), centred(bits >> 16)]
}

/// Makes the white noise for a tile of bands whose first cell with its apron is `x`, `y`.
fn white_tile(x: i32, y: i32, level: u32, seed: u32, tiles: &mut [Cells; 3]) {
    let [first, second, third] = tiles;
    let mut start = row_start(x, y, level, seed);
    for y in 0..ROWS {
        let (Some(first), Some(second), Some(third)) = (first.get_mut(y), second.get_mut(y), third.get_mut(y)) else {
            return;
        };
        for x in 0..COLUMNS {
            let bits = mixed(start.wrapping_add((x as u32).wrapping_mul(COLUMN)));
            (first[x], second[x], third[x]) = (centred(bits), centred(bits >> 8), centred(bits >> 16));
        }
        start = start.wrapping_add(ROW);
    }
}

/// The bands of white noise in some tiles of the plane, as they were last needed.
#[derive(Debug)]
pub struct Tiles {
    seed: u32,
    /// Level, column and row of the tile in each place.
    keys: [Option<(u32, i32, i32)>; PLACES],
    bands: [[Bands; 3]; PLACES],
    white: [Cells; 3],
}

/// Two by two tiles: a surface's noise may lie across a corner.
const PLACES: usize = 4;

impl Tiles {
    /// Makes room for tiles.
    pub const fn new() -> Self {
        Self {
            seed: 0,
            keys: [None; PLACES],
            bands: [[[[[0; TILE]; TILE]; 2]; 3]; PLACES],
            white: [[[0; COLUMNS]; ROWS]; 3],
        }
    }

    /// Takes another seed; the tiles of the one before are forgotten.
    pub fn reseed(&mut self, seed: u32) {
        self.seed = seed;
        self.keys = [None; PLACES];
    }

    /// Returns the responses of both bands at a place, for each channel.
    #[inline]
    #[must_use]
    pub fn at(&mut self, level: u32, x: i32, y: i32) -> [[i16; 2]; 3] {
        const BITS: u32 = TILE.trailing_zeros();
        let (column, row) = (x >> BITS, y >> BITS);
        let place = (column & 1 | (row & 1) << 1) as usize;
        let (Some(key), Some(of_channels)) = (self.keys.get_mut(place), self.bands.get_mut(place)) else {
            return Default::default();
        };
        if *key != Some((level, column, row)) {
            *key = Some((level, column, row));
            let apron = APRON as i32;
            let (left, top) = ((column << BITS).wrapping_sub(apron), (row << BITS).wrapping_sub(apron));
            white_tile(left, top, level, self.seed, &mut self.white);
            for (cells, of_channel) in self.white.iter().zip(of_channels.iter_mut()) {
                bands(cells, of_channel);
            }
        }
        let (x, y) = (x as usize % TILE, row_of(y as usize % TILE));
        let mut responses = [[0; 2]; 3];
        for (responses, of_channel) in responses.iter_mut().zip(of_channels.iter()) {
            *responses = [of_channel[0][y][x], of_channel[1][y][x]];
        }
        responses
    }
}

#[cfg(test)]
mod tests;
