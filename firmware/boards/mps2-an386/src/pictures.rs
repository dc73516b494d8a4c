//! What is measured on: one scene of surfaces, moved in five ways.
//!
//! A slanted background, textured, and 12 discs and rectangles before it at depths of their own.

use fixed::types::I32F32;
use galpix_core::{Class, Format, Galpixel, Galpixmap};

/// A way to move.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Picture {
    /// Not at all.
    Still,
    /// All by one velocity.
    Pan,
    /// From the middle outwards, by a hundredth of the distance.
    Zoom,
    /// The background pans and comes nearer, each thing moves and turns its own way: the realistic one.
    Layers,
    /// Every galpixel by a motion and at a depth of its own, up to two cells a frame.
    Chaos,
    /// Nothing moves, and all of it is equally far away: as little work as there can be, for constant time.
    Flat,
    /// Every other cell by chance is empty, the others move together, for constant time.
    Holes,
    /// Nothing moves, and beside each thing a crescent was just uncovered, for push-pull.
    Torn,
}

/// A disc or a rectangle.
#[derive(Clone, Copy)]
struct Thing {
    centre: [i32; 2],
    half: [i32; 2],
    round: bool,
    number: u32,
    depth: I32F32,
    velocity: [I32F32; 3],
    acceleration: [I32F32; 3],
    luminosity_rate: I32F32,
}

const THINGS: u32 = 12;

/// Columns of a crescent.
const CRESCENT: i32 = 12;

/// The background pans and comes nearer. As constants, for they are read from text.
const BACKGROUND: [I32F32; 3] = [I32F32::lit("-0.8"), I32F32::lit("0.3"), I32F32::lit("-0.002")];

/// The background's upper end.
const FAR: I32F32 = I32F32::lit("0.7");

const PAN: [I32F32; 3] = [I32F32::lit("1.3"), I32F32::lit("0.4"), I32F32::ZERO];

/// A counter made into noise (the finaliser of MurmurHash3).
fn noise(seed: u32, counter: u32) -> u32 {
    let mut bits = counter ^ seed.wrapping_mul(0x9e37_79b9);
    bits = (bits ^ bits >> 16).wrapping_mul(0x85eb_ca6b);
    bits = (bits ^ bits >> 13).wrapping_mul(0xc2b2_ae35);
    bits ^ bits >> 16
}

/// Noise in `-1 .. 1`, times a power of two.
fn swing(seed: u32, counter: u32, power: i32) -> I32F32 {
    I32F32::from_bits(i64::from(noise(seed, counter) as i32) << 33 >> (32 - power))
}

/// Noise in `0 .. count`.
fn below(seed: u32, counter: u32, count: u32) -> i32 {
    (((noise(seed, counter) >> 16) * count) >> 16) as i32
}

/// A number of `thousandths`.
fn thousandths(number: i32) -> I32F32 {
    I32F32::from_num(number) / 1000
}

impl Thing {
    fn new(number: u32, width: i32, height: i32) -> Self {
        let velocity = [swing(4, number, 1), swing(5, number, 1), thousandths(below(6, number, 7) - 3) / 8];
        Self {
            centre: [below(1, number, width as u32), below(2, number, height as u32)],
            half: [width / 32 + below(7, number, width as u32 / 16), width / 32 + below(8, number, width as u32 / 16)],
            round: number & 1 == 0,
            number,
            depth: thousandths(60 + below(3, number, 300)),
            velocity,
            acceleration: [velocity[1] / 32, -velocity[0] / 32, I32F32::ZERO],
            luminosity_rate: swing(9, number, 1),
        }
    }

    fn covers(&self, x: i32, y: i32) -> bool {
        let ([dx, dy], [w, h]) = ([x - self.centre[0], y - self.centre[1]], self.half);
        let within = dx.abs() < w && dy.abs() < h;
        within && (!self.round || dx * dx * h * h + dy * dy * w * w < w * w * h * h)
    }
}

/// Checks of two sizes in a tint, with grain.
fn texture(x: i32, y: i32, tint: u32) -> [u8; 3] {
    let (base, grain) = (noise(17, tint), noise(x as u32, y as u32 ^ tint << 16));
    let checks = ((x >> 5 ^ y >> 5) & 1) * 48 + ((x >> 2 ^ y >> 2) & 1) * 16;
    [0, 8, 16].map(|channel| (64 + (base >> channel & 63) as i32 + checks + (grain >> channel & 7) as i32) as u8)
}

impl Picture {
    /// Those that are measured stage by stage.
    pub const ALL: [Self; 5] = [Self::Still, Self::Pan, Self::Zoom, Self::Layers, Self::Chaos];

    /// Those that constant time is held to beside them.
    pub const EXTREMES: [Self; 2] = [Self::Flat, Self::Holes];

    /// As in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Pan => "pan",
            Self::Zoom => "zoom",
            Self::Layers => "layers",
            Self::Chaos => "chaos",
            Self::Flat => "flat",
            Self::Holes => "holes",
            Self::Torn => "torn",
        }
    }

    /// Shows every galpixel of a picture of this size, in raster order.
    pub fn each(self, width: i32, height: i32, mut show: impl FnMut(i32, i32, Galpixel)) {
        let things: [Thing; THINGS as usize] = core::array::from_fn(|number| Thing::new(number as u32, width, height));
        for y in 0..height {
            for x in 0..width {
                let covering = things.iter().filter(|thing| thing.covers(x, y));
                let mut galpixel = match covering.min_by_key(|thing| thing.depth) {
                    Some(thing) => Galpixel {
                        colour: texture(x - thing.centre[0], y - thing.centre[1], thing.number + 1),
                        depth: thing.depth,
                        tag: thing.number + 1,
                        velocity: thing.velocity,
                        acceleration: thing.acceleration,
                        luminosity_rate: thing.luminosity_rate,
                        ..Galpixel::default()
                    },
                    None => Galpixel {
                        colour: texture(x, y, 0),
                        depth: FAR + I32F32::from_bits(i64::from(y) << 20),
                        velocity: BACKGROUND,
                        ..Galpixel::default()
                    },
                };
                let uncovered = |thing: &Thing| {
                    galpixel.depth > thing.depth && thing.covers(x - CRESCENT, y) && !thing.covers(x, y)
                };
                if self == Self::Torn && things.iter().any(uncovered) {
                    galpixel.class = Class::JustUnobscured;
                }
                self.set_in_motion([x, y], [width, height], &mut galpixel);
                show(x, y, galpixel);
            }
        }
    }

    fn set_in_motion(self, [x, y]: [i32; 2], [width, height]: [i32; 2], galpixel: &mut Galpixel) {
        const HUNDREDTH: i64 = (1 << 32) / 100;
        let (still, cell) = ([I32F32::ZERO; 3], (y as u32) << 16 | x as u32);
        if self != Self::Layers {
            (galpixel.velocity, galpixel.acceleration, galpixel.luminosity_rate) = (still, still, I32F32::ZERO);
        }
        let outwards = |place: i32, middle: i32| I32F32::from_bits(i64::from(place - middle) * HUNDREDTH);
        match self {
            Self::Still | Self::Layers | Self::Torn => {}
            Self::Pan => galpixel.velocity = PAN,
            Self::Zoom => galpixel.velocity = [outwards(x, width / 2), outwards(y, height / 2), I32F32::ZERO],
            Self::Flat => galpixel.depth = FAR,
            Self::Holes => {
                let hole = noise(29, cell) & 1 == 0;
                galpixel.class = if hole { Class::Empty } else { Class::Galpixel };
                galpixel.velocity = PAN;
            }
            Self::Chaos => {
                let own = |seed: u32, power: i32| swing(seed, cell, power);
                galpixel.velocity = [own(21, 1), own(22, 1), own(23, -7)];
                galpixel.acceleration = [own(24, -3), own(25, -3), own(26, -9)];
                galpixel.depth = own(27, 0).abs();
                galpixel.luminosity_rate = own(28, 2);
            }
        }
    }

    /// Writes the picture into a map.
    pub fn paint<F: Format>(self, map: &mut Galpixmap<'_, F>) {
        let (width, height) = (map.grid().width() as i32, map.grid().height() as i32);
        self.each(width, height, |x, y, galpixel| {
            map.store(x, y, &galpixel);
        });
    }
}
