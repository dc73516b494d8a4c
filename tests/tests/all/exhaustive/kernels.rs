//! The scalar kernels of propagation and rounding.

use galpix_core::record::{Component, Scale, WIDEST_FIELD};
use galpix_core::stages::{clamp_velocity, snap, step_position, step_velocity};
use galpix_core::{Bits, Demand, Layout, Record, Rounding};
use galpix_tests::exact::{self, Exact, saturated, signed};
use galpix_tests::layouts::TINY_PLANE;

const fn component(position_frac: u32, velocity: [u32; 2], acceleration: [u32; 2]) -> Component {
    Component {
        position_frac,
        velocity_int: velocity[0],
        velocity_frac: velocity[1],
        acceleration_int: acceleration[0],
        acceleration_frac: acceleration[1],
    }
}

/// Small enough for all states of a component, and between them every relation of the three fractions.
const COMPONENTS: [(&str, Component); 8] = [
    ("as equations (11) to (13) give them for tau_prop = 4", component(2, [3, 3], [2, 3])),
    ("velocity finer than acceleration", component(2, [3, 4], [2, 2])),
    ("position finer than the step", component(6, [2, 2], [2, 1])),
    ("position as fine as the step", component(4, [3, 3], [2, 3])),
    ("no fraction of the position", component(0, [2, 3], [2, 3])),
    ("no fraction at all", component(0, [3, 0], [2, 0])),
    ("acceleration wider than velocity", component(1, [1, 2], [4, 2])),
    ("no acceleration", component(3, [3, 5], [0, 0])),
];

/// Returns the arithmetic of a component, as a layout's record holds it.
fn scale(component: Component) -> Scale {
    let bits = Bits::derive(Demand { extent: 64, recog: 8, prop: 4 }).unwrap();
    let bits = bits.with_xy(component.checked().unwrap(), component);
    let layout = Layout { acceleration: component.has_acceleration(), ..TINY_PLANE };
    Record::plan(bits, layout).unwrap().scales[0]
}

/// Frames of more than a whole period of any threshold here, over the wrapping of the counter.
fn frames() -> impl Iterator<Item = u32> + Clone {
    (0..70).map(|n| u32::MAX.wrapping_sub(33).wrapping_add(n))
}

#[test]
fn between_them_the_budgets_have_every_relation_of_fractions() {
    let scales = COMPONENTS.map(|(_, component)| scale(component));
    assert!(scales.iter().any(|scale| scale.up > 0));
    assert!(scales.iter().any(|scale| scale.down > 2));
    assert!(scales.iter().any(|scale| scale.up == 0 && scale.down == 0));
    assert!(scales.iter().any(|scale| scale.acceleration_up > 0));
}

#[test]
fn a_position_steps_by_equation_6() {
    for (name, component) in COMPONENTS {
        let scale = scale(component);
        for rounding in Rounding::ALL {
            for frame in frames() {
                let threshold = rounding.threshold(frame, scale.down);
                for v in signed(component.velocity_bits()) {
                    for a in signed(component.acceleration_bits()) {
                        for r in signed(component.position_frac) {
                            let stepped = step_position(&scale, threshold, r as i32, v as i32, a as i32);
                            let exact = exact::position(
                                Exact::of(r, component.position_frac),
                                Exact::of(v, component.velocity_frac),
                                Exact::of(a, component.acceleration_frac),
                                rounding,
                                frame,
                                component.velocity_frac,
                                component.position_frac,
                            );
                            assert_eq!(i64::from(stepped), exact, "{name}, {rounding:?}, {frame}: r {r} v {v} a {a}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_velocity_steps_by_equation_7_and_is_clamped_to_its_field() {
    for (name, component) in COMPONENTS {
        let scale = scale(component);
        for v in signed(component.velocity_bits()) {
            for a in signed(component.acceleration_bits()) {
                let exact = exact::velocity(
                    Exact::of(v, component.velocity_frac),
                    Exact::of(a, component.acceleration_frac),
                    &component,
                );
                let stepped = step_velocity(&scale, v as i32, a as i32);
                assert_eq!(i64::from(stepped), exact, "{name}: v {v} a {a}");
                let held = saturated(exact, component.velocity_bits());
                assert_eq!(i64::from(clamp_velocity(&scale, stepped)), held, "{name}: v {v} a {a}");
            }
        }
    }
}

#[test]
fn a_position_snaps_to_the_nearest_cell_halves_upwards() {
    for (name, component) in COMPONENTS {
        let scale = scale(component);
        for position in -(1i64 << 10)..=1 << 10 {
            let cell = exact::nearest_cell(Exact::of(position, component.position_frac));
            assert_eq!(i64::from(snap(&scale, position as i32)), cell, "{name}: {position}");
        }
    }
}

#[test]
fn a_threshold_is_the_offset_of_the_frame_in_dropped_bits() {
    for rounding in Rounding::ALL {
        for shift in 0..=12 {
            for frame in (0..1 << 13).chain(u32::MAX - (1 << 13)..=u32::MAX) {
                let exact = exact::offset_of_frame(rounding, frame, shift, 0).floor(shift);
                assert_eq!(i64::from(rounding.threshold(frame, shift)), exact, "{rounding:?} {frame} {shift}");
            }
        }
        for shift in [32, 33, u32::MAX] {
            assert_eq!(rounding.threshold(12345, shift), 0, "there is no such shift");
        }
    }
}

#[test]
fn low_discrepancy_takes_each_threshold_once_in_any_period() {
    for shift in 0..=8 {
        let period = 1u32 << shift;
        for first in (0..2 * period).map(|n| n.wrapping_sub(period)) {
            let mut seen = vec![false; period as usize];
            for n in 0..period {
                let threshold = Rounding::LowDiscrepancy.threshold(first.wrapping_add(n), shift);
                assert!(!std::mem::replace(&mut seen[threshold as usize], true), "{shift} bits from frame {first} on");
            }
        }
    }
}

/// The widest fields that any component may have, at both ends of their ranges: nothing leaves 32 bits.
#[test]
fn the_widest_fields_do_not_overflow() {
    let ends = |bits: u32| [-(1i64 << (bits - 1)), (1i64 << (bits - 1)) - 1];
    let mut widest = 0;
    for position_frac in 0..=16 {
        for velocity_int in 1..=30 {
            for velocity_frac in 0..=30 - velocity_int {
                for acceleration_frac in 0..=velocity_frac {
                    let wide = |acceleration_int| {
                        let fields = ([velocity_int, velocity_frac], [acceleration_int, acceleration_frac]);
                        component(position_frac, fields.0, fields.1).checked().ok()
                    };
                    let Some(component) = (1..=30).rev().find_map(wide) else { continue };
                    widest = widest.max(component.velocity_bits());
                    let scale = scale(component);
                    for rounding in Rounding::ALL {
                        for frame in [0, u32::MAX] {
                            for (v, a) in ends(component.velocity_bits())
                                .into_iter()
                                .flat_map(|v| ends(component.acceleration_bits()).map(|a| (v, a)))
                            {
                                let threshold = rounding.threshold(frame, scale.down);
                                let r = 0;
                                let exact = exact::position(
                                    Exact::of(r, position_frac),
                                    Exact::of(v, velocity_frac),
                                    Exact::of(a, acceleration_frac),
                                    rounding,
                                    frame,
                                    velocity_frac,
                                    position_frac,
                                );
                                let at = || format!("{component:?} {rounding:?} frame {frame}: v {v} a {a}");
                                let stepped = step_position(&scale, threshold, r as i32, v as i32, a as i32);
                                assert_eq!(i64::from(stepped), exact, "{}", at());
                                let velocity = step_velocity(&scale, v as i32, a as i32);
                                let held = i64::from(clamp_velocity(&scale, velocity));
                                let sum = v + (a << (velocity_frac - acceleration_frac));
                                assert_eq!(held, saturated(sum, component.velocity_bits()), "{}", at());
                            }
                        }
                    }
                }
            }
        }
    }
    assert_eq!(widest, WIDEST_FIELD);
}
