//! The order in which samples arrive does not matter.

use super::*;
use crate::fast;
use crate::layers::displacement;
use crate::source::constant_time::residual;
use crate::source::quads;
use crate::source::reference;
use crate::source::visibility::{Entry, Kind, depth, threshold};

/// The points of a layer, each with its cell.
fn points<F: Format>(source: &Source<'_, F>, first: u32, edge_threshold: u32) -> Vec<(u32, Entry)> {
    let (map, record) = (&source.map, source.map.record());
    let (grid, bits) = (map.grid(), u32::from(record.depth().bits));
    let behind = threshold(edge_threshold, bits) as u32 >> 1;
    let cells = (0..grid.cells()).filter(|&cell| map.class(cell) == Class::Galpixel);
    let point = |cell: u32| {
        let [dx, dy] = displacement(source.displacements[cell as usize]);
        let target = grid.cell((cell % grid.width()) as i32 + dx, (cell / grid.width()) as i32 + dy)?;
        let offset = [0, 1].map(|component| map.signed(record.offset(component), cell));
        let residual = residual(offset, [0, 1].map(|component| record.offset(component).bits.into()));
        let depth = depth(map.unsigned(record.depth(), cell), bits) + behind;
        Some((target, Entry::new(depth, Kind::Point, first + cell, residual)))
    };
    cells.filter_map(point).collect()
}

/// What a frame shows that is made in another order: a point, or the number of a layer and the first cell of a quad.
#[derive(Clone, Copy)]
enum Arrival {
    Point(u32, Entry),
    Quad(usize, u32),
}

#[test]
fn entries_do_not_depend_on_the_order_of_arrival() {
    let (mut random, mut crowded) = (Random(1), 0);
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            for look in [Look::Tame, Look::Grown, Look::Hostile] {
                let mut layers = [look, Look::Grown].map(|look| random_layer(&mut random, shape, format, look));
                let edge_threshold = [0, 16, 1024][random.below(3) as usize];
                with_sources(shape, format, &mut layers, &mut Random(9), |sources| {
                    crowded += compare(&mut random, sources, edge_threshold);
                });
            }
        }
    }
    assert!(crowded > 1000, "{crowded}");
}

/// Compares the order of both forms with that of shuffled lists. Returns how many samples arrive in a cell of another.
fn compare(random: &mut Random, sources: &mut Sources<'_, '_, Dynamic>, edge_threshold: u32) -> usize {
    let Sources { layers, visibility, .. } = sources;
    let (mut arrivals, mut first, mut firsts) = (Vec::new(), 0, Vec::new());
    for (number, layer) in layers.iter_mut().enumerate() {
        let displacements = layer.displacements.to_vec();
        layer.begin(edge_threshold);
        layer.displacements.copy_from_slice(&displacements);
        let points = points(layer, first, edge_threshold).into_iter();
        arrivals.extend(points.map(|(target, entry)| Arrival::Point(target, entry)));
        let cells = layer.map.grid().cells();
        arrivals.extend(
            (0..cells).filter(|&cell| layer.links().quad::<false>(cell)).map(|cell| Arrival::Quad(number, cell)),
        );
        firsts.push(first);
        first += cells;
    }
    let entries = |visibility: &Visibility<'_>| {
        (0..visibility.grid().cells()).map(|cell| visibility.at(cell)).collect::<Vec<_>>()
    };
    let mut made = Vec::new();
    for form in [reference::scatter, fast::scatter] {
        visibility.clear();
        for (layer, &first) in layers.iter_mut().zip(&firsts) {
            form(layer, visibility, first, edge_threshold, None);
        }
        made.push(entries(visibility));
    }
    for _ in 0..2 {
        random.shuffle(&mut arrivals);
        visibility.clear();
        for &arrival in &arrivals {
            match arrival {
                Arrival::Point(target, entry) => visibility.challenge(target, entry),
                Arrival::Quad(number, cell) => {
                    let layer = &layers[number];
                    let width = layer.map.grid().width();
                    let place = [(cell % width) as i32, (cell / width) as i32];
                    quads::draw_one::<_, false>(
                        layer,
                        visibility,
                        quads::Quad { first: firsts[number], place, cell, mask: u32::MAX },
                    );
                }
            }
        }
        made.push(entries(visibility));
    }
    assert!(made.iter().all(|entries| *entries == made[0]));
    let points = arrivals.iter().filter(|arrival| matches!(arrival, Arrival::Point(..))).count();
    points - made[0].iter().filter(|entry| entry.is_point()).count()
}

/// Of samples at the same depth that arrive in one cell the first one is shown, of all layers.
#[test]
fn of_equal_depths_the_lower_layer_is_shown_and_then_the_lower_cell() {
    let (shape, format) = ((70, 2, Margin::NONE), format(4, Layout::FULL));
    for shift in [0, 1, -1] {
        let mut layers = [(); 3].map(|()| drawn(shape, format, |_, _| gray(50, 0.5, [0.0; 2])));
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            for layer in sources.layers.iter_mut() {
                layer.begin(16);
            }
            // All samples of a row of each layer in one cell, or all of a layer moved.
            let settings = crate::Settings::for_depth(16);
            for (number, layer) in sources.layers.iter_mut().enumerate() {
                for (x, word) in (0..70).chain(0..70).zip(layer.displacements.iter_mut()) {
                    let dx = if number == 0 { 20 - x } else { shift };
                    *word = crate::layers::displacement_word([dx, 0]);
                }
            }
            sources.show(&settings);
            for y in 0..2 {
                let row = 70 * y;
                assert_eq!(sources.shown(row + 20), Some((0, row)));
                for x in (1..69).filter(|&x| x != 20) {
                    assert_eq!(sources.shown(row + x), Some((1, (row + x).wrapping_add_signed(-shift))));
                }
            }
        });
    }
}
