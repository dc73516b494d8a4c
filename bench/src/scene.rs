//! A deterministic scene to measure on: things move in front of a background that comes nearer.
//!
//! The background, far away, grows by a hundredth in each frame, so that the forward warp tears cracks into it. Before
//! it 24 discs and rectangles slide by up to a hundredth of the width, so that they collide at their leading edges and
//! uncover slivers at their trailing ones. Lengths follow the width: the share of holes hardly depends on the size.
//! Each cell has its own place within the cell.

use galpix_core::Galpixel;
use galpix_core::fixed::types::I32F32;

/// How the scene moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Not at all.
    Still,
    /// Rigid things and a background.
    Scene,
    /// Every cell by its own velocity, up to two cells per frame in x and y: the worst case.
    Random,
}

impl Motion {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Still, Self::Scene, Self::Random];

    /// As in the names of benches.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Scene => "scene",
            Self::Random => "random",
        }
    }
}

/// One cell of the scene, in cells and frames; depth in parts of the range.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// Place within the cell.
    pub offset: [f32; 2],
    /// Nearer is smaller, 0 to 1.
    pub depth: f32,
    /// In x, y and depth.
    pub velocity: [f32; 3],
    /// In x, y and depth.
    pub acceleration: [f32; 3],
    /// Red, green and blue.
    pub colour: [u8; 3],
}

impl Sample {
    /// As the core takes it.
    pub fn galpixel(&self) -> Galpixel {
        Galpixel {
            colour: self.colour,
            offset: self.offset.map(I32F32::from_num),
            depth: I32F32::from_num(self.depth),
            velocity: self.velocity.map(I32F32::from_num),
            acceleration: self.acceleration.map(I32F32::from_num),
            ..Galpixel::default()
        }
    }
}

/// Returns a counter made into noise (the finaliser of SplitMix64).
fn noise(seed: u64, counter: u64) -> u64 {
    let mut bits = seed.wrapping_add(counter.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Returns the `index`th 16 bits of noise as a number of 0 to 1.
fn part(bits: u64, index: u32) -> f32 {
    (bits >> (16 * index) & 0xffff) as f32 / 65535.0
}

struct Thing {
    centre: [f32; 2],
    half: [f32; 2],
    depth: f32,
    velocity: [f32; 2],
    round: bool,
    tint: u64,
}

impl Thing {
    fn new(number: u64, width: f32, height: f32) -> Self {
        let (place, form, way) = (noise(11, number), noise(12, number), noise(13, number));
        Self {
            centre: [part(place, 0) * width, part(place, 1) * height],
            half: [(0.03 + 0.06 * part(form, 0)) * width, (0.03 + 0.06 * part(form, 1)) * width],
            depth: 0.06 + 0.3 * part(form, 2),
            velocity: [0, 1].map(|axis| (2.0 * part(way, axis) - 1.0) * width / 100.0),
            round: part(form, 3) < 0.5,
            tint: number + 1,
        }
    }

    fn covers(&self, x: f32, y: f32) -> bool {
        let [u, v] = [(x - self.centre[0]) / self.half[0], (y - self.centre[1]) / self.half[1]];
        if self.round { u * u + v * v < 1.0 } else { u.abs() < 1.0 && v.abs() < 1.0 }
    }
}

/// Checks of two sizes over a tint, with grain: enough for a picture, and no two neighbours alike.
fn texture(x: i32, y: i32, tint: u64) -> [u8; 3] {
    let base = noise(17, tint);
    let checks = ((x >> 5 ^ y >> 5) & 1) as u8 * 48 + ((x >> 2 ^ y >> 2) & 1) as u8 * 16;
    let grain = noise(tint, (x as u32 as u64) << 32 | y as u32 as u64);
    [0, 1, 2].map(|channel| 64 + (base >> (8 * channel)) as u8 / 4 + checks + (grain >> (8 * channel)) as u8 / 32)
}

/// Returns the scene's cells in raster order.
pub fn samples(width: u32, height: u32, motion: Motion) -> Vec<Sample> {
    let (w, h) = (width as f32, height as f32);
    let things: Vec<_> = (0..24).map(|number| Thing::new(number, w, h)).collect();
    let cells = (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| (x, y)));
    cells
        .map(|(x, y)| {
            let own = noise(19, (y as u64) << 32 | x as u64);
            let (from_left, from_top) = (x as f32 - 0.5 * w, y as f32 - 0.5 * h);
            let nearest = things
                .iter()
                .filter(|thing| thing.covers(x as f32, y as f32))
                .min_by(|one, other| one.depth.total_cmp(&other.depth));
            let mut sample = match nearest {
                None => Sample {
                    depth: 0.625 + 0.05 * y as f32 / h,
                    velocity: [0.01 * from_left, 0.01 * from_top, -0.006],
                    acceleration: [0.0001 * from_left, 0.0001 * from_top, 0.0],
                    colour: texture(x, y, 0),
                    ..Sample::default()
                },
                Some(thing) => Sample {
                    depth: thing.depth + 0.003 * (x as f32 - thing.centre[0]) / thing.half[0],
                    velocity: [thing.velocity[0], thing.velocity[1], 0.0003],
                    acceleration: [0.05 * thing.velocity[1], -0.05 * thing.velocity[0], 0.0],
                    colour: texture(x - thing.centre[0] as i32, y - thing.centre[1] as i32, thing.tint),
                    ..Sample::default()
                },
            };
            // Nearly alike among neighbours, so that what tears are cracks and not noise.
            let spread = if motion == Motion::Random { 1.0 } else { 0.02 };
            sample.offset = [0, 1].map(|axis| (part(own, axis) - 0.5) * spread);
            match motion {
                Motion::Still => (sample.velocity, sample.acceleration) = ([0.0; 3], [0.0; 3]),
                Motion::Scene => {}
                Motion::Random => {
                    let [vx, vy] = [2, 3].map(|axis| 4.0 * part(own, axis) - 2.0);
                    (sample.velocity, sample.acceleration) = ([vx, vy, 0.0], [0.0; 3]);
                }
            }
            sample
        })
        .collect()
}
