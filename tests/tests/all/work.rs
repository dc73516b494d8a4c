//! A constant-time frame and a data-dependent one give the same bits: all planes, tally,
//! winners and edges.

use galpix_bench::pictures::Picture;
use galpix_core::record::Field;
use galpix_core::{Class, Colour, Dynamic, FillMode, Format, Layout, Rounding, Settings, Tally};
use galpix_tests::memory::{Buffers, Mode, Run, Shape, Trace, assert_same, with_maps, words};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, UNEVEN, dynamic, formats};
use galpix_tests::random;
use galpix_tests::stage::{self, settings_in_turn};

const FRAMES: u32 = 8;

/// One cell, one row, one column, a chunk of the fast pass and its neighbours, margin on all sides and on some.
const SHAPES: [Shape; 9] = [
    Shape::plain(1, 1),
    Shape::plain(1, 9),
    Shape::plain(150, 1),
    Shape::plain(2, 2),
    Shape::plain(64, 5),
    Shape::plain(65, 4),
    Shape::plain(33, 7),
    Shape::new(11, 6, [2, 3, 1, 4]),
    Shape::new(1, 1, [0, 70, 0, 1]),
];

/// Returns random words; or the same with few empty cells, one class per patch, and motion and depth in their low
/// bits only, so that there are surfaces, cracks and collisions.
fn arbitrary_words(format: Dynamic, shape: Shape, seed: u64) -> Vec<u32> {
    let record = *format.record();
    let cells = shape.cells() as usize;
    let mut content = random::words(seed, cells * record.words());
    if seed.is_multiple_of(3) {
        return content;
    }
    let mut keep = |field: Field, bits: u32| {
        // Fields that straddle are left as they are.
        if field.present() && field.spill == 0 && u32::from(field.bits) > bits {
            let mask = ((1u32 << (u32::from(field.bits) - bits)) - 1) << (u32::from(field.shift) + bits);
            for word in &mut content[usize::from(field.word) * cells..][..cells] {
                *word &= !mask;
            }
        }
    };
    for (component, scale) in record.scales.iter().enumerate() {
        keep(record.velocity(component), scale.velocity_frac + 1);
        keep(record.acceleration(component), 2);
    }
    keep(record.depth(), u32::from(record.depth().bits) / 2);
    let class = record.class();
    let mut generator = random::generator(seed);
    for cell in 0..cells {
        let word = &mut content[usize::from(class.word) * cells + cell];
        let kind = match random::below(&mut generator, 24) {
            0..=3 => Class::Empty,
            4 => Class::Debris,
            5 => Class::JustUnobscured,
            _ => Class::Galpixel,
        };
        *word = *word & !(3 << class.shift) | (kind as u32) << class.shift;
    }
    content
}

/// What frames did, in sum: a test that never met a bullet hole proves nothing about bullet holes.
#[derive(Default)]
struct Seen(Tally);

impl Seen {
    fn add(&mut self, trace: &Trace) {
        let (sum, tally) = (&mut self.0, trace.tally);
        for (sum, count) in [
            (&mut sum.moved, tally.moved),
            (&mut sum.lost, tally.lost),
            (&mut sum.collided, tally.collided),
            (&mut sum.saturated, tally.saturated),
            (&mut sum.bullets, tally.bullets),
            (&mut sum.debris, tally.debris),
            (&mut sum.galdebris, tally.galdebris),
            (&mut sum.empty, tally.empty),
        ] {
            *sum += count;
        }
    }
}

/// Compares both modes on arbitrary words.
fn same_on_arbitrary_words(format: Dynamic) -> Seen {
    let depth_bits = format.record().depth().bits;
    let mut seen = Seen::default();
    let mut turn = 0;
    for shape in SHAPES {
        for fill_mode in FillMode::ALL {
            for reach in 1..=3 {
                turn += 1;
                let content = arbitrary_words(format, shape, turn);
                let rounding = Rounding::ALL[turn as usize % Rounding::ALL.len()];
                let buffers =
                    [Buffers::Both, Buffers::Both, Buffers::Both, Buffers::Winners, Buffers::Edges, Buffers::Neither];
                let buffers = buffers[turn as usize / 2 % buffers.len()];
                let edge_threshold = [0, 1 << (depth_bits / 2), u32::MAX][turn as usize / 5 % 3];
                let settings = Settings { rounding, fill_mode, edge_threshold, reach };
                // A frame counter that wraps.
                let run = Run { first: u32::MAX, buffers, ..Run::new(settings, 3) };
                let one = run.traces(shape, format, &content);
                let other = run.by(Mode::ConstantTime).traces(shape, format, &content);
                assert_same(&one, &other, &format!("{shape:?} {buffers:?} {settings:?}, turn {turn}"));
                one.iter().for_each(|trace| seen.add(trace));
            }
        }
    }
    seen
}

#[test]
fn arbitrary_words_in_every_layout() {
    for (name, format) in formats() {
        let Seen(seen) = same_on_arbitrary_words(format);
        let layout = format.record().layout();
        assert!(seen.moved > 0 && seen.empty > 0, "{name}: {seen:?}");
        if layout.velocity {
            assert!(seen.lost > 0 && seen.collided > 0, "{name}: {seen:?}");
            assert!(seen.bullets > 0 && seen.debris > 0 && seen.galdebris > 0, "{name}: {seen:?}");
        }
        assert_eq!(seen.saturated > 0, layout.acceleration, "{name}: {seen:?}");
    }
}

/// Compares both modes from a map that holds `content`.
fn same(shape: Shape, format: Dynamic, content: &[u32], settings: Settings, what: &str) {
    let run = Run::new(settings, FRAMES);
    let one = run.traces(shape, format, content);
    let other = run.by(Mode::ConstantTime).traces(shape, format, content);
    assert_same(&one, &other, &format!("{what} {settings:?}"));
}

#[test]
fn scenes() {
    for (layout, bits) in [
        (Layout::FULL, PAPER),
        (Layout::SHADED, SCENE),
        (Layout::VELOCITY565, SLIDE),
        (Layout { colour: Colour::RGB888, ..Layout::FLAT565 }, SCENE),
    ] {
        let format = dynamic(layout, bits);
        for (turn, stage) in stage::all().enumerate() {
            let content = stage.content(format, |_| ());
            for settings in settings_in_turn(turn, format.record().depth().bits) {
                same(stage.shape, format, &content, settings, stage.scene.name());
            }
        }
    }
}

/// The pictures on which constant time is measured.
#[test]
fn pictures_that_ask_for_much_or_little() {
    for (layout, bits) in [(Layout::FULL, PAPER), (Layout::SHADED, UNEVEN), (Layout::VELOCITY565, SLIDE)] {
        let format = dynamic(layout, bits);
        for shape in [Shape::plain(96, 64), Shape::new(60, 20, [9, 0, 3, 2])] {
            for picture in Picture::ALL {
                let content = with_maps(shape, format, None, |mut front, _| {
                    picture.paint(&mut front);
                    words(&front)
                });
                for settings in settings_in_turn(1, format.record().depth().bits) {
                    same(shape, format, &content, settings, picture.name());
                }
            }
        }
    }
}
