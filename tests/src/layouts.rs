//! Layouts that the product does not need: tiny ones, whose states can be enumerated, and neighbours of the built-in ones
//! that lack a lane.

use galpix_core::colour::{Colour, Gray4, Gray8, Rgb565, Rgb888};
use galpix_core::layout::{Lanes, Layout};

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

/// Everything a layout can have.
pub const EVERYTHING: Lanes = Lanes { luminosity: true, tag_bits: 8, ..Lanes::FULL };
/// No depth, no tag: motion in the plane with acceleration.
const PLANE: Lanes = Lanes { depth_bits: 0, depth_motion: false, ..Lanes::FULL };

layouts! {
    /// Motion in the plane; class and 4 bits of colour beside it.
    TinyPlane: Gray4, PLANE;
    /// Motion in the plane without acceleration.
    TinySlide: Gray4, Lanes { acceleration: false, ..PLANE };
    /// Motion in depth over a z-buffer of 3 bits and a fraction.
    TinyDepth: Gray4, Lanes { depth_bits: 3, depth_motion: true, ..PLANE };
    /// Motion in the plane before a z-buffer of 2 bits.
    TinyDeep: Gray4, Lanes { depth_bits: 2, ..PLANE };
    /// The same without acceleration.
    TinyDeepSlide: Gray4, Lanes { depth_bits: 2, acceleration: false, ..PLANE };
    /// Shading inertia of 4 bits of gray.
    TinyShaded: Gray4, Lanes { luminosity: true, ..Lanes::NONE };
    /// Shading inertia where one channel is wider than the others.
    Shaded565: Rgb565, Lanes { luminosity: true, ..Lanes::NONE };
    /// The built-in `Shaded` without acceleration.
    ShadedWithoutAcceleration: Rgb888, Lanes { acceleration: false, ..EVERYTHING };
    /// The built-in `Shaded` without motion in depth; its z-buffer has the bits that 16 and a fraction of 4 have.
    ShadedWithoutDepthMotion: Rgb888, Lanes { depth_bits: 20, depth_motion: false, ..EVERYTHING };
    /// The built-in `Shaded` without a tag.
    ShadedWithoutTag: Rgb888, Lanes { tag_bits: 0, ..EVERYTHING };
    /// The built-in `Shaded` without luminosity rate.
    ShadedWithoutLuminosity: Rgb888, Lanes { luminosity: false, ..EVERYTHING };
    /// The built-in `Flat565` without depth.
    Flat565WithoutDepth: Rgb565, Lanes { depth_bits: 0, depth_motion: false, ..Lanes::FULL };
    /// The built-in `Velocity565` that does not move.
    Velocity565WithoutVelocity: Rgb565, Lanes { velocity: false, ..Lanes::VELOCITY_XY };
    /// A z-buffer as deep as a record can have one.
    Deep: Gray8, Lanes { depth_bits: 28, ..Lanes::VELOCITY_XY };
}

/// The lanes of every built-in layout and of some more, with the bits of the colour.
#[must_use]
pub fn every_kind() -> Vec<(Lanes, u32)> {
    use galpix_core::layout::{Flat565, Full, Shaded, Still, Tagged, Velocity565, VelocityGray4, VelocityGray8};
    fn of<L: Layout>() -> (Lanes, u32) {
        (L::LANES, L::Colour::BITS)
    }
    vec![
        of::<Full>(),
        of::<Tagged>(),
        of::<Shaded>(),
        of::<Flat565>(),
        of::<Velocity565>(),
        of::<VelocityGray8>(),
        of::<VelocityGray4>(),
        of::<Still>(),
        of::<TinyPlane>(),
        of::<TinySlide>(),
        of::<TinyDepth>(),
        of::<TinyShaded>(),
        of::<ShadedWithoutAcceleration>(),
        of::<ShadedWithoutDepthMotion>(),
        of::<Flat565WithoutDepth>(),
        of::<Velocity565WithoutVelocity>(),
        of::<Deep>(),
    ]
}
