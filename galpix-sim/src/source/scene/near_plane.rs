//! A flight low along a corridor.

use super::Scene;
use super::jet::Path;
use super::solid::{Column, Lens, Plane};
use super::surface::Surface;
use super::texture::{Rgb, cell, checks, cover, dot, gradient, hash, hex, lit, mix, noise, rect, sign, stripes};
use crate::update::Margin;

/// Scene `near-plane`.
pub struct NearPlane;

impl Scene for NearPlane {
    fn name(&self) -> &'static str {
        "near-plane"
    }

    fn about(&self) -> &'static str {
        "a flight low over a corridor's floor, close to the near plane: 1/z, stretched surfaces, beyond second order"
    }

    fn margin(&self) -> Margin {
        Margin::all(8)
    }

    fn frames(&self) -> u32 {
        16
    }

    fn second_order(&self) -> bool {
        false
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const X: [f64; 3] = [1.0, 0.0, 0.0];
        const Y: [f64; 3] = [0.0, 1.0, 0.0];
        const Z: [f64; 3] = [0.0, 0.0, 1.0];
        const SURFACES: &[&dyn Surface] = &[
            &Plane {
                lens: LENS,
                origin: [0.0, 0.0, END],
                u: X,
                v: Y,
                shape: |u, v| u.abs() <= HALF_WIDTH && (CEILING..=FLOOR).contains(&v),
                paint: end,
            },
            &Plane { lens: LENS, origin: [0.0, FLOOR, 0.0], u: X, v: Z, shape: level, paint: floor },
            &Plane { lens: LENS, origin: [0.0, CEILING, 0.0], u: X, v: Z, shape: level, paint: ceiling },
            &Plane { lens: LENS, origin: [-HALF_WIDTH, 0.0, 0.0], u: Z, v: Y, shape: in_corridor, paint: left },
            &Plane { lens: LENS, origin: [HALF_WIDTH, 0.0, 0.0], u: Z, v: Y, shape: in_corridor, paint: right },
            &Column { lens: LENS, axis: [0.62, 2.45], radius: 0.11, reach: [CEILING, FLOOR], paint: post },
            &Column { lens: LENS, axis: [-0.85, 4.4], radius: 0.13, reach: [CEILING, FLOOR], paint: post },
        ];
        SURFACES
    }
}

// No ratio of two of these is one of half-integers, so that no pixel lies exactly on an edge of the corridor.
const FLOOR: f64 = 0.7;
const CEILING: f64 = -1.31;
const HALF_WIDTH: f64 = 1.507;
const END: f64 = 8.5;

/// Floor and ceiling end a little behind the walls: no gap is between them, and nothing is behind the walls.
fn level(x: f64, z: f64) -> bool {
    z <= END && x.abs() <= HALF_WIDTH + 0.05
}

fn in_corridor(z: f64, y: f64) -> bool {
    z <= END && (CEILING..=FLOOR).contains(&y)
}

/// The lowest row of the margin sees the floor at distance 1.06, just behind the near plane; in 16 frames the nearer
/// post comes from 2.3 to 1.4.
const LENS: &Lens = &Lens {
    focal: 120.0,
    centre: [95.5, 71.5],
    near: 1.0,
    eye: [Path::new(0.0, 0.008, 0.0), Path::still(0.0), Path::new(0.0, 0.05, 0.001)],
};

/// How much of a pattern is left at world distance `z`: it fades before it gets finer than pixels. The fading belongs
/// to the surface, so it does not change as the viewer comes nearer.
fn contrast(z: f64) -> f64 {
    ((6.5 - z) / 3.0).clamp(0.0, 1.0)
}

fn floor(u: f64, z: f64) -> Rgb {
    let fine = noise(u * 60.0, z * 60.0, 24.0, 1);
    let light = mix(hex(0xd8c8a8), hex(0xb8a484), fine);
    let dark = mix(hex(0x2f5666), hex(0x47788a), fine);
    let tiles = mix(light, dark, checks(u * 50.0 + 25.0, z * 50.0, 50.0));
    let runner = mix(hex(0xa83a34), hex(0xc85a48), fine);
    let ((_, x), (_, y)) = (cell(u * 50.0 + 12.5, 25.0), cell(z * 50.0, 25.0));
    let laid = mix(runner, hex(0xf0c878), dot(x - 12.5, y - 12.5, 6.0).max(cover(3.0 - (u.abs() * 50.0 - 20.0).abs())));
    let mean = mix(light, dark, 0.5);
    lit(
        mix(mix(mean, tiles, contrast(z)), mix(runner, laid, contrast(z)), cover((0.46 - u.abs()) * 50.0)),
        1.1 - 0.05 * z,
    )
}

fn ceiling(u: f64, z: f64) -> Rgb {
    let board = gradient([hex(0x5a3c2c), hex(0x74503a), hex(0x8c6648)], noise(u * 60.0, z * 12.0, 10.0, 2));
    let beam = stripes(z * 50.0, 50.0, 14.0) * contrast(z);
    let lamp = dot(u * 50.0, cell(z * 50.0, 100.0).1 - 62.0, 11.0) * (0.3 + 0.7 * contrast(z));
    lit(mix(mix(board, hex(0x3c261c), beam), hex(0xfff0c0), lamp), 1.1 - 0.05 * z)
}

/// Panelling below, paper above, a picture in every bay.
fn wall(z: f64, y: f64, seed: u32, paper: [Rgb; 3]) -> Rgb {
    let (u, v) = (z * 50.0, y * 50.0);
    let hung = gradient(paper, noise(u, v, 16.0, seed));
    let lined = mix(hung, lit(hung, 0.86), stripes(u, 12.0, 6.0) * contrast(z));
    let (bay, x) = cell(u + 8.0, 62.0);
    let (x, v_picture) = (x - 31.0, v + 20.0);
    let own = |n| hash(bay, n, seed);
    let picture = gradient(
        [hex(0x2c5a7c), mix(hex(0xe0b060), hex(0xd07a5a), own(0)), hex(0x4a7a4c)],
        0.3 + v_picture / 34.0 + 0.5 * noise(u, v, 14.0, seed ^ 3),
    );
    let framed = mix(hex(0xd8aa4c), picture, rect(x, v_picture, 15.0, 15.0));
    let papered = mix(lined, framed, rect(x, v_picture, 19.0, 19.0));
    let wood = mix(hex(0x6a4630), hex(0x8a6040), noise(u * 0.4, v, 6.0, seed ^ 5));
    let panel = mix(wood, lit(wood, 1.3), contrast(z) * rect(cell(u, 31.0).1 - 15.5, v - 24.0, 11.0, 8.0));
    let rail = mix(papered, panel, cover(v - 9.0));
    lit(mix(rail, hex(0xe8d8b4), cover(1.8 - (v - 9.0).abs())), 1.1 - 0.055 * z)
}

fn left(z: f64, y: f64) -> Rgb {
    wall(z, y, 3, [hex(0x6a9a8c), hex(0x84b09c), hex(0xa0c4ac)])
}

fn right(z: f64, y: f64) -> Rgb {
    wall(z, y, 4, [hex(0xb88a6c), hex(0xcca484), hex(0xdcbc9c)])
}

fn end(u: f64, v: f64) -> Rgb {
    let (u, v) = (u * 20.0, v * 20.0);
    let plaster = mix(hex(0xa08c6c), hex(0xc0aa84), noise(u, v, 8.0, 6));
    let door = mix(hex(0x2c5648), hex(0x447a64), checks(u, v - 14.0, 6.0));
    let opened = mix(mix(plaster, hex(0xf0e2c0), rect(u, v - 2.0, 9.5, 14.0)), door, rect(u, v - 2.0, 7.5, 12.0));
    mix(opened, hex(0x503828), sign(u, v + 19.0, 0.9))
}

fn post([x, y, z]: [f64; 3]) -> Rgb {
    let v = y * 60.0;
    let white = mix(hex(0xf4ead4), hex(0xdccdb0), noise(x * 20.0, v, 8.0, 7));
    let banded = mix(white, hex(0xd0503c), stripes(v + 8.0 * x, 24.0, 12.0));
    lit(banded, 0.62 + 0.46 * (0.5 * x - 0.86 * z).max(0.0))
}
