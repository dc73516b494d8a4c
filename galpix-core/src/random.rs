//! Random numbers of the unit tests, the same in each run.

extern crate std;

use std::vec;
use std::vec::Vec;

/// A splitmix64 generator.
pub(crate) struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 32) as u32
    }

    /// One of the numbers `0 .. count`.
    pub fn below(&mut self, count: u32) -> u32 {
        self.next() % count
    }

    pub fn words(&mut self, count: usize) -> Vec<u32> {
        let mut words = vec![0; count];
        words.fill_with(|| self.next());
        words
    }

    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for end in (1..list.len()).rev() {
            list.swap(end, self.next() as usize % (end + 1));
        }
    }
}
