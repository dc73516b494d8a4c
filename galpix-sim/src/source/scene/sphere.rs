//! A beach ball that comes near.

use super::Scene;
use super::jet::Path;
use super::solid::{Globe, Lens, Plane};
use super::surface::Surface;
use super::texture::{Rgb, bricks, cell, checks, cover, gradient, hex, lit, mix, noise};

/// Scene `sphere`.
pub struct Sphere;

impl Scene for Sphere {
    fn name(&self) -> &'static str {
        "sphere"
    }

    fn about(&self) -> &'static str {
        "a beach ball comes near and grows by two thirds: bullet holes, and perspective beyond second order"
    }

    fn frames(&self) -> u32 {
        16
    }

    fn second_order(&self) -> bool {
        false
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] = &[
            &Plane {
                lens: LENS,
                origin: [0.0, 0.0, WALL],
                u: [1.0, 0.0, 0.0],
                v: [0.0, 1.0, 0.0],
                shape: |_, v| v <= FLOOR + OVERLAP,
                paint: wall,
            },
            &Plane {
                lens: LENS,
                origin: [0.0, FLOOR, 0.0],
                u: [1.0, 0.0, 0.0],
                v: [0.0, 0.0, 1.0],
                shape: |_, z| z <= WALL + OVERLAP,
                paint: floor,
            },
            &Globe {
                lens: LENS,
                centre: [Path::new(-1.15, 0.045, 0.0), Path::new(-0.05, 0.005, 0.0), Path::new(5.3, -0.13, 0.0)],
                radius: 1.0,
                paint: beach_ball,
            },
        ];
        SURFACES
    }
}

/// World height of the floor, and distance of the wall.
const FLOOR: f64 = 1.4;
const WALL: f64 = 12.0;

/// Wall and floor end behind each other: so nothing is behind them that a room does not have, and no gap is between
/// them.
const OVERLAP: f64 = 0.05;

const LENS: &Lens = &Lens {
    focal: 170.0,
    centre: [95.5, 52.5],
    near: 1.5,
    eye: [Path::still(0.0), Path::still(0.0), Path::still(0.0)],
};

fn wall(u: f64, v: f64) -> Rgb {
    let (u, v) = (u * 14.0, v * 14.0);
    let plaster = gradient([hex(0x86b4c4), hex(0x9cc6cf), hex(0xb9dad8)], noise(u, v, 22.0, 1));
    let (brick, own) = bricks(u, v, 18.0, 9.0, 2);
    let bare = cover((noise(u, v, 44.0, 3) - 0.58) * 30.0);
    mix(plaster, mix(hex(0xd8cdb8), lit(hex(0xc98a6a), 0.85 + 0.3 * own), brick), bare)
}

fn floor(u: f64, v: f64) -> Rgb {
    let sand = gradient([hex(0xd6b98a), hex(0xe6cfa2), hex(0xf2e2bd)], noise(u * 30.0, v * 30.0, 14.0, 4));
    mix(sand, lit(sand, 0.78), checks(u * 40.0 + 20.0, v * 40.0, 40.0))
}

/// Gores that meet at a pole which is tilted towards the viewer, a cap, and a shade of light from the left.
fn beach_ball([x, y, z]: [f64; 3]) -> Rgb {
    // The ball's own axes; `up` points to the pole.
    const UP: [f64; 3] = [0.36, -0.80, -0.48];
    const EAST: [f64; 3] = [0.911_921_505, 0.410_364_678, 0.0];
    const SOUTH: [f64; 3] = [0.196_975_045, -0.437_722_323, 0.877_266_883];
    let along = |axis: [f64; 3]| axis[0] * x + axis[1] * y + axis[2] * z;
    let (up, east, south) = (along(UP), along(EAST), along(SOUTH));
    let gore = (south.atan2(east) / std::f64::consts::TAU + 0.5) * 8.0;
    let texels = 42.0;
    let around = texels * (east * east + south * south).sqrt();
    let soft = |from: f64| cover((gore - from).min(from + 1.0 - gore) * around);
    let fine = noise(texels * east, texels * (south + 0.7 * up), 9.0, 7);
    const INKS: [Rgb; 4] = [hex(0xe4483c), hex(0x2c78b8), hex(0xf2b134), hex(0x3f9a6c)];
    let white = hex(0xf6efe0);
    let painted = INKS.iter().zip([0.0, 2.0, 4.0, 6.0]).fold(white, |under, (&ink, from)| mix(under, ink, soft(from)));
    let belt = cover((0.09 - (up - 0.05).abs()) * texels);
    let (_, within) = cell(gore, 1.0);
    let seam = cover(0.9 - within.min(1.0 - within) * around);
    let stitched = mix(painted, hex(0x23405c), 0.7 * seam);
    let cap = cover((up - 0.93) * texels * 2.5);
    let banded = mix(stitched, mix(hex(0x23405c), hex(0xf2b134), checks(gore * 24.0, 0.5, 6.0)), belt);
    let light = 0.62 + 0.42 * (-0.55 * x - 0.62 * y - 0.56 * z).max(0.0);
    lit(mix(banded, hex(0x23405c), cap), light * (0.93 + 0.14 * fine))
}
