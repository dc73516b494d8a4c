//! Whole galpixels through propagation, in all states of tiny budgets: the map holds one galpixel of each state.

use galpix_core::layers::displacement_word;
use galpix_core::record::{Component, Field};
use galpix_core::stages::sweep;
use galpix_core::{Bits, Class, Demand, Dynamic, FillMode, Format, Galpixmap, Layout, Record, Rounding, Settings};

use galpix_tests::exact::{self, Exact, saturated};
use galpix_tests::layouts::{SHADED565, TINY_DEPTH, TINY_PLANE, TINY_SHADED, TINY_SLIDE};
use galpix_tests::memory::{Shape, cell_words, with_maps};
use galpix_tests::packed;
use galpix_tests::profiles::dynamic;
use galpix_vectors::arrivals::{Arrival, arrivals};

use crate::layers::engine::with_layers;
use crate::layers::model::Kind;

/// Returns a budget with this component everywhere, 4 depth bins and a luminosity of 4.2 bits.
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

/// Checks the slow arrivals, the sweep and a stationary layer of a map that holds every state of `across` by column and
/// of `down` by row; all other bits are arbitrary and differ from cell to cell.
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
    with_maps(shape, format, Some(&content), |front, mut back| {
        let most_down = record.scales.iter().map(|scale| scale.down).max().unwrap();
        let before: Vec<Vec<u32>> = (0..shape.cells()).map(|cell| cell_words(&front, cell)).collect();
        for rounding in Rounding::ALL {
            let mut expected = Vec::new();
            for frame in (0..1 << most_down).map(|n: u32| n.wrapping_sub(2)) {
                let of = Expected { bits, record, shape, rounding, frame };
                // By these two all frames are alike.
                if expected.is_empty() || !matches!(rounding, Rounding::Truncate | Rounding::Nearest) {
                    expected = (0..).zip(&before).map(|(source, words)| of.arrival(words, source)).collect();
                }
                let what = format!("{rounding:?}, frame {frame}");
                // In raster order, and none is left out.
                let arrivals = arrivals(&front, rounding, frame);
                assert_eq!(arrivals.len(), expected.len(), "{what}");
                for ((arrival, (expected, _)), before) in arrivals.iter().zip(&expected).zip(&before) {
                    assert_eq!(arrival, expected, "{what}, state {before:x?}");
                }
                swept(&front, &mut back, &of, &expected);
                kept_in_their_cells(format, &of, &before, &expected);
            }
        }
    });
}

/// Compares a sweep: who wins a cell, and the counts.
fn swept(
    front: &Galpixmap<'_, Dynamic>,
    back: &mut Galpixmap<'_, Dynamic>,
    of: &Expected<'_>,
    expected: &[(Arrival, [i64; 2])],
) {
    let mut winners = vec![0; expected.len()];
    let tally = sweep(front, back, &mut winners, of.rounding, of.frame);
    let (mut reached, mut lost, mut saturated) = (vec![false; expected.len()], 0, 0);
    for (arrival, _) in expected {
        saturated += arrival.saturated;
        match arrival.cell {
            Some(cell) => reached[cell as usize] = true,
            None => lost += 1,
        }
    }
    assert_eq!((tally.moved, tally.lost, tally.saturated), (of.shape.cells(), lost, saturated));
    for (cell, _) in (0..).zip(reached).filter(|(_, reached)| *reached) {
        let (arrival, _) = expected[winners[cell as usize] as usize];
        assert_eq!(arrival.cell, Some(cell));
        assert_eq!(cell_words(back, cell), arrival.words[..of.record.words()]);
    }
}

/// Compares a stationary-source layer, which loses no galpixel: the words of each galpixel after a step, and the cells
/// that it moved.
fn kept_in_their_cells(format: Dynamic, of: &Expected<'_>, before: &[Vec<u32>], expected: &[(Arrival, [i64; 2])]) {
    let base = Kind { winners: false, edges: false, stationary: false };
    let mut nothing = vec![0; of.record.words()];
    packed::set(of.record.class(), &mut nothing, Class::Empty as i64);
    let layer = (Kind { stationary: true, ..base }, before.to_vec());
    with_layers(of.shape, format, &[(base, vec![nothing; before.len()]), layer], |layers| {
        layers.set_frame(of.frame);
        layers.step(&Settings { rounding: of.rounding, fill_mode: FillMode::None, ..Settings::for_depth(16) });
        let saturated = expected.iter().map(|(arrival, _)| arrival.saturated).sum::<u32>();
        assert_eq!(layers.hidden()[0].tally().saturated, saturated);
        let displacements = layers.displacements_mut(1).expect("displacements");
        for (word, (_, moved)) in displacements.iter().zip(expected) {
            assert_eq!(*word, displacement_word(moved.map(|cells| cells as i32)));
        }
        let map = layers.layer_mut(1).expect("a layer");
        for ((cell, (arrival, _)), before) in (0..).zip(expected).zip(before) {
            assert_eq!(cell_words(map, cell), arrival.words[..of.record.words()], "state {before:x?}");
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
    /// Returns the arrival of a galpixel, and the cells that it moved.
    fn arrival(&self, before: &[u32], source: u32) -> (Arrival, [i64; 2]) {
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
        let mut moved = [0; 2];
        let mut offsets = [0; 2];
        let fields = [record.offset_x(), record.offset_y()];
        if record.layout().velocity {
            for (index, component) in [bits.x, bits.y].iter().enumerate() {
                let frac = component.position_frac;
                let r = step(index, component, Exact::of(packed::signed(fields[index], before), frac), frac);
                moved[index] = exact::nearest_cell(Exact::of(r, frac));
                offsets[index] = r - (moved[index] << frac);
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
        let [x, y] = [i64::from(source % shape.width) + moved[0], i64::from(source / shape.width) + moved[1]];
        let inside = (0..i64::from(shape.width)).contains(&x) && (0..i64::from(shape.height)).contains(&y);
        let cell = inside.then(|| (y * i64::from(shape.width) + x) as u32);
        (Arrival { cell, source, words: after, saturated: saturations }, moved)
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
