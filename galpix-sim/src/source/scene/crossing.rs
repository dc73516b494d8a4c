//! A street on which a bus and a tram pass each other.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{
    Rgb, band, bricks, cell, checks, cover, dot, gradient, hash, hex, length, lit, mix, noise, rect, sign, stripes,
};

/// Scene `crossing`.
pub struct Crossing;

impl Scene for Crossing {
    fn name(&self) -> &'static str {
        "crossing"
    }

    fn about(&self) -> &'static str {
        "a bus speeds up in front of a tram that brakes: collisions, and depth order over three layers"
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const BUS: Card = Card::new([Path::new(41.3, 0.9, 0.26), Path::new(107.2, 0.0, 0.0)], 0.2, vehicle, bus);
        const TRAM: Card = Card::new([Path::new(158.6, -6.6, 0.24), Path::new(86.4, 0.0, 0.0)], 0.45, carriage, tram);
        const SURFACES: &[&dyn Surface] = &[&Card::still(0.8, everywhere, street), &TRAM, &BUS];
        SURFACES
    }
}

/// A box with rounded corners.
fn rounded(u: f64, v: f64, half: [f64; 2], radius: f64) -> f64 {
    let (x, y) = (u.abs() - half[0] + radius, v.abs() - half[1] + radius);
    if x > 0.0 && y > 0.0 { radius - length(x, y) } else { radius - x.max(y) }
}

fn vehicle(u: f64, v: f64) -> bool {
    rounded(u, v, [37.0, 20.0], 5.0) > 0.0 || length(u.abs() - 22.0, v - 20.0) < 7.0
}

fn bus(u: f64, v: f64) -> Rgb {
    let red = lit(mix(hex(0xc93a2e), hex(0xdf5a44), noise(u, v, 10.0, 1)), 1.08 - 0.008 * (v + 20.0));
    let belt = mix(red, hex(0xf6e4b8), band(v, -1.5, 1.5));
    let (pane, x) = cell(u + 36.0, 12.0);
    let glass = mix(hex(0x9fd0e0), hex(0x4f86a8), 0.5 * (x + v + 16.0) / 12.0 + 0.4 * hash(pane, 0, 2));
    let glazed = mix(belt, glass, rect(x - 6.0, v + 10.0, 4.4, 5.5));
    let lettered = mix(glazed, hex(0xf6e4b8), sign(u, v - 8.3, 1.35));
    let skirt = mix(lettered, hex(0x3a2430), cover(v - 17.0));
    wheels(skirt, u.abs() - 22.0, v - 20.0, 7.0)
}

fn carriage(u: f64, v: f64) -> bool {
    rounded(u, v, [48.0, 22.0], 4.0) > 0.0 || (u.abs() < 20.0 && (-27.0..=0.0).contains(&v))
}

fn tram(u: f64, v: f64) -> Rgb {
    let fine = noise(u, v, 9.0, 3);
    let cream = mix(hex(0xf2e2bc), hex(0xe2cc98), fine);
    let green = mix(hex(0x2f7a5c), hex(0x47977a), fine);
    let two = mix(cream, green, cover(v - 3.0));
    let lined = mix(two, hex(0xd8a63c), band(v, 1.0, 4.0).max(band(v, 14.5, 16.5)));
    let (pane, x) = cell(u + 49.5, 11.0);
    let glass = mix(hex(0xb8dce0), hex(0x5a8ca0), 0.6 * (v + 17.0) / 14.0 + 0.4 * hash(pane, 1, 4));
    let curtain = mix(glass, hex(0xd87a5a), cover(-11.0 - v) * f64::from(u8::from(hash(pane, 2, 4) < 0.5)));
    let glazed = mix(lined, curtain, rect(x - 5.5, v + 8.0, 4.0, 7.0));
    let roof = mix(glazed, mix(hex(0x6a7078), hex(0x8a9098), stripes(u, 8.0, 4.0)), cover(-19.0 - v));
    mix(roof, hex(0x2c3038), cover(v - 19.5))
}

fn wheels(under: Rgb, u: f64, v: f64, radius: f64) -> Rgb {
    let tyre = mix(under, hex(0x26222a), dot(u, v, radius));
    mix(tyre, hex(0xd6d0c4), dot(u, v, 0.5 * radius))
}

/// Houses above, pavement, and the road with its markings.
fn street(u: f64, v: f64) -> Rgb {
    let (house, x) = cell(u + 30.0, 58.0);
    let own = hash(house, 0, 5);
    let plaster = gradient([hex(0xf0bf86), hex(0x94c4b8), hex(0xe8968c)], own);
    let (brick, _) = bricks(u, v, 12.0, 6.0, 6);
    let wall = lit(plaster, (0.88 + 0.2 * noise(u, v, 14.0, 7)) * (0.94 + 0.06 * brick));
    let ((column, wx), (storey, wy)) = (cell(x - 2.0, 18.0), cell(v + 18.0, 33.0));
    let shutter = mix(hex(0x4a6a5c), hex(0x6a4a58), hash(house, 1, 5));
    let shuttered =
        mix(wall, mix(shutter, lit(shutter, 1.3), stripes(v, 4.0, 2.0)), rect(wx - 9.0, wy - 15.0, 7.5, 9.0));
    let pane = mix(hex(0x4c6c88), hex(0xa8c8d4), hash(house * 4 + column, storey, 8) + (wy - 15.0) / 30.0);
    let bars = mix(pane, hex(0xf4ead6), band(wx, 8.0, 10.0).max(band(wy, 12.0, 14.0)));
    let windowed = mix(shuttered, bars, rect(wx - 9.0, wy - 15.0, 4.5, 9.0));
    let parted = mix(windowed, lit(wall, 0.7), cover(2.0 - x));
    let kerb = mix(parted, mix(hex(0xb8aca0), hex(0xa09488), checks(u, v - 104.0, 8.0)), cover(v - 104.0));
    let asphalt = mix(hex(0x4c4c58), hex(0x64646e), noise(u, 1.5 * v, 9.0, 9));
    let marked = mix(asphalt, hex(0xe8e2d0), stripes(u, 28.0, 16.0) * band(v, 130.0, 133.0));
    mix(kerb, marked, cover(v - 116.0))
}
