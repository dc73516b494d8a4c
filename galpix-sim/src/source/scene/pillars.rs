//! A hall of round pillars, past which the viewer walks sideways.

use super::Scene;
use super::jet::Path;
use super::solid::{Column, Lens, Plane};
use super::surface::Surface;
use super::texture::{Rgb, bricks, cell, checks, cover, gradient, hex, length, lit, mix, noise, rect, sign, stripes};

/// Scene `pillars`.
pub struct Pillars;

impl Scene for Pillars {
    fn name(&self) -> &'static str {
        "pillars"
    }

    fn about(&self) -> &'static str {
        "the viewer steps sideways past pillars: a velocity for each depth, disocclusion behind every edge"
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] = &[
            &wall_across(WALL, 0.0, 0.0, |_, v| v <= FLOOR + OVERLAP, back_wall),
            &Plane {
                lens: LENS,
                origin: [0.0, FLOOR, 0.0],
                u: [1.0, 0.0, 0.0],
                v: [0.0, 0.0, 1.0],
                shape: |_, z| z <= WALL + OVERLAP,
                paint: floor,
            },
            &pillar(-1.15, 3.9, 0.26, terracotta),
            &pillar(2.55, 5.2, 0.32, teal),
            &pillar(-0.55, 7.0, 0.34, ochre),
            &pillar(4.6, 8.0, 0.34, terracotta),
            &pillar(-4.3, 9.0, 0.34, teal),
            &pillar(1.9, 10.5, 0.34, plum),
            &wall_across(6.2, 0.75, FLOOR - 0.36, |u, v| u.abs() < 0.95 && v.abs() < 0.36, board),
        ];
        SURFACES
    }
}

/// World height of the floor; y points down.
const FLOOR: f64 = 1.3;

/// Distance of the back wall.
const WALL: f64 = 14.0;

/// Wall and floor end behind each other: so nothing is behind them that a hall does not have, and no gap is between
/// them.
const OVERLAP: f64 = 0.05;

/// The step sideways gives 2.8 pixels per frame at the nearest pillar, 0.8 at the back wall.
const LENS: &Lens = &Lens {
    focal: 170.0,
    centre: [95.5, 62.0],
    near: 2.0,
    eye: [Path::new(0.0, 0.064, 0.0), Path::still(0.0), Path::still(0.0)],
};

const fn pillar(x: f64, z: f64, radius: f64, paint: fn([f64; 3]) -> Rgb) -> Column {
    Column { lens: LENS, axis: [x, z], radius, reach: [-9.0, FLOOR], paint }
}

/// A wall that faces the viewer at distance `z`, with its origin at (`x`, `y`).
const fn wall_across(z: f64, x: f64, y: f64, shape: fn(f64, f64) -> bool, paint: fn(f64, f64) -> Rgb) -> Plane {
    Plane { lens: LENS, origin: [x, y, z], u: [1.0, 0.0, 0.0], v: [0.0, 1.0, 0.0], shape, paint }
}

fn back_wall(u: f64, v: f64) -> Rgb {
    let (u, v) = (u * 12.0, v * 12.0);
    let (brick, own) = bricks(u, v, 16.0, 8.0, 1);
    let stone = gradient([hex(0xb98f74), hex(0xd2aa88), hex(0xe8c8a2)], 0.6 * own + 0.4 * noise(u, v, 10.0, 2));
    let masonry = mix(hex(0x9a7660), stone, brick);
    // Arched windows: a box below, a half disc above, sky in them.
    let (_, inside) = cell(u + 20.0, 54.0);
    let (x, y) = (inside - 27.0, v + 16.0);
    let opening =
        |r: f64| cover(r - x.abs()).min(cover(18.0 - y)).min(if y < 0.0 { cover(r - length(x, y)) } else { 1.0 });
    let sky = gradient(
        [hex(0x4f8fc0), hex(0x8fc3dc), hex(0xf3ecd8)],
        (y + 14.0) / 34.0 + 0.5 * noise(u, 2.0 * v, 20.0, 3) - 0.3,
    );
    let bars = 1.0 - (1.0 - stripes(x + 1.0, 9.0, 2.0)) * (1.0 - stripes(y + 30.0, 11.0, 2.0));
    let framed = mix(masonry, hex(0xf0e0c4), opening(17.0));
    mix(framed, mix(sky, hex(0x50423c), bars), opening(14.0))
}

fn floor(u: f64, v: f64) -> Rgb {
    let marble = noise(u * 40.0, v * 40.0, 26.0, 4);
    let light = mix(hex(0xefe4d0), hex(0xcdb9a0), marble);
    let dark = mix(hex(0x5c4a58), hex(0x86707c), marble);
    // Far tiles are lower than two pixels: their contrast fades before they break up.
    mix(mix(light, dark, 0.5), mix(light, dark, checks(u * 32.0, v * 32.0, 32.0)), 1.7 - v / 8.0)
}

/// A pillar of two colours: broad bands that climb it, a base, soft light from the left.
fn pillared([x, y, z]: [f64; 3], colours: [Rgb; 2], seed: u32) -> Rgb {
    let texels = 34.0;
    let around = 9.0 * x;
    let band = stripes(y * texels + around, 16.0, 8.0);
    let stone = lit(mix(colours[0], colours[1], band), 0.85 + 0.3 * noise(around * 1.5, y * texels, 8.0, seed));
    let base = cover((y - FLOOR + 0.3) * texels);
    let ring = rect(0.0, (y - FLOOR + 0.42) * texels, 1.0, 2.0);
    lit(mix(mix(stone, lit(colours[0], 0.8), base), hex(0xf2e6cc), ring), 0.66 + 0.42 * (-0.66 * x - 0.75 * z).max(0.0))
}

fn terracotta(point: [f64; 3]) -> Rgb {
    pillared(point, [hex(0xb9502f), hex(0xf0a070)], 5)
}

fn teal(point: [f64; 3]) -> Rgb {
    pillared(point, [hex(0x1f6f78), hex(0x7cc4b8)], 6)
}

fn ochre(point: [f64; 3]) -> Rgb {
    pillared(point, [hex(0xc08a24), hex(0xf4d888)], 7)
}

fn plum(point: [f64; 3]) -> Rgb {
    pillared(point, [hex(0x6a3a64), hex(0xc090b4)], 8)
}

fn board(u: f64, v: f64) -> Rgb {
    let (u, v) = (u * 28.0, v * 28.0);
    let painted = mix(hex(0x27496d), hex(0x3a6a92), noise(u, v, 10.0, 9));
    mix(mix(hex(0xf3dfae), painted, rect(u, v, 24.6, 8.0)), hex(0xfdf3d8), sign(u, v, 1.2))
}
