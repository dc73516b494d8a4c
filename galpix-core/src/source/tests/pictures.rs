//! What is seen: still pictures, fences, surfaces that grow, lines, and what comes back.

use super::*;
use crate::frame::Settings;
use crate::frame::fill::FillMode;
use crate::frame::tally::Tally;
use crate::source::Gather;

const GRAY: Layout = Layout { colour: Colour::GRAY8, ..Layout::FULL };

type Shown<'s, 'p, 'l> = &'s mut Sources<'p, 'l, Dynamic>;

/// The rows of the map as they are gathered, with or without sub-cell scan-out, but not finished.
fn gathered<F: Format>(sources: &Sources<'_, '_, F>, fill_mode: FillMode, sub_cell: bool) -> Vec<Vec<u32>> {
    let edge_threshold = Settings::for_depth(sources.base().unwrap().record().depth().bits.into()).edge_threshold;
    let grid = sources.base().unwrap().grid();
    let row = |y: u32| {
        let mut colours = vec![0; grid.width() as usize];
        sources.gather(y, Gather { fill_mode, sub_cell, edge_threshold }, &mut colours);
        colours
    };
    (0..grid.height()).map(row).collect()
}

/// The rows of the map as a display shows them.
fn picture<F: Format>(sources: &Sources<'_, '_, F>, fill_mode: FillMode) -> Vec<Vec<u32>> {
    let edge_threshold = Settings::for_depth(sources.base().unwrap().record().depth().bits.into()).edge_threshold;
    let rows = gathered(sources, fill_mode, true);
    let finish = |y: usize| {
        let around = [y.wrapping_sub(1), y, y + 1].map(|y| rows.get(y).map_or(&[][..], |row| row));
        let mut colours = vec![0; around[1].len()];
        sources.finish(y as u32, edge_threshold, around, &mut colours);
        colours
    };
    (0..rows.len()).map(finish).collect()
}

/// Shows layers of gray galpixels, and does something after each frame. The first one is without a step.
fn run(
    shape: (u32, u32),
    layers: &[&dyn Fn(i32, i32) -> Galpixel],
    frames: u32,
    mut each: impl FnMut(u32, Shown<'_, '_, '_>, Tally),
) {
    let (shape, format) = ((shape.0, shape.1, Margin::NONE), Dynamic::new(BITS, GRAY).unwrap());
    let mut layers: Vec<_> = layers.iter().map(|layer| drawn(shape, format, layer)).collect();
    let settings = Settings::for_depth(format.record().depth().bits.into());
    with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
        for layer in sources.layers.iter_mut() {
            layer.begin(settings.edge_threshold);
        }
        for frame in 0..=frames {
            let tally = if frame == 0 { sources.show(&settings) } else { sources.step(&settings) };
            each(frame, sources, tally);
        }
    });
}

/// The layer that each cell shows.
fn layers_shown(sources: &Sources<'_, '_, Dynamic>) -> Vec<Option<usize>> {
    (0..sources.visibility.grid().cells()).map(|cell| sources.shown(cell).map(|(layer, _)| layer)).collect()
}

/// Pictures of two depths, drawn at random, with empty cells. Nothing is resampled, mixed or closed.
#[test]
fn a_still_picture_is_shown_as_it_is_stored() {
    let mut random = Random(3);
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            for variety in 0..6 {
                let mut layers = [random_layer(&mut random, shape, format, Look::Tame)];
                with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
                    still(&mut random, sources, variety);
                    let stored = sources.base().unwrap();
                    let (width, cells) = (stored.grid().width() as usize, stored.grid().cells());
                    let is_hole = |cell: u32| stored.class(cell) != Class::Galpixel;
                    for fill_mode in [FillMode::Hold, FillMode::Extend] {
                        let shown: Vec<u32> = picture(sources, fill_mode).concat();
                        let only: Vec<u32> = gathered(sources, fill_mode, false).concat();
                        assert_eq!(shown.len(), width * stored.grid().height() as usize);
                        for cell in 0..cells {
                            let (is, was) = (shown[cell as usize], stored.colour(cell));
                            assert!(is_hole(cell) || sources.shown(cell) == Some((0, cell)), "{shape:?} {variety}");
                            assert_eq!((is, only[cell as usize]), (was, was), "{cell} of {shape:?} {variety}");
                        }
                    }
                });
            }
        }
    }
}

/// Displacements of any samples, from the numbers of their cells.
#[test]
fn a_cell_has_moved_from_where_its_sample_is_stored() {
    let mut random = Random(8);
    let mut seen = [0; 3];
    for (turn, shape) in SHAPES.into_iter().cycle().take(5 * SHAPES.len()).enumerate() {
        let (frac, layout) = FORMATS[turn % FORMATS.len()];
        let format = format(frac, layout);
        let look = LOOKS[turn / SHAPES.len()];
        let mut layers = [look, Look::Grown].map(|look| random_layer(&mut random, shape, format, look));
        with_sources(shape, format, &mut layers, &mut Random(9), |sources| {
            sources.step(&Settings::for_depth(16));
            let grid = *sources.base().unwrap().grid();
            let width = grid.width();
            for y in 0..grid.height() {
                let mut moved = vec![!0; width as usize];
                sources.moved(y, &mut moved);
                for (x, word) in (0..width).zip(moved) {
                    let way = sources
                        .shown(y * width + x)
                        .map(|(_, sample)| [x as i32 - (sample % width) as i32, y as i32 - (sample / width) as i32]);
                    assert_eq!(word, crate::layers::displacement_word(way.unwrap_or_default()), "{shape:?} {look:?}");
                    seen[way.map_or(0, |way| 1 + usize::from(way != [0; 2]))] += 1;
                }
            }
        });
    }
    assert!(seen.iter().all(|&cells| cells > 200), "{seen:?}");
    // A near galpixel that goes right and down leaves a hole where a still picture knows nothing.
    run((4, 3), &[&|x, y| gray(99, if [x, y] == [0, 0] { 0.2 } else { 0.8 }, [f64::from(x == 0 && y == 0); 2])], 2, {
        |frame, sources, _| {
            let mut rows = [[!0; 4]; 3];
            for (y, row) in (0..).zip(&mut rows) {
                sources.moved(y, row);
            }
            let mut expected = [[0; 4]; 3];
            expected[frame as usize][frame as usize] = frame << 16 | frame;
            assert_eq!(rows, expected);
        }
    });
}

/// Makes a picture of a random map: without motion or debris, and with few depths.
fn still(random: &mut Random, sources: Shown<'_, '_, '_>, variety: u32) {
    let settings = Settings::for_depth(sources.base().unwrap().record().depth().bits.into());
    let layer = &mut sources.layers[0];
    let record = *layer.map.record();
    // Depths of an eighth and three quarters of the range.
    let depths = [1, 6].map(|depth| (depth << record.depth().bits) >> 3);
    for cell in 0..layer.map.grid().cells() {
        let mut words = layer.map.words_at(cell).unwrap();
        let is_hole = variety > 2 && random.below(7) == 0;
        record.class().set(&mut words, if is_hole { 3 } else { 0 });
        record.depth().set(&mut words, depths[(random.below(5) < variety) as usize]);
        for component in 0..2 {
            record.offset(component).set(&mut words, 0);
            record.velocity(component).set(&mut words, 0);
        }
        layer.map.put(cell, &words);
    }
    layer.begin(settings.edge_threshold);
    sources.show(&settings);
}

/// Bars of one cell before a far background that slides, and bars that slide before one that does not: in no row are
/// there more cells of bars than bars.
/// A textured block moves by whole cells before a textured ground: what is seen has the colours that are stored, and
/// those of the ground that lie between others by chance are not taken for mixtures.
#[test]
fn textures_moved_by_whole_cells_are_shown_as_they_are_stored() {
    let mut random = Random(31);
    let (format, shape) = (format(4, Layout::FULL), (60, 40, Margin::NONE));
    let settings = Settings::for_depth(16);
    for colours in [1, 3] {
        let texture: Vec<[u8; 3]> = (0..60 * 40)
            .map(|_| {
                let one = random.below(256) as u8;
                [0; 3].map(|_: u8| if colours == 1 { one } else { random.below(256) as u8 })
            })
            .collect();
        let is_near = |x: i32, y: i32| (20..40).contains(&x) && (12..28).contains(&y);
        let mut layers = [drawn(shape, format, |x, y| {
            let (depth, velocity) = if is_near(x, y) { (0.25, [2.0, 1.0]) } else { (0.75, [0.0; 2]) };
            Galpixel { colour: texture[(y * 60 + x) as usize], ..gray(0, depth, velocity) }
        })];
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            sources.layers[0].begin(settings.edge_threshold);
            for _ in 0..4 {
                sources.step(&settings);
            }
            let mut seen = 0;
            for (y, row) in (0..).zip(picture(sources, FillMode::Extend)) {
                for (x, colour) in (0..).zip(row) {
                    if let Some((_, cell)) = sources.shown(y * 60 + x) {
                        assert_eq!(colour, sources.layers[0].map.colour(cell), "({x}, {y})");
                        seen += 1;
                    }
                }
            }
            assert!(seen > 2000);
        });
    }
}

#[test]
fn a_fence_of_one_pixel_bars_never_closes() {
    for (bars, background) in [([0.0, 0.0], [0.4, 0.0]), ([0.3, 0.0], [0.0, 0.0]), ([-0.7, 0.2], [0.4, -0.6])] {
        for is_upright in [true, false] {
            let is_bar = move |x: i32, y: i32| (if is_upright { x } else { y }) % 2 == 0;
            let fence = |x, y| if is_bar(x, y) { gray(220, 0.25, bars) } else { gray(40, 0.75, background) };
            let only = |x, y| if is_bar(x, y) { gray(220, 0.25, bars) } else { nothing() };
            let behind = |_, _| gray(40, 0.75, background);
            let lists: [&[&dyn Fn(i32, i32) -> Galpixel]; 2] = [&[&fence], &[&only, &behind]];
            for list in lists {
                run((40, 20), list, 24, |frame, sources, _| {
                    let is_shown = |x: u32, y: u32| {
                        let shown = sources.shown(y * 40 + x);
                        shown.is_some_and(|(layer, cell)| layer == 0 && is_bar(cell as i32 % 40, cell as i32 / 40))
                    };
                    let lines = if is_upright { [20, 40] } else { [40, 20] };
                    for line in 0..lines[0] {
                        let across = |part: u32| if is_upright { (part, line) } else { (line, part) };
                        let cells = (0..lines[1]).filter(|&part| {
                            let (x, y) = across(part);
                            is_shown(x, y)
                        });
                        assert!(cells.count() as u32 <= lines[1] / 2, "frame {frame}, line {line}, {is_upright}");
                    }
                });
            }
        }
    }
}

/// Wire mesh: a far background is seen through holes of one cell.
#[test]
fn holes_of_one_cell_never_close() {
    for (mesh, background) in [([0.0, 0.0], [0.4, 0.3]), ([0.3, 0.2], [0.0, 0.0]), ([0.0, 0.0], [0.0, 0.0])] {
        let is_mesh = |x: i32, y: i32| x % 2 == 0 || y % 2 == 0;
        let front = |x, y| if is_mesh(x, y) { gray(220, 0.25, mesh) } else { gray(40, 0.75, background) };
        let only = |x, y| if is_mesh(x, y) { gray(220, 0.25, mesh) } else { nothing() };
        let behind = |_, _| gray(40, 0.75, background);
        let lists: [&[&dyn Fn(i32, i32) -> Galpixel]; 2] = [&[&front], &[&only, &behind]];
        for list in lists {
            run((40, 20), list, 16, |frame, sources, _| {
                let is_shown = |cell: u32| {
                    let shown = sources.shown(cell);
                    shown.is_some_and(|(layer, cell)| layer == 0 && is_mesh(cell as i32 % 40, cell as i32 / 40))
                };
                let cells = (0..800).filter(|&cell| is_shown(cell)).count();
                assert!(cells <= 600, "frame {frame}: {cells} cells of 600 samples");
            });
        }
    }
}

/// A surface that grows about the centre of the map to 1.8 times its size, before a still background.
fn grows(depth: &dyn Fn(i32, i32) -> f64, mut each: impl FnMut(f64, &[Option<usize>], &[Vec<u32>], Tally)) {
    const SIDE: i32 = 64;
    let rate = 0.8 / 32.0;
    let surface = |x: i32, y: i32| {
        let place = [x, y].map(|at| f64::from(at - SIDE / 2));
        let is_inside = place.iter().all(|at| at.abs() <= 14.0);
        if is_inside { gray(200, depth(x - SIDE / 2, y - SIDE / 2), place.map(|at| at * rate)) } else { nothing() }
    };
    let behind = |_, _| gray(30, 0.9375, [0.0; 2]);
    run((SIDE as u32, SIDE as u32), &[&surface, &behind], 32, |frame, sources, tally| {
        let scale = 1.0 + rate * f64::from(frame);
        each(scale, &layers_shown(sources), &picture(sources, FillMode::Hold), tally);
    });
}

/// Whether a cell lies within a square that has grown, a cell from its border at least.
fn is_within(scale: f64, cell: usize) -> bool {
    [cell % 64, cell / 64].iter().all(|&at| (at as f64 - 32.0).abs() < 14.0 * scale - 1.0)
}

#[test]
fn slanted_and_creased_surfaces_that_grow_have_no_cracks() {
    // Slopes of less and of more than the threshold, which is a 64th of the range.
    let depths: [&dyn Fn(i32, i32) -> f64; 9] = [
        &|x, _| 0.45 + 0.03 * f64::from(x),
        &|x, y| 0.45 + 0.02 * f64::from(y - x.abs()),
        &|x, _| 0.3 + 0.0155 * f64::from(x),
        &|_, y| 0.3 - 0.0155 * f64::from(y),
        &|x, _| 0.3 + 0.008 * f64::from(x),
        &|x, y| 0.3 + 0.006 * f64::from(x) - 0.004 * f64::from(y),
        &|x, _| 0.3 + 0.008 * f64::from(x.abs()),
        &|_, y| 0.5 - 0.008 * f64::from(y.abs()),
        &|x, y| 0.5 - 0.006 * f64::from((x - y).abs()),
    ];
    for (number, depth) in depths.into_iter().enumerate() {
        grows(depth, |scale, layers, _, _| {
            let cracks = (0..64 * 64).filter(|&cell| is_within(scale, cell) && layers[cell] != Some(0)).count();
            assert_eq!(cracks, 0, "surface {number}, {scale} times");
        });
    }
}

#[test]
fn a_square_that_grows_shows_no_background_inside() {
    let mut most = 0;
    grows(&|_, _| 0.3, |scale, layers, rows, tally| {
        for cell in (0..64 * 64).filter(|&cell| is_within(scale, cell)) {
            assert_eq!((layers[cell], rows[cell / 64][cell % 64]), (Some(0), 200), "cell {cell}, {scale} times");
        }
        // All samples are there, and none of the background has moved.
        assert_eq!((tally.moved, tally.lost, tally.holes), (64 * 64 + 29 * 29, 0, 0));
        most = layers.iter().filter(|layer| **layer == Some(0)).count();
    });
    // It ends half a cell beyond its last samples, which each have a cell.
    assert!((51 * 51..=52 * 52).contains(&most), "{most}");
}

/// Dark lines of one cell on a light page, or before it, that move by half a cell: as much dark in each row as before.
#[test]
fn thin_lines_keep_their_mean() {
    for is_upright in [true, false] {
        for depth in [0.75, 0.25] {
            let velocity = if is_upright { [0.5, 0.0] } else { [0.0, 0.5] };
            let is_line = move |x: i32, y: i32| [6, 9, 13].contains(if is_upright { &x } else { &y });
            let page = if depth == 0.75 { velocity } else { [0.0; 2] };
            let text = |x, y| if is_line(x, y) { gray(20, depth, velocity) } else { gray(220, 0.75, page) };
            let behind = |_, _| gray(220, 0.75, page);
            // What is nearer needs a background to be seen.
            let lists: [&[&dyn Fn(i32, i32) -> Galpixel]; 2] = [&[&text], &[&text, &behind]];
            let list = lists[usize::from(depth == 0.25)];
            run((20, 20), list, 4, |frame, sources, _| {
                let rows = picture(sources, FillMode::Extend);
                for line in 4..17 {
                    let at = |part: usize| {
                        let [x, y] = if is_upright { [part, line] } else { [line, part] };
                        rows[y][x]
                    };
                    let dark: u32 = (4..18).map(|part| 220 - at(part)).sum();
                    assert!(dark.abs_diff(600) <= 3, "frame {frame}, line {line}: {dark}, {is_upright} {depth}");
                    // Half of a line in each of two cells.
                    let cells = (4..18).filter(|&part| at(part) < 180).count();
                    assert_eq!(cells, if frame % 2 == 0 { 3 } else { 6 }, "{is_upright} {depth} {frame}");
                }
            });
        }
    }
}

/// Samples that leave the map at the left, because they are accelerated, are back after 8 frames.
#[test]
fn a_lost_sample_comes_back_when_its_velocity_turns() {
    let turning = |x: i32, y: i32| {
        let own = gray(7 * x + y, 0.5, [-2.0, 0.0]);
        Galpixel { acceleration: [I32F32::from_num(0.5), I32F32::ZERO, I32F32::ZERO], ..own }
    };
    let mut losses = Vec::new();
    run((12, 3), &[&turning], 8, |frame, sources, tally| {
        assert_eq!(tally.moved, 36);
        losses.push(tally.lost);
        if frame == 4 {
            assert_eq!(sources.layers()[0].displacement(0), [-4, 0]);
            assert_eq!(sources.shown(0), Some((0, 4)));
        }
        if frame == 8 {
            assert!((0..36).all(|cell| sources.shown(cell) == Some((0, cell))));
        }
    });
    assert_eq!(losses, [0, 6, 9, 12, 12, 12, 9, 6, 0]);
}

#[test]
fn displacements_saturate_and_are_counted() {
    let format = format(4, Layout::FULL);
    for (velocity, place, ends, count) in [
        ([5.0, 0.0], [32765, 7], [32767, 7], 1),
        ([5.0, 0.0], [32762, 7], [32767, 7], 0),
        ([-5.0, 0.0], [-32765, 0], [-32768, 0], 1),
        ([0.0, 5.0], [0, 32765], [0, 32767], 1),
        ([0.0, -5.0], [3, -32764], [3, -32768], 1),
        ([0.0, -5.0], [3, -32763], [3, -32768], 0),
        ([5.0, -5.0], [32767, -32768], [32767, -32768], 2),
    ] {
        // The last chunk of a row has less cells than others.
        let shape = (67, 1, Margin::NONE);
        let mut layers = [drawn(shape, format, |_, _| gray(9, 0.5, velocity))];
        with_sources(shape, format, &mut layers, &mut Random(1), |sources| {
            sources.layers[0].begin(16);
            sources.layers[0].displacements_mut().fill(crate::layers::displacement_word(place));
            let tally = sources.step(&Settings::for_depth(16));
            assert_eq!((tally.saturated, tally.moved, tally.lost), (67 * count, 67, 67), "{velocity:?} {place:?}");
            assert!((0..67).all(|cell| sources.layers()[0].displacement(cell) == ends));
        });
    }
}

/// A square of a nearer layer passes before a picture, whichever of the two is the base.
#[test]
fn what_a_nearer_layer_hides_is_seen_again_when_it_has_passed() {
    let square = |x: i32, y: i32| {
        let is_inside = (2..8).contains(&x) && (2..8).contains(&y);
        if is_inside { gray(200, 0.25, [1.0, 0.0]) } else { nothing() }
    };
    let picture_of = |x: i32, y: i32| gray(x + 3 * y, 0.75, [0.0; 2]);
    for is_base in [true, false] {
        let layers: [&dyn Fn(i32, i32) -> Galpixel; 2] =
            if is_base { [&square, &picture_of] } else { [&picture_of, &square] };
        let (near, far) = if is_base { (0, 1) } else { (1, 0) };
        run((30, 10), &layers, 30, |frame, sources, tally| {
            let frame = frame as i32;
            for (x, y) in (0..10).flat_map(|y| (0..30).map(move |x| (x, y))) {
                let is_hidden = (2..8).contains(&(x - frame)) && (2..8).contains(&y);
                let cell = (y * 30 + x) as u32;
                let expected = if is_hidden { (near, cell.wrapping_add_signed(-frame)) } else { (far, cell) };
                assert_eq!(sources.shown(cell), Some(expected), "{x} {y} {frame}");
            }
            let seen = 6 * (30 - (2 + frame)).clamp(0, 6) as u32;
            assert_eq!((tally.lost, tally.collided, tally.holes), (36 - seen, seen, 0));
            let rows = picture(sources, FillMode::Extend);
            assert_eq!(rows[9], gathered(sources, FillMode::Extend, false)[9]);
        });
    }
}

/// What a frame counts, and fill modes and what is known, slowly.
#[test]
fn rows_are_counted_filled_and_known_as_written() {
    let mut random = Random(5);
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for shape in SHAPES {
            for look in LOOKS {
                let mut layers = [look, Look::Sparse].map(|look| random_layer(&mut random, shape, format, look));
                let layers = &mut layers[..1 + random.below(2) as usize];
                with_sources(shape, format, layers, &mut Random(9), |sources| {
                    sources.layers.iter_mut().for_each(|layer| layer.begin(16));
                    for _ in 0..3 {
                        let tally = sources.step(&Settings { edge_threshold: 16, ..Settings::for_depth(16) });
                        compare_fills(sources, &tally);
                    }
                });
            }
        }
    }
}

fn compare_fills(sources: Shown<'_, '_, '_>, tally: &Tally) {
    let map = sources.base().unwrap();
    let (grid, width) = (map.grid(), map.grid().width() as usize);
    let entries: Vec<_> = (0..grid.cells()).map(|cell| sources.visibility.at(cell)).collect();
    assert_eq!((tally.holes, tally.edges, tally.filled()), (tally.bullets + tally.empty, 0, tally.bullets));
    assert_eq!(tally.empty as usize, entries.iter().filter(|entry| !entry.is_some()).count());
    assert!(tally.collided + tally.lost <= tally.moved);
    let samples = sources.layers().iter().flat_map(|layer| (0..grid.cells()).map(|cell| layer.map().class(cell)));
    assert_eq!(tally.moved as usize, samples.filter(|&class| class == Class::Galpixel).count());
    for (y, &start) in (0..).zip(grid.starts()) {
        let entries = &entries[start as usize..][..width];
        let ends = |x: usize| {
            let left = (0..x).rev().find(|&x| entries[x].is_some());
            (left, (x..width).find(|&x| entries[x].is_some()))
        };
        for (sub_cell, fill_mode) in FillMode::ALL.into_iter().flat_map(|mode| [(false, mode), (true, mode)]) {
            let mut row = vec![0; width];
            let holes = sources.gather(y, Gather { fill_mode, sub_cell, edge_threshold: 16 }, &mut row);
            assert_eq!(holes as usize, entries.iter().filter(|entry| !entry.is_some()).count());
            for x in (0..width).filter(|&x| !entries[x].is_some()) {
                let cell = start + x as u32;
                let is_empty = map.class(cell) == Class::Empty;
                let expected = match (fill_mode, ends(x)) {
                    (FillMode::None, _) => 0,
                    (FillMode::Extend, (Some(left), Some(right))) if !is_empty => {
                        row[if entries[right].depth() > entries[left].depth() { right } else { left }]
                    }
                    (FillMode::Extend, (Some(end), None) | (None, Some(end))) if !is_empty => row[end],
                    _ => map.colour(cell),
                };
                assert_eq!(row[x], expected, "{fill_mode:?}");
            }
        }
        let (mut known, mut depths) = (vec![0; grid.cells().div_ceil(32) as usize], vec![0; width]);
        sources.known(y, &mut known, &mut depths);
        for cell in 0..grid.cells() {
            let is_in_row = (start..start + width as u32).contains(&cell);
            let expected = is_in_row && (entries[(cell - start) as usize].is_some() || map.class(cell) == Class::Empty);
            assert_eq!(known[cell as usize / 32] >> (cell % 32) & 1 != 0, expected);
        }
        for (x, &depth) in depths.iter().enumerate() {
            let of = |end: Option<usize>| end.map_or(0, |end| entries[end].depth());
            let (left, right) = ends(x);
            let expected = if entries[x].is_some() { entries[x].depth() } else { of(left).max(of(right)) };
            assert_eq!(depth as i32, expected);
        }
    }
}

/// A sky at the farthest depth that there is, and a ridge just before it, whose colours a renderer has mixed at the
/// border: what is mixed is not changed as long as the ridge is seen beside it.
#[test]
fn the_farthest_depth_is_one_like_others() {
    for (ridge, sky) in [(0.98, 1.0), (0.96, 1.0), (0.98, 0.9999), (0.5, 0.52)] {
        let far = |x: i32, _: i32| match x {
            0..6 => gray(200, ridge, [0.0; 2]),
            6 => gray(150, sky, [0.0; 2]),
            _ => gray(100, sky, [0.0; 2]),
        };
        run((17, 5), &[&far], 3, |_, sources, _| {
            for row in picture(sources, FillMode::Hold) {
                assert_eq!(row[4..9], [200, 200, 150, 100, 100], "{ridge} {sky}");
            }
        });
    }
}
