//! Metamers in galpixmaps: what they touch, and what they need.

use galpix_core::inpaint::{Gamma, Metamer, MetamerWorkspace, Recipe};
use galpix_core::{Class, Controller, Dynamic, Format, Inpainting, Layout, Settings, SetupError, stages};
use galpix_tests::memory::{cell_words, with_controller, with_rolling, words};
use galpix_tests::profiles::{PAPER, dynamic};
use galpix_tests::stage;

const DEPTH_BITS: u32 = 16;

fn settings(depth_bits: u32) -> Settings {
    Settings { edge_threshold: stages::threshold_for_depth(depth_bits), ..Settings::for_depth(depth_bits) }
}

fn named(name: &str) -> stage::Stage {
    stage::all().find(|stage| stage.scene.name() == name).unwrap()
}

/// Runs a closure with metamers for maps of a size.
fn with_metamer<R>([width, height]: [u32; 2], recipe: Recipe, work: impl FnOnce(&mut Metamer<'_>) -> R) -> R {
    let mut memory = vec![u32::MAX; Metamer::words(width, height, recipe.levels)];
    let mut workspace = MetamerWorkspace::new();
    work(&mut Metamer::new(width, height, recipe, &mut memory, &mut workspace).unwrap())
}

/// Makes a frame and fills what it uncovered; what is no hole must not change.
fn frame(
    controller: &mut Controller<'_, Dynamic>,
    depth_bits: u32,
    inpainting: &Inpainting<'_>,
    metamer: &mut Metamer<'_>,
) -> (Vec<u32>, u32) {
    let settings = settings(depth_bits);
    controller.step(&settings);
    let cells = 0..controller.front().grid().cells();
    let before: Vec<_> = cells.map(|cell| cell_words(controller.front(), cell)).collect();
    let filled = controller.synthesise(&settings, inpainting, metamer).unwrap();
    let map = controller.front();
    for (cell, before) in (0..).zip(&before) {
        assert!(map.class(cell) == Class::JustUnobscured || &cell_words(map, cell) == before, "cell {cell}");
    }
    (words(map), filled)
}

/// Returns the words of each frame of a scene, and how many cells were filled.
fn frames(layout: Layout, name: &str, quads: bool, recipe: Recipe, count: u32) -> Vec<(Vec<u32>, u32)> {
    let stage = named(name);
    let format = dynamic(layout, PAPER);
    let depth_bits = u32::from(format.record().depth().bits).min(DEPTH_BITS);
    let inpainting = Inpainting { quads, ..Inpainting::for_depth(depth_bits, Gamma::Half) };
    let content = stage.content(format, |_| {});
    with_metamer([stage.shape.columns(), stage.shape.rows()], recipe, |metamer| {
        with_controller(stage.shape, format, Some(&content), |controller| {
            (0..count).map(|_| frame(controller, depth_bits, &inpainting, metamer)).collect()
        })
    })
}

#[test]
fn only_what_was_just_uncovered_changes_whatever_the_levels() {
    for name in ["crossing", "pillars"] {
        for levels in [1, 4, 6] {
            let frames = frames(Layout::FULL, name, true, Recipe { levels, ..Recipe::default() }, 3);
            assert!(frames.iter().any(|(_, filled)| *filled > 20), "{name} has holes");
        }
    }
}

#[test]
fn every_colour_format_is_filled() {
    for layout in [Layout::FLAT565, Layout::VELOCITY565, Layout::VELOCITY_GRAY8, Layout::VELOCITY_GRAY4] {
        let frames = frames(layout, "crossing", true, Recipe::default(), 2);
        assert!(frames.iter().any(|(_, filled)| *filled > 0), "{layout:?}");
    }
}

#[test]
fn another_seed_is_another_texture() {
    let of = |seed| frames(Layout::FULL, "crossing", true, Recipe { seed, ..Recipe::default() }, 2);
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
}

#[test]
fn one_map_is_filled_as_two_without_quads() {
    let (stage, format) = (named("pillars"), dynamic(Layout::FULL, PAPER));
    let content = stage.content(format, |_| {});
    let two = frames(Layout::FULL, "pillars", false, Recipe::default(), 4);
    let inpainting = Inpainting::for_depth(DEPTH_BITS, Gamma::Half);
    with_metamer([stage.shape.columns(), stage.shape.rows()], Recipe::default(), |metamer| {
        with_rolling(stage.shape, format, &content, stage.shape.rows(), |rolling| {
            for (n, frame) in (1..).zip(two) {
                rolling.step(&settings(DEPTH_BITS));
                let filled = rolling.synthesise(&inpainting, metamer).unwrap();
                assert!((words(rolling.map()), filled) == frame, "frame {n}");
            }
        });
    });
}

#[test]
fn metamers_for_a_smaller_map_fill_nothing() {
    let (stage, format) = (named("crossing"), dynamic(Layout::FULL, PAPER));
    let content = stage.content(format, |_| {});
    let (width, height, levels) = (stage.shape.columns(), stage.shape.rows(), Recipe::default().levels);
    with_metamer([width / 2, height], Recipe::default(), |metamer| {
        with_controller(stage.shape, format, Some(&content), |controller| {
            let settings = settings(DEPTH_BITS);
            controller.step(&settings);
            let before = words(controller.front());
            let inpainting = Inpainting { quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Half) };
            let (need, have) = (Metamer::words(width, height, levels), Metamer::words(width / 2, height, levels));
            let refused = Err(SetupError::TooShort { plane: "metamer", need, have });
            assert_eq!(controller.synthesise(&settings, &inpainting, metamer), refused);
            assert!(words(controller.front()) == before);
        });
    });
}
