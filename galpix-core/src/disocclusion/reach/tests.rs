extern crate std;

use std::println;
use std::vec::Vec;

use super::{Bound, Motion, times, times_by_limbs};
use crate::format::budget::Component;
use crate::format::record::Scale;
use crate::format::rounding::Rounding;
use crate::frame::step::{clamp_velocity, snap, step_position, step_velocity};

/// Velocities and accelerations of so few bits that velocities saturate soon.
const ACCELERATED: Component =
    Component { position_frac: 1, velocity_int: 2, velocity_frac: 3, acceleration_int: 1, acceleration_frac: 2 };
const SLIDE: Component =
    Component { position_frac: 2, velocity_int: 2, velocity_frac: 3, acceleration_int: 0, acceleration_frac: 0 };
const EXACT: Component = Component { velocity_frac: 2, ..SLIDE };
const LIFTED: Component = Component { position_frac: 3, velocity_frac: 1, ..SLIDE };

fn motions(component: Component) -> Vec<Motion> {
    let scale = Scale::new(component, component.position_frac);
    let range = |bits: u32| if bits == 0 { 0..=0 } else { -(1 << (bits - 1))..=(1 << (bits - 1)) - 1 };
    let mut motions = Vec::new();
    for offset in range(component.position_frac) {
        for velocity in range(component.velocity_bits()) {
            for acceleration in range(component.acceleration_bits()) {
                motions.push(Motion { offset, velocity, acceleration: acceleration << scale.acceleration_up });
            }
        }
    }
    motions
}

/// Returns the cells moved after each of `frames` frames, by the kernels of propagation.
fn path(scale: &Scale, of: Motion, rounding: Rounding, phase: u32, frames: u32) -> Vec<i32> {
    let scale = Scale { acceleration_up: 0, ..*scale };
    let (mut position, mut v) = (of.offset, of.velocity);
    (0..frames)
        .map(|n| {
            let threshold = rounding.threshold(phase + n, scale.down);
            position = step_position(&scale, threshold, position, v, of.acceleration);
            v = clamp_velocity(&scale, step_velocity(&scale, v, of.acceleration));
            snap(&scale, position)
        })
        .collect()
}

/// Checks that no pair of motions ever gets farther apart than its bound, with any rounding from any frame on. Returns
/// the number of pairs that reach their bound, and of all pairs.
fn check(component: Component, frames: u32) -> [usize; 2] {
    let scale = Scale::new(component, component.position_frac);
    let bound = Bound::new(&scale, component.has_acceleration(), frames);
    let motions = motions(component);
    let phases: Vec<_> = Rounding::ALL
        .into_iter()
        .flat_map(|rounding| (0..1 << scale.down).map(move |phase| (rounding, phase)))
        .collect();
    let paths: Vec<Vec<Vec<i32>>> = motions
        .iter()
        .map(|&of| phases.iter().map(|&(rounding, phase)| path(&scale, of, rounding, phase, frames)).collect())
        .collect();
    let (mut reached, mut pairs) = (0, 0);
    for (one, paths_of_one) in motions.iter().zip(&paths) {
        for (other, paths_of_other) in motions.iter().zip(&paths) {
            let most = bound.cells(&bound.between(*one, *other)) as i32;
            let farthest = paths_of_one
                .iter()
                .flatten()
                .zip(paths_of_other.iter().flatten())
                .map(|(one, other)| one - other)
                .max()
                .unwrap_or(0);
            assert!(farthest <= most, "{one:?} gets {farthest} ahead of {other:?} in {frames}, bound {most}");
            reached += usize::from(farthest.max(0) == most);
            // The bound does not know the snap to cells, and knows only the most that rounding does either way.
            let rounded = scale.down > u32::from(!component.has_acceleration());
            let unknown = 1 + if rounded { (2 * frames as i32) >> scale.position_frac } else { 0 };
            assert!(most <= farthest.max(0) + unknown, "{one:?} gets {farthest} ahead of {other:?}, bound {most}");
            pairs += 1;
        }
    }
    [reached, pairs]
}

#[test]
fn nothing_gets_farther_ahead_than_its_bound() {
    for frames in 1..=8 {
        for component in [ACCELERATED, SLIDE, EXACT, LIFTED] {
            let [reached, pairs] = check(component, frames);
            println!("{frames} frames: {reached} of {pairs} bounds are reached");
        }
    }
}

#[test]
fn sums_are_those_of_single_steps() {
    let component = Component { velocity_int: 6, acceleration_int: 6, ..ACCELERATED };
    let scale = Scale::new(component, component.position_frac);
    let some = [-97, -31, -8, -3, -1, 0, 1, 2, 7, 30, 96];
    for frames in [1, 2, 3, 5, 8, 13, 64, 127, 128, 254, 255] {
        let bound = Bound::new(&scale, true, frames);
        for velocity in some {
            for acceleration in some {
                for other in some {
                    let one = Motion { offset: 0, velocity, acceleration };
                    let other = Motion { offset: 0, velocity: other, acceleration: 7 };
                    for slack in [0, bound.slack] {
                        let (sum, steps) =
                            (bound.most(&bound.between(one, other), slack), bound.most_in_steps(one, other, slack));
                        assert_eq!(sum, steps, "{one:?} {other:?} {frames} {slack}");
                    }
                }
            }
        }
    }
}

#[test]
fn products_are_products() {
    let by_shifts = |x: i64, n: u32| {
        let shifted = (0..8).map(|bit| if n >> bit & 1 != 0 { x << bit } else { 0 });
        shifted.fold(0, i64::wrapping_add)
    };
    for x in [i64::MIN, -(1 << 40), -(1 << 32) - 1, -65_536, -77, 0, 1, 65_535, u32::MAX.into(), 12_345_678_901] {
        for n in [0, 1, 2, 3, 254, 255] {
            assert_eq!([times(x, n), times_by_limbs(x, n)], [by_shifts(x, n); 2]);
        }
    }
}

#[test]
fn what_differs_by_less_than_the_limits_stays_together() {
    for component in [ACCELERATED, SLIDE, Component { velocity_frac: 12, acceleration_frac: 12, ..ACCELERATED }] {
        let scale = Scale::new(component, component.position_frac);
        for frames in 1..=255 {
            let bound = Bound::new(&scale, component.has_acceleration(), frames);
            let [velocity, acceleration] = bound.together();
            // The worst case of both limits.
            let one = Motion { offset: 0, velocity, acceleration: acceleration << scale.acceleration_up };
            assert!(!bound.parts(&bound.between(one, Motion::default())), "{frames} {one:?}");
            let back = Motion { velocity: -one.velocity, acceleration: -one.acceleration, ..one };
            assert!(!bound.parts(&bound.between(Motion::default(), back)));
            // The limits are not far too small: eight times the velocity gets ahead.
            if velocity > 0 {
                let faster = Motion { velocity: 8 * velocity, ..Motion::default() };
                assert!(bound.parts(&bound.between(faster, Motion::default())));
            }
        }
    }
}
