//! The passes for processors without vector registers give the same bits as those with: planes, winners, edges, tally.

use galpix_core::frame::Settings;
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::grid::Wings;
use galpix_core::layout::{Flat565, Full, Layout, Shaded, Still, Tagged, Velocity565, VelocityGray4, VelocityGray8};
use galpix_core::{edge, fill, sweep};
use galpix_tests::layouts::{Deep, Flat565WithoutDepth, TinyPlane};
use galpix_tests::lent::{Shape, Trace, with_maps, words};
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};

const FRAMES: u32 = 4;

/// How the passes of a frame are arranged.
#[derive(Clone, Copy)]
enum Arrangement {
    Vectors,
    Single,
}

/// What each of some frames leaves behind. `tells`: whether a winner map is lent.
fn traces<L: Layout, B: Budget<L>>(
    shape: Shape,
    budget: B,
    content: &[u32],
    settings: &Settings,
    tells: bool,
    arrangement: Arrangement,
) -> Vec<Trace> {
    let cells = shape.cells() as usize;
    let (mut winners, mut edges) = (vec![7; if tells { cells } else { 0 }], vec![7; cells.div_ceil(32)]);
    let mut all = edges.clone();
    let (rounding, threshold) = (settings.rounding, settings.edge_threshold);
    with_maps::<L, B, _>(shape, budget, Some(content), |mut front, mut back| {
        // A frame counter that wraps.
        (0..FRAMES)
            .map(|frame| {
                let frame = frame.wrapping_sub(3);
                let (marked, mut tally) = match arrangement {
                    Arrangement::Vectors => (
                        edge::mark(&front, threshold, &mut edges),
                        sweep::sweep(&front, &mut back, &mut winners, rounding, frame),
                    ),
                    Arrangement::Single => (
                        edge::single::mark(&front, threshold, &mut edges),
                        sweep::single::sweep(&front, &mut back, &mut winners, rounding, frame),
                    ),
                };
                let again = edge::single::mark_all(&front, threshold, &mut all);
                assert!(again == marked && all == edges, "the same work for all pictures marks other edges");
                tally.edges = marked;
                fill::fill(&front, &mut back, &mut winners, &edges, settings.rung, settings.reach, &mut tally);
                std::mem::swap(&mut front, &mut back);
                Trace { tally, words: words(&front), winners: winners.clone(), edges: edges.clone() }
            })
            .collect()
    })
}

fn assert_same<L: Layout, B: Budget<L>>(shape: Shape, budget: B, content: &[u32], settings: &Settings, what: &str) {
    for tells in [true, false] {
        let all = |arrangement| traces::<L, B>(shape, budget, content, settings, tells, arrangement);
        for (n, (a, b)) in (1..).zip(all(Arrangement::Vectors).iter().zip(&all(Arrangement::Single))) {
            a.assert_same(b, &format!("{what} {settings:?} winners {tells} frame {n}"));
        }
    }
}

/// Random words, as they are, and with so few bits that neighbours often agree.
fn rubbish(words: usize, seed: u64) -> [Vec<u32>; 3] {
    let wild = random::words(seed, words);
    let calm = wild.iter().map(|word| word & 0x0410_0041).collect();
    let mut last = 0;
    let patch = |&word: &u32| {
        if word % 7 == 0 {
            last = word & 0x3fff_ffff;
        }
        last
    };
    let patches = wild.iter().map(patch).collect();
    [wild, calm, patches]
}

fn arrangements_agree<L: Layout, P: Profile>() {
    let fixed = Static::<P>::new();
    let chosen = Chosen::<L>::new(P::BITS).unwrap();
    let depth_bits = chosen.record().depth().bits;
    for (turn, stage) in stage::all().enumerate() {
        let content = stage.content::<L, _>(fixed, |_| ());
        for settings in settings_in_turn(turn, depth_bits) {
            assert_same::<L, _>(stage.shape, fixed, &content, &settings, stage.scene.name());
        }
    }
    let wings = Wings { left: 3, right: 1, top: 2, bottom: 5 };
    let shapes = [Shape::plain(1, 1), Shape::plain(1, 9), Shape::plain(70, 1), Shape { width: 61, height: 40, wings }];
    for (seed, shape) in (0..).zip(shapes) {
        let words = shape.cells() as usize * Budget::<L>::record(&fixed).words();
        for (kind, content) in rubbish(words, seed).iter().enumerate() {
            for settings in settings_in_turn(seed as usize, depth_bits) {
                assert_same::<L, _>(shape, fixed, content, &settings, &format!("rubbish {kind}, fixed, {shape:?}"));
                assert_same::<L, _>(shape, chosen, content, &settings, &format!("rubbish {kind}, chosen, {shape:?}"));
            }
        }
    }
}

macro_rules! arrangements {
    ($($test:ident = $layout:ty, $profile:ty;)*) => {$(
        #[test]
        fn $test() {
            arrangements_agree::<$layout, $profile>();
        }
    )*};
}

arrangements! {
    the_papers_galpixel_and_budget = Full, Paper;
    tagged_galpixels_and_a_budget_of_no_power_of_two = Tagged, Odd;
    shaded_galpixels_and_components_that_differ = Shaded, Uneven;
    flat_galpixels = Flat565, Scene;
    flat_galpixels_without_depth = Flat565WithoutDepth, Scene;
    sliding_galpixels = Velocity565, Slide;
    gray_galpixels = VelocityGray8, Panel;
    the_smallest_galpixels = VelocityGray4, Slide;
    the_deepest_galpixels = Deep, Slide;
    motion_in_the_plane_only = TinyPlane, Paper;
    a_picture_that_does_not_move = Still, Paper;
}
