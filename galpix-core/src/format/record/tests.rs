//! Tests the packing of many layouts under many budgets.

extern crate std;

use super::{FIELDS, Field, MAX_WORDS, Record, Words};
use crate::format::budget::{Bits, Demand};
use crate::format::colour::Colour;
use crate::format::layout::Layout;

/// Returns layouts with many combinations of depth bits, motion, luminosity, tag and colour.
fn layouts() -> impl Iterator<Item = Layout> {
    let depths = [0, 4, 8, 16, 24];
    let motions =
        [(false, false, false), (true, false, false), (true, true, false), (true, true, true), (true, false, true)];
    let extras = [(false, 0), (false, 8), (true, 0), (true, 8), (false, 32)];
    depths.into_iter().flat_map(move |depth_bits| {
        motions.into_iter().flat_map(move |(velocity, acceleration, depth_motion)| {
            extras.into_iter().flat_map(move |(luminosity, tag_bits)| {
                [Colour::GRAY4, Colour::GRAY8, Colour::RGB565, Colour::RGB888].map(|colour| Layout {
                    colour,
                    depth_bits,
                    velocity,
                    acceleration,
                    depth_motion,
                    luminosity,
                    tag_bits,
                })
            })
        })
    })
}

fn budgets() -> impl Iterator<Item = Bits> {
    let extents = (1..=14).flat_map(|log| [1 << log, (1 << log) + 1, 3 << (log - 1)]);
    extents.flat_map(|extent| {
        [1, 2, 3, 8, 11, 32].into_iter().flat_map(move |recog| {
            [2, 3, 8, 16, 21, 64, 256]
                .into_iter()
                .filter_map(move |prop| Bits::derive(Demand { extent, recog, prop }).ok())
        })
    })
}

fn records() -> impl Iterator<Item = (Record, Layout, Bits)> {
    budgets()
        .flat_map(|bits| layouts().filter_map(move |layout| Some((Record::plan(bits, layout).ok()?, layout, bits))))
}

fn top(field: Field) -> u32 {
    ((1u64 << field.bits) - 1) as u32
}

#[test]
fn every_field_is_there_alone_and_in_the_fewest_words() {
    let (mut planned, mut straddling) = (0, 0);
    for (record, layout, bits) in records() {
        planned += 1;
        straddling += record.fields.iter().any(|field| field.spill > 0) as u32;
        let total: u32 = record.fields.iter().map(|field| u32::from(field.bits)).sum();
        assert_eq!(record.bits(), total);
        assert_eq!(record.words(), total.div_ceil(32) as usize, "{bits:?} {layout:?}");
        assert_eq!(record.bytes(), 4 * record.words());
        // Setting a field alone sets as many bits as it has, and no bit belongs to two fields.
        let mut taken = Words::default();
        for field in record.fields {
            let mut words = Words::default();
            field.set(&mut words, u32::MAX);
            let ones: u32 = words.iter().map(|word| word.count_ones()).sum();
            assert_eq!(ones, u32::from(field.bits), "{field:?}");
            for (taken, (word, number)) in taken.iter_mut().zip(words.into_iter().zip(0..)) {
                assert_eq!(*taken & word, 0, "{field:?} overlaps");
                assert!(word == 0 || number < record.words(), "{field:?} lies beyond the last word");
                *taken |= word;
            }
        }
    }
    assert!(planned > 10_000 && straddling > 1_000, "{planned} planned, {straddling} with a field that straddles");
}

#[test]
fn every_field_is_read_as_it_was_set_and_disturbs_no_other() {
    for (record, layout, _) in records().step_by(7) {
        for (chosen, field) in record.fields.into_iter().enumerate() {
            for ground in [0, u32::MAX, 0x5a5a_1234] {
                for value in [0, 1, u32::MAX, 1 << 31 >> (32 - field.bits.clamp(1, 32)), 0x2c6e_9b31] {
                    let mut words: Words = [ground; MAX_WORDS];
                    let before: [u32; FIELDS] = record.fields.map(|field| field.unsigned(&words));
                    field.set(&mut words, value);
                    assert_eq!(field.unsigned(&words), value & top(field), "{field:?} of {layout:?}");
                    assert_eq!(
                        i64::from(field.signed(&words)),
                        two_complement(field, value),
                        "{field:?} of {layout:?}"
                    );
                    for (other, (field, before)) in record.fields.into_iter().zip(before).enumerate() {
                        if other != chosen {
                            assert_eq!(field.unsigned(&words), before, "{field:?} of {layout:?} was disturbed");
                        }
                    }
                    let spare = &words[record.words()..];
                    assert!(spare.iter().all(|word| *word == ground), "{field:?} wrote beyond the record");
                }
            }
        }
    }
}

/// Returns the low bits of `value` as a two's complement number of the field's width.
fn two_complement(field: Field, value: u32) -> i64 {
    let low = i64::from(value & top(field));
    if field.present() && low >> (field.bits - 1) == 1 { low - (1 << field.bits) } else { low }
}

/// Fields that share a word are in canonical order, and end-to-end packing leaves no gap.
#[test]
fn fields_stand_in_canonical_order_from_the_top() {
    for (record, layout, _) in records() {
        let place = |field: &Field| {
            u32::from(field.word) * 32 + 32 - u32::from(field.shift) - u32::from(field.bits - field.spill)
        };
        let present: std::vec::Vec<&Field> = record.fields.iter().filter(|field| field.present()).collect();
        for pair in present.windows(2) {
            if pair[0].word == pair[1].word {
                assert!(place(pair[0]) < place(pair[1]), "{pair:?} of {layout:?}");
            }
        }
        if present.iter().any(|field| field.spill > 0) {
            let ends = present.iter().map(|field| (place(field), place(field) + u32::from(field.bits)));
            assert!(ends.clone().zip(ends.skip(1)).all(|((_, end), (start, _))| end == start), "gaps in {layout:?}");
        }
    }
}

#[test]
fn the_papers_galpixel() {
    let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let record = Record::plan(bits, Layout::FULL).unwrap();
    assert_eq!(record.bits(), 2 + 16 + 3 * 36 + 24, "class, z-buffer, equation (14) thrice, colour");
    assert_eq!(record.bytes(), 20);
    assert_eq!(record.velocity(0).bits + record.acceleration(0).bits, 32, "one machine word");
}
