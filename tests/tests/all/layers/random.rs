//! Maps by chance, in which much meets: few depths, so that keys are equal; slow, so that what meets stays in the map.

use galpix_core::record::Field;
use galpix_core::{Class, Record};
use galpix_tests::memory::Shape;
use galpix_tests::{packed, random};
use rand::rngs::SmallRng;
use rand::{Rng, RngExt};

use super::holes::Cell;

/// How full a map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filling {
    Empty,
    Sparse,
    Dense,
    Full,
    /// Blocks of a surface that drift apart, so that gaps between rows cross gaps between columns.
    Apart,
    /// Any words at all.
    Arbitrary,
}

impl Filling {
    pub const ALL: [Self; 6] = [Self::Empty, Self::Sparse, Self::Dense, Self::Full, Self::Apart, Self::Arbitrary];

    /// Returns one of them.
    pub fn any(generator: &mut SmallRng) -> Self {
        Self::ALL[random::below(generator, 6) as usize]
    }
}

/// Returns a galpixel of some class.
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

/// A galpixel of a surface; it goes as many cells as its block is from the corner.
fn apart(generator: &mut SmallRng, record: &Record, block: [usize; 2]) -> Cell {
    let mut words = vec![0; record.words()];
    packed::set(record.colour(), &mut words, generator.next_u32().into());
    packed::set(record.depth(), &mut words, 1 << record.depth().bits >> 1);
    for (component, cells) in block.into_iter().enumerate() {
        let frac = record.scales[component].velocity_frac;
        packed::set(record.velocity(component), &mut words, (cells as i64) << frac);
    }
    words
}

/// Returns a map. One class in long runs, so that there are surfaces.
pub fn map(generator: &mut SmallRng, record: &Record, filling: Filling, shape: Shape) -> Vec<Cell> {
    let (cells, columns) = (shape.cells() as usize, shape.columns() as usize);
    let share = match filling {
        Filling::Empty => 0,
        Filling::Sparse => 12,
        Filling::Dense => 85,
        Filling::Full | Filling::Apart | Filling::Arbitrary => 100,
    };
    let together = generator.random_ratio(1, 2).then(|| cell(generator, record, Class::Galpixel));
    (0..cells)
        .map(|index| {
            if filling == Filling::Apart {
                return apart(generator, record, [index % columns / 3, index / columns / 3]);
            }
            let class = match random::below(generator, 24) {
                0 => Class::Debris,
                1 => Class::JustUnobscured,
                _ => Class::Galpixel,
            };
            if filling == Filling::Arbitrary {
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
