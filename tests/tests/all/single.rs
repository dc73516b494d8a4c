//! Random maps of every layout through all forms of a frame. With the core's feature `check` each pass compares
//! the form that it takes with every other one as it goes.

use galpix_core::{Dynamic, Format, Settings, Tally};
use galpix_tests::memory::{Buffers, Mode, Run, Shape, assert_same, with_rolling, words};
use galpix_tests::profiles::formats;
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};

const FRAMES: u32 = 4;

/// A frame counter that wraps.
const FIRST: u32 = u32::MAX - 2;

/// Returns the tally and planes of each frame, in one map and a window of all its rows.
fn rolled(shape: Shape, format: Dynamic, content: &[u32], settings: &Settings) -> Vec<(Tally, Vec<u32>)> {
    with_rolling(shape, format, content, shape.rows(), |rolling| {
        rolling.set_frame(FIRST);
        (0..FRAMES).map(|_| (rolling.step(settings), words(rolling.map()))).collect()
    })
}

/// Makes some frames by every entry point; all must agree. With and without a winner map.
fn check(shape: Shape, format: Dynamic, content: &[u32], settings: &Settings, what: &str) {
    for buffers in [Buffers::Both, Buffers::Edges] {
        let run = Run { first: FIRST, buffers, ..Run::new(*settings, FRAMES) };
        let traces = run.traces(shape, format, content);
        let what = format!("{what}, {settings:?}, {buffers:?}");
        assert_same(&traces, &run.by(Mode::ConstantTime).traces(shape, format, content), &what);
        if buffers == Buffers::Both {
            for (trace, (tally, words)) in traces.iter().zip(rolled(shape, format, content, settings)) {
                assert!((trace.tally, &trace.words) == (tally, &words), "{what}: the rolling map differs");
            }
        }
    }
}

/// Returns random words, as they are, and with so few bits that neighbours often agree.
fn arbitrary_words(words: usize, seed: u64) -> [Vec<u32>; 3] {
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

#[test]
fn all_ways_of_making_a_frame_agree_on_scenes() {
    for (name, format) in formats() {
        for (turn, stage) in stage::all().enumerate() {
            let content = stage.content(format, |_| ());
            for settings in settings_in_turn(turn, format.record().depth().bits) {
                check(stage.shape, format, &content, &settings, &format!("{name}, {}", stage.scene.name()));
            }
        }
    }
}

#[test]
fn all_ways_of_making_a_frame_agree_on_random_words() {
    let shapes = [Shape::plain(1, 1), Shape::plain(1, 9), Shape::plain(70, 1), Shape::new(61, 40, [3, 1, 2, 5])];
    for (name, format) in formats() {
        for (seed, shape) in (0..).zip(shapes) {
            let words = shape.cells() as usize * format.record().words();
            for (kind, content) in arbitrary_words(words, seed).iter().enumerate() {
                for settings in settings_in_turn(seed as usize, format.record().depth().bits) {
                    check(shape, format, content, &settings, &format!("{name}, arbitrary words {kind}, {shape:?}"));
                }
            }
        }
    }
}
