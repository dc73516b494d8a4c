//! A painted disc that turns on a table.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, checks, cover, dot, gradient, hex, length, lit, mix, noise, sign, stripes};

/// Scene `disc`.
pub struct Disc;

impl Scene for Disc {
    fn name(&self) -> &'static str {
        "disc"
    }

    fn about(&self) -> &'static str {
        "a painted disc turns on a table: acceleration bends the path, the third order and above are missing"
    }

    fn frames(&self) -> u32 {
        16
    }

    fn second_order(&self) -> bool {
        false
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const TURNING: Card = Card {
            angle: Path::new(0.2, 0.04, 0.0),
            ..Card::new([Path::still(95.6), Path::still(71.3)], 0.3, |u, v| length(u, v) < RADIUS, painted)
        };
        const SURFACES: &[&dyn Surface] = &[&Card::still(0.7, everywhere, table), &TURNING];
        SURFACES
    }
}

/// Pixels; the rim runs at 2.4 pixels per frame.
const RADIUS: f64 = 61.0;

fn table(u: f64, v: f64) -> Rgb {
    let (board, own) = super::texture::cell(v + 7.0, 36.0);
    let grain = noise(u * 0.25 + 40.0 * board as f64, v, 7.0, 1 + board as u32);
    let wood = gradient([hex(0x6d4630), hex(0x95643f), hex(0xb98555)], grain);
    let rings = 0.14 * stripes(v + 12.0 * noise(u, v * 2.0, 60.0, 9), 6.0, 2.5);
    mix(lit(wood, 1.0 - rings), hex(0x3c2519), cover(1.0 - own))
}

fn painted(u: f64, v: f64) -> Rgb {
    let radius = length(u, v);
    let fine = noise(u, v, 10.0, 2);
    let rim = mix(mix(hex(0x1d5a6c), hex(0x2b7d8c), fine), hex(0xf2e3c0), rim_dots(u, v));
    let field = mix(hex(0xf4e7ca), hex(0xe3cda0), fine);
    let board = mix(field, mix(hex(0xd9583b), hex(0xea8450), fine), checks(u + 36.0, v + 36.0, 12.0));
    let plate = mix(rim, board, cover(46.0 - radius));
    let label = mix(hex(0x1f3a56), hex(0x2f5878), fine);
    let bar = cover(11.0 - v.abs()) * cover(44.0 - u.abs());
    let lettered = mix(label, hex(0xfde9b0), sign(u, v, 2.2));
    let barred = mix(plate, lettered, bar * cover(45.5 - radius));
    mix(barred, hex(0x173848), cover(radius - 59.0).max(0.6 * cover(1.0 - (radius - 46.0).abs())))
}

/// Twenty-four dots on the rim, without an angle: sixteenths of a turn are reached by folding the plane.
fn rim_dots(u: f64, v: f64) -> f64 {
    let (mut x, mut y) = (u.abs(), v.abs());
    if y > x {
        (x, y) = (y, x);
    }
    // Now within 0..45 degrees: dots at 7.5, 22.5 and 37.5.
    const PLACES: [[f64; 2]; 3] =
        [[0.991_444_861, 0.130_526_192], [0.923_879_533, 0.382_683_432], [0.793_353_340, 0.608_761_429]];
    PLACES.iter().map(|place| dot(x - 52.5 * place[0], y - 52.5 * place[1], 3.2)).fold(0.0, f64::max)
}
