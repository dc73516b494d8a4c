//! Whole pictures.

use fixed::types::I32F32;
use galpix_core::{Class, Galpixel, Layout, Margin};

use super::super::picture::Picture;
use super::super::setting::Setting;

/// A picture of galpixels with a motion and a depth for each cell.
fn picture(
    name: impl Into<String>,
    size: [u32; 2],
    frames: u32,
    galpixel: impl Fn(u32, u32) -> Galpixel + Send + Sync + 'static,
) -> Picture {
    Picture {
        name: name.into(),
        size,
        margin: Margin::NONE,
        galpixel: Box::new(galpixel),
        layout: Layout::FULL,
        frames,
        counter: 0,
        same_as: None,
    }
}

/// A galpixel whose colour and depth identify its cell.
fn moving(x: u32, y: u32, velocity: [f64; 2], acceleration: [f64; 2]) -> Galpixel {
    let number = I32F32::saturating_from_num::<f64>;
    let zero = I32F32::ZERO;
    Galpixel {
        colour: [x as u8, y as u8, (x ^ y) as u8],
        depth: number(f64::from((x * 7 + y * 13) % 64) / 64.0),
        velocity: [number(velocity[0]), number(velocity[1]), zero],
        acceleration: [number(acceleration[0]), number(acceleration[1]), zero],
        ..Galpixel::default()
    }
}

/// The largest velocity of the budget, in cells per frame.
fn fastest(setting: &Setting) -> f64 {
    0.5f64.powi(setting.bits.x.velocity_frac as i32) * setting.ranges(0).velocity_top as f64
}

/// Velocities of different parts of a cell, as the cells differ.
fn mixed(x: u32, y: u32) -> Galpixel {
    let part = |n: u32| f64::from(n % 31) / 8.0 - 1.9;
    moving(x, y, [part(5 * x + 3 * y), part(x + 11 * y)], [part(7 * x + y) / 64.0, part(x + 2 * y) / 64.0])
}

/// The same picture shortly before the counter's end, and shortly before the end of its lower half.
pub fn counter_wrap(setting: &Setting) -> Vec<Picture> {
    let before = setting.demand.prop / 2;
    let half = setting.bits.x.velocity_frac + 2;
    let end = format!("from 2^32 - {before}");
    vec![
        Picture { counter: 0u32.wrapping_sub(before), ..picture(end.clone(), [65, 33], setting.demand.prop, mixed) },
        Picture {
            // Thresholds read as many low bits of the counter as are dropped.
            counter: (1u32 << half << 1).wrapping_sub(before),
            same_as: Some(end),
            ..picture("from a smaller power of two, the same bits", [65, 33], setting.demand.prop, mixed)
        },
    ]
}

/// 3^8 combinations of ends, a cell each: position, velocity, acceleration, depth and its motion, luminosity.
pub fn every_field(setting: &Setting) -> Vec<Picture> {
    let ends = |digit: u32| [I32F32::MIN, I32F32::ZERO, I32F32::MAX][digit as usize];
    let galpixel = move |x: u32, y: u32| {
        let number = y * 81 + x;
        let digit = |place: u32| number / 3u32.pow(place) % 3;
        let within = [I32F32::lit("-0.5"), I32F32::ZERO, I32F32::lit("0.499")];
        Galpixel {
            class: Class::Galpixel,
            colour: [0, 128, 255],
            offset: [within[digit(0) as usize], within[digit(1) as usize]],
            depth: [I32F32::ZERO, I32F32::lit("0.5"), I32F32::ONE][digit(2) as usize],
            velocity: [ends(digit(3)), ends(digit(4)), ends(digit(5))],
            acceleration: [ends(digit(6)), ends(digit(7)), ends(digit(0))],
            luminosity_rate: ends(digit(1)),
            tag: u32::MAX,
        }
    };
    vec![Picture { layout: Layout::SHADED, ..picture("3^8 combinations", [81, 81], setting.demand.prop, galpixel) }]
}

/// A name, which cells move in one direction, and their speed.
type Board = (&'static str, fn(u32, u32) -> bool, [f64; 2]);

/// Velocities of one and a half cells.
pub fn checkerboard(setting: &Setting) -> Vec<Picture> {
    let boards: [Board; 3] = [
        ("along rows", |x, y| (x + y).is_multiple_of(2), [1.5, 0.0]),
        ("along columns", |x, y| (x + y).is_multiple_of(2), [0.0, 1.5]),
        ("across, rows against rows", |_, y| y.is_multiple_of(2), [1.25, 0.75]),
    ];
    let of = |(name, way, [vx, vy]): Board| {
        picture(name, [65, 33], setting.demand.prop, move |x, y| {
            let sign = if way(x, y) { 1.0 } else { -1.0 };
            moving(x, y, [sign * vx, sign * vy], [0.0, 0.0])
        })
    };
    boards.map(of).into()
}

/// In one frame, and by an acceleration in several.
pub fn one_cell(setting: &Setting) -> Vec<Picture> {
    // No farther than a velocity reaches in a frame.
    let half = (fastest(setting) as u32).clamp(1, 32);
    let side = 2 * half - 1;
    let towards = move |x: u32, y: u32| {
        [half - 1, half - 1]
            .map(f64::from)
            .into_iter()
            .zip([x, y])
            .map(|(to, from)| to - f64::from(from))
            .collect::<Vec<_>>()
    };
    vec![
        picture("in one frame", [side, side], setting.demand.prop, move |x, y| {
            let way = towards(x, y);
            moving(x, y, [way[0], way[1]], [0.0, 0.0])
        }),
        picture("in four frames, from rest", [side, side], setting.demand.prop, move |x, y| {
            let way = towards(x, y);
            moving(x, y, [0.0, 0.0], [way[0] / 8.0, way[1] / 8.0])
        }),
    ]
}

/// In each direction, as fast as can be.
pub fn off_screen(setting: &Setting) -> Vec<Picture> {
    let v = fastest(setting);
    let side = (v as u32).clamp(1, 48);
    [("right", [v, 0.0]), ("left", [-v, 0.0]), ("down", [0.0, v]), ("up", [0.0, -v]), ("down and left", [-v, v])]
        .map(|(name, velocity)| picture(name, [side, side], 4, move |x, y| moving(x, y, velocity, [0.0, 0.0])))
        .into()
}

/// Nothing to move, nothing to fill with.
pub fn empty(setting: &Setting) -> Vec<Picture> {
    let nothing = |_: u32, _: u32| Galpixel { class: Class::Empty, colour: [9; 3], ..Galpixel::default() };
    vec![picture("a map of 64 x 48 empty cells", [64, 48], setting.demand.prop, nothing)]
}

/// Columns and rows around those that the passes take at once.
pub fn sizes(setting: &Setting) -> Vec<Picture> {
    let sizes = [
        [1, 1],
        [1, 2],
        [2, 1],
        [1, 257],
        [257, 1],
        [3, 5],
        [7, 7],
        [31, 33],
        [63, 2],
        [64, 2],
        [65, 2],
        [127, 3],
        [129, 3],
    ];
    sizes.map(|size| picture(format!("{} x {}", size[0], size[1]), size, setting.demand.prop, mixed)).into()
}

/// Display cells and margin alike move.
pub fn margins(setting: &Setting) -> Vec<Picture> {
    let of = |margin: Margin| {
        let Margin { left, right, top, bottom } = margin;
        let name = format!("{left}, {right}, {top}, {bottom} around 9 x 7");
        Picture { margin, ..picture(name, [9, 7], setting.demand.prop, mixed) }
    };
    [
        Margin::NONE,
        Margin::all(1),
        Margin { left: 1, right: 0, top: 0, bottom: 0 },
        Margin { left: 0, right: 64, top: 3, bottom: 1 },
        Margin::all(8),
        Margin::all(40),
    ]
    .map(of)
    .into()
}

/// Debris of all kinds that lies, and that moves.
pub fn old_debris(setting: &Setting) -> Vec<Picture> {
    let of = |name: &str, debris: [f64; 2]| {
        picture(name, [48, 33], 4 * setting.demand.prop, move |x, y| {
            let class = [Class::Debris, Class::JustUnobscured, Class::Galpixel][((x + 2 * y) % 3) as usize];
            let velocity = if class == Class::Galpixel { [0.4, 0.1] } else { debris };
            Galpixel { class, ..moving(x, y, velocity, [0.0, 0.0]) }
        })
    };
    vec![of("debris that lies", [0.0, 0.0]), of("debris that moves", [-0.3, 0.2])]
}
