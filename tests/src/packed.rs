//! Fields of a stored galpixel, read and written bit by bit.

use galpix_core::record::Field;

/// Returns where each bit of a field is stored, from its highest to its lowest: word and bit in the word.
pub fn places(field: Field) -> impl Iterator<Item = (usize, u32)> {
    let upper = u32::from(field.bits - field.spill);
    let top = u32::from(field.shift) + upper;
    let word = usize::from(field.word);
    let high = (u32::from(field.shift)..top).rev().map(move |bit| (word, bit));
    high.chain((32 - u32::from(field.spill)..32).rev().map(move |bit| (word + 1, bit)))
}

/// Returns the field as an unsigned number; 0 if it is absent.
#[must_use]
pub fn unsigned(field: Field, words: &[u32]) -> i64 {
    places(field).fold(0, |value, (word, bit)| value << 1 | i64::from(words[word] >> bit & 1))
}

/// Returns the field as a two's complement number; 0 if it is absent.
#[must_use]
pub fn signed(field: Field, words: &[u32]) -> i64 {
    let value = unsigned(field, words);
    if field.bits > 0 && value >> (field.bits - 1) == 1 { value - (1 << field.bits) } else { value }
}

/// Replaces the field by the low bits of `value`.
pub fn set(field: Field, words: &mut [u32], value: i64) {
    for ((word, bit), step) in places(field).zip((0..field.bits).rev()) {
        words[word] = words[word] & !(1 << bit) | ((value >> step & 1) as u32) << bit;
    }
}
