//! A poster that drifts by small fractions of a pixel per frame.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, bricks, cell, cover, dot, hash, hex, length, mix, noise, rect, sign, stripes};

/// Scene `drift`.
pub struct Drift;

impl Scene for Drift {
    fn name(&self) -> &'static str {
        "drift"
    }

    fn about(&self) -> &'static str {
        "a poster drifts by 0.07 and 0.03 pixels a frame: the fraction of the position and the rounding must hold"
    }

    fn frames(&self) -> u32 {
        24
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const SURFACES: &[&dyn Surface] =
            &[&Card::new([Path::new(95.7, 0.07, 0.0), Path::new(71.6, 0.03, 0.0)], 0.5, everywhere, poster)];
        SURFACES
    }
}

fn poster(u: f64, v: f64) -> Rgb {
    let (brick, own) = bricks(u, v, 21.0, 10.0, 1);
    let clay = mix(hex(0x8b4a3c), hex(0xc07a58), 0.5 * own + 0.5 * noise(u, v, 9.0, 2));
    let wall = mix(hex(0xcbb8a0), clay, brick);
    let paper = mix(hex(0xf3e6c6), hex(0xe0cb9c), noise(u, v, 30.0, 3));
    let sheet = mix(wall, mix(hex(0x24485a), paper, rect(u, v, 71.5, 51.5)), rect(u, v, 75.0, 55.0));
    let rings = mix(hex(0xe0543c), hex(0xf2b24a), stripes(length(u, v + 13.0), 10.0, 5.0));
    let target = mix(sheet, rings, dot(u, v + 13.0, 30.0));
    let heading = small_print(u + 48.0, v + 43.0, 16.0).max(small_print(u - 48.0, v + 43.0, 16.0));
    let lettered = mix(target, hex(0x24485a), sign(u, v - 30.0, 3.4));
    mix(lettered, hex(0x24485a), small_print(u, v - 46.5, 58.0).max(heading))
}

/// Marks two to four pixels wide, like a line of small print.
fn small_print(u: f64, v: f64, half_width: f64) -> f64 {
    let (column, inside) = cell(u, 5.0);
    let width = 2.0 + 2.0 * hash(column, 0, 9);
    cover(width - inside) * cover(inside) * rect(u, v, half_width, 1.0 + hash(column, 1, 9))
}
