//! Sub-cell scan-out against the same rules written slowly, and what they are for.

extern crate std;

use std::vec;
use std::vec::Vec;

use super::{SubCell, row};
use crate::format::budget::{Bits, Component, Demand};
use crate::format::colour::Colour;
use crate::format::layout::Layout;
use crate::format::{Dynamic, Format, Profile, Static};
use crate::map::Galpixmap;
use crate::map::galpixel::{Class, Galpixel};
use crate::map::grid::{Grid, Margin};
use crate::output::scan_out::{self, Sampling};
use crate::random::Random;
use fixed::types::I32F32;

const BITS: Bits = Bits::must(Bits::derive(Demand { extent: 64, recog: 8, prop: 16 }));

/// A cell as the reference has it.
#[derive(Clone, Copy, Debug)]
struct Plain {
    class: u32,
    depth: i64,
    offset: [i64; 2],
    colour: u32,
}

/// A cell of a map, if there is one; its offset in 256ths of a cell.
fn plain<F: Format>(map: &Galpixmap<'_, F>, x: i64, y: i64) -> Option<Plain> {
    let record = map.record();
    let words = map.words_at(map.grid().cell(i32::try_from(x).ok()?, i32::try_from(y).ok()?)?)?;
    let offset = [record.offset_x(), record.offset_y()].map(|field| {
        let unit = 1i64 << field.bits;
        (2 * 256 * i64::from(field.signed(&words)) + unit).div_euclid(2 * unit)
    });
    Some(Plain {
        class: record.class().unsigned(&words),
        depth: record.depth().unsigned(&words).into(),
        offset,
        colour: record.colour().unsigned(&words),
    })
}

/// The mean of levels by weights out of 256.
fn mixed(levels: &[(i64, i64)]) -> i64 {
    assert_eq!(levels.iter().map(|&(_, weight)| weight).sum::<i64>(), 256);
    assert!(levels.iter().all(|&(_, weight)| weight >= 0));
    (levels.iter().map(|(level, weight)| level * weight).sum::<i64>() * 2 + 256).div_euclid(512)
}

/// What column `x`, row `y` of the map shows.
fn expected<F: Format>(map: &Galpixmap<'_, F>, threshold: u32, x: i64, y: i64) -> u32 {
    let at = |dx: i64, dy: i64| plain(map, x + dx, y + dy);
    let (here, threshold) = (at(0, 0).unwrap(), i64::from(threshold));
    let [right, down] = here.offset;
    let (dx, dy) = (if right > 0 { -1 } else { 1 }, if down > 0 { -1 } else { 1 });
    let surface = |other: Option<Plain>| {
        other.filter(|other| here.class != 3 && other.class != 3 && (here.depth - other.depth).abs() <= threshold)
    };
    let beside = surface(at(dx, 0)).filter(|other| (other.offset[0] - right).abs() <= 96);
    let along = surface(at(0, dy)).filter(|other| (other.offset[1] - down).abs() <= 96);
    let diagonal = surface(at(dx, dy)).filter(|_| beside.is_some() && along.is_some());
    let in_front = |near: Plain, far: Plain| near.class != 3 && far.class != 3 && far.depth - near.depth > threshold;
    let mut word = 0;
    for channel in map.record().colour_format().channels() {
        let level = |cell: Plain| i64::from(cell.colour >> channel.shift & ((1 << channel.bits) - 1));
        let (p, x, y) = (level(here), right.abs(), down.abs());
        let mut shown = match (beside, along) {
            (None, None) => p,
            (Some(a), None) => mixed(&[(p, 256 - x), (level(a), x)]),
            (None, Some(b)) => mixed(&[(p, 256 - y), (level(b), y)]),
            (Some(a), Some(b)) => {
                let d = if diagonal.is_some() { (x * y + 128).div_euclid(256) } else { 0 };
                let d_level = diagonal.map_or(0, level);
                mixed(&[(p, 256 - x - y + d), (level(a), x - d), (level(b), y - d), (d_level, d)])
            }
        };
        for (dx, dy, axis, sign) in [(-1, 0, 0, 1), (1, 0, 0, -1), (0, -1, 1, 1), (0, 1, 1, -1)] {
            let Some(other) = at(dx, dy) else { continue };
            let nearer = if in_front(other, here) {
                other
            } else if in_front(here, other) {
                here
            } else {
                continue;
            };
            let part = (sign * nearer.offset[axis]).max(0);
            shown = mixed(&[(shown, 256 - part), (level(other), part)]);
        }
        word |= (shown as u32) << channel.shift;
    }
    word
}

/// Lends a map over words.
fn with_map<F: Format, R>(
    (width, height, margin): (u32, u32, Margin),
    format: F,
    words: &mut [u32],
    work: impl FnOnce(Galpixmap<'_, F>) -> R,
) -> R {
    let mut starts = vec![0; Grid::rows(height, margin)];
    let grid = Grid::new(width, height, margin, &mut starts).unwrap();
    work(Galpixmap::over(grid, format, words).unwrap())
}

/// Compares every row of the display with the reference.
fn compare<F: Format>(map: &Galpixmap<'_, F>, threshold: u32) {
    let margin = map.grid().margin();
    for y in 0..map.grid().display_height() {
        let made: Vec<u32> = row(map, threshold, y).collect();
        let place = |x: u32| (i64::from(x + margin.left), i64::from(y + margin.top));
        let expected: Vec<u32> =
            (0..map.grid().display_width()).map(place).map(|(x, y)| expected(map, threshold, x, y)).collect();
        assert!(made == expected, "row {y}, threshold {threshold}: {made:x?}, not {expected:x?}");
    }
}

/// Around runs of 16 cells too.
const SHAPES: [(u32, u32, Margin); 10] = [
    (16, 2, Margin::NONE),
    (17, 3, Margin { left: 1, right: 0, top: 1, bottom: 0 }),
    (31, 2, Margin { left: 0, right: 1, top: 0, bottom: 1 }),
    (13, 7, Margin::NONE),
    (1, 1, Margin::NONE),
    (1, 9, Margin::NONE),
    (40, 1, Margin::NONE),
    (6, 5, Margin { left: 2, right: 1, top: 1, bottom: 3 }),
    (5, 4, Margin { left: 0, right: 1, top: 0, bottom: 1 }),
    (1, 1, Margin::all(2)),
];

/// Fraction bits of the position, and the fields beside it.
const FORMATS: [(u32, Layout); 10] = [
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
];

fn format(frac: u32, layout: Layout) -> Dynamic {
    let component = Component { position_frac: frac, ..BITS.x };
    Dynamic::new(BITS.with_xy(component, component), layout).unwrap()
}

/// Random words, of which those of a few seeds have little variety in the depth, so that surfaces go on.
fn hostile(random: &mut Random, cells: u32, format: Dynamic, tame: bool) -> Vec<u32> {
    let mut words = vec![0; format.record().words() * cells as usize];
    words.fill_with(|| random.next());
    if tame {
        let mut starts = [0];
        let grid = Grid::new(cells, 1, Margin::NONE, &mut starts).unwrap();
        let mut map = Galpixmap::over(grid, format, &mut words).unwrap();
        for cell in 0..cells {
            let mut words = map.words_at(cell).unwrap();
            let record = format.record();
            record.class().set(&mut words, [0, 0, 0, 0, 0, 0, 1, 2, 3][random.next() as usize % 9]);
            record.depth().set(&mut words, random.next() % 4);
            // Every other offset is at most a quarter, so that neighbours have moved alike.
            for field in [record.offset_x(), record.offset_y()] {
                let offset = field.signed(&words) >> (random.next() & 1);
                field.set(&mut words, offset as u32);
            }
            map.put(cell, &words);
        }
    }
    words
}

/// Any words, also such as no frame makes, in any format.
#[test]
fn every_map_gives_the_bits_of_the_reference() {
    let mut random = Random(1);
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            let cells = Grid::cells_for(shape.0, shape.1, shape.2);
            for turn in 0..12 {
                let mut words = hostile(&mut random, cells, format, turn % 4 > 0);
                with_map(shape, format, &mut words, |map| {
                    for threshold in [0, 1, 2, u32::MAX] {
                        compare(&map, threshold);
                    }
                });
            }
        }
    }
}

struct Full;

impl Profile for Full {
    const LAYOUT: Layout = Layout::FULL;
    const BITS: Bits = BITS;
}

#[test]
fn formats_fixed_at_compile_time_give_the_same_bits() {
    let mut random = Random(2);
    let dynamic = Dynamic::new(BITS, Layout::FULL).unwrap();
    for shape in SHAPES {
        let mut words = hostile(&mut random, Grid::cells_for(shape.0, shape.1, shape.2), dynamic, true);
        with_map(shape, Static::<Full>::new(), &mut words, |map| compare(&map, 1));
    }
}

/// Two and three cells in a row or a column, and all states of class, depth and offset.
#[test]
fn all_states_of_few_cells_give_the_bits_of_the_reference() {
    let component = Component { position_frac: 2, ..BITS.x };
    let layout = Layout { depth_bits: 2, ..Layout::VELOCITY_GRAY4 };
    let format = Dynamic::new(BITS.with_xy(component, component), layout).unwrap();
    let record = *format.record();
    // Sides, then how many classes, depths and offsets.
    for ((width, height), [classes, depths, offsets]) in
        [((2, 1), [4, 4, 4]), ((1, 2), [4, 4, 4]), ((3, 1), [3, 2, 4]), ((1, 3), [3, 2, 4])]
    {
        let states = classes * depths * offsets;
        let mut words = vec![0; record.words() * (width * height) as usize];
        with_map((width, height, Margin::NONE), format, &mut words, |mut map| {
            for number in 0..u32::pow(states, width * height) {
                let mut rest = number;
                for cell in 0..width * height {
                    let mut words = Default::default();
                    // With three classes the one that is left out is just unobscured, which is as debris.
                    let class = rest % classes;
                    record.class().set(&mut words, if classes == 3 && class > 0 { class + 1 } else { class });
                    record.depth().set(&mut words, rest / classes % depths);
                    let offset = rest / classes / depths % offsets;
                    record.offset_x().set(&mut words, if width > 1 { offset } else { 3 - offset });
                    record.offset_y().set(&mut words, if width > 1 { 3 - offset } else { offset });
                    record.colour().set(&mut words, [15, 2, 9][cell as usize]);
                    map.put(cell, &words);
                    rest /= states;
                }
                for threshold in 0..2 {
                    compare(&map, threshold);
                }
            }
        });
    }
}

/// Four galpixels, all offsets, on one or on two surfaces.
#[test]
fn all_offsets_of_four_galpixels_give_the_bits_of_the_reference() {
    let component = Component { position_frac: 2, ..BITS.x };
    let layout = Layout { depth_bits: 2, ..Layout::VELOCITY_GRAY8 };
    let format = Dynamic::new(BITS.with_xy(component, component), layout).unwrap();
    let record = *format.record();
    let mut words = vec![0; record.words() * 4];
    with_map((2, 2, Margin::NONE), format, &mut words, |mut map| {
        for number in 0..1 << 18 {
            // Of the cell that is looked at every state, of the others those by which they count or not.
            for cell in 0..4 {
                let bits = if cell == 0 { number & 15 } else { number >> (cell * 4) & 15 };
                let mut words = Default::default();
                record.offset_x().set(&mut words, bits & 3);
                record.offset_y().set(&mut words, bits >> 2);
                record.depth().set(&mut words, if cell == number >> 16 { 2 } else { 0 });
                record.colour().set(&mut words, [3, 200, 90, 255][cell as usize]);
                map.put(cell, &words);
            }
            compare(&map, 1);
        }
    });
}

/// Stores galpixels at given places.
fn drawn(shape: (u32, u32), galpixel: impl Fn(i32, i32) -> Galpixel, work: impl FnOnce(&Galpixmap<'_, Dynamic>)) {
    let format = Dynamic::new(BITS, Layout { colour: Colour::GRAY8, ..Layout::FULL }).unwrap();
    let mut words = vec![0; format.record().words() * (shape.0 * shape.1) as usize];
    with_map((shape.0, shape.1, Margin::NONE), format, &mut words, |mut map| {
        for (x, y) in (0..shape.1 as i32).flat_map(|y| (0..shape.0 as i32).map(move |x| (x, y))) {
            map.store(x, y, &galpixel(x, y));
        }
        work(&map);
    });
}

fn at(x: &str, y: &str, gray: i32, depth: &str) -> Galpixel {
    let number = |text: &str| text.parse::<I32F32>().unwrap();
    Galpixel { colour: [gray as u8; 3], offset: [number(x), number(y)], depth: number(depth), ..Galpixel::default() }
}

/// The mode for maps without motion: every bit as nearest-cell scan-out has it.
#[test]
fn offset_0_is_exact() {
    let mut random = Random(3);
    for (frac, layout) in FORMATS {
        let (format, shape) = (format(frac, layout), (13, 7, Margin::NONE));
        for tame in [false, true] {
            let mut words = hostile(&mut random, 13 * 7, format, tame);
            with_map(shape, format, &mut words, |mut map| {
                for cell in 0..13 * 7 {
                    let mut words = map.words_at(cell).unwrap();
                    map.record().offset_x().set(&mut words, 0);
                    map.record().offset_y().set(&mut words, 0);
                    map.put(cell, &words);
                }
                for (y, threshold) in (0..7).flat_map(|y| [0, 1, u32::MAX].map(|threshold| (y, threshold))) {
                    assert!(row(&map, threshold, y).eq(scan_out::row(&map, y)), "{layout:?}");
                }
            });
        }
    }
}

#[test]
fn empty_cells_keep_their_colour_and_give_none() {
    let mut random = Random(4);
    let (format, shape) = (format(4, Layout::FULL), (13, 7, Margin::NONE));
    for threshold in [0, 1, u32::MAX] {
        let mut words = hostile(&mut random, 13 * 7, format, true);
        with_map(shape, format, &mut words, |map| {
            for (x, y) in (0..7).flat_map(|y| (0..13).map(move |x| (x, y))) {
                let empty = |dx: i32, dy: i32| {
                    map.grid().cell(x + dx, y + dy).is_none_or(|cell| map.class(cell) == Class::Empty)
                };
                let alone =
                    (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y))).all(|at| at == (0, 0) || empty(at.0, at.1));
                if empty(0, 0) || alone {
                    let shown = row(&map, threshold, y as u32).nth(x as usize).unwrap();
                    assert_eq!(shown, map.colour(map.grid().cell(x, y).unwrap()));
                }
            }
        });
    }
}

/// A ramp that has moved by a part of a cell is seen moved by that part.
#[test]
fn what_lies_right_of_its_centre_is_seen_there() {
    for (offset, less) in [("0.25", 5), ("-0.25", -5), ("0.125", 3), ("-0.5", -10), ("0", 0)] {
        drawn(
            (8, 5),
            |x, y| at(offset, "0", 20 * x + y, "0.5"),
            |map| {
                let shown: Vec<u32> = row(map, 0, 2).collect();
                // Halves are rounded upwards: 2.5 less is 2 less.
                let less = if less == 3 { 2 } else { less };
                assert!((1..7).all(|x| shown[x] as i32 == 20 * x as i32 + 2 - less), "{offset}: {shown:?}");
            },
        );
        drawn(
            (5, 8),
            |x, y| at("0", offset, 20 * y + x, "0.5"),
            |map| {
                let less = if less == 3 { 2 } else { less };
                assert!((1..7).all(|y| row(map, 0, y).nth(2).unwrap() as i32 == 20 * y as i32 + 2 - less), "{offset}");
            },
        );
    }
}

/// A near white surface to the left of a far black one: the border lies half a cell beyond the last galpixel.
#[test]
fn silhouettes_cover_what_they_reach_over() {
    for (offset, shown) in [("0", [255, 0]), ("0.25", [255, 64]), ("-0.25", [191, 0]), ("-0.5", [128, 0])] {
        let near = |x: i32| if x < 3 { at(offset, "0", 255, "0.25") } else { at("0.4375", "0", 0, "0.75") };
        drawn(
            (6, 3),
            |x, _| near(x),
            |map| {
                let made: Vec<u32> = row(map, 1 << 10, 1).collect();
                assert_eq!(made, [255, 255, shown[0], shown[1], 0, 0], "{offset}");
            },
        );
    }
    // What was filled covers and is covered likewise, by its depth; a hole is not.
    for (class, shown) in [(Class::Debris, 64), (Class::JustUnobscured, 64), (Class::Empty, 0)] {
        let near = |x: i32| {
            if x < 3 { at("0.25", "0", 255, "0.25") } else { Galpixel { class, ..at("0", "0", 0, "0.75") } }
        };
        drawn((6, 3), |x, _| near(x), |map| assert_eq!(row(map, 1 << 10, 1).nth(3), Some(shown), "{class:?}"));
        let near = |x: i32| {
            if x < 3 { Galpixel { class, ..at("0.25", "0", 255, "0.25") } } else { at("0", "0", 0, "0.75") }
        };
        drawn((6, 3), |x, _| near(x), |map| assert_eq!(row(map, 1 << 10, 1).nth(3), Some(shown), "{class:?}"));
    }
}

/// Any part of a row is that part of the row, and there is nothing below the display.
#[test]
fn spans_are_parts_of_rows() {
    let mut random = Random(5);
    let format = format(4, Layout::FULL);
    for shape in SHAPES {
        let mut words = hostile(&mut random, Grid::cells_for(shape.0, shape.1, shape.2), format, true);
        with_map(shape, format, &mut words, |map| {
            let sampling = SubCell { edge_threshold: 1 };
            for y in 0..shape.1 {
                let whole: Vec<u32> = row(&map, 1, y).collect();
                assert_eq!(whole.len(), shape.0 as usize);
                for (x, width) in (0..shape.0 + 2).flat_map(|x| [0, 1, 3, u32::MAX].map(|width| (x, width))) {
                    let part = whole.iter().copied().skip(x as usize).take(width as usize);
                    let span = sampling.span(&map, y, x, width);
                    assert_eq!(span.len(), part.len());
                    assert!(span.eq(part), "{width} from {x} of row {y} of {shape:?}");
                }
            }
            for y in [shape.1, shape.1 + 1, u32::MAX] {
                assert_eq!(row(&map, 1, y).len(), 0, "below the display");
            }
        });
    }
}
