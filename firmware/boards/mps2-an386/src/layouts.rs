//! The formats that are measured, each under the budget of a panel of its size.

use galpix_core::{Bits, Demand, Layout, Profile, Static};

use crate::bench::Bench;

/// A panel of 320 pixels a side, recognition in 8 frames, an update every 16.
const DEMAND: Demand = Demand { extent: 320, recog: 8, prop: 16 };
/// The paper's: 1024 pixels a side.
const PAPER: Demand = Demand { extent: 1024, ..DEMAND };

macro_rules! formats {
    ($($profile:ident: $layout:ident, $bits:expr;)*) => {
        $(
            struct $profile;

            impl Profile for $profile {
                const LAYOUT: Layout = Layout::$layout;
                const BITS: Bits = Bits::must($bits);
            }
        )*

        /// Words of a galpixel of the largest of them.
        pub const MOST_WORDS: usize = {
            let (mut most, words) = (0, [$(Static::<$profile>::RECORD.words()),*]);
            let mut index = 0;
            while index < words.len() {
                most = if words[index] > most { words[index] } else { most };
                index += 1;
            }
            most
        };

        /// Measures each of them.
        pub fn measure_all(bench: &mut Bench) {
            $(bench.measure::<$profile>(stringify!($profile));)*
        }
    };
}

formats! {
    VelocityGray4: VELOCITY_GRAY4, Bits::derive_without_acceleration(DEMAND);
    VelocityGray8: VELOCITY_GRAY8, Bits::derive_without_acceleration(DEMAND);
    Velocity565: VELOCITY565, Bits::derive_without_acceleration(DEMAND);
    Flat565: FLAT565, Bits::derive(DEMAND);
    Full: FULL, Bits::derive(PAPER);
    Shaded: SHADED, Bits::derive(DEMAND);
}
