//! The code of a frame by layout, to be measured: `galpix-check text` adds up what each `text_` function reaches. The
//! program is never run; no panic can be reached in it either.

#![no_std]
#![no_main]

mod link;

use core::hint::black_box;

use galpix_core::{Demand, Layout};

/// A panel of 320 pixels a side, recognition in 8 frames, an update every 16; as in the cost bench.
const DEMAND: Demand = Demand { extent: 320, recog: 8, prop: 16 };
/// The paper's: 1024 pixels a side.
const PAPER: Demand = Demand { extent: 1024, ..DEMAND };

macro_rules! formats {
    ($($profile:ident: $layout:ident, $bits:expr;)*) => {
        $(
            #[allow(non_snake_case)]
            mod $profile {
                use core::hint::black_box;

                use galpix_core::inpaint::PushPull;
                use galpix_core::rolling::Rolling;
                use galpix_core::{Bits, Controller, Inpainting, Layout, Profile, Settings, Static, Tally};

                pub struct Format;
                impl Profile for Format {
                    const LAYOUT: Layout = super::$layout;
                    const BITS: Bits = Bits::must($bits);
                }

                /// A frame in one map and a window of rows, with every fill mode: it is chosen at run time.
                #[inline(never)]
                fn text_rolling(rolling: &mut Rolling<'_, Static<Format>>, settings: &Settings) -> Tally {
                    rolling.step(settings)
                }

                /// A frame in two maps.
                #[inline(never)]
                fn text_two_maps(maps: &mut Controller<'_, Static<Format>>, settings: &Settings) -> Tally {
                    maps.step(settings)
                }

                /// Push-pull after a frame in one map.
                #[inline(never)]
                fn text_push_pull(
                    rolling: &mut Rolling<'_, Static<Format>>,
                    inpainting: &Inpainting<'_>,
                    push_pull: &mut PushPull<'_>,
                ) -> u32 {
                    rolling.inpaint(inpainting, push_pull)
                }

                pub fn keep() {
                    black_box(text_rolling as *const ());
                    black_box(text_two_maps as *const ());
                    black_box(text_push_pull as *const ());
                }
            }
        )*

        /// Keeps all of them in the program.
        fn run() {
            $($profile::keep();)*
            black_box(());
        }
    };
}

const VELOCITY_GRAY4: Layout = Layout::VELOCITY_GRAY4;
const VELOCITY_GRAY8: Layout = Layout::VELOCITY_GRAY8;
const VELOCITY565: Layout = Layout::VELOCITY565;
const FLAT565: Layout = Layout::FLAT565;
const FULL: Layout = Layout::FULL;
const SHADED: Layout = Layout::SHADED;

formats! {
    VelocityGray4: VELOCITY_GRAY4, Bits::derive_without_acceleration(super::DEMAND);
    VelocityGray8: VELOCITY_GRAY8, Bits::derive_without_acceleration(super::DEMAND);
    Velocity565: VELOCITY565, Bits::derive_without_acceleration(super::DEMAND);
    Flat565: FLAT565, Bits::derive(super::DEMAND);
    Full: FULL, Bits::derive(super::PAPER);
    Shaded: SHADED, Bits::derive(super::DEMAND);
}
