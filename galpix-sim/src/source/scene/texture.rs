//! Procedural textures: smooth noise for the large forms, and patterns whose edges are softened over one texel so that
//! a point sample of them stands for its pixel. Integer hashes and arithmetic only: the same bytes on every machine.
//!
//! Lengths are in texels, of which a pixel of the finished picture should show about one. Coverages are within 0..=1.

/// Red, green and blue in 8-bit code values, not yet rounded.
pub type Rgb = [f64; 3];

/// Returns a colour from its usual notation, `0xRRGGBB`.
#[must_use]
pub const fn hex(code: u32) -> Rgb {
    [(code >> 16 & 0xff) as f64, (code >> 8 & 0xff) as f64, (code & 0xff) as f64]
}

/// Returns `share` of `ink` over the rest of `ground`; a share outside of 0..=1 is clamped.
#[must_use]
pub fn mix(ground: Rgb, ink: Rgb, share: f64) -> Rgb {
    let share = share.clamp(0.0, 1.0);
    [0, 1, 2].map(|i| ground[i] + (ink[i] - ground[i]) * share)
}

/// Three colours strung on a line, at 0, 1/2 and 1.
#[must_use]
pub fn gradient(stops: [Rgb; 3], place: f64) -> Rgb {
    mix(mix(stops[0], stops[1], place * 2.0), stops[2], place * 2.0 - 1.0)
}

/// Returns `colour`, brighter (`light` above 1) or darker.
#[must_use]
pub fn lit(colour: Rgb, light: f64) -> Rgb {
    colour.map(|channel| channel * light)
}

/// Returns the nearest 8-bit colour.
#[must_use]
pub fn round(colour: Rgb) -> [u8; 3] {
    // `as` saturates, so that a colour a little out of range is clamped.
    colour.map(|channel| channel.round() as u8)
}

/// Returns a number in 0..1 for each cell of a lattice: the finaliser of the SplitMix64 generator (Steele, Lea, Flood
/// 2014).
#[must_use]
pub fn hash(column: i64, row: i64, seed: u32) -> f64 {
    let mut bits = (column as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (row as u64).rotate_left(32).wrapping_mul(0xd1b5_4a32_d192_ed03)
        ^ u64::from(seed) << 17;
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Returns the lattice cell that `place` is in, and how far into it (0..`size`) it lies.
#[must_use]
pub fn cell(place: f64, size: f64) -> (i64, f64) {
    let index = (place / size).floor();
    (index as i64, place - index * size)
}

/// Returns smooth value noise in 0..=1 with one lattice point a unit.
fn value_noise(u: f64, v: f64, seed: u32) -> f64 {
    let ((i, u), (j, v)) = (cell(u, 1.0), cell(v, 1.0));
    let smooth = |s: f64| s * s * (3.0 - 2.0 * s);
    let row = |j| hash(i, j, seed) + (hash(i + 1, j, seed) - hash(i, j, seed)) * smooth(u);
    let (upper, lower) = (row(j), row(j + 1));
    upper + (lower - upper) * smooth(v)
}

/// Returns fractal noise in 0..=1: three octaves, the largest forms `size` texels wide and each octave half as wide
/// and strong.
#[must_use]
pub fn noise(u: f64, v: f64, size: f64, seed: u32) -> f64 {
    let octave = |scale: f64, seed| value_noise(u / size * scale, v / size * scale, seed);
    (4.0 * octave(1.0, seed) + 2.0 * octave(2.0, seed ^ 0x55) + octave(4.0, seed ^ 0xaa)) / 7.0
}

/// Returns how much of a texel lies inside of a border that is `inside` texels away (negative: outside).
#[must_use]
pub fn cover(inside: f64) -> f64 {
    (inside + 0.5).clamp(0.0, 1.0)
}

/// Returns the coverage of the stretch `from..to`.
#[must_use]
pub fn band(place: f64, from: f64, to: f64) -> f64 {
    cover(place - from) * cover(to - place)
}

/// Returns the coverage of a box around the origin, `half_width` and `half_height` texels.
#[must_use]
pub fn rect(u: f64, v: f64, half_width: f64, half_height: f64) -> f64 {
    cover(half_width - u.abs()) * cover(half_height - v.abs())
}

/// Returns the distance from the origin.
#[must_use]
pub fn length(u: f64, v: f64) -> f64 {
    (u * u + v * v).sqrt()
}

/// Returns the coverage of a disc around the origin.
#[must_use]
pub fn dot(u: f64, v: f64, radius: f64) -> f64 {
    cover(radius - length(u, v))
}

/// Returns the coverage of stripes: of each `period` the first `width` texels.
#[must_use]
pub fn stripes(place: f64, period: f64, width: f64) -> f64 {
    let (_, place) = cell(place, period);
    band(place, 0.0, width).max(cover(place - period))
}

/// Returns the coverage of every other square of a board with squares of `size` texels.
#[must_use]
pub fn checks(u: f64, v: f64, size: f64) -> f64 {
    let (u, v) = (stripes(u, 2.0 * size, size), stripes(v, 2.0 * size, size));
    u + v - 2.0 * u * v
}

/// Returns brickwork with joints 1.5 texels wide: coverage of the brick, and a number in 0..1 that is the brick's
/// own.
#[must_use]
pub fn bricks(u: f64, v: f64, width: f64, height: f64, seed: u32) -> (f64, f64) {
    let (row, v) = cell(v, height);
    let (column, u) = cell(u + 0.5 * width * (row & 1) as f64, width);
    (rect(u - width / 2.0, v - height / 2.0, width / 2.0 - 0.75, height / 2.0 - 0.75), hash(column, row, seed))
}

/// The six letters of the sign, five columns by seven rows, the leftmost column in the highest of the five bits.
const SIGN: [[u8; 7]; 6] = [
    [0b01110, 0b10001, 0b10000, 0b10111, 0b10001, 0b10001, 0b01110],
    [0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001],
    [0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111],
    [0b11110, 0b10001, 0b10001, 0b11110, 0b10000, 0b10000, 0b10000],
    [0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
    [0b10001, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001, 0b10001],
];

/// Returns the coverage of the word GALPIX, centred at the origin: 35 x 7 units of `unit` texels each.
#[must_use]
pub fn sign(u: f64, v: f64, unit: f64) -> f64 {
    let inked = |column: i64, row: i64| {
        let letter = usize::try_from(column.div_euclid(6)).ok().and_then(|letter| SIGN.get(letter));
        let bits = letter.zip(usize::try_from(row).ok()).and_then(|(letter, row)| letter.get(row));
        let bit = bits.is_some_and(|bits| bits << column.rem_euclid(6) & 0b1_0000 != 0);
        f64::from(u8::from(bit))
    };
    // Between the middles of four units the ink is interpolated; cut below one half, strokes are bold, their corners
    // round, and the steps of a diagonal hold together.
    let ((i, u), (j, v)) = (cell(u / unit + 17.0, 1.0), cell(v / unit + 3.0, 1.0));
    let row = |j| inked(i, j) * (1.0 - u) + inked(i + 1, j) * u;
    cover((row(j) * (1.0 - v) + row(j + 1) * v - 0.38) * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_is_even_and_the_same_everywhere() {
        let mean = (0..10_000).map(|i| hash(i % 100 - 50, i / 100 - 50, 7)).sum::<f64>() / 1e4;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        assert_eq!((hash(-3, 14, 1) * 1e9) as u64, 469_850_948);
    }

    #[test]
    fn noise_is_smooth_and_stays_within_its_range() {
        for k in 0..20_000 {
            let (u, v) = (f64::from(k) * 0.01 - 80.0, f64::from(k) * 0.003);
            let here = noise(u, v, 12.0, 5);
            assert!((0.0..=1.0).contains(&here));
            assert!((noise(u + 0.01, v, 12.0, 5) - here).abs() < 0.01, "a step at {u}, {v}");
        }
    }

    /// Across zero, where truncation instead of flooring would mirror the pattern.
    #[test]
    fn patterns_repeat_at_negative_places() {
        for k in -200..200 {
            let u = f64::from(k) * 0.25;
            assert!((stripes(u, 7.0, 3.0) - stripes(u + 70.0, 7.0, 3.0)).abs() < 1e-9);
            assert!((checks(u, 1.0, 5.0) - checks(u + 5.0, 6.0, 5.0)).abs() < 1e-9);
            assert!((checks(u, 1.0, 5.0) + checks(u + 5.0, 1.0, 5.0) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_sign_reads_from_left_to_right() {
        assert!(sign(-17.0 * 3.0, 0.0, 3.0) > 0.9, "left stroke of the G");
        assert!(sign(5.0 * 3.0, 0.0, 3.0) < 0.1, "between P and I");
        assert!(sign(9.0 * 3.0, 0.0, 3.0) > 0.9, "stem of the I");
        assert!(sign(18.5 * 3.0, 0.0, 3.0) < 0.1 && sign(0.0, 13.0, 3.0) < 0.1, "outside");
    }
}
