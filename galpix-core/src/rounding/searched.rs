//! Threshold tables found by search: `cargo run --release -p galpix-sim --example search_thresholds` finds them anew.

/// The most dropped bits that there is a table for.
pub(super) const MOST: u32 = 4;

/// The table for `shift` dropped bits fills the places `2^shift .. 2^(shift+1)`; the first two places are none's.
#[rustfmt::skip]
const THRESHOLDS: [u8; 2 << MOST] = [
    0, 0,
    0, 1,
    2, 1, 1, 2,
    6, 1, 3, 4, 3, 4, 6, 1,
    15, 3, 0, 12, 4, 8, 11, 7, 7, 11, 8, 4, 12, 0, 3, 15,
];

/// The threshold of a frame; `shift` is at most [`MOST`].
pub(super) const fn threshold(frame: u32, shift: u32) -> i32 {
    let place = 1 << shift | frame & ((1 << shift) - 1);
    // The mask changes nothing, and tells the compiler that there is such a place.
    THRESHOLDS[place as usize & (THRESHOLDS.len() - 1)] as i32
}
