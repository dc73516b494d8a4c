//! Push-pull and metamers of galpixmaps of any format: the same bits as the reference.

extern crate std;

use std::vec;
use std::vec::Vec;

use super::{Random, inpainting};
use crate::format::budget::{Bits, Demand};
use crate::format::layout::Layout;
use crate::format::{Dynamic, Format, Profile, Static};
use crate::inpaint::levels::Levels;
use crate::inpaint::map::{Uncovered, metamers, push_pull};
use crate::inpaint::metamer::tone::Tone;
use crate::inpaint::paint::{Moving, OfCell, Tint};
use crate::inpaint::{Inpainting, Metamer, MetamerWorkspace, Motion, PushPull, Recipe, Scale};
use crate::inpaint::{metamer, reference};
use crate::map::Galpixmap;
use crate::map::galpixel::{Class, Galpixel};
use crate::map::grid::{Grid, Margin};
use fixed::types::I32F32;

const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }));

struct Full;

impl Profile for Full {
    const LAYOUT: Layout = Layout::FULL;
    const BITS: Bits = BITS;
}

struct Flat565;

impl Profile for Flat565 {
    const LAYOUT: Layout = Layout::FLAT565;
    const BITS: Bits = BITS;
}

/// A depth of more bits than a pyramid has, one that no galpixel lacks, and none.
const LAYOUTS: [Layout; 6] = [
    Layout { depth_bits: 28, depth_motion: false, ..Layout::FULL },
    Layout { depth_bits: 0, depth_motion: false, tag_bits: 5, ..Layout::FULL },
    Layout::SHADED,
    Layout::STILL,
    Layout::FLAT565,
    Layout { depth_bits: 4, depth_motion: false, colour: crate::format::colour::Colour::GRAY4, ..Layout::FULL },
];

/// A map with small holes and a large one.
fn content<F: Format>(map: &mut Galpixmap<'_, F>, random: &mut Random) {
    let (width, height) = (map.grid().width(), map.grid().height());
    let (left, top) = (random.below(width), random.below(height));
    let part = |random: &mut Random| I32F32::from_bits(i64::from(random.below(1 << 16)) << 16);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let in_large = x >= left && y >= top && x < left + 80 && y < top + 70;
        let class = match random.below(200) {
            0..2 => Class::JustUnobscured,
            2 => Class::Debris,
            3 => Class::Empty,
            _ if in_large => Class::JustUnobscured,
            _ => Class::Galpixel,
        };
        let surface = [I32F32::lit("0.25"), I32F32::lit("0.75")][(x / 16 % 3 == 0) as usize];
        let depth = if random.below(20) == 0 { part(random) } else { surface };
        let [u, v] = [0; 2].map(|_| part(random) * 4 - I32F32::lit("2"));
        map.store(
            x as i32,
            y as i32,
            &Galpixel {
                class,
                colour: [0; 3].map(|_| (random.below(64) + x) as u8),
                depth,
                velocity: [u, v, I32F32::ZERO],
                acceleration: [v / 16, u / 16, I32F32::ZERO],
                tag: x,
                ..Galpixel::default()
            },
        );
    }
}

/// Runs a pass over a map that holds `words`; returns what it holds afterwards, and what the pass returned.
fn after<F: Format, R>(
    grid: Grid<'_>,
    format: F,
    words: &[u32],
    pass: impl FnOnce(&mut Galpixmap<'_, F>) -> R,
) -> (Vec<u32>, R) {
    let mut words = words.to_vec();
    let result = pass(&mut Galpixmap::over(grid, format, &mut words).unwrap());
    (words, result)
}

/// A mask of random bits that may end too early, or none.
pub fn mask(random: &mut Random, cells: u32) -> Vec<u32> {
    let words = cells.div_ceil(32);
    let words = random.one_of(&[0, words, words / 2 + 1]);
    (0..words).map(|_| random.next() << 1 | random.next()).collect()
}

/// Compares push-pull with its reference; returns the words and the count.
fn pushed_and_pulled<F: Format, V: OfCell>(
    (grid, format, words): (Grid<'_>, F, &[u32]),
    motion: Motion,
    inpainting: &Inpainting<'_>,
    [width, height]: [u32; 2],
) -> (Vec<u32>, u32) {
    let expected = after(grid, format, words, |map| {
        reference::push_pull(&mut Uncovered::<F, V>::new(map, inpainting.mask), &Levels::new(width, height), inpainting)
    });
    let mut memory = vec![u32::MAX; PushPull::words(width, height, motion)];
    let mut pyramid = PushPull::new(width, height, motion, &mut memory).unwrap();
    let made = after(grid, format, words, |map| push_pull(map, inpainting, &mut pyramid));
    assert!(made == expected, "{inpainting:?} {width} x {height}");
    made
}

/// Compares metamers with their reference; returns the words and the count.
fn textured<F: Format>(
    (grid, format, words): (Grid<'_>, F, &[u32]),
    inpainting: &Inpainting<'_>,
    recipe: Recipe,
    age: u32,
) -> (Vec<u32>, u32) {
    let expected = after(grid, format, words, |map| {
        metamer::reference::metamers(&mut Uncovered::<F, Tone>::new(map, inpainting.mask), inpainting, &recipe, age)
    });
    let mut memory = vec![u32::MAX; Metamer::words(grid.width(), grid.height(), recipe.levels)];
    let mut workspace = MetamerWorkspace::new();
    let mut metamer = Metamer::new(grid.width(), grid.height(), recipe, &mut memory, &mut workspace).unwrap();
    let made = after(grid, format, words, |map| metamers(map, inpainting, &mut metamer, age).unwrap());
    assert!(made == expected, "{inpainting:?} {recipe:?}");
    made
}

/// Makes a map of a format and runs a test over it, a given number of times.
fn rounds<F: Format>(format: F, count: u32, mut test: impl FnMut((Grid<'_>, F, &[u32]), &Inpainting<'_>, &mut Random)) {
    let mut random = Random::new(7);
    for _ in 0..count {
        let [width, height] = random.one_of(&[[150, 90], [33, 41], [97, 5], [1, 12], [1, 1]]);
        let mut rows = vec![0; height as usize];
        let grid = Grid::new(width, height, Margin::NONE, &mut rows).unwrap();
        let mut words = vec![0; Galpixmap::words(&grid, format)];
        content(&mut Galpixmap::new(grid, format, &mut words).unwrap(), &mut random);
        let mask = mask(&mut random, grid.cells());
        let inpainting = Inpainting { mask: &mask, ..inpainting(&mut random) };
        test((grid, format, &words), &inpainting, &mut random);
    }
}

fn push_pull_in_maps<F: Format>(format: F, count: u32) -> Vec<(Vec<u32>, u32)> {
    let mut all = Vec::new();
    rounds(format, count, |content, inpainting, random| {
        let own = [content.0.width(), content.0.height()];
        let size = random.one_of(&[own, own, own, [5, 200], [300, 3], [1, 1]]);
        all.push(pushed_and_pulled::<F, Tint>(content, Motion::Kept, inpainting, size));
        all.push(pushed_and_pulled::<F, Moving>(content, Motion::Inpainted, inpainting, size));
    });
    assert!(all.iter().filter(|(_, filled)| *filled > 20).count() > 3);
    all
}

fn metamers_in_maps<F: Format>(format: F, count: u32) -> Vec<(Vec<u32>, u32)> {
    let mut all = Vec::new();
    rounds(format, count, |content, inpainting, random| {
        let recipe = Recipe {
            levels: random.below(10),
            noise: random.one_of(&Scale::ALL),
            coloured: random.below(2) == 1,
            seed: random.next(),
        };
        let age = random.one_of(&[0, 3, 900, 1 << 20]);
        all.push(textured(content, inpainting, recipe, age));
    });
    assert!(all.iter().filter(|(_, filled)| *filled > 20).count() > 3);
    all
}

#[test]
fn push_pull_of_maps_has_the_bits_of_the_reference_whatever_the_format() {
    let full = push_pull_in_maps(Static::<Full>::new(), 40);
    assert!(full == push_pull_in_maps(Dynamic::new(BITS, Layout::FULL).unwrap(), 40));
    assert!(push_pull_in_maps(Static::<Flat565>::new(), 20) != full);
    for layout in LAYOUTS {
        push_pull_in_maps(Dynamic::new(BITS, layout).unwrap(), 20);
    }
}

#[test]
fn metamers_in_maps_have_the_bits_of_the_reference_whatever_the_format() {
    let full = metamers_in_maps(Static::<Full>::new(), 16);
    assert!(full == metamers_in_maps(Dynamic::new(BITS, Layout::FULL).unwrap(), 16));
    for layout in LAYOUTS {
        metamers_in_maps(Dynamic::new(BITS, layout).unwrap(), 12);
    }
}
