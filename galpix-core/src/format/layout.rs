//! Layouts: which fields the galpixels of a scene carry. An absent field takes no bits and no work.

use crate::format::colour::Colour;

/// The fields that a galpixel carries in addition to its class, which always has 2 bits.
///
/// ```
/// use galpix_core::{Colour, Layout};
/// /// A flat status bar that slides.
/// const BAR: Layout = Layout { colour: Colour::GRAY4, velocity: true, ..Layout::STILL };
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Layout {
    /// How a colour is stored.
    pub colour: Colour,
    /// Bits of the z-buffer; 0 leaves the depth out, so that collisions are resolved by class and source alone.
    pub depth_bits: u32,
    /// Fractional position and velocity in x and y.
    pub velocity: bool,
    /// Acceleration, in each component that has a velocity.
    pub acceleration: bool,
    /// Velocity of the depth, and the fraction of the depth; with `acceleration` also the acceleration of the depth.
    pub depth_motion: bool,
    /// Rate of the luminosity (shading inertia), and the fraction of the luminosity.
    pub luminosity: bool,
    /// Bits of the object tag; 0 leaves it out.
    pub tag_bits: u32,
}

impl Layout {
    /// Colour only, RGB888: a picture that does not move.
    pub const STILL: Self = Self {
        colour: Colour::RGB888,
        depth_bits: 0,
        velocity: false,
        acceleration: false,
        depth_motion: false,
        luminosity: false,
        tag_bits: 0,
    };

    /// The paper's galpixel: x, y, z with velocity and acceleration, RGB888, 16-bit z.
    pub const FULL: Self =
        Self { depth_bits: 16, velocity: true, acceleration: true, depth_motion: true, ..Self::STILL };

    /// The paper's galpixel with an 8-bit object tag.
    pub const TAGGED: Self = Self { tag_bits: 8, ..Self::FULL };

    /// The paper's galpixel with shading inertia and an 8-bit object tag.
    pub const SHADED: Self = Self { luminosity: true, tag_bits: 8, ..Self::FULL };

    /// x and y with velocity and acceleration, RGB565, 16-bit z that does not move.
    pub const FLAT565: Self = Self { colour: Colour::RGB565, depth_motion: false, ..Self::FULL };

    /// x and y with velocity only, RGB565, 16-bit z that does not move.
    pub const VELOCITY565: Self = Self { acceleration: false, ..Self::FLAT565 };

    /// x and y with velocity only, 8-bit gray, 8-bit z that does not move.
    pub const VELOCITY_GRAY8: Self = Self { colour: Colour::GRAY8, depth_bits: 8, ..Self::VELOCITY565 };

    /// x and y with velocity only, 4-bit gray, 4-bit z that does not move: for small panels.
    pub const VELOCITY_GRAY4: Self = Self { colour: Colour::GRAY4, depth_bits: 4, ..Self::VELOCITY565 };
}
