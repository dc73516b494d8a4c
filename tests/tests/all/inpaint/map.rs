//! Push-pull on galpixmaps: what it touches, and what it makes of the built-in scenes.

use galpix_core::inpaint::{Gamma, Motion, PushPull};
use galpix_core::{Class, FillMode, Inpainting, Layout, Settings, stages};
use galpix_tests::memory::{Shape, cell_words, with_controller, with_rolling, words};
use galpix_tests::profiles::{PAPER, dynamic};
use galpix_tests::stage;

const DEPTH_BITS: u32 = 16;

fn settings() -> Settings {
    Settings {
        fill_mode: FillMode::Extend,
        edge_threshold: stages::threshold_for_depth(DEPTH_BITS),
        ..Settings::for_depth(DEPTH_BITS)
    }
}

/// Runs a closure with push-pull for maps of a size.
fn with_push_pull<R>([width, height]: [u32; 2], motion: Motion, work: impl FnOnce(&mut PushPull<'_>) -> R) -> R {
    let mut memory = vec![u32::MAX; PushPull::words(width, height, motion)];
    work(&mut PushPull::new(width, height, motion, &mut memory).unwrap())
}

fn size(shape: Shape) -> [u32; 2] {
    [shape.columns(), shape.rows()]
}

/// Returns the words of each frame of a scene with inpainting, and how many cells were filled.
fn frames(
    stage: &stage::Stage,
    inpainting: Option<&Inpainting<'_>>,
    motion: Motion,
    count: u32,
) -> Vec<(Vec<u32>, u32)> {
    let format = dynamic(Layout::FULL, PAPER);
    let content = stage.content(format, |_| {});
    with_push_pull(size(stage.shape), motion, |push_pull| {
        with_controller(stage.shape, format, Some(&content), |controller| {
            let one = |_| {
                controller.step(&settings());
                let inpaint = |inpainting| controller.inpaint(&settings(), inpainting, push_pull);
                let filled = inpainting.map_or(0, inpaint);
                (words(controller.front()), filled)
            };
            (0..count).map(one).collect()
        })
    })
}

fn named(name: &str) -> stage::Stage {
    stage::all().find(|stage| stage.scene.name() == name).unwrap()
}

#[test]
fn one_map_is_filled_as_two_without_quads() {
    let format = dynamic(Layout::FULL, PAPER);
    let inpainting = Inpainting { quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Half) };
    for (name, motion) in [("crossing", Motion::Kept), ("pillars", Motion::Kept), ("pillars", Motion::Inpainted)] {
        let stage = named(name);
        let content = stage.content(format, |_| {});
        let two = frames(&stage, Some(&inpainting), motion, 4);
        assert!(two.iter().any(|(_, filled)| *filled > 0), "{name} has holes");
        with_push_pull(size(stage.shape), motion, |push_pull| {
            with_rolling(stage.shape, format, &content, stage.shape.rows(), |rolling| {
                for (n, frame) in (1..).zip(two) {
                    rolling.step(&settings());
                    // Quads are ignored: the map before is gone.
                    let filled = rolling.inpaint(&Inpainting { quads: n % 2 == 0, ..inpainting }, push_pull);
                    assert!((words(rolling.map()), filled) == frame, "{name}, {motion:?}, frame {n}");
                }
            });
        });
    }
}

#[test]
fn only_what_was_just_uncovered_changes() {
    let format = dynamic(Layout::FULL, PAPER);
    for (name, motion) in [("crossing", Motion::Kept), ("pillars", Motion::Inpainted)] {
        let stage = named(name);
        let content = stage.content(format, |_| {});
        let one = |push_pull: &mut PushPull<'_>| {
            with_controller(stage.shape, format, Some(&content), |controller| {
                let (settings, mut all) = (settings(), 0);
                for gamma in [Gamma::Zero, Gamma::Half, Gamma::One, Gamma::Zero] {
                    controller.step(&settings);
                    let cells = 0..controller.front().grid().cells();
                    let before: Vec<_> = cells.map(|cell| cell_words(controller.front(), cell)).collect();
                    let filled = controller.inpaint(&settings, &Inpainting::for_depth(DEPTH_BITS, gamma), push_pull);
                    let map = controller.front();
                    let mut holes = 0;
                    for (cell, before) in (0..).zip(&before) {
                        if map.class(cell) == Class::JustUnobscured {
                            holes += 1;
                        } else {
                            assert_eq!(&cell_words(map, cell), before, "{name}, cell {cell}");
                        }
                    }
                    assert!(filled <= holes, "{name}");
                    all += filled;
                }
                assert!(all > 20, "{name}");
            });
        };
        with_push_pull(size(stage.shape), motion, one);
    }
}

#[test]
fn an_empty_mask_of_bits_fills_nothing_and_half_of_it_half() {
    let stage = named("crossing");
    let cells = stage.shape.cells() as usize;
    let plain = frames(&stage, None, Motion::Inpainted, 1);
    let inpainting = |mask| Inpainting { mask, quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::Zero) };
    let (none, upper) = (vec![0; cells.div_ceil(32)], vec![u32::MAX; cells.div_ceil(32) / 2]);
    let masked = frames(&stage, Some(&inpainting(&none)), Motion::Inpainted, 1);
    assert_eq!((&masked[0].0, masked[0].1), (&plain[0].0, 0));
    let all = frames(&stage, Some(&inpainting(&[])), Motion::Inpainted, 1);
    let half = frames(&stage, Some(&inpainting(&upper)), Motion::Inpainted, 1);
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
fn push_pull_of_another_size_fills_what_lies_within_both() {
    let stage = named("crossing");
    let format = dynamic(Layout::FULL, PAPER);
    let content = stage.content(format, |_| {});
    for other in [[1, 1], [5, 900], [2000, 3]] {
        with_push_pull(other, Motion::Inpainted, |push_pull| {
            with_controller(stage.shape, format, Some(&content), |controller| {
                for _ in 0..2 {
                    controller.step(&settings());
                    let before = words(controller.front());
                    controller.inpaint(
                        &settings(),
                        &Inpainting { quads: false, ..Inpainting::for_depth(DEPTH_BITS, Gamma::One) },
                        push_pull,
                    );
                    let (after, cells) = (words(controller.front()), stage.shape.cells());
                    for (at, _) in before.iter().zip(&after).enumerate().filter(|(_, (before, after))| before != after)
                    {
                        let cell = at as u32 % cells;
                        let [x, y] = [cell % stage.shape.columns(), cell / stage.shape.columns()];
                        // A hole takes from the cells of level 1 next to its own.
                        assert!(x <= other[0] + 1 && y <= other[1] + 1, "{other:?}: {x}, {y}");
                    }
                }
            });
        });
    }
}

/// Over all scenes: what is filled moves as a galpixel of the picture does.
#[test]
fn holes_move_as_a_known_galpixel_does() {
    let format = dynamic(Layout::FULL, PAPER);
    const { assert!(Layout::FULL.acceleration) }
    for stage in stage::all() {
        let content = stage.content(format, |_| {});
        let [width, height] = size(stage.shape);
        with_push_pull([width, height], Motion::Inpainted, |push_pull| {
            with_controller(stage.shape, format, Some(&content), |controller| {
                let settings = settings();
                controller.step(&settings);
                controller.inpaint(&settings, &Inpainting::classic(), push_pull);
                let map = controller.front();
                let galpixels = |class| {
                    (0..height as i32)
                        .flat_map(|y| (0..width as i32).map(move |x| (x, y)))
                        .filter_map(|(x, y)| map.load(x, y))
                        .filter(move |galpixel| galpixel.class == class)
                        .map(|galpixel| (galpixel.velocity, galpixel.acceleration))
                };
                let known: std::collections::HashSet<_> =
                    galpixels(Class::Galpixel).chain(galpixels(Class::Debris)).collect();
                assert!(
                    galpixels(Class::JustUnobscured).all(|motion| known.contains(&motion)),
                    "{}",
                    stage.scene.name()
                );
            });
        });
    }
}
