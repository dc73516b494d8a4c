//! A frame in one map and a rolling window gives the same bits as one in two maps: all planes and the tally.

use galpix_core::record::Component;
use galpix_core::rolling::{self, Rolling};
use galpix_core::stages::{snap, step_position};
use galpix_core::{
    Bits, Demand, Dynamic, Format, Galpixmap, Grid, Layout, Margin, Rounding, Scratch, Settings, SetupError, Tally,
};
use galpix_tests::layouts::TINY_PLANE;
use galpix_tests::memory::{Run, Shape, with_rolling, words};
use galpix_tests::profiles::{SCENE, SLIDE, dynamic, formats};
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};

const FRAMES: u32 = 6;

/// Returns the tally and planes of each of some frames, in one map and a window of `rows` rows.
fn rolled(shape: Shape, format: Dynamic, content: &[u32], settings: &Settings, rows: u32) -> Vec<(Tally, Vec<u32>)> {
    with_rolling(shape, format, content, rows, |rolling| {
        (0..FRAMES).map(|_| (rolling.step(settings), words(rolling.map()))).collect()
    })
}

fn assert_same(shape: Shape, format: Dynamic, content: &[u32], settings: &Settings, what: &str) {
    let rounds = if settings.fill_mode.uses_edges() { settings.reach } else { 1 };
    let least = rolling::rows(format.record(), rounds);
    let two_maps = Run::new(*settings, FRAMES).traces(shape, format, content);
    for rows in [least, least + 1, 1000] {
        let one_map = rolled(shape, format, content, settings, rows.min(shape.rows().max(1)).max(1));
        for (n, (two, (tally, words))) in (1..).zip(two_maps.iter().zip(&one_map)) {
            assert_eq!(&two.tally, tally, "{what} {settings:?} {rows} rows, frame {n}");
            assert!(&two.words == words, "{what} {settings:?} {rows} rows, frame {n}: planes differ");
        }
    }
}

/// [`SCENE`] but so slow that a window is much lower than its map, and with an acceleration.
const SLOW: Bits = {
    let y =
        Component { position_frac: 3, velocity_int: 3, velocity_frac: 4, acceleration_int: 2, acceleration_frac: 3 };
    SCENE.with_xy(SCENE.x, y)
};

/// Returns the formats of the tables, and a slow one.
fn all_formats() -> impl Iterator<Item = (&'static str, Dynamic)> {
    formats().chain([("slow galpixels", dynamic(Layout::SHADED, SLOW))])
}

#[test]
fn one_map_is_two_on_scenes() {
    for (name, format) in all_formats() {
        for (turn, stage) in stage::all().enumerate() {
            let content = stage.content(format, |_| ());
            let settings = settings_in_turn(turn, format.record().depth().bits).last().unwrap();
            assert_same(stage.shape, format, &content, &settings, &format!("{name}, {}", stage.scene.name()));
        }
    }
}

#[test]
fn one_map_is_two_on_random_words() {
    let shapes = [Shape::plain(1, 1), Shape::plain(3, 200), Shape::new(21, 90, [3, 1, 2, 5])];
    for (name, format) in all_formats() {
        for (seed, shape) in (0..).zip(shapes) {
            let content = random::words(seed, shape.cells() as usize * format.record().words());
            for settings in settings_in_turn(seed as usize, format.record().depth().bits) {
                assert_same(shape, format, &content, &settings, &format!("{name}, arbitrary words, {shape:?}"));
            }
        }
    }
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
        let demand = Demand { extent: 16, recog: 2, prop: 4 };
        let bits = Bits::derive(demand).unwrap().with_xy(y, y);
        let format = dynamic(Layout { acceleration: acceleration_int > 0, ..TINY_PLANE }, bits);
        let record = *format.record();
        let scale = &record.scales[1];
        let ends = |bits: u32| if bits == 0 { [0, 0] } else { [-(1 << (bits - 1)), (1 << (bits - 1)) - 1] };
        let mut farthest = 0;
        for offset in ends(position_frac) {
            for v in ends(y.velocity_bits()) {
                for a in ends(y.acceleration_bits()) {
                    for rounding in Rounding::ALL {
                        for frame in 0..64 {
                            let threshold = rounding.threshold(frame, scale.down);
                            let position = step_position(scale, threshold, offset, v, a);
                            farthest = snap(scale, position).unsigned_abs().max(farthest);
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
    let format = dynamic(Layout::VELOCITY565, SLIDE);
    let (mut starts, mut turns) = ([0; 100], [0; 100]);
    let grid = Grid::new(10, 100, Margin::NONE, &mut starts).unwrap();
    let need = rolling::rows(format.record(), 1);
    assert!(need < 100);
    let mut memory = vec![0; 3 * 1000];
    let mut few = vec![0; 3 * 1000];
    let refused = |rows: u32, winners: usize, edges: usize, memory: &mut [u32], few: &mut [u32], turns: &mut [u32]| {
        let window = Grid::window(&grid, rows, turns).unwrap();
        let (mut winners, mut edges) = (vec![0; winners], vec![0; edges]);
        Rolling::new(
            Galpixmap::new(grid, format, memory).unwrap(),
            Galpixmap::new(window, format, few).unwrap(),
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
