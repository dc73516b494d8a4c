//! Worlds made for the DDOC, and the stage for objects from files: after the paper's own examples, a portal through
//! which rows of seats are seen, and one object with many folds before a wall.

use std::f64::consts::{PI, TAU};

use super::view::{Corner, Place};
use super::world::World;
use crate::source::scene::texture::{Rgb, bricks, checks, gradient, hex, lit, mix, noise, stripes};

/// The worlds that are no scenes.
#[must_use]
pub fn names() -> &'static [&'static str] {
    &["portal", "knot"]
}

/// The world called `name`.
#[must_use]
pub fn find(name: &str) -> Option<World> {
    match name {
        "portal" => Some(portal()),
        "knot" => Some(knot()),
        _ => None,
    }
}

/// Adds a patch of a surface, a lattice of `steps` quads over `0..=1` by `0..=1`.
fn patch(world: &mut World, steps: [usize; 2], place: impl Fn(f64, f64) -> Place, paint: impl Fn(f64, f64) -> Rgb) {
    let node = |i: usize, j: usize| {
        let (s, t) = (i as f64 / steps[0] as f64, j as f64 / steps[1] as f64);
        Corner { place: place(s, t), colour: paint(s, t).map(|channel| channel as f32) }
    };
    for i in 0..steps[0] {
        for j in 0..steps[1] {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)];
            world.add([a, b, c]);
            world.add([b, d, c]);
        }
    }
}

fn between(from: f64, to: f64, share: f64) -> f64 {
    from + (to - from) * share
}

/// A floor at height `y` from in front of the eye to `far`.
fn floor(world: &mut World, y: f64, far: f64, tiles: [u32; 2]) {
    let half = 1.3 * far;
    let place = |s, t: f64| [between(-half, half, s), y, between(0.8 * y, far, t)];
    let paint = move |s: f64, t: f64| {
        let (u, v) = (between(-half, half, s) * 32.0, between(0.8 * y, far, t) * 32.0);
        let marble = noise(u, v, 26.0, 4);
        let tile = |colour: u32| lit(hex(colour), 0.85 + 0.3 * marble);
        mix(tile(tiles[0]), tile(tiles[1]), checks(u, v, 24.0))
    };
    patch(world, [360, 220], place, paint);
}

/// A wall of bricks at distance `z`, down to height `y`.
fn wall(world: &mut World, y: f64, z: f64, colours: [u32; 3]) {
    let half = 1.3 * z;
    let at = move |s, t| [between(-half, half, s), between(-half, y, t)];
    let paint = move |s, t| {
        let [u, v] = at(s, t).map(|length| length * 60.0 / z);
        let (brick, own) = bricks(u, v, 8.0, 4.0, 1);
        let stone = gradient(colours.map(hex), 0.6 * own + 0.4 * noise(u, v, 10.0, 2));
        mix(lit(stone, 0.75), stone, brick)
    };
    let place = move |s, t| {
        let [x, y] = at(s, t);
        [x, y, z]
    };
    patch(world, [300, 300], place, paint);
}

/// Height of the portal's floor.
const FLOOR: f64 = 1.2;

/// Three round arches in a thick wall; behind them rows of seats that climb to a wall.
fn portal() -> World {
    let mut world = World::new("portal", "three arches in a thick wall, through which rows of seats are seen", 0.07);
    floor(&mut world, FLOOR, 11.0, [0xd8c8a8, 0x6a5a64]);
    wall(&mut world, FLOOR, 11.0, [0x88a0b4, 0xa4bccb, 0xc4d6de]);
    const FRONT: f64 = 3.4;
    const BACK: f64 = 3.8;
    const SPACING: f64 = 1.9;
    const HALF: f64 = 0.55;
    const SPRING: f64 = -0.35;
    let stone = |x: f64, y: f64, light: f64| {
        let (brick, own) = bricks(x * 40.0, y * 40.0, 22.0, 11.0, 3);
        let ashlar = gradient(
            [hex(0xc8a878), hex(0xdcc096), hex(0xeed8b4)],
            0.6 * own + 0.4 * noise(x * 40.0, y * 40.0, 12.0, 5),
        );
        lit(mix(lit(ashlar, 0.7), ashlar, brick), light)
    };
    // The arch's own contour: up the left side, around, down the right side.
    let contour = |share: f64| -> [f64; 2] {
        let side = FLOOR - SPRING;
        let length = 2.0 * side + PI * HALF;
        let way = share * length;
        if way < side {
            [-HALF, FLOOR - way]
        } else if way < side + PI * HALF {
            let angle = (way - side) / HALF;
            [-HALF * angle.cos(), SPRING - HALF * angle.sin()]
        } else {
            [HALF, SPRING + way - side - PI * HALF]
        }
    };
    for bay in -2i32..=2 {
        let middle = f64::from(bay) * SPACING;
        let open = bay.abs() <= 1;
        for z in [FRONT, BACK] {
            let light = if z == FRONT { 1.0 } else { 0.6 };
            // Above the opening, and the piers on both sides of it.
            let top = move |x: f64| {
                if open && x.abs() < HALF { SPRING - (HALF * HALF - x * x).max(0.0).sqrt() } else { FLOOR }
            };
            for (from, to) in [(-0.5 * SPACING, -HALF), (-HALF, HALF), (HALF, 0.5 * SPACING)] {
                // At the sides of the opening the arch's end counts, not the pier's.
                let inner = 1e-9;
                let x = move |s| between(from + inner, to - inner, s);
                let place = move |s, t| [middle + x(s), between(-5.0, top(x(s)), t), z];
                patch(&mut world, [36, 90], place, |s, t| {
                    let [x, y, _] = place(s, t);
                    stone(x, y, light)
                });
            }
        }
        if open {
            let place = move |s, t| {
                let [x, y] = contour(s);
                [middle + x, y, between(FRONT, BACK, t)]
            };
            patch(&mut world, [120, 8], place, |s, t| stone(between(0.0, 4.0, s), t, 0.8));
        }
    }
    for row in 0..6u32 {
        let (z, y) = (5.0 + 0.8 * f64::from(row), FLOOR - 0.22 * f64::from(row));
        let velvet = [0xb03a3a, 0x8c2c48, 0xc05a34][row as usize % 3];
        let cloth = move |x: f64, share: f64| {
            let seat = stripes(x * 30.0, 15.0, 13.0);
            lit(
                mix(hex(0x3c2420), hex(velvet), seat),
                (1.1 - 0.3 * share) * (0.9 + 0.2 * noise(x * 30.0, share * 8.0, 5.0, 6)),
            )
        };
        let half = 5.2;
        // The back of a row's seats, and their tops.
        let back = move |s, t| [between(-half, half, s), between(y - 0.52, y, t), z];
        patch(&mut world, [240, 12], back, |s, t| cloth(between(-half, half, s), t));
        let seat = move |s, t| [between(-half, half, s), y - 0.52 + 0.3 * t, z + 0.3 * t];
        patch(&mut world, [240, 8], seat, |s, t| lit(cloth(between(-half, half, s), t), 0.8));
        let step = move |s, t| [between(-half, half, s), y - 0.22, between(z + 0.3, z + 0.8, t)];
        patch(&mut world, [160, 8], step, |s, t| lit(hex(0x8a7a6c), 0.8 + 0.3 * noise(s * 200.0, t * 10.0, 8.0, 7)));
    }
    world.with_near()
}

/// The floor and the wall before which an object stands.
pub fn stage(world: &mut World) {
    floor(world, STAGE_FLOOR, 6.5, [0xe8dcc8, 0x7c8c94]);
    wall(world, STAGE_FLOOR, 6.5, [0xb08a74, 0xc8a48c, 0xe0c4a8]);
}

/// Height of the stage's floor.
pub const STAGE_FLOOR: f64 = 1.0;

/// A tube around a knot of three loops that hides parts of itself.
fn knot() -> World {
    let mut world = World::new("knot", "a knotted tube that hides parts of itself, on a floor before a wall", 0.07);
    stage(&mut world);
    const LOOP: f64 = 0.52;
    const TUBE: f64 = 0.15;
    let centre = |angle: f64| -> Place {
        let ring = LOOP * (1.0 + 0.45 * (1.5 * angle).cos());
        [ring * angle.cos(), 0.15 + ring * angle.sin(), 2.6 + LOOP * 0.75 * (1.5 * angle).sin()]
    };
    let frame = move |angle: f64| -> [Place; 2] {
        let (a, b) = (centre(angle - 1e-4), centre(angle + 1e-4));
        let along = unit([0, 1, 2].map(|i| b[i] - a[i]));
        let out = unit([angle.cos(), angle.sin(), 0.3]);
        let side = unit(cross(along, out));
        [cross(side, along), side]
    };
    let normal = move |s: f64, t: f64| -> Place {
        let [out, side] = frame(2.0 * TAU * s);
        let (sin, cos) = (TAU * t).sin_cos();
        [0, 1, 2].map(|i| cos * out[i] + sin * side[i])
    };
    let place = move |s: f64, t: f64| {
        let (middle, normal) = (centre(2.0 * TAU * s), normal(s, t));
        [0, 1, 2].map(|i| middle[i] + TUBE * normal[i])
    };
    let paint = move |s: f64, t: f64| {
        let [x, y, z] = normal(s, t);
        let light = 0.6 + 0.45 * (-0.5 * x - 0.6 * y - 0.62 * z).max(0.0);
        let painted = mix(hex(0x2f7f86), hex(0xf0c060), stripes(s * 480.0 + t * 24.0, 24.0, 12.0));
        lit(painted, light * (0.9 + 0.2 * noise(s * 400.0, t * 30.0, 8.0, 9)))
    };
    patch(&mut world, [900, 60], place, paint);
    world.with_near()
}

fn unit(vector: Place) -> Place {
    let length = vector.iter().map(|component| component * component).sum::<f64>().sqrt();
    vector.map(|component| component / length)
}

fn cross(a: Place, b: Place) -> Place {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
