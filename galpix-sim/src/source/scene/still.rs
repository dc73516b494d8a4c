//! A landscape at sunset in which nothing moves.

use super::Scene;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, cover, dot, gradient, hex, length, lit, mix, noise, rect, stripes};

/// Scene `still`.
pub struct Still;

impl Scene for Still {
    fn name(&self) -> &'static str {
        "still"
    }

    fn about(&self) -> &'static str {
        "a landscape at rest: no cell may change, and a skipping engine has nothing to do"
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] = &[
            &Card::still(0.95, everywhere, sky),
            &Card::still(0.8, |u, v| v > mountain(u), mountains),
            &Card::still(0.6, |u, v| v > hill(u), hills),
            &Card::still(0.35, |u, v| v > meadow(u), meadows),
        ];
        SURFACES
    }
}

/// Height of the skylines, in pixels from the top.
fn mountain(u: f64) -> f64 {
    84.0 - 52.0 * noise(u, 0.0, 46.0, 1)
}

fn hill(u: f64) -> f64 {
    102.0 - 26.0 * noise(u, 0.0, 80.0, 2)
}

fn meadow(u: f64) -> f64 {
    126.0 - 24.0 * noise(u, 0.0, 120.0, 3)
}

fn sky(u: f64, v: f64) -> Rgb {
    let air = gradient([hex(0x31477d), hex(0xc9798f), hex(0xffd49a)], v / 84.0);
    let clouds = cover((noise(u, 3.2 * v, 64.0, 4) - 0.56) * 12.0);
    let clouded = mix(air, hex(0xffe6cc), 0.55 * clouds);
    let glow = mix(clouded, hex(0xfff0b8), 0.7 - length(u - 136.0, v - 36.0) / 60.0);
    mix(glow, hex(0xfffbe0), dot(u - 136.0, v - 36.0, 11.0))
}

fn mountains(u: f64, v: f64) -> Rgb {
    let rock = gradient([hex(0x4a4a78), hex(0x6c5f8c), hex(0x8d779c)], noise(u + 0.6 * v, v, 22.0, 5));
    let snow = cover((mountain(u) + 9.0 - v) * 0.5 + 5.0 * noise(u, v, 9.0, 6) - 3.0);
    mix(rock, hex(0xf4dfe0), 0.85 * snow)
}

fn hills(u: f64, v: f64) -> Rgb {
    let forest = gradient([hex(0x1f4a50), hex(0x2f6a5c), hex(0x4b8a66)], noise(u, v, 7.0, 7));
    lit(forest, 1.1 - 0.012 * (v - hill(u)))
}

fn meadows(u: f64, v: f64) -> Rgb {
    let grass = gradient([hex(0x4c8a3a), hex(0x79ad45), hex(0xb4cc5c)], noise(u, 2.0 * v, 24.0, 8));
    let below = v - meadow(u);
    let field = mix(
        grass,
        hex(0x5c7a2c),
        0.6 * stripes(u * 0.5 + 1.7 * below, 7.0, 3.0) * cover(0.7 * (u - 100.0 - 0.8 * below)),
    );
    let (x, y) = (u - 52.3, v - 127.4);
    let walled = mix(field, mix(hex(0xf3e4c8), hex(0x6b4a3a), stripes(x, 9.0, 3.4)), rect(x, y, 16.0, 8.0));
    let gable = cover(y + 17.0 - 0.55 * x.abs()) * cover(-7.0 - y);
    mix(walled, mix(hex(0xb6452f), hex(0x8c2f25), stripes(y, 4.0, 2.0)), gable)
}
