//! Budgets by name.

use galpix_core::record::{Component, Shave};
use galpix_core::{Bits, BudgetError, Demand, Dynamic, Layout};

use crate::layouts::{DEEP, FLAT565_WITHOUT_DEPTH, TINY_PLANE};

const fn component(component: Result<Component, BudgetError>) -> Component {
    match component {
        Ok(component) => component,
        Err(_) => panic!("this component cannot exist"),
    }
}

const FOR_SCENES: Demand = Demand { extent: 256, recog: 8, prop: 32 };

const NO_SHAVE: Shave =
    Shave { position_frac: 0, velocity_int: 0, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };

/// The paper's example.
pub const PAPER: Bits = Bits::must(Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }));
/// The built-in scenes, for 32 frames.
pub const SCENE: Bits = Bits::must(Bits::derive(FOR_SCENES));
/// No number of it is a power of two.
pub const ODD: Bits = Bits::must(Bits::derive(Demand { extent: 200, recog: 7, prop: 11 }));
/// Different widths in x and y, both apart from what the equations give; the position of y is finer than its step.
pub const UNEVEN: Bits = {
    let x = component(component(Component::derive(FOR_SCENES)).shaved(Shave {
        velocity_int: 1,
        velocity_frac: 1,
        acceleration_frac: 3,
        ..NO_SHAVE
    }));
    let y = component(
        Component { position_frac: 7, velocity_int: 7, velocity_frac: 4, acceleration_int: 4, acceleration_frac: 2 }
            .checked(),
    );
    SCENE.with_xy(x, y)
};
/// Velocity alone, for the built-in scenes.
pub const SLIDE: Bits = Bits::must(Bits::derive_without_acceleration(FOR_SCENES));
/// A panel of 320 x 240, recognition in 8 frames, an update every 16.
pub const PANEL: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 320, recog: 8, prop: 16 }));

/// Under it a field of `Layout::FULL` straddles two words.
pub const STRADDLING: Bits = Bits::must(Bits::derive(Demand { extent: 200, recog: 4, prop: 32 }));

/// Layouts with budgets that they fit; between them everything that a format can be.
pub const FORMATS: [(&str, Layout, Bits); 15] = [
    ("the paper's galpixel and budget", Layout::FULL, PAPER),
    ("a field that straddles two words", Layout::FULL, STRADDLING),
    ("tagged galpixels and a budget of no power of two", Layout::TAGGED, ODD),
    ("shaded galpixels and components that differ", Layout::SHADED, UNEVEN),
    ("flat galpixels", Layout::FLAT565, SCENE),
    ("flat galpixels without depth", FLAT565_WITHOUT_DEPTH, SCENE),
    ("sliding galpixels", Layout::VELOCITY565, SLIDE),
    ("gray galpixels", Layout::VELOCITY_GRAY8, PANEL),
    ("the smallest galpixels", Layout::VELOCITY_GRAY4, SLIDE),
    ("the smallest galpixels of a panel", Layout::VELOCITY_GRAY4, PANEL),
    ("the deepest galpixels", DEEP, SLIDE),
    ("motion in the plane only", TINY_PLANE, PAPER),
    ("motion in the plane only and components that differ", TINY_PLANE, UNEVEN),
    ("motion in the plane only and a budget of no power of two", TINY_PLANE, ODD),
    ("a picture that does not move", Layout::STILL, PAPER),
];

/// Returns the formats of [`FORMATS`], by name.
pub fn formats() -> impl Iterator<Item = (&'static str, Dynamic)> {
    FORMATS.into_iter().map(|(name, layout, bits)| (name, dynamic(layout, bits)))
}

/// Returns the format of a layout under a budget.
///
/// Panics if it does not fit.
#[must_use]
pub fn dynamic(layout: Layout, bits: Bits) -> Dynamic {
    Dynamic::new(bits, layout).unwrap_or_else(|error| panic!("{layout:?}: {error}"))
}
