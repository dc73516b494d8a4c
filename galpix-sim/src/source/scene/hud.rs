//! The view from a glider: an archipelago rushes past, drones circle over it, and instruments are pinned over it all.

use super::Scene;
use super::jet::{Jet, Path};
use super::surface::{Card, Hit, Paint, Point, Shape, Surface, everywhere};
use super::texture::{Rgb, cover, dot, gradient, hex, length, lit, mix, noise, rect, sign, stripes};
use crate::overlay::Overlay;
use crate::update::Margin;

/// Scene `hud`.
pub struct Hud;

/// The sea's way: it rushes to the left, and sways.
const WAY: [Path; 2] = [Path::new(0.0, -3.0, 0.0), Path::new(0.0, 0.4, -0.006)];

impl Scene for Hud {
    fn name(&self) -> &'static str {
        "hud"
    }

    fn about(&self) -> &'static str {
        "drones circle over a sea that rushes past, under pinned instruments: lines of a pixel that must not smear"
    }

    fn margin(&self) -> Margin {
        Margin { left: 0, right: 76, top: 8, bottom: 2 }
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        false
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] = &[
            &Card::new(WAY, 0.9, everywhere, sea),
            &Rider {
                centre: [61.3, 52.4],
                radius: [26.0, 17.0],
                rate: 0.13,
                phase: 0.4,
                depth: 0.5,
                shape: disc,
                paint: red,
            },
            &Rider {
                centre: [122.7, 77.6],
                radius: [37.0, 22.0],
                rate: -0.1,
                phase: 2.1,
                depth: 0.35,
                shape: cross,
                paint: blue,
            },
            &Rider {
                centre: [92.4, 91.3],
                radius: [48.0, 9.0],
                rate: 0.08,
                phase: 4.0,
                depth: 0.2,
                shape: barge,
                paint: gold,
            },
        ];
        SURFACES
    }

    fn overlay(&self) -> Option<Overlay> {
        Some(Overlay::draw(self.width(), self.height(), instruments))
    }
}

/// A card that rides round an ellipse: beyond second order, however short a while it is.
struct Rider {
    /// Middle of the ellipse, pixels.
    centre: [f64; 2],
    /// Half axes of the ellipse, pixels.
    radius: [f64; 2],
    /// Radians a frame.
    rate: f64,
    /// Radians at the update.
    phase: f64,
    /// Normalised depth.
    depth: f64,
    shape: Shape,
    paint: Paint,
}

impl Surface for Rider {
    fn hit(&self, x: f64, y: f64, t: f64) -> Option<Hit> {
        let [left, top, depth] = self.place([0.0; 3], Jet::constant(t)).map(|coordinate| coordinate.value);
        (self.shape)(x - left, y - top).then_some(Hit { point: [x - left, y - top, 0.0], depth })
    }

    fn place(&self, [u, v, _]: Point, t: Jet) -> [Jet; 3] {
        let (sin, cos) = (t * self.rate + Jet::constant(self.phase)).sin_cos();
        let (x, y) = (Jet::constant(self.centre[0] + u), Jet::constant(self.centre[1] + v));
        [x + cos * self.radius[0], y + sin * self.radius[1], Jet::constant(self.depth)]
    }

    fn colour(&self, [u, v, _]: Point) -> Rgb {
        (self.paint)(u, v)
    }
}

fn sea(u: f64, v: f64) -> Rgb {
    let height = noise(u, v, 70.0, 1) + 0.35 * noise(u, v, 21.0, 2);
    let water = gradient([hex(0x12345c), hex(0x1f6a8c), hex(0x58b4b0)], 1.3 * height);
    let waves = lit(water, 0.86 + 0.3 * noise(u, 2.2 * v, 6.0, 3));
    let land = gradient([hex(0xe8d8a0), hex(0x6c9c4c), hex(0x3c6c44)], 5.0 * (height - 0.8));
    let grown = lit(land, 0.8 + 0.4 * noise(u, v, 5.0, 4));
    mix(waves, grown, cover(40.0 * (height - 0.8)))
}

fn disc(u: f64, v: f64) -> bool {
    length(u, v) < 13.5
}

fn red(u: f64, v: f64) -> Rgb {
    let hull = mix(hex(0xc83c34), hex(0xf0e4d0), stripes(u + v + 40.0, 9.0, 4.5));
    let lit_hull = lit(hull, 0.8 + 0.4 * noise(u, v, 5.0, 5));
    mix(mix(lit_hull, hex(0x2c2830), cover(1.8 - (length(u, v) - 12.5).abs())), hex(0x84d0e0), dot(u, v, 4.5))
}

fn cross(u: f64, v: f64) -> bool {
    (u.abs() < 5.0 && v.abs() < 16.0) || (v.abs() < 5.0 && u.abs() < 16.0)
}

fn blue(u: f64, v: f64) -> Rgb {
    let hull = mix(hex(0x2c4cb0), hex(0xd4dcf0), rect(u, v, 2.5, 14.0).max(rect(u, v, 14.0, 2.5)));
    let rotors = dot(u.abs() - 12.0, v, 3.4).max(dot(u, v.abs() - 12.0, 3.4));
    mix(lit(hull, 0.75 + 0.5 * noise(u, v, 4.0, 6)), hex(0x181c28), rotors)
}

fn barge(u: f64, v: f64) -> bool {
    u.abs() < 27.0 - 0.5 * v.abs() && v.abs() < 10.0
}

fn gold(u: f64, v: f64) -> Rgb {
    let hull = gradient([hex(0xb8842c), hex(0xe8c050), hex(0xf8e8a0)], (v + 10.0) / 20.0);
    let plated = mix(hull, hex(0x7c5420), stripes(u + 30.0, 7.0, 1.4));
    mix(lit(plated, 0.8 + 0.35 * noise(u, v, 6.0, 7)), hex(0x30281c), sign(u, v, 1.2))
}

const GREEN: [u8; 3] = [0x7c, 0xfc, 0x98];
const AMBER: [u8; 3] = [0xfc, 0xc4, 0x3c];
const BLACK: [u8; 3] = [0x08, 0x10, 0x0c];

/// Rows of three bits for each digit.
const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 7, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 1, 2, 2],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// What is pinned to a pixel: a cross-hair in a ring, a horizon, a scale and a gauge, a line of text and of numbers,
/// and a border of single dots.
fn instruments(x: usize, y: usize) -> Option<[u8; 3]> {
    let (i, j) = (x as i32, y as i32);
    let (u, v) = (f64::from(i) - 95.5, f64::from(j) - 71.5);
    let ring = (length(u, v) - 25.0).abs() < 0.5;
    let hair = (i == 96 && (4..14).contains(&(j - 72).abs())) || (j == 72 && (4..14).contains(&(i - 96).abs()));
    let horizon = (j - 40 == (i - 96) / 12) && (24..72).contains(&(i - 96).abs()) && i % 12 < 9;
    if ring || hair || horizon {
        return Some(GREEN);
    }
    let tick = (i == 8 && (20..124).contains(&j)) || ((9..14).contains(&i) && (20..124).contains(&j) && j % 8 == 0);
    let dots = (i == 2 || i == 189 || j == 2 || j == 141) && (i + j) % 4 == 0;
    if tick || dots {
        return Some(GREEN);
    }
    if (128..184).contains(&i) && (128..137).contains(&j) {
        let frame = i == 128 || i == 183 || j == 128 || j == 136;
        return Some(if frame || (130..166).contains(&i) && (130..135).contains(&j) { AMBER } else { BLACK });
    }
    if sign(f64::from(i) - 150.0, f64::from(j) - 12.0, 1.6) > 0.5 {
        return Some(AMBER);
    }
    number(i - 18, j - 8, [1, 0, 9, 4, 7]).or_else(|| number(i - 18, j - 128, [3, 6, 5, 2, 8]))
}

/// Digits of two pixels per unit, four units apart, in a black box.
fn number(x: i32, y: i32, digits: [usize; 5]) -> Option<[u8; 3]> {
    if !(-2..40).contains(&x) || !(-2..12).contains(&y) {
        return None;
    }
    let digit = digits.get(usize::try_from(x.div_euclid(8)).unwrap_or(usize::MAX)).and_then(|&digit| DIGITS.get(digit));
    let row = digit.zip(usize::try_from(y.div_euclid(2)).ok()).and_then(|(rows, row)| rows.get(row));
    let inked = row.is_some_and(|bits| bits << (x.rem_euclid(8) / 2) & 4 != 0 && x.rem_euclid(8) < 6);
    Some(if inked { GREEN } else { BLACK })
}
