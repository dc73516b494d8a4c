//! Budgets by name, each once as a constant and once as a profile fixed at compile time.

use galpix_core::budget::{Bits, Component, Demand, Shave};
use galpix_core::error::BudgetError;
use galpix_core::galpixel::Profile;

const fn component(component: Result<Component, BudgetError>) -> Component {
    match component {
        Ok(component) => component,
        Err(_) => panic!("this component cannot exist"),
    }
}

macro_rules! profiles {
    ($($(#[$doc:meta])* $name:ident = $bits:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;
        impl Profile for $name {
            const BITS: Bits = $bits;
        }
    )*};
}

const PAPER: Demand = Demand { extent: 1024, recog: 8, prop: 16 };
const SCENE: Demand = Demand { extent: 256, recog: 8, prop: 32 };
const ODD: Demand = Demand { extent: 200, recog: 7, prop: 11 };

/// Different widths in x and y, both apart from what the equations give; the position of y is finer than its step.
const UNEVEN: Bits = {
    let x = component(component(Component::derive(SCENE)).shaved(Shave {
        velocity_int: 1,
        velocity_frac: 1,
        acceleration_frac: 3,
        ..NO_SHAVE
    }));
    let y = component(
        Component { position_frac: 7, velocity_int: 7, velocity_frac: 4, acceleration_int: 4, acceleration_frac: 2 }
            .checked(),
    );
    Bits::must(Bits::derive(SCENE)).with_xy(x, y)
};

const NO_SHAVE: Shave =
    Shave { position_frac: 0, velocity_int: 0, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };

profiles! {
    /// The paper's example.
    Paper = Bits::must(Bits::derive(PAPER));
    /// The built-in scenes, for 32 frames.
    Scene = Bits::must(Bits::derive(SCENE));
    /// No number of it is a power of two.
    Odd = Bits::must(Bits::derive(ODD));
    /// Components that differ.
    Uneven = UNEVEN;
    /// Velocity alone, for the built-in scenes.
    Slide = Bits::must(Bits::derive_without_acceleration(SCENE));
    /// A panel of 320 x 240, recognition in 8 frames, an update every 16.
    Panel = Bits::must(Bits::derive_without_acceleration(Demand { extent: 320, recog: 8, prop: 16 }));
}
