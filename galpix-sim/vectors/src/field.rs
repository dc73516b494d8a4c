//! Fields of a galpixel's words, by their definition: a field and the word after it are read as one number of 64 bits.

use galpix_core::record::{Field, MAX_WORDS};

/// The words of one galpixel. Those beyond the record's are 0.
pub type Words = [u32; MAX_WORDS];

/// Returns the word of the field's upper part and the word after it, the first one higher.
fn joined(words: &Words, field: Field) -> u64 {
    let word = usize::from(field.word);
    u64::from(words[word]) << 32 | u64::from(words.get(word + 1).copied().unwrap_or_default())
}

/// Returns the field's lowest bit in these two words.
fn lowest(field: Field) -> u32 {
    32 + u32::from(field.shift) - u32::from(field.spill)
}

fn mask(field: Field) -> u64 {
    (1 << field.bits) - 1
}

/// Reads a field as an unsigned number; 0 if it is absent.
pub fn unsigned(words: &Words, field: Field) -> u32 {
    (joined(words, field) >> lowest(field) & mask(field)) as u32
}

/// Reads a field of at most 31 bits as a two's complement number; 0 if it is absent.
pub fn signed(words: &Words, field: Field) -> i32 {
    let sign = 1 << field.bits >> 1;
    (unsigned(words, field) as i32 ^ sign) - sign
}

/// Replaces a field by the low bits of a value; an absent one is left out.
pub fn set(words: &mut Words, field: Field, value: i32) {
    let mask = mask(field) << lowest(field);
    let both = joined(words, field) & !mask | u64::from(value as u32) << lowest(field) & mask;
    let word = usize::from(field.word);
    words[word] = (both >> 32) as u32;
    if let Some(next) = words.get_mut(word + 1) {
        *next = both as u32;
    }
}
