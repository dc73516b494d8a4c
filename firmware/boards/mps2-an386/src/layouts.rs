//! The layouts that are measured, each under the budget of a panel of its size.

use galpix_core::budget::{Bits, Demand};
use galpix_core::galpixel::{Fixed, Profile, Static};
use galpix_core::layout::{Flat565, Full, Shaded, Velocity565, VelocityGray4, VelocityGray8};

use crate::bench::Bench;

/// A panel of 320 pixels a side, recognition in 8 frames, an update every 16.
const DEMAND: Demand = Demand { extent: 320, recog: 8, prop: 16 };

/// Velocities only.
pub struct Velocity;

impl Profile for Velocity {
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));
}

/// Accelerations too.
pub struct Acceleration;

impl Profile for Acceleration {
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

/// The paper's: 1024 pixels a side.
pub struct Paper;

impl Profile for Paper {
    const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 1024, ..DEMAND }));
}

macro_rules! layouts {
    ($($layout:ident: $profile:ident;)*) => {
        /// Words of a galpixel of the largest of them.
        pub const MOST_WORDS: usize = {
            let (mut most, words) = (0, [$(<Static<$profile> as Fixed<$layout>>::RECORD.words()),*]);
            let mut index = 0;
            while index < words.len() {
                most = if words[index] > most { words[index] } else { most };
                index += 1;
            }
            most
        };

        /// Measures each of them.
        pub fn measure_all(bench: &mut Bench) {
            $(bench.measure::<$layout, $profile>(stringify!($layout));)*
        }
    };
}

layouts! {
    VelocityGray4: Velocity;
    VelocityGray8: Velocity;
    Velocity565: Velocity;
    Flat565: Acceleration;
    Full: Paper;
    Shaded: Acceleration;
}
