//! The two bands of a level: what of it varies along its rows, and what along its columns.
//!
//! A steerable pyramid takes what a lowpass leaves behind, level by level, apart into orientations (section 3.2 of the
//! paper; five by five cells as there). The lowpass here is what push-pull does anyway, a mean of two by two cells, and
//! the linear sample of it: in each direction `[1 1]/2` and then `[1 3 3 1]/4`, which is `b = [1 4 6 4 1]/16` on the
//! average over the places where pairs may begin. So the bands must share out `delta - b (x) b`, and with `s = [1 4 22
//! 4 1]` and `d = [-1 -4 10 -4 -1]` they do:
//!
//! ```text
//! K_x = (s down the columns) (x) (d along the rows) / 512       K_y = K_x transposed
//!
//! s = 16 (delta + b),  d = 16 (delta - b)        in each direction
//! K_x = 256 (delta + b)_y (delta - b)_x / 512 = (delta delta + b_y delta - delta b_x - b_y b_x) / 2
//! K_y = 256 (delta - b)_y (delta + b)_x / 512 = (delta delta - b_y delta + delta b_x - b_y b_x) / 2
//! K_x + K_y = delta delta - b_y b_x
//! ```
//!
//! Both sum to zero, as `d` does. The first of them answers to what varies along a row.
//!
//! **Numbers.** Cells come with 2 fraction bits and go with 4, in 16 bits. The first pass, down the columns, multiplies
//! by up to 32 and rounds 5 bits away, the second by up to 20 or 32 and rounds 2 away: no sum leaves 16 bits for cells
//! of -1020 to 1020 (times 32: 32640), no response -5104 to 5104. All roundings are to the nearest, halves upwards.
//!
//! **Border.** The outermost row and column go on beyond the picture: the caller repeats them.

/// Columns and rows of a tile of responses.
pub const TILE: usize = 16;

/// Cells around a tile that its responses depend on.
pub const APRON: usize = 2;

/// Rows of cells for a tile.
pub const ROWS: usize = TILE + 2 * APRON;

/// Columns of cells for a tile, rounded up to what vector registers hold.
pub const COLUMNS: usize = 24;

/// The largest cell, in quarters.
pub const LARGEST: i16 = 1020;

/// Fraction bits of a response.
pub const FRACTION_BITS: u32 = 4;

/// The largest response.
pub const LARGEST_RESPONSE: i16 = 5104;

/// Bits that the first pass rounds away, and the second.
const FIRST: u32 = 5;
const SECOND: u32 = 2;

/// The cells under a tile: from [`APRON`] to the left of it and above.
pub type Cells = [[i16; COLUMNS]; ROWS];

/// The responses of a tile: of `K_x`, then of `K_y`. Its even rows come first, then its odd ones, see [`row_of`]: so
/// pairs of rows are two long rows.
pub type Bands = [[[i16; TILE]; TILE]; 2];

/// Returns where row `y` of a tile's responses is.
#[inline(always)]
#[must_use]
pub const fn row_of(y: usize) -> usize {
    (y & 1) * (TILE / 2) + (y >> 1)
}

/// Returns 16 (delta + b).
#[inline(always)]
const fn smoothed([a, b, c, d, e]: [i16; 5]) -> i16 {
    // No intermediate sum exceeds the largest possible last one.
    (a + e) + ((b + d) << 2) + 22 * c
}

/// Returns 16 (delta - b).
#[inline(always)]
const fn sharpened([a, b, c, d, e]: [i16; 5]) -> i16 {
    10 * c - ((a + e) + ((b + d) << 2))
}

/// Drops `bits` bits, to the nearest, halves upwards.
#[inline(always)]
const fn rounded(sum: i16, bits: u32) -> i16 {
    (sum + (1 << (bits - 1))) >> bits
}

/// Works out both bands of a tile. The last columns of the cells are not looked at.
///
/// Each pass goes over all rows as if they were one: a loop so long becomes vector code. What it makes of places where
/// a row ends and the next begins is not used, and fits 16 bits as well: any cells within the range do.
#[inline]
pub fn bands(cells: &Cells, bands: &mut Bands) {
    const LONG: usize = TILE * COLUMNS;
    let rows = |from: usize| cells.as_flattened().get(from * COLUMNS..).and_then(|rows| rows.first_chunk::<LONG>());
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = [rows(0), rows(1), rows(2), rows(3), rows(4)] else { return };
    let (mut smooth, mut sharp) = ([0; LONG], [0; LONG]);
    for x in 0..LONG {
        let column = [a[x], b[x], c[x], d[x], e[x]];
        smooth[x] = rounded(smoothed(column), FIRST);
        sharp[x] = rounded(sharpened(column), FIRST);
    }
    let (mut across, mut down) = ([0; LONG], [0; LONG]);
    for x in 0..LONG - 2 * APRON {
        across[x] = rounded(sharpened([smooth[x], smooth[x + 1], smooth[x + 2], smooth[x + 3], smooth[x + 4]]), SECOND);
        down[x] = rounded(smoothed([sharp[x], sharp[x + 1], sharp[x + 2], sharp[x + 3], sharp[x + 4]]), SECOND);
    }
    for (band, long) in bands.iter_mut().zip([&across, &down]) {
        for (y, row) in long.chunks_exact(COLUMNS).enumerate() {
            if let (Some(to), Some(row)) = (band.get_mut(row_of(y)), row.first_chunk()) {
                *to = *row;
            }
        }
    }
}

/// Returns both bands at one cell: of the five by five around it. The same numbers as [`bands`] has.
#[cfg(any(test, feature = "check"))]
#[must_use]
pub fn response(window: &[[i16; 5]; 5]) -> [i16; 2] {
    let [a, b, c, d, e] = window;
    let (mut smooth, mut sharp) = ([0; 5], [0; 5]);
    for x in 0..5 {
        let column = [a[x], b[x], c[x], d[x], e[x]];
        smooth[x] = rounded(smoothed(column), FIRST);
        sharp[x] = rounded(sharpened(column), FIRST);
    }
    [rounded(sharpened(smooth), SECOND), rounded(smoothed(sharp), SECOND)]
}

#[cfg(test)]
mod tests;
