//! The engine and the slow model of the specification, side by side: the same bits in every map, count and flag.

use galpix_core::fill::Rung;
use galpix_core::frame::{Controller, Inpainting, Scratch, Settings, Work};
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::grid::Wings;
use galpix_core::inpaint::levels;
use galpix_core::inpaint::paint::Moving;
use galpix_core::inpaint::pyramid::{Cell as PyramidCell, Pyramid, state_words};
use galpix_core::inpaint::validity::Gamma;
use galpix_core::layers::{Layers, LayersTally, displacement_word};
use galpix_core::layout::{Full, Layout, Shaded, Still, Tagged, Velocity565, VelocityGray4};
use galpix_core::rounding::Rounding;
use galpix_tests::lent::{Shape, Trace, cell_words, with_controller, with_maps, words};
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};
use galpix_tests::random::{below, generator};
use rand::RngExt;
use rand::rngs::SmallRng;

use crate::engine::with_layers;
use crate::holes::{Cell, packed_edges};
use crate::model::{Kind, Model, cells_of, planes};
use crate::random::{self as chance, Filling};

const FRAMES: usize = 5;

/// A frame counter that wraps while it is watched.
const FIRST_FRAME: u32 = u32::MAX - 1;

const fn shape(width: u32, height: u32, left: u32, right: u32, top: u32, bottom: u32) -> Shape {
    Shape { width, height, wings: Wings { left, right, top, bottom } }
}

/// One cell, a word of flags and its neighbours, wings.
const SHAPES: [Shape; 6] = [
    Shape::plain(1, 1),
    Shape::plain(37, 1),
    Shape::plain(16, 10),
    Shape::plain(33, 7),
    shape(9, 6, 2, 3, 1, 4),
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
    fn add<const HIDDEN: usize>(&mut self, tally: &LayersTally<HIDDEN>) {
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
fn assert_shown<L: Layout, B: Budget<L>, const HIDDEN: usize>(
    layers: &Layers<'_, L, B, HIDDEN>,
    model: &Model<L, B>,
    what: &str,
) {
    let (shown, of) = model.shown();
    for (cell, (words, &layer)) in (0..).zip(shown.iter().zip(&of)) {
        assert_eq!(&cell_words(layers.front(), cell), words, "{what}: shown in cell {cell}");
        assert_eq!(layers.layer_at(cell), layer, "{what}: the layer of cell {cell}");
    }
    let counts = layers.shown();
    for (hidden, &count) in (1..).zip(&counts) {
        assert_eq!(count as usize, of.iter().filter(|&&layer| layer == hidden).count(), "{what}: layer {hidden}");
    }
    assert_eq!(layers.layer_at(u32::MAX), 0);
}

/// Each layer's own galpixels are those of the model, and where they came from.
fn assert_own<L: Layout, B: Budget<L>, const HIDDEN: usize>(
    layers: &mut Layers<'_, L, B, HIDDEN>,
    model: &Model<L, B>,
    what: &str,
) {
    for (index, own) in model.layers.iter().enumerate() {
        let map = layers.layer_mut(index).expect("a layer");
        let expected = if own.kind.anchored { &own.stored } else { &own.cells };
        assert!(&cells_of(map) == expected, "{what}: layer {index} differs");
        if own.kind.anchored {
            let expected: Vec<u32> =
                own.displacements.iter().map(|place| displacement_word(place.map(|cells| cells as i32))).collect();
            assert!(layers.displacements_mut(index).expect("displacements") == expected, "{what}: layer {index}");
        } else {
            assert!(layers.displacements_mut(index).is_none(), "{what}");
        }
    }
    assert!(layers.layer_mut(HIDDEN + 1).is_none() && layers.displacements_mut(HIDDEN + 1).is_none());
}

fn assert_winners<L: Layout, B: Budget<L>, const HIDDEN: usize>(
    layers: &Layers<'_, L, B, HIDDEN>,
    model: &Model<L, B>,
    what: &str,
) {
    for (index, own) in model.layers.iter().enumerate() {
        let expected: &[u32] = if own.kind.winners { &own.winners } else { &[] };
        assert_eq!(layers.winners(index), expected, "{what}: the winners of layer {index}");
    }
    assert!(layers.winners(HIDDEN + 1).is_empty());
}

/// Some galpixels are written into a layer of both.
fn write<L: Layout, B: Budget<L>, const HIDDEN: usize>(
    layers: &mut Layers<'_, L, B, HIDDEN>,
    model: &mut Model<L, B>,
    generator: &mut SmallRng,
) {
    let layer = below(generator, HIDDEN as u32 + 1) as usize;
    let cells = model.shape.cells() as usize;
    let filling = Filling::any(generator);
    let update = chance::map(generator, model.budget.record(), filling, model.shape);
    // Of an anchored layer at times a displacement alone.
    let galpixels = !model.layers[layer].kind.anchored || generator.random_ratio(1, 2);
    let taken: Vec<bool> = (0..cells).map(|_| galpixels && generator.random_ratio(1, 3)).collect();
    let columns = model.shape.columns();
    let own = &mut model.layers[layer];
    let to = if own.kind.anchored { &mut own.stored } else { &mut own.cells };
    with_maps::<L, B, _>(model.shape, model.budget, Some(&planes(&update)), |from, _| {
        for cell in (0..cells).filter(|&cell| taken[cell]) {
            let map = layers.layer_mut(layer).expect("a layer");
            let [x, y] = [cell as u32 % columns, cell as u32 / columns].map(|place| place as i32);
            let galpixel = from.load(x, y).expect("in the map");
            map.store(x, y, &galpixel).expect("in the map");
            let (words, _) = from.stored(&galpixel);
            to[cell].copy_from_slice(&words[..from.record().words()]);
        }
    });
    if own.kind.anchored {
        let cell = below(generator, cells as u32) as usize;
        let place = [0, 1].map(|_| i64::from(below(generator, 9)) - 4);
        own.displacements[cell] = place;
        let words = layers.displacements_mut(layer).expect("displacements");
        words[cell] = displacement_word(place.map(|cells| cells as i32));
    }
    model.draw();
}

/// Inpainting of what is shown, from the base's own map before and its edges.
fn inpainted<L: Layout, B: Budget<L>, const HIDDEN: usize>(
    layers: &mut Layers<'_, L, B, HIDDEN>,
    model: &mut Model<L, B>,
    settings: &Settings,
    what: &str,
) -> u32 {
    let (columns, rows) = (model.shape.columns(), model.shape.rows());
    let inpainting = Inpainting::for_depth(u32::from(model.budget.record().depth().bits), Gamma::Half);
    let mut memory = vec![PyramidCell::<Moving>::default(); levels::cells(columns, rows)];
    let mut states = vec![0; state_words(memory.len())];
    let mut pyramid = Pyramid::new(columns, rows, &mut memory, &mut states).unwrap();
    let filled = layers.inpaint(settings, &inpainting, &mut pyramid);
    let (shown, of) = model.shown();
    let mut edges = packed_edges(&model.edges);
    let (shown, expected) = with_maps::<L, B, _>(model.shape, model.budget, Some(&planes(&shown)), |front, _| {
        with_maps::<L, B, _>(model.shape, model.budget, Some(&planes(&model.before)), |before, _| {
            let edges: &mut [u32] = if model.layers[0].kind.edges { &mut edges } else { &mut [] };
            let mut controller = Controller::new(front, before, Scratch { winners: &mut [], edges }).unwrap();
            controller.set_frame(model.frame);
            let filled = controller.inpaint(settings, &inpainting, &mut pyramid);
            (cells_of(controller.front()), filled)
        })
    });
    assert_eq!(filled, expected, "{what}: cells inpainted");
    for (cell, words) in shown.into_iter().enumerate().filter(|&(cell, _)| of[cell] == 0) {
        model.layers[0].cells[cell] = words;
    }
    filled
}

/// Several frames of layers by chance, with updates and inpainting in between.
fn same_as_the_model<L: Layout, B: Budget<L>, const HIDDEN: usize>(budget: B, seed: u64, seen: &mut Seen) {
    let mut generator = generator(seed);
    let record = *budget.record();
    let shape = SHAPES[seed as usize % SHAPES.len()];
    let rung = Rung::ALL[seed as usize / 3 % Rung::ALL.len()];
    let rounding = Rounding::ALL[below(&mut generator, 4) as usize];
    let depth_bits = u32::from(record.depth().bits);
    let edge_threshold = [0, 1 << (depth_bits / 2), u32::MAX][below(&mut generator, 3) as usize];
    let reach = 1 + below(&mut generator, 3);
    let work = Work::ALL[seed as usize % 2];
    let settings = Settings { rounding, rung, reach, edge_threshold, work };
    let contents: Vec<(Kind, Vec<Cell>)> = (0..=HIDDEN)
        .map(|layer| {
            let anchored = layer > 0 && generator.random_ratio(1, 3);
            let [winners, edges] = [0, 1].map(|_| generator.random_ratio(5, 6));
            let filling = Filling::any(&mut generator);
            let content = chance::map(&mut generator, &record, filling, shape);
            (Kind { winners, edges: edges && !anchored, anchored }, content)
        })
        .collect();
    let kinds: Vec<Kind> = contents.iter().map(|(kind, _)| *kind).collect();
    let what = format!("seed {seed}, {shape:?}, {settings:?}, {kinds:?}");
    let mut model = Model::<L, B>::new(shape, budget, contents.clone());
    with_layers::<L, B, HIDDEN, _>(shape, budget, &contents, |layers| {
        layers.set_frame(FIRST_FRAME);
        model.frame = FIRST_FRAME;
        assert_shown(layers, &model, &format!("{what}, at first"));
        for frame in 0..FRAMES {
            let what = format!("{what}, frame {frame}");
            let (tally, expected) = (layers.step(&settings), model.step(&settings));
            assert_eq!(tally, expected, "{what}");
            seen.add(&tally);
            assert_shown(layers, &model, &what);
            assert_winners(layers, &model, &what);
            if rung == Rung::Extend {
                seen.inpainted += inpainted(layers, &mut model, &settings, &what);
                assert_shown(layers, &model, &format!("{what}, inpainted"));
            }
            // What is written is shown at once, or from the next frame on.
            match below(&mut generator, 4) {
                0 => assert_own(layers, &model, &what),
                1 => write(layers, &mut model, &mut generator),
                2 => {
                    write(layers, &mut model, &mut generator);
                    layers.resolve(settings.work);
                    assert_shown(layers, &model, &format!("{what}, written"));
                }
                _ => {}
            }
            assert_eq!(layers.frame(), model.frame, "{what}");
        }
        assert_own(layers, &model, &what);
    });
}

fn same_for_all_depths_of_layers<L: Layout, P: Profile>() -> Seen {
    let mut seen = Seen::default();
    let (fixed, chosen) = (Static::<P>::new(), Chosen::<L>::new(P::BITS).unwrap());
    for seed in 0..36 {
        same_as_the_model::<L, _, 0>(chosen, seed, &mut seen);
        same_as_the_model::<L, _, 1>(fixed, seed, &mut seen);
        same_as_the_model::<L, _, 1>(chosen, seed + 1, &mut seen);
        same_as_the_model::<L, _, 2>(fixed, seed + 2, &mut seen);
        same_as_the_model::<L, _, 3>(chosen, seed + 3, &mut seen);
    }
    seen
}

macro_rules! same_as_the_model {
    ($($test:ident = $layout:ty, $profile:ty;)*) => {$(
        #[test]
        fn $test() {
            let seen = same_for_all_depths_of_layers::<$layout, $profile>();
            assert!(seen.shown > 0, "{seen:?}");
            if <$layout as Layout>::LANES.velocity {
                assert!(seen.galdebris > 0 && seen.debris > 0, "{seen:?}");
                assert!(seen.bullets > 0 && seen.hidden_bullets > 0 && seen.lost > 0 && seen.collided > 0, "{seen:?}");
                assert!(seen.inpainted > 0, "{seen:?}");
            }
        }
    )*};
}

same_as_the_model! {
    layers_of_the_papers_galpixels = Full, Paper;
    layers_of_tagged_galpixels = Tagged, Odd;
    layers_of_shaded_galpixels = Shaded, Uneven;
    layers_of_sliding_galpixels = Velocity565, Slide;
    layers_of_the_smallest_galpixels = VelocityGray4, Panel;
    layers_that_do_not_move = Still, Scene;
}

/// No further layer: a controller, to the bit.
#[test]
fn a_base_alone_is_a_controller() {
    let budget = Static::<Paper>::new();
    let kind = Kind { winners: true, edges: true, anchored: false };
    let record = *Budget::<Full>::record(&budget);
    let mut holes = 0;
    for (seed, rung) in (0..).zip(Rung::ALL) {
        for work in Work::ALL {
            let settings = Settings { rung, work, reach: 2, ..Settings::for_depth(16) };
            let shape = SHAPES[2];
            let content = chance::map(&mut generator(seed), &record, Filling::Dense, shape);
            with_controller::<Full, _, _>(shape, budget, Some(&planes(&content)), |controller| {
                with_layers::<Full, _, 0, _>(shape, budget, &[(kind, content.clone())], |layers| {
                    for _ in 0..FRAMES {
                        let tally = controller.step(&settings);
                        let trace = Trace::of(controller, tally);
                        let tally = layers.step(&settings).base;
                        trace.assert_same(&Trace::of(layers.base(), tally), &format!("{settings:?}"));
                        assert_eq!(words(layers.front()), trace.words);
                        holes += tally.holes;
                    }
                });
            });
        }
    }
    assert!(holes > 0);
}

/// Both modes of work leave the same layers behind, also where they take turns.
#[test]
fn layers_are_the_same_in_both_modes_of_work() {
    let budget = Chosen::<Shaded>::new(Scene::BITS).unwrap();
    for seed in 100..130 {
        let run = |mode: fn(usize) -> Work| {
            let mut generator = generator(seed);
            let shape = SHAPES[seed as usize % SHAPES.len()];
            let contents: Vec<(Kind, Vec<Cell>)> = (0..3)
                .map(|layer| {
                    let kind = Kind { winners: true, edges: layer < 2, anchored: layer == 2 };
                    let filling = Filling::any(&mut generator);
                    (kind, chance::map(&mut generator, budget.record(), filling, shape))
                })
                .collect();
            with_layers::<Shaded, _, 2, _>(shape, budget, &contents, |layers| {
                let rung = Rung::ALL[seed as usize % Rung::ALL.len()];
                let frame = |frame| {
                    let tally = layers.step(&Settings { rung, work: mode(frame), ..Settings::for_depth(16) });
                    let winners: Vec<_> = (0..3).map(|layer| layers.winners(layer).to_vec()).collect();
                    (tally, words(layers.front()), winners)
                };
                (0..FRAMES).map(frame).collect::<Vec<_>>()
            })
        };
        let skipping = run(|_| Work::Skipping);
        assert_eq!(skipping, run(|_| Work::Constant));
        assert_eq!(skipping, run(|frame| Work::ALL[frame % 2]));
    }
}
