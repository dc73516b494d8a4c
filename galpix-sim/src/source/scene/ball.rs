//! A ball that is thrown across the whole display and comes back.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Surface, everywhere};
use super::texture::{Rgb, band, cell, cover, dot, gradient, hex, length, lit, mix, noise, rect, stripes};

/// Scene `ball`.
pub struct Ball;

/// Frames until the ball is back where it started: what the paper calls the shortest recognisable time.
const FLIGHT: f64 = 24.0;

/// A coordinate that goes `reach` pixels away and is back after [`FLIGHT`]: at half time it stops, so `v = 4 reach /
/// T`, and `v = -a T / 2`. With `reach` the extent of the display these are the extremes behind (8) and (9).
const fn there_and_back(start: f64, reach: f64) -> Path {
    let velocity = 4.0 * reach / FLIGHT;
    Path::new(start, velocity, -2.0 * velocity / FLIGHT)
}

impl Scene for Ball {
    fn name(&self) -> &'static str {
        "ball"
    }

    fn about(&self) -> &'static str {
        "a ball flies across the display, is pulled back and returns: the extreme velocity and acceleration of the paper"
    }

    fn frames(&self) -> u32 {
        FLIGHT as u32
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        const BALL: Card = Card {
            depth: there_and_back(0.25, 0.3),
            ..Card::new(
                [there_and_back(24.4, 143.0), there_and_back(112.6, -78.0)],
                0.25,
                |u, v| length(u, v) < RADIUS,
                ball,
            )
        };
        const SURFACES: &[&dyn Surface] = &[&Card::still(0.85, everywhere, park), &BALL];
        SURFACES
    }
}

/// Pixels.
const RADIUS: f64 = 17.0;

fn ball(u: f64, v: f64) -> Rgb {
    let leather = mix(hex(0xd96a2b), hex(0xf08a3c), noise(u, v, 6.0, 1));
    let seam = |d: f64| cover(1.1 - d.abs());
    let seams = seam(u + 0.3 * v).max(seam(v - 0.3 * u)).max(seam(length(u - 22.0, v + 6.0) - 14.0));
    let marked = mix(leather, hex(0x40241c), seams.max(seam(length(u + 22.0, v - 6.0) - 14.0)));
    let towards_light = length(u + 6.0, v + 7.0) / (RADIUS + 9.0);
    lit(mix(marked, hex(0xfff0d8), 0.5 - 2.2 * towards_light), 1.12 - 0.6 * towards_light * towards_light)
}

/// A lawn with a fence and trees behind it.
fn park(u: f64, v: f64) -> Rgb {
    let sky = gradient([hex(0x5a9fd0), hex(0x8cc4e2), hex(0xd6ecee)], v / 62.0);
    let clouded = mix(sky, hex(0xffffff), 0.9 * cover((noise(u, 2.0 * v, 52.0, 2) - 0.55) * 8.0));
    let crown = 58.0 - 40.0 * noise(u, 0.0, 34.0, 3) + 6.0 * noise(u, v, 8.0, 4);
    let leaves = gradient([hex(0x1f5a3c), hex(0x3f8448), hex(0x86b254)], noise(u, v, 9.0, 5));
    let wooded = mix(clouded, leaves, cover(v - crown));
    let lawn = gradient([hex(0x5c9a3e), hex(0x7cb449), hex(0x9cc85c)], noise(u, 2.0 * v, 20.0, 6));
    // Mown in stripes that run to one point far behind the fence.
    let mown = lit(lawn, 1.0 - 0.13 * stripes((u - 96.0) * 60.0 / (v - 40.0).max(20.0), 26.0, 13.0));
    let grown = mix(wooded, mown, cover(v - 84.0));
    let plank = mix(hex(0xf6efe2), hex(0xd8cfc0), noise(u, v, 7.0, 7));
    let pale = stripes(u, 12.0, 7.0) * band(v, 64.0 + 0.8 * (cell(u, 12.0).1 - 3.5).abs(), 90.0);
    let rails = band(v, 70.0, 73.5).max(band(v, 81.0, 84.5));
    let fenced = mix(grown, lit(plank, 0.82), rails);
    let whole = mix(fenced, plank, pale);
    let pole = rect(u - 172.0, v - 88.0, 2.0, 50.0);
    let hoop = mix(whole, hex(0x58606c), pole);
    let board = mix(hoop, hex(0xf4f0e6), rect(u - 168.0, v - 34.0, 17.0, 13.0));
    let line = rect(u - 168.0, v - 34.0, 14.5, 10.5) - rect(u - 168.0, v - 34.0, 12.5, 8.5);
    mix(mix(board, hex(0xd0483c), line), hex(0xd0483c), dot(u - 168.0, v - 36.0, 3.0))
}
