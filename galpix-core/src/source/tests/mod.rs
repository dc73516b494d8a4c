//! Stationary sources: the fast passes against their references, small budgets exhaustively, and what is seen.

mod constant_time;
mod equal;
mod exact;
mod objects;
mod order;
mod pictures;
mod setup;

extern crate std;

use std::vec;
use std::vec::Vec;

use super::visibility::Visibility;
use super::{Source, Sources, links};
use crate::format::budget::{Bits, Component, Demand};
use crate::format::colour::Colour;
use crate::format::layout::Layout;
use crate::format::{Dynamic, Format, Profile, Static};
use crate::map::Galpixmap;
use crate::map::galpixel::{Class, Galpixel};
use crate::map::grid::{Grid, Margin};
use crate::random::Random;
use fixed::types::I32F32;

const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 64, recog: 8, prop: 16 }));

/// The display of a map, and its margin.
type Shape = (u32, u32, Margin);

/// Around runs of 32 and chunks of 64 cells too.
const SHAPES: [Shape; 16] = [
    (1, 1, Margin::NONE),
    (1, 9, Margin::NONE),
    (9, 1, Margin::NONE),
    (2, 2, Margin::NONE),
    (2, 7, Margin::NONE),
    (6, 5, Margin { left: 2, right: 1, top: 1, bottom: 3 }),
    (1, 1, Margin::all(2)),
    (31, 5, Margin::NONE),
    (31, 4, Margin { left: 1, right: 0, top: 1, bottom: 0 }),
    (31, 6, Margin::all(1)),
    (63, 4, Margin::NONE),
    (64, 5, Margin::NONE),
    (65, 4, Margin::NONE),
    (96, 3, Margin::NONE),
    (127, 3, Margin { left: 1, right: 1, top: 0, bottom: 1 }),
    (130, 3, Margin::NONE),
];

/// Fraction bits of the position, and the fields beside it.
const FORMATS: [(u32, Layout); 11] = [
    (4, Layout::FULL),
    (5, Layout::SHADED),
    (4, Layout::STILL),
    (1, Layout::FLAT565),
    (8, Layout::VELOCITY565),
    (9, Layout::VELOCITY_GRAY8),
    (12, Layout { depth_bits: 28, depth_motion: false, ..Layout::FULL }),
    (16, Layout { depth_bits: 0, depth_motion: false, tag_bits: 3, ..Layout::FULL }),
    (3, Layout { colour: Colour::must(Colour::rgb(1, 8, 2)), ..Layout::VELOCITY565 }),
    (0, Layout::VELOCITY_GRAY4),
    (6, Layout { depth_bits: 15, ..Layout::VELOCITY565 }),
];

fn format(frac: u32, layout: Layout) -> Dynamic {
    let component = Component { position_frac: frac, ..BITS.x };
    Dynamic::new(BITS.with_xy(component, component), layout).unwrap()
}

struct Full;

impl Profile for Full {
    const LAYOUT: Layout = Layout::FULL;
    const BITS: Bits = BITS;
}

struct Small;

impl Profile for Small {
    const LAYOUT: Layout = Layout::VELOCITY_GRAY4;
    const BITS: Bits = BITS;
}

/// Lends layers of one grid over the words of their maps and displacements. `garbage` is what all other buffers hold.
fn with_sources<F: Format, R>(
    shape: Shape,
    format: F,
    layers: &mut [[Vec<u32>; 2]],
    garbage: &mut Random,
    work: impl FnOnce(&mut Sources<'_, '_, F>) -> R,
) -> R {
    with_shapes(&[shape], format, layers, garbage, work)
}

/// Lends layers as [`with_sources`]. The shapes are those of the layers in turn; layers without one have the first.
fn with_shapes<F: Format, R>(
    shapes: &[Shape],
    format: F,
    layers: &mut [[Vec<u32>; 2]],
    garbage: &mut Random,
    work: impl FnOnce(&mut Sources<'_, '_, F>) -> R,
) -> R {
    let shape_of = |layer: usize| *shapes.get(layer).unwrap_or(&shapes[0]);
    let mut starts: Vec<_> =
        (0..layers.len()).map(|layer| vec![0; Grid::rows(shape_of(layer).1, shape_of(layer).2)]).collect();
    let grids: Vec<_> = (0..)
        .zip(&mut starts)
        .map(|(layer, starts)| {
            let (width, height, margin) = shape_of(layer);
            Grid::new(width, height, margin, starts).unwrap()
        })
        .collect();
    let grid = grids[0];
    let cells = grid.cells() as usize;
    let mut all_links: Vec<_> = grids.iter().map(|grid| garbage.words(links::words(grid))).collect();
    let mut sources: Vec<_> = layers
        .iter_mut()
        .zip(&mut all_links)
        .zip(&grids)
        .map(|(([map, displacements], links), grid)| {
            Source::new(Galpixmap::over(*grid, format, map).unwrap(), displacements, links).unwrap()
        })
        .collect();
    let halves = |words: &[u32]| -> Vec<_> { words.iter().map(|&word| word as u16).collect() };
    let mut words = garbage.words(cells);
    let (mut keys, mut line) = (halves(&words), halves(&garbage.words(Visibility::line_half_words(&grid))));
    let visibility = Visibility::new(&grid, &mut keys, &mut words, &mut line).unwrap();
    work(&mut Sources::new(&mut sources, visibility).unwrap())
}

/// How a random layer looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    /// Any bits.
    Hostile,
    /// Few values of each field, so that surfaces and runs go on.
    Tame,
    /// A slanted surface that has grown or shrunk, with a few holes and steps.
    Grown,
    /// The same, with displacements that a step clamps.
    Far,
    /// A few samples only.
    Sparse,
}

const LOOKS: [Look; 5] = [Look::Hostile, Look::Tame, Look::Grown, Look::Far, Look::Sparse];

/// The words of a random map and of its displacements.
fn random_layer(random: &mut Random, shape: Shape, format: Dynamic, look: Look) -> [Vec<u32>; 2] {
    let mut starts = vec![0; Grid::rows(shape.1, shape.2)];
    let grid = Grid::new(shape.0, shape.1, shape.2, &mut starts).unwrap();
    let (cells, record) = (grid.cells(), format.record());
    let mut memory = random.words(record.words() * cells as usize);
    let mut displacements = random.words(cells as usize);
    if look == Look::Hostile {
        return [memory, displacements];
    }
    // Growth in 64ths of a cell for each cell, and the place that does not move.
    let growth = [random.below(96) as i32 - 16, random.below(96) as i32 - 16];
    let centre = [random.below(grid.width()) as i32, random.below(grid.height()) as i32];
    let slope = [random.below(7) as i32 - 3, random.below(7) as i32 - 3];
    let base = random.below(200) as i32;
    let few = random.below(3);
    let mut map = Galpixmap::over(grid, format, &mut memory).unwrap();
    for (y, x) in (0..grid.height() as i32).flat_map(|y| (0..grid.width() as i32).map(move |x| (y, x))) {
        let cell = grid.cell(x, y).unwrap();
        let mut words = map.words_at(cell).unwrap();
        let is_odd = random.below(16) == 0;
        let class = match look {
            Look::Sparse => [3, 3, 3, 3, 3, 3, 3, 0, 1, 2][random.below(10) as usize],
            Look::Tame => [0, 0, 0, 0, 0, 0, 1, 2, 3][random.below(9) as usize],
            _ if random.below(40) == 0 => random.below(4),
            _ => 0,
        };
        record.class().set(&mut words, class);
        let grown = [(x - centre[0]) * growth[0], (y - centre[1]) * growth[1]];
        if look == Look::Grown || look == Look::Far {
            let step = if is_odd { 40 } else { 0 };
            record.depth().set(&mut words, (base + step + slope[0] * x + slope[1] * y).max(0) as u32);
            for (component, grown) in grown.into_iter().enumerate() {
                let field = record.offset(component);
                // The low 6 bits of what has grown are the part of a cell.
                let part = (grown & 63) - if grown & 32 == 0 { 0 } else { 64 };
                let bits = u32::from(field.bits);
                field.set(&mut words, if bits > 6 { part << (bits - 6) } else { part >> (6 - bits) } as u32);
                record.velocity(component).set(&mut words, grown as u32);
                record.acceleration(component).set(&mut words, random.below(4) / 3);
            }
        } else {
            record.depth().set(&mut words, random.below(4) << few);
            for component in 0..2 {
                // Motion that is none, the same for all, or any.
                let field = record.velocity(component);
                let speed = [0, 0, 17, field.signed(&words)][random.below(if is_odd { 4 } else { 1 + few }) as usize];
                field.set(&mut words, speed as u32);
                if few == 0 {
                    record.acceleration(component).set(&mut words, 0);
                }
            }
        }
        map.put(cell, &words);
        let near = [(grown[0] + 32) >> 6, (grown[1] + 32) >> 6];
        let place = match look {
            Look::Grown => near,
            Look::Far => [[32767, 32766, -32768, -32767, 0][few as usize * 2], [-32768, 32760][few as usize & 1]],
            _ if is_odd => [random.below(9) as i32 - 4, random.below(9) as i32 - 4],
            _ => [few as i32 - 1, few as i32],
        };
        displacements[cell as usize] = crate::layers::displacement_word(place);
    }
    [memory, displacements]
}

/// A layer of galpixels at given places that do not lie beside their cells yet.
fn drawn<F: Format>(shape: Shape, format: F, galpixel: impl Fn(i32, i32) -> Galpixel) -> [Vec<u32>; 2] {
    let mut starts = vec![0; Grid::rows(shape.1, shape.2)];
    let grid = Grid::new(shape.0, shape.1, shape.2, &mut starts).unwrap();
    let mut memory = vec![0; Galpixmap::words(&grid, format)];
    let mut map = Galpixmap::new(grid, format, &mut memory).unwrap();
    for (y, x) in (0..grid.height() as i32).flat_map(|y| (0..grid.width() as i32).map(move |x| (y, x))) {
        map.store(x, y, &galpixel(x, y));
    }
    [memory, vec![0; grid.cells() as usize]]
}

/// A gray galpixel with its velocity in cells a frame and its depth as a fraction of the range.
fn gray(level: i32, depth: f64, velocity: [f64; 2]) -> Galpixel {
    let [x, y] = velocity.map(I32F32::from_num);
    Galpixel {
        colour: [level as u8; 3],
        depth: I32F32::from_num(depth),
        velocity: [x, y, I32F32::ZERO],
        ..Galpixel::default()
    }
}

fn nothing() -> Galpixel {
    Galpixel { class: Class::Empty, ..Galpixel::default() }
}
