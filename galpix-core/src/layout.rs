//! Layouts: which lanes the galpixels of a scene carry. What a scene lacks is absent by type: no bit, no code.

use crate::colour::{Colour, Gray4, Gray8, Rgb565, Rgb888};

/// The lanes of a layout. Class (2 bits) and colour are always there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lanes {
    /// Bits of the z-buffer; 0 leaves depth out, and collisions are decided by class and source alone.
    pub depth_bits: u32,
    /// Fractional position and velocity in x and y.
    pub velocity: bool,
    /// Acceleration, in each component that has a velocity.
    pub acceleration: bool,
    /// Velocity (and acceleration) of the depth, and its fraction.
    pub depth_motion: bool,
    /// Rate of the luminosity (shading inertia) and the fraction of the luminosity.
    pub luminosity: bool,
    /// Bits of the object tag; 0 leaves it out.
    pub tag_bits: u32,
}

/// A layout, as a type that has no values. Write your own in five lines.
///
/// ```
/// use galpix_core::{colour::Gray4, layout::{Lanes, Layout}};
/// /// A flat status bar that slides.
/// enum Bar {}
/// impl Layout for Bar {
///     type Colour = Gray4;
///     const LANES: Lanes = Lanes { velocity: true, ..Lanes::NONE };
/// }
/// ```
pub trait Layout {
    /// How a colour is stored.
    type Colour: Colour;
    /// What else is stored.
    const LANES: Lanes;
}

impl Lanes {
    /// Colour and class only: a picture that does not move.
    pub const NONE: Self = Self {
        depth_bits: 0,
        velocity: false,
        acceleration: false,
        depth_motion: false,
        luminosity: false,
        tag_bits: 0,
    };

    /// x, y and z with velocity and acceleration over a 16-bit z-buffer: the paper's galpixel.
    pub const FULL: Self =
        Self { depth_bits: 16, velocity: true, acceleration: true, depth_motion: true, luminosity: false, tag_bits: 0 };

    /// x and y with velocity only, over a 16-bit z-buffer.
    pub const VELOCITY_XY: Self = Self { acceleration: false, depth_motion: false, ..Self::FULL };

    /// Whether every lane of `other` is one of these. The depth may have any width where there is one.
    #[must_use]
    pub const fn include(self, other: Self) -> bool {
        (self.depth_bits > 0 || other.depth_bits == 0)
            && (self.velocity || !other.velocity)
            && (self.acceleration || !other.acceleration)
            && (self.depth_motion || !other.depth_motion)
            && (self.luminosity || !other.luminosity)
            && self.tag_bits >= other.tag_bits
    }
}

macro_rules! layouts {
    ($($(#[$doc:meta])* $name:ident: $colour:ty, $lanes:expr;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub enum $name {}
        impl Layout for $name {
            type Colour = $colour;
            const LANES: Lanes = $lanes;
        }
    )*};
}

layouts! {
    /// The paper's galpixel: x, y, z with velocity and acceleration, RGB888, 16-bit z.
    Full: Rgb888, Lanes::FULL;
    /// The paper's galpixel with an 8-bit object tag.
    Tagged: Rgb888, Lanes { tag_bits: 8, ..Lanes::FULL };
    /// The paper's galpixel with shading inertia and an 8-bit object tag.
    Shaded: Rgb888, Lanes { luminosity: true, tag_bits: 8, ..Lanes::FULL };
    /// x and y with velocity and acceleration, RGB565, 16-bit z that does not move.
    Flat565: Rgb565, Lanes { depth_motion: false, ..Lanes::FULL };
    /// x and y with velocity only, RGB565, 16-bit z that does not move.
    Velocity565: Rgb565, Lanes::VELOCITY_XY;
    /// x and y with velocity only, 8-bit gray, 8-bit z that does not move.
    VelocityGray8: Gray8, Lanes { depth_bits: 8, ..Lanes::VELOCITY_XY };
    /// x and y with velocity only, 4-bit gray, 4-bit z that does not move: for small panels.
    VelocityGray4: Gray4, Lanes { depth_bits: 4, ..Lanes::VELOCITY_XY };
    /// Colour only: a picture that does not move.
    Still: Rgb888, Lanes::NONE;
}
