//! The engine and the slow model of the specification, side by side: the same bits in every map, count and flag.

use galpix_core::inpaint::{Gamma, Motion, PushPull};
use galpix_core::layers::{Layers, displacement_word};
use galpix_core::{Controller, Dynamic, FillMode, Format, Inpainting, Layout, Rounding, Scratch, Settings};
use galpix_tests::memory::{Mode, Shape, Trace, cell_words, with_controller, with_maps, words};
use galpix_tests::profiles::{ODD, PANEL, PAPER, SCENE, SLIDE, UNEVEN, dynamic};
use galpix_tests::random::{below, generator};
use rand::RngExt;
use rand::rngs::SmallRng;

use super::engine::with_layers;
use super::holes::{Cell, packed_edges};
use super::model::{Counts, Kind, Model, cells_of, planes};
use super::random::{self as chance, Filling};

const FRAMES: usize = 5;

/// A frame counter that wraps while it is watched.
const FIRST_FRAME: u32 = u32::MAX - 1;

/// One cell, a word of flags and its neighbours, margin.
const SHAPES: [Shape; 6] = [
    Shape::plain(1, 1),
    Shape::plain(37, 1),
    Shape::plain(16, 10),
    Shape::plain(33, 7),
    Shape::new(9, 6, [2, 3, 1, 4]),
    Shape::plain(2, 32),
];

/// What layers did, in sum: what never happened was not tested.
#[derive(Debug, Default)]
struct Seen {
    shown: u32,
    bullets: u32,
    hidden_bullets: u32,
    galdebris: u32,
    debris: u32,
    lost: u32,
    collided: u32,
    inpainted: u32,
}

impl Seen {
    fn add(&mut self, tally: &Counts) {
        self.shown += tally.shown.iter().sum::<u32>();
        self.bullets += tally.base.bullets;
        self.galdebris += tally.base.galdebris;
        self.debris += tally.base.debris;
        for hidden in &tally.hidden {
            self.hidden_bullets += hidden.bullets;
            self.lost += hidden.lost;
            self.collided += hidden.collided;
        }
    }
}

/// The engine shows what the model shows.
fn assert_shown(layers: &Layers<'_, '_, Dynamic>, model: &Model, what: &str) {
    let (shown, of) = model.shown();
    for (cell, (words, &layer)) in (0..).zip(shown.iter().zip(&of)) {
        assert_eq!(&cell_words(layers.front(), cell), words, "{what}: shown in cell {cell}");
        assert_eq!(layers.layer_at(cell), layer, "{what}: the layer of cell {cell}");
    }
    for (hidden, layer) in (1..).zip(layers.hidden()) {
        assert_eq!(
            layer.shown() as usize,
            of.iter().filter(|&&layer| layer == hidden).count(),
            "{what}: layer {hidden}"
        );
    }
    assert_eq!(layers.layer_at(u32::MAX), 0);
}

/// Each layer's own galpixels are those of the model, and where they came from.
fn assert_own(layers: &mut Layers<'_, '_, Dynamic>, model: &Model, what: &str) {
    for (index, own) in model.layers.iter().enumerate() {
        let map = layers.layer_mut(index).expect("a layer");
        let expected = if own.kind.stationary { &own.stored } else { &own.cells };
        assert!(&cells_of(map) == expected, "{what}: layer {index} differs");
        if own.kind.stationary {
            let expected: Vec<u32> =
                own.displacements.iter().map(|place| displacement_word(place.map(|cells| cells as i32))).collect();
            assert!(layers.displacements_mut(index).expect("displacements") == expected, "{what}: layer {index}");
        } else {
            assert!(layers.displacements_mut(index).is_none(), "{what}");
        }
    }
    assert!(layers.layer_mut(model.layers.len()).is_none() && layers.displacements_mut(model.layers.len()).is_none());
}

fn assert_winners(layers: &Layers<'_, '_, Dynamic>, model: &Model, what: &str) {
    for (index, own) in model.layers.iter().enumerate() {
        let expected: &[u32] = if own.kind.winners { &own.winners } else { &[] };
        assert_eq!(layers.winners(index), expected, "{what}: the winners of layer {index}");
    }
    assert!(layers.winners(model.layers.len()).is_empty());
}

/// Some galpixels are written into a layer of both.
fn write(layers: &mut Layers<'_, '_, Dynamic>, model: &mut Model, generator: &mut SmallRng) {
    let layer = below(generator, model.layers.len() as u32) as usize;
    let cells = model.shape.cells() as usize;
    let filling = Filling::any(generator);
    let update = chance::map(generator, model.format.record(), filling, model.shape);
    // Of a stationary layer at times a displacement alone.
    let galpixels = !model.layers[layer].kind.stationary || generator.random_ratio(1, 2);
    let taken: Vec<bool> = (0..cells).map(|_| galpixels && generator.random_ratio(1, 3)).collect();
    let columns = model.shape.columns();
    let own = &mut model.layers[layer];
    let to = if own.kind.stationary { &mut own.stored } else { &mut own.cells };
    with_maps(model.shape, model.format, Some(&planes(&update)), |from, _| {
        for cell in (0..cells).filter(|&cell| taken[cell]) {
            let map = layers.layer_mut(layer).expect("a layer");
            let [x, y] = [cell as u32 % columns, cell as u32 / columns].map(|place| place as i32);
            let galpixel = from.load(x, y).expect("in the map");
            map.store(x, y, &galpixel).expect("in the map");
            let (words, _) = from.stored(&galpixel);
            to[cell].copy_from_slice(&words[..from.record().words()]);
        }
    });
    if own.kind.stationary {
        let cell = below(generator, cells as u32) as usize;
        let place = [0, 1].map(|_| i64::from(below(generator, 9)) - 4);
        own.displacements[cell] = place;
        let words = layers.displacements_mut(layer).expect("displacements");
        words[cell] = displacement_word(place.map(|cells| cells as i32));
    }
    model.draw();
}

/// Inpainting of what is shown, from the base's own map before and its edges.
fn inpainted(layers: &mut Layers<'_, '_, Dynamic>, model: &mut Model, settings: &Settings, what: &str) -> u32 {
    let (columns, rows) = (model.shape.columns(), model.shape.rows());
    let inpainting = Inpainting::for_depth(u32::from(model.format.record().depth().bits), Gamma::Half);
    let mut memory = vec![0; PushPull::words(columns, rows, Motion::Inpainted)];
    let mut push_pull = PushPull::new(columns, rows, Motion::Inpainted, &mut memory).unwrap();
    let filled = layers.inpaint(settings, &inpainting, &mut push_pull);
    let (shown, of) = model.shown();
    let mut edges = packed_edges(&model.edges);
    let (shown, expected) = with_maps(model.shape, model.format, Some(&planes(&shown)), |front, _| {
        with_maps(model.shape, model.format, Some(&planes(&model.before)), |before, _| {
            let edges: &mut [u32] = if model.layers[0].kind.edges { &mut edges } else { &mut [] };
            let mut controller = Controller::new(front, before, Scratch { winners: &mut [], edges }).unwrap();
            controller.set_frame(model.frame);
            let filled = controller.inpaint(settings, &inpainting, &mut push_pull);
            (cells_of(controller.front()), filled)
        })
    });
    assert_eq!(filled, expected, "{what}: cells inpainted");
    for (cell, words) in shown.into_iter().enumerate().filter(|&(cell, _)| of[cell] == 0) {
        model.layers[0].cells[cell] = words;
    }
    filled
}

/// Several frames of a base and `hidden` layers by chance, with updates and inpainting in between.
fn same_as_the_model(format: Dynamic, hidden: usize, seed: u64, seen: &mut Seen) {
    let mut generator = generator(seed);
    let record = *format.record();
    let shape = SHAPES[seed as usize % SHAPES.len()];
    let fill_mode = FillMode::ALL[seed as usize / 3 % FillMode::ALL.len()];
    let rounding = Rounding::ALL[below(&mut generator, 4) as usize];
    let depth_bits = u32::from(record.depth().bits);
    let edge_threshold = [0, 1 << (depth_bits / 2), u32::MAX][below(&mut generator, 3) as usize];
    let reach = 1 + below(&mut generator, 3);
    let mode = Mode::ALL[seed as usize % 2];
    let settings = Settings { rounding, fill_mode, edge_threshold, reach };
    let contents: Vec<(Kind, Vec<Cell>)> = (0..=hidden)
        .map(|layer| {
            let stationary = layer > 0 && generator.random_ratio(1, 3);
            let [winners, edges] = [0, 1].map(|_| generator.random_ratio(5, 6));
            let filling = Filling::any(&mut generator);
            let content = chance::map(&mut generator, &record, filling, shape);
            (Kind { winners, edges: edges && !stationary, stationary }, content)
        })
        .collect();
    let kinds: Vec<Kind> = contents.iter().map(|(kind, _)| *kind).collect();
    let what = format!("seed {seed}, {shape:?}, {settings:?}, {mode:?}, {kinds:?}");
    let mut model = Model::new(shape, format, contents.clone());
    with_layers(shape, format, &contents, |layers| {
        layers.set_frame(FIRST_FRAME);
        model.frame = FIRST_FRAME;
        assert_shown(layers, &model, &format!("{what}, at first"));
        for frame in 0..FRAMES {
            let what = format!("{what}, frame {frame}");
            let base = mode.step_layers(layers, &settings);
            let counts = Counts::of(layers, base);
            assert_eq!(counts, model.step(&settings), "{what}");
            seen.add(&counts);
            assert_shown(layers, &model, &what);
            assert_winners(layers, &model, &what);
            if fill_mode == FillMode::Extend {
                seen.inpainted += inpainted(layers, &mut model, &settings, &what);
                assert_shown(layers, &model, &format!("{what}, inpainted"));
            }
            // What is written is shown at once, or from the next frame on.
            match below(&mut generator, 4) {
                0 => assert_own(layers, &model, &what),
                1 => write(layers, &mut model, &mut generator),
                2 => {
                    write(layers, &mut model, &mut generator);
                    layers.composite();
                    assert_shown(layers, &model, &format!("{what}, written"));
                }
                _ => {}
            }
            assert_eq!(layers.frame(), model.frame, "{what}");
        }
        assert_own(layers, &model, &what);
    });
}

#[test]
fn layers_are_those_of_the_model() {
    for (layout, bits) in [
        (Layout::FULL, PAPER),
        (Layout::TAGGED, ODD),
        (Layout::SHADED, UNEVEN),
        (Layout::VELOCITY565, SLIDE),
        (Layout::VELOCITY_GRAY4, PANEL),
        (Layout::STILL, SCENE),
    ] {
        let format = dynamic(layout, bits);
        let mut seen = Seen::default();
        for seed in 0..36 {
            // Two of one layer more, so that shapes, fill modes and modes are combined differently.
            for (hidden, seed) in [(0, seed), (1, seed), (1, seed + 1), (2, seed + 2), (3, seed + 3)] {
                same_as_the_model(format, hidden, seed, &mut seen);
            }
        }
        assert!(seen.shown > 0, "{layout:?}: {seen:?}");
        if layout.velocity {
            assert!(seen.galdebris > 0 && seen.debris > 0, "{layout:?}: {seen:?}");
            assert!(seen.bullets > 0 && seen.hidden_bullets > 0, "{layout:?}: {seen:?}");
            assert!(seen.lost > 0 && seen.collided > 0, "{layout:?}: {seen:?}");
            assert!(seen.inpainted > 0, "{layout:?}: {seen:?}");
        }
    }
}

/// No further layer: a controller, to the bit.
#[test]
fn a_base_alone_is_a_controller() {
    let format = dynamic(Layout::FULL, PAPER);
    let kind = Kind { winners: true, edges: true, stationary: false };
    let mut holes = 0;
    for (seed, fill_mode) in (0..).zip(FillMode::ALL) {
        for mode in Mode::ALL {
            let settings = Settings { fill_mode, reach: 2, ..Settings::for_depth(16) };
            let shape = SHAPES[2];
            let content = chance::map(&mut generator(seed), format.record(), Filling::Dense, shape);
            with_controller(shape, format, Some(&planes(&content)), |controller| {
                with_layers(shape, format, &[(kind, content.clone())], |layers| {
                    for _ in 0..FRAMES {
                        let tally = mode.step(controller, &settings);
                        let trace = Trace::of(controller, tally);
                        let tally = mode.step_layers(layers, &settings);
                        trace.assert_same(&Trace::of(layers.base(), tally), &format!("{settings:?} {mode:?}"));
                        assert_eq!(words(layers.front()), trace.words);
                        holes += tally.holes;
                    }
                });
            });
        }
    }
    assert!(holes > 0);
}

/// Both modes leave the same layers behind, also where they take turns.
#[test]
fn layers_are_the_same_in_both_modes() {
    let format = dynamic(Layout::SHADED, SCENE);
    for seed in 100..130 {
        let run = |mode: fn(usize) -> Mode| {
            let mut generator = generator(seed);
            let shape = SHAPES[seed as usize % SHAPES.len()];
            let contents: Vec<(Kind, Vec<Cell>)> = (0..3)
                .map(|layer| {
                    let kind = Kind { winners: true, edges: layer < 2, stationary: layer == 2 };
                    let filling = Filling::any(&mut generator);
                    (kind, chance::map(&mut generator, format.record(), filling, shape))
                })
                .collect();
            with_layers(shape, format, &contents, |layers| {
                let fill_mode = FillMode::ALL[seed as usize % FillMode::ALL.len()];
                let settings = Settings { fill_mode, ..Settings::for_depth(16) };
                let frame = |frame| {
                    let base = mode(frame).step_layers(layers, &settings);
                    let winners: Vec<_> = (0..3).map(|layer| layers.winners(layer).to_vec()).collect();
                    (Counts::of(layers, base), words(layers.front()), winners)
                };
                (0..FRAMES).map(frame).collect::<Vec<_>>()
            })
        };
        let skipping = run(|_| Mode::Step);
        assert_eq!(skipping, run(|_| Mode::ConstantTime));
        assert_eq!(skipping, run(|frame| Mode::ALL[frame % 2]));
    }
}
