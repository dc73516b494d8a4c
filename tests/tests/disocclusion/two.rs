//! All maps of two surfaces: what is uncovered is covered.

use std::thread;

use galpix_core::budget::Component;
use galpix_core::disocclusion::{Border, Reach};
use galpix_core::galpixel::Chosen;
use galpix_core::layout::Layout;
use galpix_core::rounding::Rounding;
use galpix_tests::layouts::{TinyDeep, TinyDeepSlide};

use crate::tiny::{Memory, Scene, State, bits, laid_open, uncovered, with_grid};

const SLIDE: Component =
    Component { position_frac: 0, velocity_int: 2, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };
const HALVES: Component = Component { position_frac: 1, velocity_int: 1, velocity_frac: 1, ..SLIDE };
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
}

impl Count {
    fn plus(self, other: Self) -> Self {
        Self {
            maps: self.maps + other.maps,
            uncovered: self.uncovered + other.uncovered,
            covered: self.covered + other.covered,
        }
    }
}

fn numbers(bits: u32) -> std::ops::Range<i32> {
    if bits == 0 { 0..1 } else { -(1 << (bits - 1))..1 << (bits - 1) }
}

/// All pairs of numbers.
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
fn check<L: Layout + Send + Sync>(
    component: Component,
    scenes: &[(State, State)],
    masks: impl Fn(usize, u16) -> bool + Sync,
    frames: std::ops::RangeInclusive<u32>,
) -> Count {
    let budget = Chosen::<L>::new(bits(component)).unwrap();
    let halves = scenes.chunks(scenes.len().div_ceil(2));
    let (masks, frames) = (&masks, &frames);
    thread::scope(|scope| {
        let workers: Vec<_> = halves
            .enumerate()
            .map(|(half, scenes)| {
                scope.spawn(move || {
                    let mut count = Count::default();
                    for (number, &(near, far)) in scenes.iter().enumerate() {
                        let scene = Scene { budget, near, far };
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

fn check_scene<L: Layout>(scene: &Scene<L>, frames: u32, masks: impl Fn(u16) -> bool) -> Count {
    let down = scene.record().scales[0].down;
    let phases = Rounding::ALL.into_iter().flat_map(|rounding| (0..1 << down).map(move |phase| (rounding, phase)));
    let mut paths: Vec<_> = phases.map(|(rounding, phase)| scene.paths(rounding, phase, frames)).collect();
    paths.sort_unstable();
    paths.dedup();
    let words = scene.words();
    let accelerates = scene.near.acceleration != [0, 0] || scene.far.acceleration != [0, 0];
    let exact = !accelerates && scene.record().scales[0].position_frac == 0;
    let mut memory = Memory::new();
    let mut count = Count::default();
    with_grid(|grid| {
        for mask in (0..=u16::MAX).filter(|&mask| masks(mask)) {
            for border in [Border::Still, Border::Continues] {
                let reach = Reach { frames, separation: 1, border, tears: true };
                let (covered, tally) = memory.covered(grid, scene.budget, words, mask, &reach);
                let open = paths.iter().flatten().fold(0, |open, &now| open | uncovered(mask, now, border));
                assert!(
                    open & !covered == 0,
                    "{:?} {:?} {frames} {border:?} {mask:#06x}: {open:#06x} {covered:#06x}",
                    scene.near,
                    scene.far
                );
                assert_eq!((tally.cut, tally.covered), (0, covered.count_ones()));
                if border == Border::Continues {
                    // Where nothing turns back, nothing else is laid open either.
                    for path in paths.iter().filter(|_| exact) {
                        for n in 0..path.len() {
                            assert_eq!(laid_open(mask, path[n], &path[..n]) & !covered, 0);
                        }
                    }
                    count.maps += 1;
                    count.uncovered += u64::from(open.count_ones());
                    count.covered += u64::from(covered.count_ones());
                }
            }
        }
    });
    count
}

/// All pairs of a near and a far state, of those that differ alike only `each`.
fn pairs(states: &[State], each: usize) -> Vec<(State, State)> {
    let mut seen = std::collections::HashMap::new();
    let mut pairs = Vec::new();
    for &near in states {
        for &far in states {
            let difference = [0, 1].map(|component| {
                [
                    near.velocity[component] - far.velocity[component],
                    near.acceleration[component] - far.acceleration[component],
                    near.offset[component],
                    far.offset[component],
                ]
            });
            let count = seen.entry(difference).or_insert(0);
            *count += 1;
            if *count <= each {
                pairs.push((near, far));
            }
        }
    }
    pairs
}

fn report(what: &str, count: Count) {
    println!(
        "{what}: {} maps, {} cells uncovered, {} covered: {:.3} times as many",
        count.maps,
        count.uncovered,
        count.covered,
        count.covered as f64 / count.uncovered as f64
    );
}

#[test]
fn all_velocities() {
    let start = std::time::Instant::now();
    let states = states(SLIDE, &[[0, 0]]);
    let pairs = pairs(&states, usize::MAX);
    report("all", check::<TinyDeepSlide>(SLIDE, &pairs[..16], |_, _| true, 1..=3));
    println!("{} pairs, {:?} for 16", pairs.len(), start.elapsed());
}
