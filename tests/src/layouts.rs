//! Layouts that the product does not need: tiny ones, whose states can be enumerated, and neighbours of the built-in
//! ones that lack a field.

use galpix_core::{Colour, Layout};

/// Motion in the plane, class and 4 bits of colour.
pub const TINY_PLANE: Layout = Layout { colour: Colour::GRAY4, depth_bits: 0, depth_motion: false, ..Layout::FULL };
/// Motion in the plane without acceleration.
pub const TINY_SLIDE: Layout = Layout { acceleration: false, ..TINY_PLANE };
/// Motion in depth over a z-buffer of 3 bits and a fraction.
pub const TINY_DEPTH: Layout = Layout { depth_bits: 3, depth_motion: true, ..TINY_PLANE };
/// Motion in the plane before a z-buffer of 2 bits.
pub const TINY_DEEP: Layout = Layout { depth_bits: 2, ..TINY_PLANE };
/// The same without acceleration.
pub const TINY_DEEP_SLIDE: Layout = Layout { acceleration: false, ..TINY_DEEP };
/// Shading inertia of 4 bits of gray.
pub const TINY_SHADED: Layout = Layout { colour: Colour::GRAY4, luminosity: true, ..Layout::STILL };
/// Shading inertia where one channel is wider than the others.
pub const SHADED565: Layout = Layout { colour: Colour::RGB565, ..TINY_SHADED };
/// `Layout::SHADED` without acceleration.
pub const SHADED_WITHOUT_ACCELERATION: Layout = Layout { acceleration: false, ..Layout::SHADED };
/// `Layout::SHADED` without motion in depth; its z-buffer has the bits that 16 and a fraction of 4 have.
pub const SHADED_WITHOUT_DEPTH_MOTION: Layout = Layout { depth_bits: 20, depth_motion: false, ..Layout::SHADED };
/// `Layout::SHADED` without a tag.
pub const SHADED_WITHOUT_TAG: Layout = Layout { tag_bits: 0, ..Layout::SHADED };
/// `Layout::SHADED` without luminosity rate.
pub const SHADED_WITHOUT_LUMINOSITY: Layout = Layout { luminosity: false, ..Layout::SHADED };
/// `Layout::FLAT565` without depth.
pub const FLAT565_WITHOUT_DEPTH: Layout = Layout { depth_bits: 0, ..Layout::FLAT565 };
/// `Layout::VELOCITY565` that does not move.
pub const VELOCITY565_WITHOUT_VELOCITY: Layout = Layout { velocity: false, ..Layout::VELOCITY565 };
/// A z-buffer as deep as a record can have one.
pub const DEEP: Layout = Layout { colour: Colour::GRAY8, depth_bits: 28, ..Layout::VELOCITY565 };

/// Returns every built-in layout and those above that a map of the built-in scenes can have.
#[must_use]
pub fn every_kind() -> Vec<Layout> {
    vec![
        Layout::FULL,
        Layout::TAGGED,
        Layout::SHADED,
        Layout::FLAT565,
        Layout::VELOCITY565,
        Layout::VELOCITY_GRAY8,
        Layout::VELOCITY_GRAY4,
        Layout::STILL,
        TINY_PLANE,
        TINY_SLIDE,
        TINY_DEPTH,
        TINY_SHADED,
        SHADED_WITHOUT_ACCELERATION,
        SHADED_WITHOUT_DEPTH_MOTION,
        FLAT565_WITHOUT_DEPTH,
        VELOCITY565_WITHOUT_VELOCITY,
        DEEP,
    ]
}
