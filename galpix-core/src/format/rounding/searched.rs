//! Threshold tables found by search. `cargo run --release -p galpix-sim --example search_thresholds` reproduces them.

/// The largest number of dropped bits for which there is a table.
pub(super) const MOST: u32 = 6;

/// The tables: the one for `shift` dropped bits has the indices `2^shift .. 2^(shift + 1)`. The first two are unused.
#[rustfmt::skip]
const THRESHOLDS: [u8; 2 << MOST] = [
    0, 0,
    1, 0,
    2, 1, 2, 1,
    6, 1, 3, 4, 3, 4, 6, 1,
    0, 12, 15, 3, 11, 7, 4, 8, 8, 4, 7, 11, 3, 15, 12, 0,
    26, 3, 12, 0, 21, 30, 16, 22, 18, 11, 3, 27, 13, 21, 7, 14,
    9, 18, 27, 19, 5, 13, 31, 6, 1, 27, 20, 9, 29, 5, 23, 4,
    7, 30, 23, 7, 56, 14, 37, 58, 15, 50, 29, 16, 0, 56, 51, 60,
    56, 11, 7, 24, 41, 55, 58, 36, 20, 4, 15, 63, 18, 1, 33, 44,
    31, 17, 53, 40, 25, 47, 10, 19, 44, 18, 63, 48, 34, 22, 18, 27,
    23, 40, 39, 55, 10, 29, 26, 4, 62, 26, 47, 32, 3, 37, 59, 12,
];

/// Returns the threshold of a frame; `shift` is 1 to [`MOST`].
pub(super) const fn threshold(frame: u32, shift: u32) -> i32 {
    let index = 1 << shift | frame & ((1 << shift) - 1);
    THRESHOLDS[index as usize] as i32
}
