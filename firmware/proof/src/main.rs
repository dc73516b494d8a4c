//! A proof by linking: no panic can be reached from anything that a firmware calls of `galpix-core`.
//!
//! ```sh
//! cargo build --release -p galpix-proof --target thumbv6m-none-eabi
//! ```
//!
//! Everything is called with inputs that the optimiser knows nothing of. What panics calls the panic handler, which
//! calls a function that does not exist: where the linker finds a way there, it says so and fails. With the feature
//! `bad` there is one, to see that it does.
//!
//! The program is never run. `galpix-check machine-code` reads it: in what the `proof_` functions reach there must be
//! no product, quotient, float or trap, and in each `planted_` function there is one. Push-pull, `proof_inpaint_`,
//! multiplies: there a product may be, and nothing else.

#![no_std]
#![no_main]

mod link;
mod passes;
mod planted;

use core::hint::black_box;

use galpix_core::inpaint::{Gamma, Motion, PushPull};
use galpix_core::{Bits, Demand, Galpixel, Inpainting, Layout, Margin, Profile, Settings};

/// A panel of up to 512 pixels a side.
const DEMAND: Demand = Demand { extent: 512, recog: 8, prop: 16 };
const WITH_ACCELERATION: Bits = Bits::must(Bits::derive(DEMAND));
const WITHOUT_ACCELERATION: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));

macro_rules! profiles {
    ($($profile:ident: $layout:ident, $bits:ident;)*) => {$(
        struct $profile;

        impl Profile for $profile {
            const LAYOUT: Layout = Layout::$layout;
            const BITS: Bits = $bits;
        }
    )*};
}

profiles! {
    VelocityGray4: VELOCITY_GRAY4, WITHOUT_ACCELERATION;
    Velocity565: VELOCITY565, WITHOUT_ACCELERATION;
    Full: FULL, WITH_ACCELERATION;
    Shaded: SHADED, WITH_ACCELERATION;
}

/// What comes from outside.
struct Inputs<'m> {
    size: [u32; 2],
    margin: Margin,
    place: [i32; 2],
    frame: u32,
    settings: Settings,
    galpixel: Galpixel,
    rows: &'m mut [u32],
    window_rows: &'m mut [u32],
    maps: [&'m mut [u32]; 2],
    scratch: [&'m mut [u32]; 2],
    line: &'m mut [u16],
    inpainting: Inpainting<'m>,
    motion: Motion,
    push_pull: &'m mut [u32],
}

/// Calls everything.
fn run() {
    let (mut rows, mut window_rows, mut front, mut back) = ([0; 8], [0; 8], [0; 512], [0; 512]);
    let (mut winners, mut edges, mut line) = ([0; 64], [0; 2], [0; 8]);
    let (mut push_pull, mask) = ([0; PushPull::words(8, 8, Motion::Inpainted)], [u32::MAX; 2]);
    let mut inputs = black_box(Inputs {
        size: [8, 8],
        margin: Margin::NONE,
        place: [0; 2],
        frame: 0,
        settings: Settings::for_depth(16),
        galpixel: Galpixel::default(),
        rows: &mut rows,
        window_rows: &mut window_rows,
        maps: [&mut front, &mut back],
        scratch: [&mut winners, &mut edges],
        line: &mut line,
        inpainting: Inpainting { mask: &mask, ..Inpainting::for_depth(16, Gamma::Half) },
        motion: Motion::Inpainted,
        push_pull: &mut push_pull,
    });
    passes::call_all::<VelocityGray4>(&mut inputs);
    passes::call_all::<Velocity565>(&mut inputs);
    passes::call_all::<Full>(&mut inputs);
    passes::call_all::<Shaded>(&mut inputs);
    planted::call_all(&mut inputs);
}
