//! Seeded randomness: the same on every machine and in every run.

use rand::rngs::SmallRng;
use rand::seq::SliceRandom;
use rand::{Rng, RngExt, SeedableRng};

/// Returns a generator that `seed` determines.
#[must_use]
pub fn generator(seed: u64) -> SmallRng {
    SmallRng::seed_from_u64(seed)
}

/// Returns `count` random words.
#[must_use]
pub fn words(seed: u64, count: usize) -> Vec<u32> {
    let mut generator = generator(seed);
    (0..count).map(|_| generator.next_u32()).collect()
}

/// The same items in a random order.
pub fn shuffle<T>(seed: u64, items: &mut [T]) {
    items.shuffle(&mut generator(seed));
}

/// Returns a number in `0 .. end`.
pub fn below(generator: &mut impl Rng, end: u32) -> u32 {
    generator.random_range(0..end)
}
