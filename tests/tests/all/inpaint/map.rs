//! Push-pull on galpixmaps: what it touches, and what it makes of the built-in scenes.

use galpix_core::inpaint::levels;
use galpix_core::inpaint::map::{Filling, Uncovered};
use galpix_core::inpaint::paint::{Moving, Tint};
use galpix_core::inpaint::push_pull::dense;
use galpix_core::inpaint::pyramid::{Cell, Pyramid, state_words};
use galpix_core::inpaint::validity::Gamma;
use galpix_core::{Class, Controller, Dynamic, FillMode, Inpainting, Layout, Settings, stages};
use galpix_tests::lent::{Mode, cell_words, with_controller, with_rolling, words};
use galpix_tests::profiles::{PAPER, dynamic};
use galpix_tests::stage;

use super::Form;

const DEPTH_BITS: u32 = 16;

fn settings() -> Settings {
    Settings {
        fill_mode: FillMode::Extend,
        edge_threshold: stages::threshold_for_depth(DEPTH_BITS),
        ..Settings::for_depth(DEPTH_BITS)
    }
}

/// Inpaints what the last step uncovered by one of the two forms.
fn inpaint<V: Filling>(
    controller: &mut Controller<'_, Dynamic>,
    inpainting: &Inpainting<'_>,
    pyramid: &mut Pyramid<'_, V>,
    form: Form,
) -> u32 {
    match form {
        Form::Sparse => controller.inpaint(&settings(), inpainting, pyramid),
        Form::Dense => {
            // With a mask in which nothing is set the background is laid, and nothing filled.
            controller.inpaint(&settings(), &Inpainting { mask: &[0], ..*inpainting }, pyramid);
            let mut holes = Uncovered::<_, V>::new(controller.front_mut(), inpainting.mask);
            dense(&mut holes, pyramid, &inpainting.rule)
        }
    }
}

/// The words of each frame of a scene with inpainting, and how many cells were filled.
fn frames<V: Filling>(
    stage: &stage::Stage,
    inpainting: Option<&Inpainting<'_>>,
    form: Form,
    count: u32,
) -> Vec<(Vec<u32>, u32)> {
    let format = dynamic(Layout::FULL, PAPER);
    let content = stage.content(format, |_| {});
    let (width, height) = (stage.shape.columns(), stage.shape.rows());
    let mut memory = vec![Cell::<V>::default(); levels::cells(width, height)];
    let mut states = vec![0; state_words(memory.len())];
    let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
    with_controller(stage.shape, format, Some(&content), |controller| {
        let mode = if form == Form::Sparse { Mode::Step } else { Mode::ConstantTime };
        let one = |_| {
            mode.step(controller, &settings());
            let filled = inpainting.map_or(0, |inpainting| inpaint(controller, inpainting, &mut pyramid, form));
            (words(controller.front()), filled)
        };
        (0..count).map(one).collect()
    })
}

fn named(name: &str) -> stage::Stage {
    stage::all().find(|stage| stage.scene.name() == name).unwrap()
}

#[test]
fn sparse_and_dense_give_the_same_maps() {
    for name in ["crossing", "pillars"] {
        let stage = named(name);
        for gamma in Gamma::ALL {
            let inpainting = Inpainting::for_depth(DEPTH_BITS, gamma);
            let sparse = frames::<Moving>(&stage, Some(&inpainting), Form::Sparse, 3);
            assert!(sparse.iter().any(|(_, filled)| *filled > 20), "{name} has holes");
            assert_eq!(sparse, frames::<Moving>(&stage, Some(&inpainting), Form::Dense, 3), "{name} {gamma:?}");
        }
    }
}

#[test]
fn one_map_is_filled_as_two_without_quads() {
    let format = dynamic(Layout::FULL, PAPER);
    let inpainting = Inpainting { quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Half) };
    for name in ["crossing", "pillars"] {
        let stage = named(name);
        let content = stage.content(format, |_| {});
        let two = frames::<Tint>(&stage, Some(&inpainting), Form::Sparse, 4);
        let (width, height) = (stage.shape.columns(), stage.shape.rows());
        let mut memory = vec![Cell::<Tint>::default(); levels::cells(width, height)];
        let mut states = vec![0; state_words(memory.len())];
        let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
        with_rolling(stage.shape, format, &content, height, |rolling| {
            for (n, frame) in (1..).zip(two) {
                rolling.step(&settings());
                let filled = rolling.inpaint(&inpainting, &mut pyramid);
                assert!((words(rolling.map()), filled) == frame, "{name}, frame {n}");
            }
        });
    }
}

#[test]
fn only_what_was_just_uncovered_changes() {
    let stage = named("crossing");
    let format = dynamic(Layout::FULL, PAPER);
    let content = stage.content(format, |_| {});
    let (width, height) = (stage.shape.columns(), stage.shape.rows());
    let mut memory = vec![Cell::<Tint>::default(); levels::cells(width, height)];
    let mut states = vec![0; state_words(memory.len())];
    let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
    with_controller(stage.shape, format, Some(&content), |controller| {
        let settings = settings();
        for _ in 0..4 {
            controller.step(&settings);
            let before: Vec<_> =
                (0..controller.front().grid().cells()).map(|cell| cell_words(controller.front(), cell)).collect();
            let inpainting = Inpainting::for_depth(DEPTH_BITS, Gamma::Zero);
            let filled = controller.inpaint(&settings, &inpainting, &mut pyramid);
            let map = controller.front();
            let mut holes = 0;
            for (cell, before) in (0..).zip(&before) {
                if map.class(cell) == Class::JustUnobscured {
                    holes += 1;
                } else {
                    assert_eq!(&cell_words(map, cell), before, "cell {cell}");
                }
            }
            assert!(filled > 0 && filled <= holes);
        }
    });
}

#[test]
fn an_empty_mask_of_bits_fills_nothing_and_half_of_it_half() {
    let stage = named("crossing");
    let cells = stage.shape.cells() as usize;
    let plain = frames::<Moving>(&stage, None, Form::Sparse, 1);
    let inpainting = |mask| Inpainting { mask, quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Zero) };
    let (none, upper) = (vec![0; cells.div_ceil(32)], vec![u32::MAX; cells.div_ceil(32) / 2]);
    let masked = frames::<Moving>(&stage, Some(&inpainting(&none)), Form::Sparse, 1);
    assert_eq!((&masked[0].0, masked[0].1), (&plain[0].0, 0));
    let all = frames::<Moving>(&stage, Some(&inpainting(&[])), Form::Sparse, 1);
    let half = frames::<Moving>(&stage, Some(&inpainting(&upper)), Form::Sparse, 1);
    assert!(0 < half[0].1 && half[0].1 < all[0].1);
    let planes = half[0].0.len() / cells;
    for plane in 0..planes {
        for cell in 0..cells {
            let expected = if cell < upper.len() * 32 { &all } else { &plain };
            assert_eq!(half[0].0[plane * cells + cell], expected[0].0[plane * cells + cell]);
        }
    }
}

#[test]
fn a_pyramid_of_another_size_does_no_harm() {
    let stage = named("crossing");
    let format = dynamic(Layout::FULL, PAPER);
    let content = stage.content(format, |_| {});
    for (width, height) in [(1, 1), (5, 900), (2000, 3)] {
        let mut memory = vec![Cell::<Moving>::default(); levels::cells(width, height)];
        let mut states = vec![0; state_words(memory.len())];
        let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
        with_controller(stage.shape, format, Some(&content), |controller| {
            for form in [Form::Sparse, Form::Dense] {
                controller.step(&settings());
                inpaint(controller, &Inpainting::for_depth(DEPTH_BITS, Gamma::One), &mut pyramid, form);
            }
        });
    }
}

/// Over all scenes: every hole whose surroundings are known is filled, and its motion is that of a galpixel nearby.
#[test]
fn holes_move_as_a_known_galpixel_does() {
    let format = dynamic(Layout::FULL, PAPER);
    for stage in stage::all() {
        let content = stage.content(format, |_| {});
        let (width, height) = (stage.shape.columns(), stage.shape.rows());
        let mut memory = vec![Cell::<Moving>::default(); levels::cells(width, height)];
        let mut states = vec![0; state_words(memory.len())];
        let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
        with_controller(stage.shape, format, Some(&content), |controller| {
            let settings = settings();
            controller.step(&settings);
            let inpainting = Inpainting { quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Half) };
            controller.inpaint(&settings, &Inpainting { rule: Inpainting::classic().rule, ..inpainting }, &mut pyramid);
            let map = controller.front();
            let grid = map.grid();
            let galpixels = || {
                (0..height as i32)
                    .flat_map(|y| (0..width as i32).map(move |x| (x, y)))
                    .filter_map(|(x, y)| map.load(x, y))
            };
            let motion = |galpixel: &galpix_core::Galpixel| (galpixel.velocity, galpixel.acceleration);
            let known: std::collections::HashSet<_> = galpixels()
                .filter(|galpixel| galpixel.class == Class::Galpixel)
                .map(|galpixel| motion(&galpixel))
                .collect();
            for galpixel in galpixels().filter(|galpixel| galpixel.class == Class::JustUnobscured) {
                assert!(known.contains(&motion(&galpixel)), "{}", stage.scene.name());
            }
            assert_eq!(grid.cells(), width * height);
        });
    }
    const { assert!(Layout::FULL.acceleration) }
}
