//! A town at night, over which the view pans.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, cell, cover, dot, gradient, hash, hex, lit, mix, noise, rect};
use crate::update::Margin;

/// Scene `pan`.
pub struct Pan;

/// The picture's way: to the left and first down, with the pan slowing. By frame 24 it has gone 66.7 pixels to the
/// left; its lowest place, 9.4 pixels down, it reaches in frame 25.
const WAY: [Path; 2] = [Path::new(0.0, -3.5, 0.06), Path::new(0.0, 0.75, -0.03)];

impl Scene for Pan {
    fn name(&self) -> &'static str {
        "pan"
    }

    fn about(&self) -> &'static str {
        "the view pans over a town with velocity and acceleration: what enters must have waited in the overscan margin"
    }

    fn margin(&self) -> Margin {
        Margin { left: 0, right: 72, top: 12, bottom: 0 }
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] = &[
            &Card::new(WAY, 0.95, everywhere, sky),
            &Card::new(WAY, 0.75, |u, v| v > skyline(u, FAR), |u, v| houses(u, v, FAR)),
            &Card::new(WAY, 0.5, |u, v| v > skyline(u, MIDDLE), |u, v| houses(u, v, MIDDLE)),
            &Card::new(WAY, 0.25, |u, v| v > skyline(u, FRONT), |u, v| houses(u, v, FRONT)),
        ];
        SURFACES
    }
}

/// A row of houses.
struct Row {
    seed: u32,
    /// Width of a house.
    width: f64,
    /// Roofs lie between these heights, in pixels from the top.
    roofs: [f64; 2],
    walls: [Rgb; 3],
    lamp: Rgb,
}

const FAR: &Row = &Row {
    seed: 1,
    width: 17.0,
    roofs: [58.0, 96.0],
    walls: [hex(0x3c3f78), hex(0x4a4a88), hex(0x585a9a)],
    lamp: hex(0xc8b6e8),
};
const MIDDLE: &Row = &Row {
    seed: 2,
    width: 25.0,
    roofs: [66.0, 112.0],
    walls: [hex(0x2c3566), hex(0x354a78), hex(0x4a4478)],
    lamp: hex(0xffc982),
};
const FRONT: &Row = &Row {
    seed: 3,
    width: 37.0,
    roofs: [96.0, 132.0],
    walls: [hex(0x1b2344), hex(0x2a2c50), hex(0x20384c)],
    lamp: hex(0xffe9a8),
};

fn skyline(u: f64, row: &Row) -> f64 {
    let (house, inside) = cell(u, row.width);
    let roof = row.roofs[0] + (row.roofs[1] - row.roofs[0]) * hash(house, 0, row.seed);
    // Every third house or so has a gable, some have a mast.
    let gable = if hash(house, 1, row.seed) < 0.35 { 0.6 * (inside - row.width / 2.0).abs() } else { 0.0 };
    let mast = if hash(house, 2, row.seed) < 0.25 && (inside - 6.0).abs() < 1.5 { 12.0 } else { 0.0 };
    roof + gable - mast
}

fn houses(u: f64, v: f64, row: &Row) -> Rgb {
    let (house, inside) = cell(u, row.width);
    let wall = lit(gradient(row.walls, hash(house, 3, row.seed)), 0.85 + 0.3 * noise(u, v, 12.0, row.seed));
    let roof = row.roofs[0] + (row.roofs[1] - row.roofs[0]) * hash(house, 0, row.seed);
    let (across, window_u) = cell(inside - 2.0, 6.0);
    let (storey, window_v) = cell(v - roof - 13.0, 8.0);
    let number = house * 16 + across;
    let light = hash(number, storey, row.seed ^ 0x77);
    let pane = if light < 0.5 { mix(row.lamp, hex(0xff9a5a), light * 1.4) } else { lit(wall, 0.7) };
    let fits = across >= 0 && inside < row.width - 3.0 - (6.0 - window_u).min(3.0) && storey >= 0;
    let glazed = if fits { rect(window_u - 2.2, window_v - 3.0, 1.6, 2.2) } else { 0.0 };
    let edge = cover(1.5 - inside).max(cover(roof + 1.5 - v));
    mix(mix(wall, lit(wall, 1.45), edge), pane, glazed)
}

fn sky(u: f64, v: f64) -> Rgb {
    let air = gradient([hex(0x101a44), hex(0x30337c), hex(0x9a5a98)], (v + 12.0) / 110.0);
    let haze = mix(air, hex(0xb07ab0), 0.9 * noise(u, 2.5 * v, 70.0, 11) - 0.4);
    let ((i, x), (j, y)) = (cell(u, 19.0), cell(v, 17.0));
    let star = dot(x - 4.0 - 10.0 * hash(i, j, 12), y - 4.0 - 8.0 * hash(i, j, 13), 0.6 + 0.9 * hash(i, j, 14));
    let starry = mix(haze, hex(0xfff6dc), star * (0.9 - v / 90.0).clamp(0.0, 1.0));
    let crater = 0.35 * cover((noise(u, v, 9.0, 15) - 0.55) * 9.0);
    mix(starry, mix(hex(0xfff4d0), hex(0xd0b890), crater), dot(u - 147.0, v - 29.0, 15.0))
}
