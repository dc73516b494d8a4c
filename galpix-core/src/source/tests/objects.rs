//! Layers of a grid of their own, and layers that are replaced.

use super::*;
use crate::format::rounding::Rounding;
use crate::frame::Settings;
use crate::frame::fill::FillMode;
use crate::source::Gather;

const DISPLAY: Shape = (70, 24, Margin { left: 3, right: 2, top: 1, bottom: 0 });
const OBJECT: Shape = (37, 11, Margin::NONE);

/// Lays the words of a small layer into a layer as large as the display, with the object's first cell at `place`.
fn enlarged(format: Dynamic, object: &[Vec<u32>; 2], place: [u32; 2]) -> [Vec<u32>; 2] {
    let [width, height] = [columns(DISPLAY), DISPLAY.1 + DISPLAY.2.top + DISPLAY.2.bottom];
    let mut large = drawn(DISPLAY, format, |_, _| nothing());
    let (cells, object_cells) = ((width * height) as usize, (OBJECT.0 * OBJECT.1) as usize);
    for (y, x) in (0..OBJECT.1).flat_map(|y| (0..OBJECT.0).map(move |x| (y, x))) {
        let (from, to) = ((y * OBJECT.0 + x) as usize, ((place[1] + y) * width + place[0] + x) as usize);
        for word in 0..format.record().words() {
            large[0][word * cells + to] = object[0][word * object_cells + from];
        }
        large[1][to] = object[1][from];
    }
    large
}

fn columns((width, _, margin): Shape) -> u32 {
    width + margin.left + margin.right
}

/// All that a frame shows, but for the numbers of the samples.
fn picture(sources: &Sources<'_, '_, Dynamic>) -> Vec<(Option<u16>, u32, u32)> {
    let grid = sources.visibility.grid();
    let rows: Vec<Vec<u32>> = (0..grid.height())
        .map(|y| {
            let mut colours = vec![0; grid.width() as usize];
            let gather = Gather { fill_mode: FillMode::Extend, sub_cell: true, edge_threshold: 1024 };
            sources.gather(y, gather, &mut colours);
            colours
        })
        .collect();
    let row = |y: u32| rows.get(y as usize).map_or(&[][..], Vec::as_slice);
    (0..grid.height())
        .flat_map(|y| {
            let (mut finished, mut moved) = (vec![0; grid.width() as usize], vec![0; grid.width() as usize]);
            sources.finish(y, 1024, [row(y.wrapping_sub(1)), row(y), row(y + 1)], &mut finished);
            sources.moved(y, &mut moved);
            let keys = (0..grid.width()).map(move |x| sources.entry(y * grid.width() + x).map(|(key, _)| key));
            keys.zip(finished).zip(moved).map(|((key, finished), moved)| (key, finished, moved)).collect::<Vec<_>>()
        })
        .collect()
}

/// An object in a layer of its own grid is shown as one in a layer of the display's grid whose other cells are empty.
#[test]
fn a_layer_of_its_own_grid_is_shown_as_in_a_large_one() {
    let (mut random, settings) = (Random(11), Settings::for_depth(16));
    for (frac, layout) in FORMATS {
        let format = format(frac, layout);
        for (turn, look) in LOOKS.into_iter().filter(|look| *look != Look::Far).cycle().take(8).enumerate() {
            let base = random_layer(&mut random, DISPLAY, format, if turn < 4 { Look::Sparse } else { Look::Grown });
            let object = random_layer(&mut random, OBJECT, format, look);
            let place = [random.below(columns(DISPLAY) - OBJECT.0), random.below(14)];
            let mut layers = [base.clone(), enlarged(format, &object, place)];
            let frames = |sources: &mut Sources<'_, '_, Dynamic>| {
                (0..4)
                    .map(|frame| {
                        let tally = if frame == 0 { sources.show(&settings) } else { sources.step(&settings) };
                        let mut picture = picture(sources);
                        // Where a sample is stored is another cell in the two.
                        picture.iter_mut().for_each(|(_, _, moved)| *moved = 0);
                        (tally, picture)
                    })
                    .collect::<Vec<_>>()
            };
            let large = with_sources(DISPLAY, format, &mut layers, &mut Random(1), |sources| {
                sources.layers.iter_mut().for_each(|layer| layer.begin(settings.edge_threshold));
                frames(sources)
            });
            let mut layers = [base, object];
            let small = with_shapes(&[DISPLAY, OBJECT], format, &mut layers, &mut Random(2), |sources| {
                sources.layers[0].begin(settings.edge_threshold);
                sources.layers[1].begin_at(place.map(|number| number as i32), settings.edge_threshold);
                frames(sources)
            });
            assert!(small == large, "{layout:?} {look:?} {place:?}");
        }
    }
}

/// The same where a near block has moved away from samples that a renderer has mixed, whose colours are unmixed then,
/// and where it has not.
#[test]
fn rims_in_a_layer_of_its_own_grid_are_unmixed_as_in_a_large_one() {
    let settings = Settings::for_depth(16);
    let format = format(4, Layout { colour: Colour::GRAY8, ..Layout::FULL });
    let is_near = |x: i32, y: i32| (12..25).contains(&x) && (4..7).contains(&y);
    for [block, slide] in [[[3.0, 20.0], [0.3, 0.3]], [[0.0; 2], [0.0; 2]]] {
        let object = drawn(OBJECT, format, |x, y| {
            let is_beside = is_near(x - 1, y) || is_near(x + 1, y) || is_near(x, y - 1) || is_near(x, y + 1);
            match (is_near(x, y), is_beside) {
                (true, _) => gray(220, 0.25, block),
                (false, true) => gray(150, 0.75, slide),
                (false, false) => gray(100, 0.75, slide),
            }
        });
        for place in [[30, 8], [0, 0], [35, 13]] {
            let base = drawn(DISPLAY, format, |_, _| nothing());
            let mut layers = [base.clone(), enlarged(format, &object, place)];
            let large = with_sources(DISPLAY, format, &mut layers, &mut Random(1), |sources| {
                sources.layers.iter_mut().for_each(|layer| layer.begin(settings.edge_threshold));
                sources.step(&settings);
                picture(sources)
            });
            let mut layers = [base, object.clone()];
            let small = with_shapes(&[DISPLAY, OBJECT], format, &mut layers, &mut Random(2), |sources| {
                sources.layers[0].begin(settings.edge_threshold);
                sources.layers[1].begin_at(place.map(|number| number as i32), settings.edge_threshold);
                sources.step(&settings);
                picture(sources)
            });
            let colours = |picture: &[(Option<u16>, u32, u32)]| {
                picture.iter().map(|&(key, finished, _)| (key, finished)).collect::<Vec<_>>()
            };
            assert!(colours(&small) == colours(&large), "{place:?}");
            let is_mixed = |colour: &&(Option<u16>, u32)| colour.0.is_some() && (125..200).contains(&colour.1);
            let mixed = colours(&small).iter().filter(is_mixed).count();
            assert_eq!(mixed > 0, block == [0.0; 2], "{block:?} {place:?}");
        }
    }
}

/// How far a cell shows that its sample has moved is what its layer says.
#[test]
fn movements_are_those_of_the_layer() {
    let (mut random, format) = (Random(12), format(4, Layout::FULL));
    let shapes = [DISPLAY, OBJECT, (5, 3, Margin::NONE)];
    let mut layers = shapes.map(|shape| random_layer(&mut random, shape, format, Look::Tame));
    with_shapes(&shapes, format, &mut layers, &mut Random(1), |sources| {
        for (layer, place) in sources.layers.iter_mut().zip([[0, 0], [20, 7], [-2, 19]]) {
            layer.begin_at(place, 16);
        }
        sources.step(&Settings::for_depth(16));
        let (width, mut layers_seen) = (columns(DISPLAY), [0; 3]);
        for (cell, (key, _, moved)) in (0..).zip(picture(sources)) {
            let Some((layer, stored)) = sources.shown(cell).filter(|_| key.is_some()) else {
                assert_eq!(moved, 0);
                continue;
            };
            let own = columns(shapes[layer]);
            let apart = |here: u32, there: u32| here as i32 - there as i32;
            let place = [apart(cell % width, stored % own), apart(cell / width, stored / own)];
            assert_eq!(moved, crate::layers::displacement_word(place));
            layers_seen[layer] += 1;
        }
        assert!(layers_seen.iter().all(|&seen| seen > 3), "{layers_seen:?}");
    });
}

/// A source that was not shown and then steps what it missed has the bits of one that was shown in every frame; and
/// what is written into a spare one is not seen before it takes the place of a layer.
#[test]
fn an_update_that_comes_late_is_as_one_in_time() {
    let mut random = Random(13);
    for (turn, (frac, layout)) in FORMATS.into_iter().enumerate() {
        let format = format(frac, layout);
        let mut settings = Settings::for_depth(16);
        settings.rounding = Rounding::ALL[turn % Rounding::ALL.len()];
        let layers = [(); 3].map(|()| random_layer(&mut random, DISPLAY, format, LOOKS[turn % LOOKS.len()]));
        let [base, old, new] = &layers;
        let mut in_time = [base.clone(), new.clone()];
        let expected = with_sources(DISPLAY, format, &mut in_time, &mut Random(1), |sources| {
            sources.layers.iter_mut().for_each(|layer| layer.begin(1024));
            (0..7).fold(0, |_, _| sources.step(&settings).saturated);
            (sources.layers[1].displacements.to_vec(), picture(sources))
        });
        let mut without = [base.clone(), old.clone()];
        let undisturbed = with_sources(DISPLAY, format, &mut without, &mut Random(1), |sources| {
            sources.layers.iter_mut().for_each(|layer| layer.begin(1024));
            (0..6).for_each(|_| _ = sources.step(&settings));
            picture(sources)
        });
        let mut late = [base.clone(), old.clone()];
        with_sources(DISPLAY, format, &mut late, &mut Random(1), |sources| {
            sources.layers.iter_mut().for_each(|layer| layer.begin(1024));
            let mut spare = spare(format, new);
            for row in 0..6 {
                sources.step(&settings);
                // A row of the update arrives with each frame.
                for x in 0..columns(DISPLAY) {
                    let words = arrived(format, new, row * columns(DISPLAY) + x);
                    spare.map_mut().put(row * columns(DISPLAY) + x, &words);
                }
            }
            assert!(picture(sources) == undisturbed, "an update that is not complete is not seen: {layout:?}");
            spare.begin(1024);
            let samples = |source: &Source<'_, Dynamic>| {
                (0..source.map.grid().cells()).filter(|&cell| source.map.class(cell) == Class::Galpixel).count() as u32
            };
            for frame in 0..6 {
                assert_eq!(spare.step(settings.rounding, frame).moved, samples(&spare));
            }
            sources.replace(1, &mut spare).unwrap();
            sources.step(&settings);
            assert!((sources.layers[1].displacements.to_vec(), picture(sources)) == expected, "{layout:?}");
        });
    }
}

/// Returns a source of the display's grid with the galpixels of a layer, without its first six rows.
fn spare(format: Dynamic, layer: &[Vec<u32>; 2]) -> Source<'static, Dynamic> {
    let starts = vec![0; Grid::rows(DISPLAY.1, DISPLAY.2)].leak();
    let grid = Grid::new(DISPLAY.0, DISPLAY.1, DISPLAY.2, starts).unwrap();
    let mut map = Galpixmap::over(grid, format, layer[0].clone().leak()).unwrap();
    (0..6 * grid.width()).for_each(|cell| map.put(cell, &[u32::MAX; 8]));
    let links = vec![0; links::words(&grid)].leak();
    Source::new(map, layer[1].clone().leak(), links).unwrap()
}

/// Returns the words of a cell of a layer over the display's grid.
fn arrived(format: Dynamic, layer: &[Vec<u32>; 2], cell: u32) -> crate::format::record::Words {
    let mut words = [0; 8];
    let cells = layer[1].len();
    for (word, to) in words.iter_mut().enumerate().take(format.record().words()) {
        *to = layer[0][word * cells + cell as usize];
    }
    words
}
