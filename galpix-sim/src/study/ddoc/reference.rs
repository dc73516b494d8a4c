//! The reference images: the plain depth image, and the DDOC image (section 4).

use std::time::Instant;

use galpix_core::SetupError;
use galpix_core::ddoc::{DistortionMap, Settings, Tally};

use super::view::{Corner, View};
use super::world::World;
use crate::source::ddoc::distortion::{self, Memory, depth_word};
use crate::source::ddoc::raster::{Pin, Raster};

/// An image with depth, colour, and for each sample by how much it was moved.
#[derive(Clone, Debug)]
pub struct Reference {
    /// From where it was taken.
    pub view: View,
    /// Distance of inverse distance 1.
    pub near: f64,
    /// Red, green, blue, and the distortion in x and y.
    pub raster: Raster<5>,
}

/// A DDOC image and what it took.
#[derive(Clone, Debug)]
pub struct Ddoc {
    /// The image.
    pub image: Reference,
    /// What the distortion map counted.
    pub tally: Tally,
    /// Seconds for the z-buffer, the distortion map and the image.
    pub seconds: [f64; 3],
    /// The full distortion of each pixel of the map.
    pub map: Vec<[f64; 2]>,
}

/// Nothing is drawn that is nearer to an eye than this share of the near distance.
const CLIPPED: f64 = 0.1;

fn pin(view: &View, near: f64, corner: &Corner) -> Pin<5> {
    let [u, v, z] = view.project(corner.place);
    let [red, green, blue] = corner.colour;
    Pin { at: [u, v], nearness: near / z, carried: [red, green, blue, 0.0, 0.0] }
}

/// Returns the world from a view, as a pinhole camera sees it: the truth for that view, or the plain reference image.
#[must_use]
pub fn plain(world: &World, view: &View) -> Reference {
    let mut raster = Raster::new(view.width, view.height);
    for &triangle in &world.triangles {
        view.in_front(&world.triangle(triangle), CLIPPED * world.near, |corners| {
            let [a, b, c] = [0, 1, 2].map(|i| pin(view, world.near, &corners[i]));
            raster.draw([&a, &b, &c]);
        });
    }
    Reference { view: *view, near: world.near, raster }
}

/// Returns the world from the reference view of `size` pixels squared with the DDOC.
///
/// *Errors:* a size that a distortion map cannot have.
pub fn ddoc(world: &World, size: usize, settings: &Settings) -> Result<Ddoc, SetupError> {
    let view = View::reference(size);
    let started = Instant::now();
    let seen = plain(world, &view);
    let depths: Vec<u32> = seen.raster.nearness.iter().map(|&nearness| depth_word(f64::from(nearness))).collect();
    let seen_after = started.elapsed().as_secs_f64();
    let mut memory = Memory::default();
    let (map, tally) = memory.map(size, &depths, settings)?;
    let mapped_after = started.elapsed().as_secs_f64();
    let mut raster = Raster::new(size, size);
    for &triangle in &world.triangles {
        view.in_front(&world.triangle(triangle), CLIPPED * world.near, |corners| {
            let pins = [0, 1, 2].map(|i| pin(&view, world.near, &corners[i]));
            let seen_by = SeenBy { map: &map, view: &view, near: world.near, reach: f64::from(settings.radius) + 1.0 };
            subdivide(&mut raster, &seen_by, corners, &pins);
        });
    }
    let drawn_after = started.elapsed().as_secs_f64();
    let full =
        |index: usize| distortion::displacement(&map, [(index % size) as f64, (index / size) as f64], u32::MAX >> 4);
    Ok(Ddoc {
        image: Reference { view, near: world.near, raster },
        tally,
        seconds: [seen_after, mapped_after - seen_after, drawn_after - mapped_after],
        map: (0..size * size).map(full).collect(),
    })
}

/// The DDOC.
struct SeenBy<'m> {
    map: &'m DistortionMap<'m>,
    view: &'m View,
    near: f64,
    /// Nothing is moved farther, pixels.
    reach: f64,
}

/// Draws a triangle with the DDOC: halves it along its longest edge until none is longer than a pixel in the plain
/// image, then moves its corners (equation 1).
fn subdivide(raster: &mut Raster<5>, by: &SeenBy<'_>, corners: &[Corner; 3], pins: &[Pin<5>; 3]) {
    let SeenBy { map, view, near, reach } = *by;
    // What is nowhere near the picture is not moved into it.
    let outside = |axis: usize, size: usize| {
        let all = |beyond: &dyn Fn(f64) -> bool| pins.iter().all(|pin| beyond(pin.at[axis]));
        all(&|at| at < -reach) || all(&|at| at > size as f64 + reach)
    };
    if outside(0, raster.width) || outside(1, raster.height) {
        return;
    }
    let square = |i: usize| {
        let (from, to) = (&pins[i].at, &pins[(i + 1) % 3].at);
        (from[0] - to[0]).powi(2) + (from[1] - to[1]).powi(2)
    };
    let squares = [square(0), square(1), square(2)];
    let longest = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
    if squares[longest] > 1.0 {
        let (from, to, rest) = (longest, (longest + 1) % 3, (longest + 2) % 3);
        let middle = corners[from].towards(&corners[to], 0.5);
        let middle_pin = pin(view, near, &middle);
        for (of, pins_of) in [
            ([corners[from], middle, corners[rest]], [pins[from], middle_pin, pins[rest]]),
            ([middle, corners[to], corners[rest]], [middle_pin, pins[to], pins[rest]]),
        ] {
            subdivide(raster, by, &of, &pins_of);
        }
        return;
    }
    let [a, b, c] = [0, 1, 2].map(|i| {
        let mut pin = pins[i];
        let [x, y] = distortion::displacement(map, pin.at, depth_word(pin.nearness));
        pin.at = [pin.at[0] + x, pin.at[1] + y];
        pin.carried[3] = x as f32;
        pin.carried[4] = y as f32;
        pin
    });
    raster.draw([&a, &b, &c]);
}
