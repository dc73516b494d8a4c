//! A market seen by an eye that looks at its middle: many things near and far cross the periphery.

use super::Scene;
use super::jet::Path;
use super::surface::{Card, Shape, Surface, everywhere};
use super::texture::{
    Rgb, band, bricks, cell, checks, cover, dot, gradient, hash, hex, length, lit, mix, noise, rect, sign, stripes,
};

/// Scene `fovea`.
pub struct Fovea;

impl Scene for Fovea {
    fn name(&self) -> &'static str {
        "fovea"
    }

    fn about(&self) -> &'static str {
        "balloons, kites and a cart cross a market: three frames make 90 Hz of 30 where a foveated display shows the periphery"
    }

    fn width(&self) -> usize {
        256
    }

    fn height(&self) -> usize {
        192
    }

    fn frames(&self) -> u32 {
        3
    }

    fn second_order(&self) -> bool {
        true
    }

    fn surfaces(&self) -> &[&dyn Surface] {
        // Places end in an odd fraction, so that no pixel lies exactly on an edge.
        const SURFACES: &[&dyn Surface] = &[
            &Card::still(0.85, everywhere, market),
            &card([38.3, 46.7], [6.4, 1.2], 0.42, |u, v| length(u, v) < 21.0, red),
            &card([214.6, 52.4], [-5.6, 2.1], 0.46, |u, v| length(u, v) < 18.0, blue),
            &card([121.4, 31.3], [4.3, -0.9], 0.55, |u, v| u.abs() + 0.8 * v.abs() < 17.0, kite),
            &card([196.7, 139.6], [-7.2, 0.0], 0.25, on_cart, cart),
            &card([52.6, 141.3], [5.2, -2.3], 0.33, |u, v| u.abs() < 15.0 && v.abs() < 23.0, parcel),
            &card([128.3, 98.7], [2.6, 1.7], 0.6, |u, v| length(0.7 * u, v) < 11.0, plate),
        ];
        SURFACES
    }
}

/// A card that drifts, and gains a little of its speed in each frame.
const fn card(place: [f64; 2], speed: [f64; 2], depth: f64, shape: Shape, paint: fn(f64, f64) -> Rgb) -> Card {
    let x = Path::new(place[0], speed[0], 0.06 * speed[0]);
    let y = Path::new(place[1], speed[1], 0.06 * speed[1]);
    Card::new([x, y], depth, shape, paint)
}

/// Houses of stone with windows and a striped awning, wares on a table below, cobbles.
fn market(u: f64, v: f64) -> Rgb {
    let (brick, own) = bricks(u, v, 15.0, 7.0, 1);
    let stone = gradient([hex(0xb08468), hex(0xd2a27c), hex(0xe8cba4)], 0.5 * own + 0.5 * noise(u, v, 9.0, 2));
    let masonry = mix(hex(0x8a6a54), stone, brick);
    let ((column, x), (row, y)) = (cell(u + 7.0, 37.0), cell(v + 4.0, 43.0));
    let pane = mix(hex(0x2f4f68), hex(0x9cc4d4), hash(column, row, 3) + (y - 22.0) / 40.0);
    let bars = mix(pane, hex(0xf2e6cc), band(x, 17.0, 19.0).max(band(y, 20.0, 22.0)));
    let windowed = mix(masonry, bars, rect(x - 18.0, y - 21.0, 9.0, 13.0));
    let cloth = mix(hex(0xc84a38), hex(0xf6e8cc), stripes(u + 2.0 * noise(u, v, 30.0, 4), 11.0, 5.5));
    let hung = mix(windowed, lit(cloth, 0.86 + 0.3 * noise(u, v, 8.0, 5)), band(v, 104.0, 121.0));
    let wares = gradient([hex(0xd8722c), hex(0x88a83c), hex(0xe8c44c)], hash(cell(u, 7.0).0, cell(v, 7.0).0, 6));
    let fruit = mix(hex(0x4a3424), wares, dot(cell(u, 7.0).1 - 3.5, cell(v, 7.0).1 - 3.5, 3.1));
    let laid = mix(hung, fruit, band(v, 121.0, 142.0));
    let ((i, s), (j, t)) = (cell(u + 4.0 * (cell(v, 8.0).0 & 1) as f64, 8.0), cell(v, 8.0));
    let cobble = lit(mix(hex(0x6c6a70), hex(0x9a948c), hash(i, j, 7)), 0.9 + 0.2 * noise(u, v, 5.0, 8));
    let paved = mix(hex(0x46444a), cobble, dot(s - 4.0, t - 4.0, 3.8));
    mix(laid, paved, cover(v - 142.0))
}

fn balloon(u: f64, v: f64, radius: f64, colours: [Rgb; 2], seed: u32) -> Rgb {
    let gores = mix(colours[0], colours[1], stripes(u / (1.0 - (v / radius).powi(2)).max(0.08).sqrt() + 3.0, 9.0, 4.5));
    let silk = lit(gores, 0.85 + 0.3 * noise(u, v, 6.0, seed));
    lit(silk, 1.1 - 0.5 * (length(u + 0.3 * radius, v + 0.4 * radius) / (1.7 * radius)).powi(2))
}

fn red(u: f64, v: f64) -> Rgb {
    balloon(u, v, 21.0, [hex(0xd83c34), hex(0xf8d464)], 9)
}

fn blue(u: f64, v: f64) -> Rgb {
    balloon(u, v, 18.0, [hex(0x2c5cb0), hex(0xd8e8f4)], 10)
}

fn kite(u: f64, v: f64) -> Rgb {
    let cloth = mix(hex(0x3c8c5c), hex(0xf0b848), checks(u + 32.0, v + 32.0, 6.0));
    mix(lit(cloth, 0.85 + 0.3 * noise(u, v, 7.0, 11)), hex(0x30241c), cover(1.2 - u.abs()).max(cover(1.2 - v.abs())))
}

fn on_cart(u: f64, v: f64) -> bool {
    (u.abs() < 31.0 && v.abs() < 15.0) || length(u.abs() - 19.0, v - 15.0) < 9.0
}

fn cart(u: f64, v: f64) -> Rgb {
    let wood = gradient([hex(0x5c3a24), hex(0x8a5c38), hex(0xb88450)], noise(u * 0.3, v, 6.0, 12));
    let planked = mix(wood, hex(0x3a2418), stripes(v + 15.0, 6.0, 1.2));
    let lettered = mix(planked, hex(0xf8e4b0), sign(u, v + 1.0, 1.4));
    let tyre = mix(lettered, hex(0x241c18), dot(u.abs() - 19.0, v - 15.0, 9.0));
    let spokes = checks(u.abs() - 19.0, v - 15.0, 3.0);
    mix(tyre, mix(hex(0xc89c5c), hex(0x7a5230), spokes), dot(u.abs() - 19.0, v - 15.0, 6.0))
}

fn parcel(u: f64, v: f64) -> Rgb {
    let paper = mix(hex(0xc8a070), hex(0xe4c494), noise(u, v, 8.0, 13));
    let printed = mix(paper, hex(0x7c5434), stripes(u + v, 10.0, 1.6).max(stripes(u - v, 10.0, 1.6)));
    let tied = mix(printed, hex(0xb02c3c), cover(2.0 - (u - 4.0).abs()).max(cover(2.0 - (v + 3.0).abs())));
    mix(tied, hex(0x6a4628), cover(u.abs() - 14.0).max(cover(v.abs() - 22.0)))
}

fn plate(u: f64, v: f64) -> Rgb {
    let glaze = mix(hex(0xf0ece0), hex(0xd0d8d8), noise(u, v, 6.0, 14));
    let ringed = mix(glaze, hex(0x2c5c8c), cover(1.4 - (length(0.7 * u, v) - 8.0).abs()));
    mix(ringed, hex(0x2c5c8c), checks(u + 16.0, v + 16.0, 2.5) * dot(0.7 * u, v, 5.0))
}
