//! Pictures that ask for as little or as much of an engine as there is: what constant time is held to.

use galpix_core::fixed::types::I32F32;
use galpix_core::{Class, Format, Galpixel, Galpixmap};

/// A picture by what makes it hard, or easy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Picture {
    /// A full map, nothing moves.
    Still,
    /// Nothing at all.
    Empty,
    /// Every galpixel wants the cell in the middle, the later the nearer.
    OneCell,
    /// Each galpixel has its own velocity and depth.
    Random,
    /// Neighbours move in opposite directions.
    Checkerboard,
    /// Every other cell is empty, by chance; what is there moves together.
    HalfHoles,
    /// Every galpixel leaves the map.
    OffScreen,
    /// Every field is at its end and moves on.
    Saturating,
    /// A plane that zooms, behind a thing that slides: cracks, collisions, and what was just unobscured.
    Zoom,
    /// Debris and what was just unobscured, among galpixels.
    Debris,
    /// Every field of every galpixel by chance.
    Arbitrary,
}

impl Picture {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Still,
        Self::Empty,
        Self::OneCell,
        Self::Random,
        Self::Checkerboard,
        Self::HalfHoles,
        Self::OffScreen,
        Self::Saturating,
        Self::Zoom,
        Self::Debris,
        Self::Arbitrary,
    ];

    /// As in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Still => "still",
            Self::Empty => "empty",
            Self::OneCell => "all to one cell",
            Self::Random => "random",
            Self::Checkerboard => "checkerboard",
            Self::HalfHoles => "half holes",
            Self::OffScreen => "all off screen",
            Self::Saturating => "saturating",
            Self::Zoom => "zoom",
            Self::Debris => "debris",
            Self::Arbitrary => "arbitrary words",
        }
    }

    /// Writes the picture into all cells of a map, margin included.
    pub fn paint<F: Format>(self, map: &mut Galpixmap<'_, F>) {
        let (width, height) = (map.grid().width() as i32, map.grid().height() as i32);
        for y in 0..height {
            for x in 0..width {
                map.store(x, y, &self.galpixel(x, y, width, height));
            }
        }
    }

    fn galpixel(self, x: i32, y: i32, width: i32, height: i32) -> Galpixel {
        let own = noise((y as u64) << 32 | x as u64);
        let part = |index: u32| I32F32::from_bits((own >> (16 * index) & 0xffff) as i64) << 16;
        let number = I32F32::from_num::<i32>;
        let (half, far, near) = (I32F32::lit("0.5"), I32F32::lit("0.75"), I32F32::lit("0.25"));
        let plane = Galpixel { colour: [x as u8, y as u8, own as u8], depth: far, ..Galpixel::default() };
        match self {
            Self::Still => plane,
            Self::Empty => Galpixel { class: Class::Empty, ..plane },
            Self::OneCell => {
                let nearer = far - (number(y) + (number(x) >> 8)) / i64::from(height.max(2) * 2);
                let velocity = [number(width / 2 - x), number(height / 2 - y), I32F32::ZERO];
                Galpixel { velocity, depth: nearer, ..plane }
            }
            Self::Random => {
                let velocity = [(part(0) - half) * 4, (part(1) - half) * 4, (part(2) - half) / 64];
                let acceleration = [(part(3) - half) / 4, (part(2) - half) / 4, I32F32::ZERO];
                let offset = [part(1) - half, part(0) - half];
                Galpixel {
                    velocity,
                    acceleration,
                    offset,
                    depth: part(3),
                    luminosity_rate: (part(0) - half) * 8,
                    ..plane
                }
            }
            Self::Checkerboard => {
                let velocity = number(1 - ((x ^ y) & 1) * 2);
                Galpixel {
                    velocity: [velocity, velocity, I32F32::ZERO],
                    depth: if velocity > 0 { near } else { far },
                    ..plane
                }
            }
            Self::HalfHoles => {
                let class = if own & 1 == 0 { Class::Empty } else { Class::Galpixel };
                Galpixel { class, velocity: [half, -half, I32F32::ZERO], ..plane }
            }
            Self::OffScreen => Galpixel { velocity: [number(-2 * width), number(height), I32F32::ZERO], ..plane },
            Self::Saturating => {
                let most = number(1 << 20);
                let ends = [0, 1, 2].map(|axis| if own >> axis & 1 == 0 { most } else { -most });
                let depth = if own >> 2 & 1 == 0 { I32F32::ONE } else { I32F32::ZERO };
                let colour = [255 * (own & 1) as u8; 3];
                Galpixel { velocity: ends, acceleration: ends, depth, colour, luminosity_rate: ends[0], ..plane }
            }
            Self::Zoom => {
                let (from_left, from_top) = (number(x) - number(width) * half, number(y) - number(height) * half);
                let thing = (x - width / 3).abs() < width / 6 && (y - height / 2).abs() < height / 5;
                if thing {
                    let velocity = [I32F32::lit("1.5"), half, I32F32::ZERO];
                    return Galpixel { velocity, depth: near, tag: 1, ..plane };
                }
                Galpixel { velocity: [from_left / 16, from_top / 16, -near / 256], ..plane }
            }
            Self::Debris => {
                let class = Class::from_bits((own >> 8) as u32);
                Galpixel { class, velocity: [near, half, I32F32::ZERO], ..plane }
            }
            Self::Arbitrary => Galpixel {
                class: Class::from_bits((own >> 8) as u32),
                colour: [own as u8, (own >> 8) as u8, (own >> 16) as u8],
                offset: [part(0) - half, part(1) - half],
                depth: part(2),
                velocity: [0, 1, 2].map(|axis| (part(axis) - half) * 4096),
                acceleration: [1, 2, 3].map(|axis| (part(axis) - half) * 1024),
                luminosity_rate: part(3) * 64,
                tag: own as u32,
            },
        }
    }
}

/// A counter made into noise (the finaliser of SplitMix64).
fn noise(counter: u64) -> u64 {
    let mut bits = counter.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x0123_4567_89ab_cdef);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}
