//! All maps of two surfaces: what is uncovered is covered.

use std::collections::HashSet;
use std::thread;

use galpix_core::disocclusion::{Border, Reach};
use galpix_core::record::Component;
use galpix_core::{Layout, Rounding};
use galpix_tests::layouts::{TINY_DEEP, TINY_DEEP_SLIDE};
use galpix_tests::profiles::dynamic;
use galpix_tests::random;

use super::tiny::{Memory, Scene, State, bits, uncovered, with_grid};

const SLIDE: Component =
    Component { position_frac: 0, velocity_int: 2, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };
const HALVES: Component = Component { position_frac: 1, velocity_frac: 1, acceleration_frac: 1, ..ACCELERATED };
const ACCELERATED: Component =
    Component { position_frac: 0, velocity_int: 1, velocity_frac: 0, acceleration_int: 1, acceleration_frac: 0 };
const FINE: Component =
    Component { position_frac: 1, velocity_int: 2, velocity_frac: 2, acceleration_int: 1, acceleration_frac: 2 };

/// Cells, over all maps: uncovered in some frame, and covered.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    maps: u64,
    uncovered: u64,
    covered: u64,
    /// Of these, how many are near ones: the others hide nothing.
    hiding: u64,
}

impl Count {
    fn plus(self, other: Self) -> Self {
        Self {
            maps: self.maps + other.maps,
            uncovered: self.uncovered + other.uncovered,
            covered: self.covered + other.covered,
            hiding: self.hiding + other.hiding,
        }
    }
}

fn numbers(bits: u32) -> std::ops::Range<i32> {
    if bits == 0 { 0..1 } else { -(1 << (bits - 1))..1 << (bits - 1) }
}

/// Returns all pairs of numbers.
fn squares(of: std::ops::Range<i32>) -> Vec<[i32; 2]> {
    of.clone().flat_map(|y| of.clone().map(move |x| [x, y])).collect()
}

/// All states of a budget with these places.
fn states(component: Component, offsets: &[[i32; 2]]) -> Vec<State> {
    let mut states = Vec::new();
    for &offset in offsets {
        for velocity in squares(numbers(component.velocity_bits())) {
            for acceleration in squares(numbers(component.acceleration_bits())) {
                states.push(State { offset, velocity, acceleration });
            }
        }
    }
    states
}

/// Checks some scenes: all near and far masks that `masks` leaves, all `frames`.
fn check(
    layout: Layout,
    component: Component,
    scenes: &[(State, State)],
    masks: impl Fn(usize, u16) -> bool + Sync,
    frames: std::ops::RangeInclusive<u32>,
) -> Count {
    let format = dynamic(layout, bits(component));
    let halves = scenes.chunks(scenes.len().div_ceil(2));
    let (masks, frames) = (&masks, &frames);
    thread::scope(|scope| {
        let workers: Vec<_> = halves
            .enumerate()
            .map(|(half, scenes)| {
                scope.spawn(move || {
                    let mut count = Count::default();
                    for (number, &(near, far)) in scenes.iter().enumerate() {
                        let scene = Scene { format, near, far };
                        for frames in frames.clone() {
                            let number = 2 * number + half;
                            count = count.plus(check_scene(&scene, frames, |mask| masks(number, mask)));
                        }
                    }
                    count
                })
            })
            .collect();
        workers.into_iter().map(|worker| worker.join().unwrap()).fold(Count::default(), Count::plus)
    })
}

fn check_scene(scene: &Scene, frames: u32, masks: impl Fn(u16) -> bool) -> Count {
    let down = scene.record().scales[0].down;
    let phases = Rounding::ALL.into_iter().flat_map(|rounding| (0..1 << down).map(move |phase| (rounding, phase)));
    let mut paths: Vec<_> = phases.map(|(rounding, phase)| scene.paths(rounding, phase, frames)).collect();
    paths.sort_unstable();
    paths.dedup();
    let words = scene.words();
    let mut memory = Memory::new();
    let mut count = Count::default();
    with_grid(|grid| {
        for mask in (0..=u16::MAX).filter(|&mask| masks(mask)) {
            // Beyond the border it makes a difference only before what is still.
            let still = if scene.far.velocity == [0, 0] { Some(Border::Still) } else { None };
            for border in still.into_iter().chain([Border::Continues]) {
                let reach = Reach { frames, separation: 1, border, tears: true, through: false };
                let (covered, tally) = memory.covered(grid, scene.format, words, mask, &reach);
                let open = paths.iter().flatten().fold(0, |open, &now| open | uncovered(mask, now, border));
                assert!(
                    open & !covered == 0,
                    "{:?} {:?} {frames} {border:?} {mask:#06x}: {open:#06x} {covered:#06x}",
                    scene.near,
                    scene.far
                );
                assert_eq!((tally.saturated, tally.covered), (0, covered.count_ones()));
                if border == Border::Continues {
                    count.maps += 1;
                    count.uncovered += u64::from(open.count_ones());
                    count.covered += u64::from(covered.count_ones());
                    count.hiding += u64::from((covered & mask).count_ones());
                }
            }
        }
    });
    count
}

/// Pairs of a near and a far state, of those that differ alike only one.
fn distinct(states: &[State]) -> Vec<(State, State)> {
    let mut seen = HashSet::new();
    let all = states.iter().flat_map(|&near| states.iter().map(move |&far| (near, far)));
    all.filter(|(near, far)| {
        let apart = |of: fn(&State) -> [i32; 2]| [0, 1].map(|component| of(near)[component] - of(far)[component]);
        seen.insert([apart(|state| state.velocity), apart(|state| state.acceleration)])
    })
    .collect()
}

fn report(what: &str, count: Count) {
    println!(
        "{what}: {} maps, {} cells uncovered, {} covered ({:.2} times as many), {} of them of the near surface ({:.2})",
        count.maps,
        count.uncovered,
        count.covered,
        count.covered as f64 / count.uncovered as f64,
        count.hiding,
        count.hiding as f64 / count.uncovered as f64,
    );
    assert!(count.uncovered > 0 && count.hiding < 9 * count.uncovered);
}

/// Returns one of every `share` masks, another one for each scene.
fn sampled(share: u32) -> impl Fn(usize, u16) -> bool + Sync {
    move |scene, mask| (u32::from(mask).wrapping_add(scene as u32)).wrapping_mul(0x9e37_79b1) >> 16 < 65536 / share
}

/// All maps, all differences of whole velocities from -2 to 1, 3 frames.
#[test]
fn all_maps_of_two_velocities() {
    let pairs = distinct(&states(SLIDE, &[[0, 0]]));
    assert_eq!(pairs.len(), 49);
    report("all maps, all differences of velocities", check(TINY_DEEP_SLIDE, SLIDE, &pairs, |_, _| true, 3..=3));
}

/// The same of all pairs of velocities, for 1 to 3 frames, of a part of the maps: a map depends on the difference
/// alone.
#[test]
fn all_velocities() {
    let states = states(SLIDE, &[[0, 0]]);
    let pairs: Vec<_> = states.iter().flat_map(|&near| states.iter().map(move |&far| (near, far))).collect();
    assert_eq!(pairs.len(), 256);
    report("all velocities", check(TINY_DEEP_SLIDE, SLIDE, &pairs, sampled(64), 1..=3));
}

/// All maps, all differences of velocities and accelerations of a bit; and all pairs of these, which saturate, of a
/// part of the maps.
#[test]
fn all_accelerations() {
    let states = states(ACCELERATED, &[[0, 0]]);
    let apart = distinct(&states);
    assert_eq!(apart.len(), 81);
    report("all maps, all differences of accelerations", check(TINY_DEEP, ACCELERATED, &apart, |_, _| true, 3..=3));
    let pairs: Vec<_> = states.iter().flat_map(|&near| states.iter().map(move |&far| (near, far))).collect();
    assert_eq!(pairs.len(), 256);
    report("all accelerations", check(TINY_DEEP, ACCELERATED, &pairs, sampled(64), 1..=3));
}

/// Fractions, places in the cells, every rounding from every frame on: a part of the states, and of the maps.
#[test]
fn some_of_fractions() {
    for (component, offsets) in [(HALVES, [[0, 0], [-1, 0], [0, -1]]), (FINE, [[0, 0], [-1, 0], [-1, -1]])] {
        let mut generator = random::generator(7);
        let states = states(component, &offsets);
        let mut any = || states[random::below(&mut generator, states.len() as u32) as usize];
        let pairs: Vec<_> = (0..400).map(|_| (any(), any())).collect();
        report("fractions", check(TINY_DEEP, component, &pairs, sampled(256), 1..=6));
    }
}
