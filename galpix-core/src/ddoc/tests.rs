extern crate std;

use std::vec;
use std::vec::Vec;

use super::direction::{Moments, unit};
use super::splat::Splat;
use super::*;
use crate::map::grid::Margin;

const NEAR: u32 = 100_000;
const FAR: u32 = 900_000;

/// The parts of a distortion map.
struct Made {
    owners: Vec<u32>,
    splats: Vec<Splat>,
    tally: Tally,
    moved: Vec<[i32; 2]>,
}

/// Makes the map of a picture of `side` x `side` cells with these depths; `moved` are the displacements of the middles
/// of the cells at `FAR`.
fn made(side: u32, settings: &Settings, depth: impl Fn(i32, i32) -> u32) -> Made {
    let cells = || (0..side as i32).flat_map(|y| (0..side as i32).map(move |x| (x, y)));
    let depths: Vec<u32> = cells().map(|(x, y)| depth(x, y)).collect();
    let (mut rows, mut owners) = (vec![0; side as usize], vec![7; depths.len()]);
    let mut splats = vec![Splat::default(); depths.len()];
    let grid = Grid::new(side, side, Margin::NONE, &mut rows).unwrap();
    let (map, tally) = DistortionMap::new(grid, &depths, settings, &mut owners, &mut splats).unwrap();
    let moved = cells().map(|(x, y)| map.displacement([x * ONE, y * ONE], FAR)).collect();
    splats.truncate(tally.splats as usize);
    Made { owners, splats, tally, moved }
}

fn settings(radius: u32) -> Settings {
    Settings { radius, ..Settings::for_depth(20) }
}

/// Returns settings without conflicts: all radii stay as they are.
fn without_conflicts(radius: u32) -> Settings {
    Settings { conflict: i32::MIN, ..settings(radius) }
}

fn splat(radius: i32) -> Splat {
    Splat { cell: [40, 40], direction: [1 << 14, 0], near: NEAR, far: FAR, radius: (radius * ONE) as u32 }
}

#[test]
fn the_distortion_has_the_values_of_figure_5() {
    let r = 16;
    let full = |x: i32, asymmetry: u32| splat(r).full(x * ONE, asymmetry);
    assert_eq!([-r, 0, r].map(|x| full(x, SYMMETRIC)), [r * ONE, r / 2 * ONE, 0]);
    assert_eq!([-8, 8].map(|x| full(x, SYMMETRIC)), [12 * ONE, 4 * ONE], "(r - x) / 2");
    // a_f = 2: [-r, 0] -> [0, r/4], and the visible r/2 -> [r/4, r/2].
    assert_eq!([-r, 0, r / 2, r].map(|x| full(x, 32)), [r * ONE, r / 4 * ONE, 0, 0]);
    assert_eq!([-100, 100].map(|x| full(x, 32)), [r * ONE, 0], "beyond the splat as on its border");
}

#[test]
fn bands_are_squeezed_in_order_and_stay_in_their_room() {
    for radius in [1, 5, 16, 255] {
        let splat = splat(radius);
        for asymmetry in [16, 20, 32, 50, 128, 255] {
            let room = splat.room(asymmetry) as i32;
            let to = |x: i32| x + splat.full(x, asymmetry);
            let mut before = -1;
            for x in -radius * ONE..=radius * ONE {
                assert!(to(x) >= before, "{x} overtakes, radius {radius}, asymmetry {asymmetry}");
                before = to(x);
                if x <= 0 {
                    assert!((0..=room / 2 + 1).contains(&to(x)));
                } else if x < room {
                    assert!((room / 2 - 1..=room).contains(&to(x)));
                } else {
                    assert_eq!(to(x), x);
                }
            }
        }
    }
}

#[test]
fn the_share_is_a_ramp_in_the_depth() {
    let full = 16 * ONE;
    let splat = splat(16);
    assert_eq!([0, NEAR, FAR, u32::MAX].map(|depth| splat.share(depth, full)), [0, 0, full, full]);
    assert_eq!(splat.share((NEAR + FAR) / 2, full), full / 2);
    let mut before = 0;
    for depth in NEAR..FAR {
        let share = splat.share(depth, full);
        let exact = f64::from(full) * f64::from(depth - NEAR) / f64::from(FAR - NEAR);
        assert!(share >= before && (f64::from(share) - exact).abs() < 1.6, "{depth}: {share} for {exact}");
        before = share;
    }
    // The widest that there is.
    let widest = Splat { near: 0, far: (1 << 28) - 1, radius: 255 << 8, ..splat };
    assert_eq!(widest.share(1 << 27, 255 * ONE), 255 * ONE / 2);
    // No step at all.
    assert_eq!(Splat { near: 5, far: 5, ..splat }.share(6, full), full);
}

#[test]
fn lines_have_normals_at_right_angles() {
    for degrees in (0..180).step_by(5) {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let mut moments = Moments::default();
        for step in -15..=15 {
            moments.add((f64::from(step) * cos).round() as i32, (f64::from(step) * sin).round() as i32);
        }
        let [x, y] = unit(moments.normal().unwrap()).unwrap().map(|component| f64::from(component) / 16384.0);
        assert!((x * x + y * y).sqrt() > 0.9995 && (x * x + y * y).sqrt() < 1.0003, "{degrees}");
        assert!((x * cos + y * sin).abs() < 0.03, "{degrees}: {x} {y}");
    }
    let mut cross = Moments::default();
    assert_eq!(cross.normal(), None);
    [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].iter().for_each(|&(x, y)| cross.add(x, y));
    assert_eq!(cross.normal(), None, "no line fits better than another");
    assert_eq!(unit([0, 0]), None);
    assert_eq!(unit([1, 0]), Some([1 << 14, 0]));
    assert_eq!(unit([i32::MIN, 0]), Some([-(1 << 14), 0]));
}

/// A half-plane that is near, at many angles: the whole chain from depths to moved places.
#[test]
fn behind_a_straight_edge_nothing_overtakes_and_nothing_near_moves() {
    for degrees in (0..360).step_by(15) {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let distance = |x: i32, y: i32| (f64::from(x) - 39.6) * cos + (f64::from(y) - 39.7) * sin;
        for asymmetry in [16, 32] {
            let settings = Settings { asymmetry, ..settings(8) };
            let made = made(80, &settings, |x, y| if distance(x, y) < 0.0 { NEAR } else { FAR });
            assert!(made.tally.splats > 60 && made.tally.shrunk == 0, "{degrees}: {:?}", made.tally);
            let away = |splat: &Splat| f64::from(splat.direction[0]) * cos + f64::from(splat.direction[1]) * sin;
            // Where the edge leaves the picture, few cells are left to lay a line through.
            let inner = |splat: &&Splat| splat.cell.iter().all(|at| (4..76).contains(at));
            assert!(made.splats.iter().filter(inner).all(|splat| away(splat) > 0.97 * 16384.0), "{degrees}");
            // Along the normal through the middle, from the hidden to the visible side.
            let mut before = f64::MIN;
            for step in -12..=12 {
                let at = [39.6 + f64::from(step) * cos, 39.7 + f64::from(step) * sin].map(|at| at.round() as i32);
                let [x, y] = made.moved[(at[1] * 80 + at[0]) as usize].map(|by| f64::from(by) / 256.0);
                let to = distance(at[0], at[1]) + x * cos + y * sin;
                if (-6..=6).contains(&step) {
                    assert!(to > before - 0.2, "{degrees}, {step}: {to} after {before}");
                    assert!(to > -1.2, "{degrees}, {step}: still hidden at {to}");
                }
                before = to;
            }
        }
    }
    let made = made(80, &settings(8), |x, _| if x < 40 { NEAR } else { FAR });
    let mut rows = vec![0; 80];
    let grid = Grid::new(80, 80, Margin::NONE, &mut rows).unwrap();
    let map = DistortionMap { grid, owners: &made.owners, splats: &made.splats, asymmetry: 16 };
    for x in 30..50 {
        assert_eq!(map.displaced([x * ONE, 40 * ONE], NEAR), [x * ONE, 40 * ONE], "what is near stays");
    }
    assert_eq!(
        map.displaced([40 * ONE - 64, 40 * ONE], FAR)[0],
        (40 * ONE - 64 + 39 * ONE + 8 * ONE) / 2,
        "between cells"
    );
}

#[test]
fn two_edges_back_to_back_share_what_is_between_them() {
    for width in 2..=12 {
        let made = made(48, &settings(8), |x, _| if (20..20 + width).contains(&x) { NEAR } else { FAR });
        assert!(made.tally.shrunk == made.tally.splats, "{width}: {:?}", made.tally);
        for x in 0..48 {
            let [by_x, by_y] = made.moved[24 * 48 + x as usize];
            assert_eq!(by_y, 0, "{width}, {x}");
            // A cell in the very middle is the left edge's, which comes first.
            let left = 2 * x < 2 * 20 + width;
            assert!(if left { by_x <= 0 } else { by_x >= 0 }, "{width}, {x}: {by_x}");
        }
        // No splat reaches what is another's.
        for splat in &made.splats {
            assert!(splat.radius as i32 <= (width / 2 + 1) * ONE, "{width}: {splat:?}");
            // Neither edge bends the other's line, not even where the picture ends.
            let out = if splat.cell[0] == 20 { -(1 << 14) } else { 1 << 14 };
            assert_eq!(splat.direction, [out, 0], "{width}: {splat:?}");
        }
    }
}

#[test]
fn a_conflict_puts_the_closest_cell_just_outside() {
    // A gap of 9 cells between two near walls: edges that face each other at columns 19 and 29, 5 cells from the
    // middle.
    let made = made(48, &settings(12), |x, _| if (20..29).contains(&x) { FAR } else { NEAR });
    assert_eq!(made.tally.shrunk, made.tally.splats);
    for splat in &made.splats {
        let left = splat.cell[0] == 19;
        // The cell halfway between both is the left one's, which comes first; so the right one ends before it.
        let closest = if left { 6 } else { 5 };
        assert_eq!(splat.radius, closest * ONE as u32 - 1, "{splat:?}");
    }
    // With twice the asymmetry, the room on the visible side is the same, and the hidden side reaches twice as far.
    let settings = Settings { asymmetry: 32, ..settings(30) };
    let wider = self::made(48, &settings, |x, _| if (20..29).contains(&x) { FAR } else { NEAR });
    for splat in &wider.splats {
        let closest = if splat.cell[0] == 19 { 6 } else { 5 };
        assert_eq!(splat.room(32), closest * ONE as u32 - 1, "{splat:?}");
    }
}

#[test]
fn right_angles_conflict() {
    // Far is what lies right of column 19 and below row 19; both edges run from the corner between them.
    let corner = |x: i32, y: i32| if x > 19 && y > 19 { FAR } else { NEAR };
    let radii = |conflict: i32| {
        let made = made(64, &Settings { conflict, ..settings(12) }, corner);
        [[19, 27], [27, 19], [19, 60]].map(|cell| made.splats.iter().find(|splat| splat.cell == cell).unwrap().radius)
    };
    let [left, top, away] = radii(0);
    assert!(left < 12 << 8 && top < 12 << 8, "{left}, {top}");
    assert_eq!(away, 12 << 8);
    assert_eq!(radii(-200), [12 << 8; 3]);
}

#[test]
fn a_splat_shrinks_no_more_than_it_must() {
    for asymmetry in [16, 17, 32, 50, 255] {
        for y in -40i32..=40 {
            for x in (-40i32..=40).filter(|&x| x != 0 || y != 0) {
                let radius = splat(40).outside([x, y], asymmetry);
                let covers = |radius: u32| Splat { radius, ..splat(40) }.covers([x, y], asymmetry);
                // On the visible side a large asymmetry needs more than a splat can have.
                if radius < 255 << 8 {
                    assert!(!covers(radius) && covers(radius + 1), "{x}, {y}, {asymmetry}: {radius}");
                }
            }
        }
    }
}

/// A disc, a bar and a corner, near and far: all that there can be of edges.
fn clutter(x: i32, y: i32) -> u32 {
    if (x - 20) * (x - 20) + (y - 22) * (y - 22) < 90 {
        NEAR
    } else if (x - 38).abs() < 3 && y > 10 {
        300_000
    } else if x > 45 && y > 40 {
        500_000
    } else {
        FAR - (x + 2 * y) as u32 * 100
    }
}

#[test]
fn owners_are_those_that_an_exhaustive_search_finds() {
    let settings = without_conflicts(9);
    let made = made(64, &settings, clutter);
    assert!(made.tally.splats > 100 && made.tally.shrunk == 0 && made.tally.orphans == 0, "{:?}", made.tally);
    for y in 0..64 {
        for x in 0..64 {
            let square = |splat: &Splat| (x - i32::from(splat.cell[0])).pow(2) + (y - i32::from(splat.cell[1])).pow(2);
            let covers = |splat: &&Splat| square(splat) <= 81;
            // Of splats as close, `min_by_key` gives the first.
            let closest = made.splats.iter().filter(covers).min_by_key(|splat| square(splat));
            let owner = made.owners[(y * 64 + x) as usize].checked_sub(1).map(|owner| &made.splats[owner as usize]);
            assert_eq!(owner, closest, "{x}, {y}");
        }
    }
}

#[test]
fn no_cell_belongs_to_a_splat_that_does_not_reach_it() {
    let made = made(64, &settings(12), clutter);
    let before = self::made(64, &without_conflicts(12), clutter);
    assert!(made.tally.orphans > 20 && made.tally.shrunk > 20, "{:?}", made.tally);
    let owned = made.owners.iter().filter(|&&owner| owner != 0).count() as u32;
    assert_eq!(owned, made.tally.distorted);
    assert_eq!(owned + made.tally.orphans, before.tally.distorted);
    for (cell, (&owner, &was)) in made.owners.iter().zip(&before.owners).enumerate() {
        assert!(owner == was || owner == 0, "an owner changes only by deletion");
        let Some(owner) = was.checked_sub(1) else { continue };
        let splat = &made.splats[owner as usize];
        let (x, y) = (cell as i32 % 64 - i32::from(splat.cell[0]), cell as i32 / 64 - i32::from(splat.cell[1]));
        let reached = f64::from(x * x + y * y).sqrt() * 256.0 <= f64::from(splat.radius);
        assert_eq!(reached, made.owners[cell] != 0, "{cell}");
    }
}

#[test]
fn what_faces_nowhere_is_no_splat() {
    // One near cell: its surroundings are equally far, so no direction leads away from it.
    let made = made(16, &settings(4), |x, y| if (x, y) == (8, 8) { NEAR } else { FAR });
    assert_eq!((made.tally.edges, made.tally.splats, made.tally.distorted), (1, 0, 0));
    // Two of them do have a line.
    let made = self::made(16, &settings(4), |x, y| if y == 8 && (x == 8 || x == 9) { NEAR } else { FAR });
    assert_eq!(made.tally.splats, 2);
}

#[test]
fn a_plane_at_any_slant_is_not_distorted() {
    let made = made(64, &settings(8), |x, y| 100_000 + 7000 * x as u32 + 5000 * y as u32);
    assert_eq!(made.tally, Tally::default());
    assert!(made.moved.iter().all(|by| *by == [0, 0]));
}

#[test]
fn memory_that_is_too_short_is_refused_or_counted() {
    let mut rows = [0; 16];
    let grid = Grid::new(16, 16, Margin::NONE, &mut rows).unwrap();
    let depths: [u32; 256] = core::array::from_fn(|cell| if cell % 16 < 8 { NEAR } else { FAR });
    let (mut owners, mut splats) = ([0; 256], [Splat::default(); 5]);
    let short = |plane: &'static str, have: usize| SetupError::TooShort { plane, need: 256, have };
    let refused = |depths: &[u32], owners: &mut [u32]| {
        DistortionMap::new(grid, depths, &settings(4), owners, &mut []).unwrap_err()
    };
    assert_eq!(refused(&depths[1..], &mut owners), short("plane of depths", 255));
    assert_eq!(refused(&depths, &mut owners[9..]), short("distortion map", 247));
    let (_, tally) = DistortionMap::new(grid, &depths, &settings(4), &mut owners, &mut splats).unwrap();
    assert_eq!((tally.edges, tally.splats, tally.dropped), (16, 5, 11));
}

/// Depths and places that make no sense, and settings beyond their ranges: nothing overflows, and a map stays the same.
#[test]
fn nothing_overflows_and_the_same_comes_out_again() {
    let mut state = 1u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    for round in 0..40 {
        let settings = Settings {
            radius: (random() >> 58 << (round % 3)) as u32,
            asymmetry: (random() >> 55) as u32,
            threshold: (random() >> 40) as u32,
            window: (random() >> 59) as u32,
            conflict: random() as i32 >> (round % 20),
        };
        let depths: Vec<u32> = (0..40 * 40).map(|_| (random() >> 36) as u32).collect();
        let depth = |x: i32, y: i32| depths[(y * 40 + x) as usize];
        let (one, other) = (made(40, &settings, depth), made(40, &settings, depth));
        assert!(one.owners == other.owners && one.splats == other.splats && one.moved == other.moved);
        let mut rows = vec![0; 40];
        let grid = Grid::new(40, 40, Margin::NONE, &mut rows).unwrap();
        let map =
            DistortionMap { grid, owners: &one.owners, splats: &one.splats, asymmetry: settings.clamped().asymmetry };
        for _ in 0..2000 {
            let place = [(random() >> 50) as i32 - 2000, (random() >> 50) as i32 - 2000];
            let by = map.displacement(place, random() as u32);
            assert!(by.iter().all(|by| by.abs() <= 255 * ONE + 2), "{by:?}");
            let [x, y] = [random() as i32, random() as i32];
            let _ = map.displaced([x, y], random() as u32);
        }
    }
}
