//! Several surfaces over one another, whose second layer is known: how much of what is uncovered is covered, and how
//! much else.

use fixed::types::I32F32;
use galpix_core::disocclusion::{Border, Reach, covered, map};
use galpix_core::stages::{snap, step_position};
use galpix_core::{Galpixel, Layout, Rounding};
use galpix_tests::memory::{Shape, with_maps};
use galpix_tests::profiles::{SLIDE, dynamic};
use galpix_tests::{packed, random};
use rand::RngExt;
use rand::rngs::SmallRng;

const SIDE: i32 = 48;

/// A rectangle, or all of the map; smaller numbers in a list are nearer.
struct Surface {
    corners: [[i32; 2]; 2],
    velocity: [f32; 2],
}

impl Surface {
    fn any(generator: &mut SmallRng) -> Self {
        let from = [0, 1].map(|_| generator.random_range(-4..SIDE - 4));
        let to = from.map(|from| from + generator.random_range(4..28));
        Self { corners: [from, to], velocity: [0, 1].map(|_| generator.random_range(-24..=24) as f32 / 16.0) }
    }

    fn shows(&self, x: i32, y: i32) -> bool {
        let [[left, top], [right, bottom]] = self.corners;
        (left..right).contains(&x) && (top..bottom).contains(&y)
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Count {
    hidden: u32,
    uncovered: u32,
    kept: u32,
    missed: u32,
}

/// Lays out some surfaces, and counts hidden samples of the second layer: all, those that nothing is in front of after
/// some frame, those that the map keeps, and those of the second kind that it does not.
fn count(surfaces: &[Surface], frames: u32, through: bool, count: &mut Count) {
    let format = dynamic(Layout::VELOCITY565, SLIDE);
    let shape = Shape::plain(SIDE as u32, SIDE as u32);
    let of =
        |x: i32, y: i32| surfaces.iter().enumerate().filter(move |(_, surface)| surface.shows(x, y)).map(|(n, _)| n);
    with_maps(shape, format, None, |mut front, _| {
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let first = of(x, y).next().unwrap();
            let [vx, vy] = surfaces[first].velocity.map(I32F32::from_num);
            let depth = I32F32::from_num(0.1 + 0.2 * first as f32);
            front.store(x, y, &Galpixel { depth, velocity: [vx, vy, I32F32::ZERO], ..Galpixel::default() });
        }
        // Where each surface has moved after each frame, by its stored velocity.
        let record = *front.record();
        let moved: Vec<Vec<[i32; 2]>> = surfaces
            .iter()
            .map(|surface| {
                let [vx, vy] = surface.velocity.map(I32F32::from_num);
                let (words, _) = front.stored(&Galpixel { velocity: [vx, vy, I32F32::ZERO], ..Galpixel::default() });
                let mut position = [0; 2];
                (0..frames)
                    .map(|n| {
                        [0, 1].map(|component| {
                            let scale = &record.scales[component];
                            let v = packed::signed(record.velocity(component), &words) as i32;
                            let threshold = Rounding::default().threshold(n, scale.down);
                            position[component] = step_position(scale, threshold, position[component], v, 0);
                            snap(scale, position[component])
                        })
                    })
                    .collect()
            })
            .collect();
        let mut extents = vec![0; (SIDE * SIDE) as usize];
        let reach = Reach { border: Border::Continues, through, ..Reach::new(frames, 16) };
        map(&front, &mut extents, &reach);
        let inside = |x: i32, y: i32| (0..SIDE).contains(&x) && (0..SIDE).contains(&y);
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let Some(second) = of(x, y).nth(1) else { continue };
            let open = (0..frames as usize).any(|n| {
                let [dx, dy] = moved[second][n];
                let (x, y) = (x + dx, y + dy);
                // Nothing of the first layer comes here; of what comes from beyond the border nothing is known.
                inside(x, y)
                    && moved.iter().enumerate().all(|(number, moved)| {
                        let [dx, dy] = moved[n];
                        inside(x - dx, y - dy) && of(x - dx, y - dy).next() != Some(number)
                    })
            });
            let kept = covered(&extents, (y * SIDE + x) as u32);
            count.hidden += 1;
            count.uncovered += u32::from(open);
            count.kept += u32::from(kept);
            count.missed += u32::from(open && !kept);
        }
    });
}

fn background() -> Surface {
    Surface { corners: [[-1000; 2], [1000; 2]], velocity: [0.25, -0.5] }
}

/// Counts over many pictures of `things` rectangles before a background.
fn pictures(things: usize, through: bool) -> Count {
    let mut total = Count::default();
    for seed in 0..400 {
        let mut generator = random::generator(seed);
        let mut surfaces: Vec<_> = (0..things).map(|_| Surface::any(&mut generator)).collect();
        surfaces.push(background());
        count(&surfaces, 1 + seed as u32 % 16, through, &mut total);
    }
    println!("{things} before a background, through: {through}: {total:?}");
    total
}

#[test]
fn of_two_surfaces_nothing_is_missed() {
    for through in [false, true] {
        let count = pictures(1, through);
        assert_eq!(count.missed, 0);
        assert!(count.uncovered > 10_000 && count.kept < count.hidden);
        // Bounds are not exact, and extents are boxes.
        assert!(2 * count.kept < 3 * count.uncovered);
    }
}

/// Of chains of surfaces not everything is known: what one leaves may be hidden by another one that is not seen yet.
#[test]
fn of_more_surfaces_little_is_missed() {
    for things in [2, 4] {
        let [ending, through] = [false, true].map(|through| pictures(things, through));
        assert!(ending.missed * 16 < ending.uncovered, "{ending:?}");
        assert!(through.missed <= ending.missed && through.kept >= ending.kept);
    }
}
