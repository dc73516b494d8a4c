//! Whole galpixels through propagation, in all states of tiny budgets: the map holds one galpixel of each state.

use galpix_core::record::{Component, Field};
use galpix_core::{Bits, Class, Demand, Format, Layout, Record, Rounding};
use galpix_tests::exact::{self, Exact, saturated};
use galpix_tests::layouts::{SHADED565, TINY_DEPTH, TINY_PLANE, TINY_SHADED, TINY_SLIDE};
use galpix_tests::lent::{Shape, with_maps};
use galpix_tests::packed;
use galpix_tests::profiles::dynamic;
use galpix_vectors::arrivals::{Arrival, arrivals};

/// A budget with this component everywhere, 4 depth bins and a luminosity of 4.2 bits.
fn bits(component: Component) -> Bits {
    let component = component.checked().unwrap();
    let mut bits = Bits::derive(Demand { extent: 4, recog: 1, prop: 4 }).unwrap();
    bits = bits.with_xy(component, component).with_z(component, 2);
    Bits { luminosity_int: 4, luminosity_frac: 2, ..bits }
}

const DERIVED: Component =
    Component { position_frac: 2, velocity_int: 1, velocity_frac: 3, acceleration_int: 1, acceleration_frac: 2 };
const LIFTED: Component =
    Component { position_frac: 4, velocity_int: 2, velocity_frac: 1, acceleration_int: 1, acceleration_frac: 1 };
const SLIDE: Component =
    Component { position_frac: 2, velocity_int: 2, velocity_frac: 5, acceleration_int: 0, acceleration_frac: 0 };

/// Every state of `fields`, by number.
fn put_state(fields: &[Field], words: &mut [u32], mut state: u32) {
    for &field in fields {
        packed::set(field, words, i64::from(state));
        state >>= field.bits;
    }
}

fn states(fields: &[Field]) -> u32 {
    1 << fields.iter().map(|field| u32::from(field.bits)).sum::<u32>()
}

/// Checks the arrivals of a map that holds every state of `across` by column and of `down` by row; all other bits are
/// arbitrary and differ from cell to cell.
fn check(layout: Layout, bits: Bits, across: &[Field], down: &[Field]) {
    let format = dynamic(layout, bits);
    let record = format.record();
    let shape = Shape::plain(states(across), states(down));
    let cells = shape.cells() as usize;
    let mut content = vec![0; cells * record.words()];
    for (cell, number) in (0..cells).zip(0u32..) {
        let mut words: Vec<u32> =
            (1..).map(|n| number.wrapping_mul(0x9e37_79b9 ^ n << 7)).take(record.words()).collect();
        packed::set(record.class(), &mut words, i64::from(number.count_ones() % 3));
        put_state(across, &mut words, number % shape.width);
        put_state(down, &mut words, number / shape.width);
        for (plane, word) in words.into_iter().enumerate() {
            content[plane * cells + cell] = word;
        }
    }
    with_maps(shape, format, Some(&content), |front, _| {
        let most_down = record.scales.iter().map(|scale| scale.down).max().unwrap();
        for rounding in Rounding::ALL {
            for frame in (0..1 << most_down).map(|n: u32| n.wrapping_sub(2)) {
                let mut sources = 0..shape.cells();
                for arrival in arrivals(&front, rounding, frame) {
                    assert_eq!(Some(arrival.source), sources.next(), "raster order, and nobody is left out");
                    let before: Vec<u32> =
                        (0..record.words()).map(|word| front.plane(word).unwrap()[arrival.source as usize]).collect();
                    let expected = Expected { bits, record, shape, rounding, frame }.arrival(&before, arrival.source);
                    assert_eq!(arrival, expected, "{rounding:?}, frame {frame}, state {before:x?}");
                }
                assert!(sources.is_empty());
            }
        }
    });
}

/// What propagation makes of galpixels, equation by equation.
struct Expected<'r> {
    bits: Bits,
    record: &'r Record,
    shape: Shape,
    rounding: Rounding,
    frame: u32,
}

impl Expected<'_> {
    fn arrival(&self, before: &[u32], source: u32) -> Arrival {
        let Self { bits, record, shape, rounding, frame } = *self;
        let mut after = [0; galpix_core::record::MAX_WORDS];
        after[..before.len()].copy_from_slice(before);
        let mut saturations = 0;
        let mut step = |index: usize, component: &Component, r: Exact, r_frac: u32| {
            let (velocity, acceleration) = (record.velocity(index), record.acceleration(index));
            let v = Exact::of(packed::signed(velocity, before), component.velocity_frac);
            let a = Exact::of(packed::signed(acceleration, before), component.acceleration_frac);
            if acceleration.present() {
                let raw = exact::velocity(v, a, component);
                let held = saturated(raw, u32::from(velocity.bits));
                saturations += u32::from(held != raw);
                packed::set(velocity, &mut after, held);
            }
            exact::position(r, v, a, rounding, frame, component.velocity_frac, r_frac)
        };
        let mut cells = [i64::from(source % shape.width), i64::from(source / shape.width)];
        let mut offsets = [0; 2];
        let fields = [record.offset_x(), record.offset_y()];
        if record.layout().velocity {
            for (index, component) in [bits.x, bits.y].iter().enumerate() {
                let frac = component.position_frac;
                let r = step(index, component, Exact::of(packed::signed(fields[index], before), frac), frac);
                let moved = exact::nearest_cell(Exact::of(r, frac));
                cells[index] += moved;
                offsets[index] = r - (moved << frac);
            }
        }
        let depth = record.depth();
        let mut deep = packed::unsigned(depth, before);
        if record.layout().depth_motion {
            let frac = u32::from(depth.bits) - bits.depth_int;
            let raw = step(2, &bits.z, Exact::of(deep, frac), frac);
            deep = raw.clamp(0, (1 << depth.bits) - 1);
            saturations += u32::from(deep != raw);
        }
        packed::set(depth, &mut after, deep);
        for (field, offset) in fields.into_iter().zip(offsets) {
            packed::set(field, &mut after, offset);
        }
        if record.layout().luminosity {
            let frac = bits.luminosity_frac;
            let level = Exact::of(packed::unsigned(record.luminosity(), before), frac)
                .plus(Exact::of(packed::signed(record.luminosity_rate(), before), frac));
            let steps = level.floor(0);
            packed::set(record.luminosity(), &mut after, level.whole(frac) - (steps << frac));
            let colour = packed::unsigned(record.colour(), before) as u32;
            packed::set(
                record.colour(),
                &mut after,
                i64::from(record.colour_format().brightened(colour, steps as i32)),
            );
        }
        if packed::unsigned(record.class(), before) == Class::JustUnobscured as i64 {
            packed::set(record.class(), &mut after, Class::Debris as i64);
        }
        let [x, y] = cells;
        let inside = (0..i64::from(shape.width)).contains(&x) && (0..i64::from(shape.height)).contains(&y);
        let cell = inside.then(|| (y * i64::from(shape.width) + x) as u32);
        Arrival { cell, source, words: after, saturated: saturations }
    }
}

fn plane(layout: Layout, component: Component) {
    let bits = bits(component);
    let record = *dynamic(layout, bits).record();
    let of = |index: usize, offset| [offset, record.velocity(index), record.acceleration(index)];
    check(layout, bits, &of(0, record.offset_x()), &of(1, record.offset_y()));
}

fn depth(layout: Layout, component: Component) {
    let bits = bits(component);
    let record = *dynamic(layout, bits).record();
    check(layout, bits, &[record.depth()], &[record.velocity(2), record.acceleration(2)]);
}

fn luminosity(layout: Layout) {
    let bits = bits(DERIVED);
    let record = *dynamic(layout, bits).record();
    check(layout, bits, &[record.colour()], &[record.luminosity_rate(), record.luminosity()]);
}

#[test]
fn in_the_plane() {
    plane(TINY_PLANE, DERIVED);
}

#[test]
fn in_the_plane_with_a_position_finer_than_the_step() {
    plane(TINY_PLANE, LIFTED);
}

#[test]
fn in_the_plane_without_acceleration() {
    plane(TINY_SLIDE, SLIDE);
}

#[test]
fn in_depth() {
    depth(TINY_DEPTH, DERIVED);
    depth(TINY_DEPTH, Component { velocity_int: 3, acceleration_int: 3, ..DERIVED });
}

#[test]
fn in_luminosity() {
    luminosity(TINY_SHADED);
}

#[test]
fn in_luminosity_of_uneven_channels() {
    let bits = Bits { luminosity_int: 2, luminosity_frac: 1, ..bits(DERIVED) };
    let record = *dynamic(SHADED565, bits).record();
    // 2^15 columns is as wide as a map can be: the blue channel's lowest bit is left to chance.
    let high = Field { bits: 15, shift: record.colour().shift + 1, ..record.colour() };
    check(SHADED565, bits, &[high], &[record.luminosity_rate(), record.luminosity()]);
}
