//! Metamers on galpixmaps: what they touch, and what they need.

use galpix_core::edge;
use galpix_core::frame::{Inpainting, Settings, Work};
use galpix_core::galpixel::{Budget, Chosen, Class, Profile};
use galpix_core::inpaint::features::Workspace;
use galpix_core::inpaint::metamer::{MOST_LEVELS, Recipe, Scratch};
use galpix_core::inpaint::pyramid::{Cell, state_words};
use galpix_core::inpaint::validity::Gamma;
use galpix_core::inpaint::{levels, needs, noise};
use galpix_core::layout::{Flat565, Full, Layout, Velocity565, VelocityGray4, VelocityGray8};
use galpix_tests::lent::{cell_words, with_controller, words};
use galpix_tests::profiles::Paper;
use galpix_tests::stage;

const DEPTH_BITS: u32 = 16;

fn settings(work: Work, depth_bits: u32) -> Settings {
    Settings { work, edge_threshold: edge::threshold_for_depth(depth_bits), ..Settings::for_depth(depth_bits) }
}

/// The words of each frame of a scene, and how many cells were filled; what is no hole must not change.
fn frames<L: Layout>(name: &str, work: Work, recipe: &Recipe, count: u32) -> Vec<(Vec<u32>, u32)> {
    let stage = stage::all().find(|stage| stage.scene.name() == name).unwrap();
    let budget = Chosen::<L>::new(Paper::BITS).unwrap();
    let depth_bits = u32::from(budget.record().depth().bits).min(DEPTH_BITS);
    let content = stage.content::<L, _>(budget, |_| {});
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
    with_controller(stage.shape, budget, Some(&content), |controller| {
        let one = |_| {
            let settings = settings(work, depth_bits);
            controller.step(&settings);
            let before: Vec<_> =
                (0..controller.front().grid().cells()).map(|cell| cell_words(controller.front(), cell)).collect();
            let inpainting = Inpainting::for_depth(depth_bits, Gamma::Half);
            let filled = controller.synthesise(&settings, &inpainting, recipe, &mut scratch).unwrap();
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
            let sparse = frames::<Full>(name, Work::Skipping, &recipe, 3);
            assert!(sparse.iter().any(|(_, filled)| *filled > 20), "{name} has holes");
            assert_eq!(sparse, frames::<Full>(name, Work::Constant, &recipe, 3), "{name}, {levels} levels");
        }
    }
}

#[test]
fn every_colour_format_is_filled() {
    let filled = |frames: Vec<(Vec<u32>, u32)>| frames.iter().map(|(_, filled)| filled).sum::<u32>();
    let recipe = Recipe::new(0, 0);
    assert!(filled(frames::<Flat565>("crossing", Work::Skipping, &recipe, 2)) > 0);
    assert!(filled(frames::<Velocity565>("crossing", Work::Skipping, &recipe, 2)) > 0);
    assert!(filled(frames::<VelocityGray8>("crossing", Work::Skipping, &recipe, 2)) > 0);
    assert!(filled(frames::<VelocityGray4>("crossing", Work::Skipping, &recipe, 2)) > 0);
}

#[test]
fn another_seed_is_another_texture() {
    let of = |seed| frames::<Full>("crossing", Work::Skipping, &Recipe { seed, ..Recipe::new(0, 0) }, 2);
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
}
