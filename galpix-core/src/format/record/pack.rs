//! Packs fields into words.

use super::{FIELDS, Field, MAX_WORDS};
use crate::error::BudgetError;

/// Packs fields of these widths, given in canonical order, into as few words as their bits allow. Returns the fields,
/// the number of words and the number of bits in use.
///
/// *Errors:* a field wider than a word, more than [`MAX_WORDS`] words.
pub(super) const fn pack(widths: [u32; FIELDS]) -> Result<([Field; FIELDS], u8, u16), BudgetError> {
    let mut total = 0;
    let mut i = 0;
    while i < FIELDS {
        if widths[i] > 32 {
            return Err(BudgetError::FieldTooWide { bits: widths[i], most: 32 });
        }
        total += widths[i];
        i += 1;
    }
    let fewest = total.div_ceil(32);
    if fewest as usize > MAX_WORDS {
        return Err(BudgetError::RecordTooLong { bits: total, most: 32 * MAX_WORDS as u32 });
    }
    let fields = match first_fit(widths, fewest) {
        Some(fields) => fields,
        None => end_to_end(widths),
    };
    Ok((fields, fewest as u8, total as u16))
}

/// Packs fields by first-fit with decreasing width into `words` words; `None` if they do not fit.
const fn first_fit(widths: [u32; FIELDS], words: u32) -> Option<[Field; FIELDS]> {
    let mut fields = [Field { bits: 0, word: 0, shift: 0, spill: 0 }; FIELDS];
    let mut used = [0u32; MAX_WORDS];
    let mut width = 32;
    while width > 0 {
        let mut i = 0;
        while i < FIELDS {
            if widths[i] == width {
                let mut word = 0;
                while word < words as usize && used[word] + width > 32 {
                    word += 1;
                }
                if word == words as usize {
                    return None;
                }
                used[word] += width;
                fields[i] = Field { bits: width as u8, word: word as u8, shift: 0, spill: 0 };
            }
            i += 1;
        }
        width -= 1;
    }
    let mut top = [32u8; MAX_WORDS];
    let mut i = 0;
    while i < FIELDS {
        if fields[i].bits > 0 {
            let word = fields[i].word as usize;
            top[word] -= fields[i].bits;
            fields[i].shift = top[word];
        }
        i += 1;
    }
    Some(fields)
}

/// Packs fields one after the other, from the top of the first word. A field may straddle two words.
const fn end_to_end(widths: [u32; FIELDS]) -> [Field; FIELDS] {
    let mut fields = [Field { bits: 0, word: 0, shift: 0, spill: 0 }; FIELDS];
    let mut start = 0;
    let mut i = 0;
    while i < FIELDS {
        if widths[i] > 0 {
            let (word, room) = (start / 32, 32 - start % 32);
            let bits = widths[i];
            fields[i] = if bits <= room {
                Field { bits: bits as u8, word: word as u8, shift: (room - bits) as u8, spill: 0 }
            } else {
                Field { bits: bits as u8, word: word as u8, shift: 0, spill: (bits - room) as u8 }
            };
            start += bits;
        }
        i += 1;
    }
    fields
}
