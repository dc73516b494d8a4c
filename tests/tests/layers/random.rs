//! Maps by chance, in which much meets: few depths, so that keys are equal; slow, so that what meets stays in the map.

use galpix_core::galpixel::Class;
use galpix_core::record::{Field, Record};
use galpix_tests::{packed, random};
use rand::rngs::SmallRng;
use rand::{Rng, RngExt};

use crate::holes::Cell;

/// How full a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    Empty,
    Sparse,
    Dense,
    Full,
    /// Any words at all.
    Rubbish,
}

impl Filling {
    pub const ALL: [Self; 5] = [Self::Empty, Self::Sparse, Self::Dense, Self::Full, Self::Rubbish];
}

/// A galpixel of some class.
pub fn cell(generator: &mut SmallRng, record: &Record, class: Class) -> Cell {
    let mut words: Cell = (0..record.words()).map(|_| generator.next_u32()).collect();
    packed::set(record.class(), &mut words, class as i64);
    let small = |field: Field, bits: u32, words: &mut Cell| {
        let value = packed::signed(field, words) & ((1 << bits) - 1);
        packed::set(field, words, if value >> (bits - 1) & 1 == 1 { value - (1 << bits) } else { value });
    };
    // One in some is left as it is: those that saturate, and those that leave.
    if !generator.random_ratio(1, 16) {
        for (component, scale) in record.scales.iter().enumerate() {
            if record.velocity(component).bits > 0 {
                small(record.velocity(component), scale.velocity_frac + 1, &mut words);
            }
            if record.acceleration(component).bits > 0 {
                small(record.acceleration(component), 2, &mut words);
            }
        }
    }
    if record.depth().bits > 2 && generator.random_ratio(3, 4) {
        let depth = i64::from(random::below(generator, 4)) << (record.depth().bits - 2);
        packed::set(record.depth(), &mut words, depth);
    }
    words
}

/// A map. One class in long runs, so that there are surfaces.
pub fn map(generator: &mut SmallRng, record: &Record, filling: Filling, cells: usize) -> Vec<Cell> {
    let share = match filling {
        Filling::Empty => 0,
        Filling::Sparse => 12,
        Filling::Dense => 85,
        Filling::Full | Filling::Rubbish => 100,
    };
    let together = generator.random_ratio(1, 2).then(|| cell(generator, record, Class::Galpixel));
    (0..cells)
        .map(|_| {
            let class = match random::below(generator, 24) {
                0 => Class::Debris,
                1 => Class::JustUnobscured,
                _ => Class::Galpixel,
            };
            if filling == Filling::Rubbish {
                return (0..record.words()).map(|_| generator.next_u32()).collect();
            }
            if random::below(generator, 100) >= share {
                return cell(generator, record, Class::Empty);
            }
            match &together {
                Some(surface) if random::below(generator, 10) > 0 => {
                    let mut words = surface.clone();
                    packed::set(record.colour(), &mut words, generator.next_u32().into());
                    words
                }
                _ => cell(generator, record, class),
            }
        })
        .collect()
}
