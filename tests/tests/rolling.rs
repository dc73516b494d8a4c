//! A frame in one map and a rolling window gives the same bits as one in two maps: all planes and the tally.

use galpix_core::budget::{Bits, Component};
use galpix_core::edge;
use galpix_core::error::SetupError;
use galpix_core::frame::{Scratch, Settings};
use galpix_core::galpixel::{Budget, Chosen, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layout::{Flat565, Full, Layout, Shaded, Still, Velocity565, VelocityGray4};
use galpix_core::rolling::{self, Rolling};
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;
use galpix_tests::layouts::TinyPlane;
use galpix_tests::lent::{Shape, traces, words};
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};

const FRAMES: u32 = 6;

/// Tally and planes of each of some frames, in one map and a window of `rows` rows.
fn rolled<L: Layout, B: Budget<L>>(
    shape: Shape,
    budget: B,
    content: &[u32],
    settings: &Settings,
    rows: u32,
) -> Vec<(Tally, Vec<u32>)> {
    let (mut starts, mut turns) = (vec![7; shape.rows() as usize], vec![7; shape.rows() as usize]);
    let grid = Grid::new(shape.width, shape.height, shape.wings, &mut starts).unwrap();
    let window = Grid::window(&grid, rows, &mut turns).unwrap();
    assert_eq!(window.cells(), rows.min(shape.rows()) * shape.columns());
    let (mut memory, mut few) = (content.to_vec(), vec![7; Galpixmap::<L, B>::words(&window, budget)]);
    let (mut winners, mut edges) = (vec![7; window.cells() as usize], vec![7; edge::words(&grid)]);
    let mut rolling = Rolling::<L, B>::new(
        Galpixmap::over(grid, budget, &mut memory).unwrap(),
        Galpixmap::over(window, budget, &mut few).unwrap(),
        Scratch { winners: &mut winners, edges: &mut edges },
    )
    .unwrap();
    (0..FRAMES).map(|_| (rolling.step(settings), words(rolling.map()))).collect()
}

fn assert_same<L: Layout, B: Budget<L>>(shape: Shape, budget: B, content: &[u32], settings: &Settings, what: &str) {
    let rounds = if settings.rung.tells_surfaces() { settings.reach } else { 1 };
    let least = rolling::rows(budget.record(), rounds);
    let two_maps = traces::<L, B>(shape, budget, content, settings, FRAMES);
    for rows in [least, least + 1, 1000] {
        let one_map = rolled::<L, B>(shape, budget, content, settings, rows.min(shape.rows().max(1)).max(1));
        for (n, (two, (tally, words))) in (1..).zip(two_maps.iter().zip(&one_map)) {
            assert_eq!(&two.tally, tally, "{what} {settings:?} {rows} rows, frame {n}");
            assert!(&two.words == words, "{what} {settings:?} {rows} rows, frame {n}: planes differ");
        }
    }
}

fn one_map_is_two<L: Layout, P: Profile>() {
    let fixed = Static::<P>::new();
    let depth_bits = Budget::<L>::record(&fixed).depth().bits;
    for (turn, stage) in stage::all().enumerate() {
        let content = stage.content::<L, _>(fixed, |_| ());
        let settings = settings_in_turn(turn, depth_bits).last().unwrap();
        assert_same::<L, _>(stage.shape, fixed, &content, &settings, stage.scene.name());
    }
    let wings = Wings { left: 3, right: 1, top: 2, bottom: 5 };
    let shapes = [Shape::plain(1, 1), Shape::plain(3, 200), Shape { width: 21, height: 90, wings }];
    for (seed, shape) in (0..).zip(shapes) {
        let content = random::words(seed, shape.cells() as usize * Budget::<L>::record(&fixed).words());
        for settings in settings_in_turn(seed as usize, depth_bits) {
            assert_same::<L, _>(shape, fixed, &content, &settings, &format!("rubbish, {shape:?}"));
        }
    }
}

/// So slow that a window is much lower than its map, and with an acceleration.
#[derive(Clone, Copy, Debug)]
struct Slow;

impl Profile for Slow {
    const BITS: Bits = {
        let y = Component {
            position_frac: 3,
            velocity_int: 3,
            velocity_frac: 4,
            acceleration_int: 2,
            acceleration_frac: 3,
        };
        Scene::BITS.with_xy(Scene::BITS.x, y)
    };
}

macro_rules! one_map_is_two {
    ($($test:ident = $layout:ty, $profile:ty;)*) => {$(
        #[test]
        fn $test() {
            one_map_is_two::<$layout, $profile>();
        }
    )*};
}

one_map_is_two! {
    the_papers_galpixel_and_budget = Full, Paper;
    shaded_galpixels_and_components_that_differ = Shaded, Uneven;
    flat_galpixels = Flat565, Scene;
    slow_galpixels = Shaded, Slow;
    sliding_galpixels = Velocity565, Slide;
    the_smallest_galpixels = VelocityGray4, Panel;
    motion_in_the_plane_only = TinyPlane, Odd;
    a_picture_that_does_not_move = Still, Paper;
}

/// The extreme steps of small budgets, tried one by one, and the bound.
#[test]
fn no_galpixel_moves_further_than_the_reach() {
    let mut tight = 0;
    for (position_frac, velocity_int, velocity_frac, acceleration_int) in
        [(0, 1, 0, 0), (0, 3, 2, 0), (4, 3, 4, 0), (3, 2, 1, 2), (2, 3, 3, 1), (5, 1, 1, 3)]
    {
        let acceleration_frac = if acceleration_int == 0 { 0 } else { velocity_frac.min(1) };
        let y = Component { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac };
        let y = y.checked().unwrap();
        let demand = galpix_core::budget::Demand { extent: 16, recog: 2, prop: 4 };
        let bits = Bits::derive(demand).unwrap().with_xy(y, y);
        let lanes = galpix_core::layout::Lanes { acceleration: acceleration_int > 0, ..TinyPlane::LANES };
        let budget = Chosen::<TinyPlane>::with_lanes(bits, lanes).unwrap();
        let record = *budget.record();
        let scale = &record.scales[1];
        let ends = |bits: u32| if bits == 0 { [0, 0] } else { [-(1 << (bits - 1)), (1 << (bits - 1)) - 1] };
        let mut farthest = 0;
        for offset in ends(position_frac) {
            for v in ends(y.velocity_bits()) {
                for a in ends(y.acceleration_bits()) {
                    for rounding in Rounding::ALL {
                        for frame in 0..64 {
                            let threshold = rounding.threshold(frame, scale.down);
                            let position = galpix_core::propagate::step_position(scale, threshold, offset, v, a);
                            farthest = galpix_core::propagate::snap(scale, position).unsigned_abs().max(farthest);
                        }
                    }
                }
            }
        }
        assert!(farthest <= rolling::reach(&record), "{y:?}: {farthest}");
        tight += u32::from(farthest == rolling::reach(&record));
    }
    assert_eq!(tight, 6, "the bound is not the least one");
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let budget = Static::<Slide>::new();
    let (mut starts, mut turns) = ([0; 100], [0; 100]);
    let grid = Grid::new(10, 100, Wings::NONE, &mut starts).unwrap();
    let need = rolling::rows(Budget::<Velocity565>::record(&budget), 1);
    assert!(need < 100);
    let mut memory = vec![0; 3 * 1000];
    let mut few = vec![0; 3 * 1000];
    let refused = |rows: u32, winners: usize, edges: usize, memory: &mut [u32], few: &mut [u32], turns: &mut [u32]| {
        let window = Grid::window(&grid, rows, turns).unwrap();
        let (mut winners, mut edges) = (vec![0; winners], vec![0; edges]);
        Rolling::<Velocity565, _>::new(
            Galpixmap::new(grid, budget, memory).unwrap(),
            Galpixmap::new(window, budget, few).unwrap(),
            Scratch { winners: &mut winners, edges: &mut edges },
        )
        .err()
    };
    let cells = 10 * need as usize;
    assert_eq!(refused(need, cells, 32, &mut memory, &mut few, &mut turns), None);
    assert_eq!(refused(need, 0, 0, &mut memory, &mut few, &mut turns), None);
    assert_eq!(
        refused(need - 1, cells, 32, &mut memory, &mut few, &mut turns),
        Some(SetupError::TooShort { plane: "window", need: cells, have: cells - 10 })
    );
    assert!(matches!(
        refused(need, cells - 1, 32, &mut memory, &mut few, &mut turns),
        Some(SetupError::TooShort { plane: "winner map", .. })
    ));
    assert!(matches!(
        refused(need, cells, 31, &mut memory, &mut few, &mut turns),
        Some(SetupError::TooShort { plane: "edge map", .. })
    ));
    let mut other = [0; 99];
    assert!(matches!(Grid::window(&grid, 4, &mut other), Err(SetupError::TooShort { .. })));
    assert!(matches!(Grid::window(&grid, 0, &mut [0; 100]), Err(SetupError::Size { .. })));
}
