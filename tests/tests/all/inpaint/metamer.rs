//! Metamers on galpixmaps: what they touch, and what they need.

use galpix_core::inpaint::features::Workspace;
use galpix_core::inpaint::map::Uncovered;
use galpix_core::inpaint::metamer::{MOST_LEVELS, Recipe, Scratch, dense};
use galpix_core::inpaint::pyramid::{Cell, state_words};
use galpix_core::inpaint::tone::Tone;
use galpix_core::inpaint::validity::Gamma;
use galpix_core::inpaint::{levels, needs, noise};
use galpix_core::{Class, Format, Inpainting, Layout, Settings, stages};
use galpix_tests::lent::{Mode, cell_words, with_controller, words};
use galpix_tests::profiles::{PAPER, dynamic};
use galpix_tests::stage;

use super::Form;

const DEPTH_BITS: u32 = 16;

fn settings(depth_bits: u32) -> Settings {
    Settings { edge_threshold: stages::threshold_for_depth(depth_bits), ..Settings::for_depth(depth_bits) }
}

/// The words of each frame of a scene, and how many cells were filled; what is no hole must not change.
fn frames(layout: Layout, name: &str, form: Form, recipe: &Recipe, count: u32) -> Vec<(Vec<u32>, u32)> {
    let stage = stage::all().find(|stage| stage.scene.name() == name).unwrap();
    let format = dynamic(layout, PAPER);
    let depth_bits = u32::from(format.record().depth().bits).min(DEPTH_BITS);
    let content = stage.content(format, |_| {});
    let (width, height) = (stage.shape.columns(), stage.shape.rows());
    let cells = levels::cells(width, height);
    let (mut tones, mut moments) = (vec![Cell::default(); cells], vec![Cell::default(); cells]);
    let (mut of_tones, mut of_moments) = (vec![0; state_words(cells)], vec![0; state_words(cells)]);
    let mut scratch = Scratch {
        tones: &mut tones,
        moments: &mut moments,
        states: [&mut of_tones, &mut of_moments],
        needs: &mut vec![Default::default(); needs::tiles(width, height, MOST_LEVELS)],
        workspace: &mut Workspace::new(),
        noise: &mut noise::Tiles::default(),
    };
    with_controller(stage.shape, format, Some(&content), |controller| {
        let mode = if form == Form::Sparse { Mode::Step } else { Mode::ConstantTime };
        let one = |_| {
            let settings = settings(depth_bits);
            mode.step(controller, &settings);
            let before: Vec<_> =
                (0..controller.front().grid().cells()).map(|cell| cell_words(controller.front(), cell)).collect();
            let inpainting = Inpainting::for_depth(depth_bits, Gamma::Half);
            let filled = match form {
                Form::Sparse => controller.synthesise(&settings, &inpainting, recipe, &mut scratch).unwrap(),
                Form::Dense => {
                    // With a mask in which nothing is set the background is laid, and nothing filled.
                    let nothing = Inpainting { mask: &[0], ..inpainting };
                    assert_eq!(controller.synthesise(&settings, &nothing, recipe, &mut scratch), Ok(0));
                    let recipe = Recipe { rule: inpainting.rule, age: controller.frame(), ..*recipe };
                    let mut holes = Uncovered::<_, Tone>::new(controller.front_mut(), &[]);
                    dense(&mut holes, &mut scratch, &recipe).unwrap()
                }
            };
            let map = controller.front();
            for (cell, before) in (0..).zip(&before) {
                assert!(map.class(cell) == Class::JustUnobscured || &cell_words(map, cell) == before, "cell {cell}");
            }
            (words(map), filled)
        };
        (0..count).map(one).collect()
    })
}

#[test]
fn sparse_and_dense_give_the_same_maps() {
    for name in ["crossing", "pillars"] {
        for levels in [1, 4, 6] {
            let recipe = Recipe { levels, ..Recipe::new(0, 0) };
            let sparse = frames(Layout::FULL, name, Form::Sparse, &recipe, 3);
            assert!(sparse.iter().any(|(_, filled)| *filled > 20), "{name} has holes");
            assert_eq!(sparse, frames(Layout::FULL, name, Form::Dense, &recipe, 3), "{name}, {levels} levels");
        }
    }
}

#[test]
fn every_colour_format_is_filled() {
    let filled = |frames: Vec<(Vec<u32>, u32)>| frames.iter().map(|(_, filled)| filled).sum::<u32>();
    let recipe = Recipe::new(0, 0);
    assert!(filled(frames(Layout::FLAT565, "crossing", Form::Sparse, &recipe, 2)) > 0);
    assert!(filled(frames(Layout::VELOCITY565, "crossing", Form::Sparse, &recipe, 2)) > 0);
    assert!(filled(frames(Layout::VELOCITY_GRAY8, "crossing", Form::Sparse, &recipe, 2)) > 0);
    assert!(filled(frames(Layout::VELOCITY_GRAY4, "crossing", Form::Sparse, &recipe, 2)) > 0);
}

#[test]
fn another_seed_is_another_texture() {
    let of = |seed| frames(Layout::FULL, "crossing", Form::Sparse, &Recipe { seed, ..Recipe::new(0, 0) }, 2);
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
}
