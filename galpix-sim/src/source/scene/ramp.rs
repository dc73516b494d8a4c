//! A gallery in which the light changes.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, checks, cover, dot, gradient, hex, length, mix, noise, rect, sign, stripes};

/// Scene `ramp`.
pub struct Ramp;

impl Scene for Ramp {
    fn name(&self) -> &'static str {
        "ramp"
    }

    fn about(&self) -> &'static str {
        "light wanders over a gallery and its pictures: shading inertia, on surfaces that rest or hardly move"
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const WALL: Card = Card { rate: |u, v| 1.1 - 0.009 * u - 0.003 * v, ..Card::still(0.8, everywhere, wall) };
        const LEFT: Card = Card { rate: |_, _| 1.5, ..hung([Path::still(38.3), Path::still(54.6)], 0.6, sea) };
        const MIDDLE: Card = Card {
            rate: |u, v| 1.75 - 0.05 * length(u, v),
            ..hung([Path::new(92.4, 0.31, 0.0), Path::still(58.7)], 0.5, target)
        };
        const RIGHT: Card = Card {
            rate: |u, _| -1.0 - 0.02 * u,
            ..hung([Path::still(157.8), Path::new(53.2, 0.11, 0.006)], 0.4, board)
        };
        const SURFACES: &[&dyn Surface] = &[&WALL, &LEFT, &MIDDLE, &RIGHT];
        SURFACES
    }
}

const HALF: [f64; 2] = [25.0, 31.0];

const fn hung(origin: [Path; 2], depth: f64, paint: fn(f64, f64) -> Rgb) -> Card {
    Card::new(origin, depth, |u, v| u.abs() < HALF[0] && v.abs() < HALF[1], paint)
}

/// Paper with a fine stripe above, panelling below. No channel so dark or bright that the light could drive it to its
/// end.
fn wall(u: f64, v: f64) -> Rgb {
    let paper = gradient([hex(0x7c6a8c), hex(0x8c7a98), hex(0xa08ea8)], noise(u, v, 26.0, 1));
    let striped = mix(paper, hex(0xb4a0b4), 0.35 * stripes(u, 12.0, 5.0));
    let wood = gradient([hex(0x6e5648), hex(0x84684f), hex(0x9c7c5c)], noise(0.3 * u, v, 6.0, 2));
    let panel =
        mix(wood, hex(0xae8e6c), 0.5 * rect(super::texture::cell(u + 9.0, 34.0).1 - 17.0, v - 125.0, 12.0, 12.0));
    mix(mix(striped, panel, cover(v - 104.0)), hex(0xc4b090), cover(2.5 - (v - 104.0).abs()))
}

fn framed(u: f64, v: f64, picture: Rgb) -> Rgb {
    let gold = mix(hex(0xa07c3c), hex(0xc8a458), noise(u, v, 5.0, 3));
    let groove = mix(gold, hex(0x7c5c2c), cover(1.2 - (HALF[0] - u.abs()).min(HALF[1] - v.abs()).min(9.0) + 1.5));
    mix(groove, picture, rect(u, v, HALF[0] - 5.0, HALF[1] - 5.0))
}

fn sea(u: f64, v: f64) -> Rgb {
    let sky = gradient([hex(0x5c7ca0), hex(0x9c94a0), hex(0xc49c84)], (v + 26.0) / 28.0);
    let sunny = mix(sky, hex(0xcdb890), dot(u - 4.0, v + 8.0, 7.0));
    let water = mix(hex(0x385c74), hex(0x7c98a0), noise(u, 3.0 * v, 14.0, 4));
    let sail = cover(1.1 * (u + 8.0)) * cover(12.0 + 0.9 * v - (u + 8.0)).min(cover(6.0 - v));
    framed(u, v, mix(mix(sunny, water, cover(v - 2.0)), hex(0xcdc0a8), sail * cover(v + 12.0)))
}

fn target(u: f64, v: f64) -> Rgb {
    let ground = mix(hex(0x4c6c6c), hex(0x608884), noise(u, v, 12.0, 5));
    let rings = mix(hex(0xb45c48), hex(0xc8a868), stripes(length(u, v), 9.0, 4.5));
    framed(u, v, mix(ground, rings, dot(u, v, 18.0)))
}

fn board(u: f64, v: f64) -> Rgb {
    let fine = noise(u, v, 10.0, 6);
    let squares =
        mix(mix(hex(0x9c5c64), hex(0xb47c78), fine), mix(hex(0x5c7890), hex(0x7c98ac), fine), checks(u, v, 7.0));
    let plate = mix(squares, mix(hex(0xc8b890), hex(0xb0a078), fine), rect(u, v, 20.0, 6.5));
    framed(u, v, mix(plate, hex(0x48343c), sign(u, v, 1.0)))
}
