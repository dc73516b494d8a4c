//! Push-pull: the same bits as a slow text of the same rules, sparse or dense, and what must hold for any picture.

mod map;
mod metamer;
mod slow;

use galpix_core::inpaint::levels;
use galpix_core::inpaint::paint::Tint;
use galpix_core::inpaint::picture::Masked;
use galpix_core::inpaint::push_pull::{Rule, dense, pulled, sparse};
use galpix_core::inpaint::pyramid::{Cell, Known, Pyramid, state_words};
use galpix_core::inpaint::validity::Gamma;
use galpix_core::{Colour, SetupError};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(2021), ..ProptestConfig::default() }
}

/// The two forms of an inpainting: what is needed alone, and everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Sparse,
    Dense,
}

/// A picture with holes, as [`Masked`] takes it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Holed {
    size: [u32; 2],
    colours: Vec<u32>,
    known: Vec<bool>,
    depths: Vec<u32>,
}

impl Holed {
    /// The colours after the holes were filled, and how many were.
    fn filled(&self, rule: Rule, form: Form) -> (Vec<u32>, u32) {
        let [width, height] = self.size;
        let mut bits = vec![0u32; self.known.len().div_ceil(32)];
        for (cell, _) in self.known.iter().enumerate().filter(|(_, known)| **known) {
            bits[cell / 32] |= 1 << (cell % 32);
        }
        let mut colours = self.colours.clone();
        let mut memory = vec![Cell::default(); levels::cells(width, height)];
        let mut states = vec![0; state_words(memory.len())];
        let mut pyramid = Pyramid::new(width, height, &mut memory, &mut states).unwrap();
        let mut picture = Masked::new(width, height, Colour::RGB888, &mut colours, &bits, &self.depths).unwrap();
        let filled = match form {
            Form::Sparse => sparse(&mut picture, &mut pyramid, &rule),
            Form::Dense => dense(&mut picture, &mut pyramid, &rule),
        };
        (colours, filled)
    }

    fn holes(&self) -> impl Iterator<Item = usize> {
        self.known.iter().enumerate().filter(|(_, known)| !**known).map(|(cell, _)| cell)
    }

    /// Left and right exchanged.
    fn mirrored(&self) -> Self {
        let width = self.size[0] as usize;
        fn turn<T: Copy>(cells: &[T], width: usize) -> Vec<T> {
            cells.chunks(width).flat_map(|row| row.iter().rev().copied()).collect()
        }
        Self {
            size: self.size,
            colours: turn(&self.colours, width),
            known: turn(&self.known, width),
            depths: turn(&self.depths, width),
        }
    }
}

fn rules() -> impl Strategy<Value = Rule> {
    let threshold = prop_oneof![Just(u32::MAX), Just(0u32), 0..40u32];
    (prop::sample::select(&Gamma::ALL[..]), threshold).prop_map(|(gamma, threshold)| Rule { gamma, threshold })
}

/// Sides of any parity; holes from none to all; depths of a few surfaces, or of one.
fn pictures() -> impl Strategy<Value = Holed> {
    let share = prop_oneof![0..=100u32, Just(1u32)];
    let depth = prop_oneof![Just(0..64u32), Just(40..44u32)];
    (1..=75u32, 1..=17u32, share, depth).prop_flat_map(|(width, height, share, depth)| {
        let cells = (width * height) as usize;
        let known = prop::collection::vec((0..100u32).prop_map(move |n| n >= share), cells);
        let depths = prop::collection::vec(prop_oneof![depth, Just(40)], cells);
        (prop::collection::vec(0..1u32 << 24, cells), known, depths).prop_map(move |(colours, known, depths)| Holed {
            size: [width, height],
            colours,
            known,
            depths,
        })
    })
}

fn channels(colour: u32) -> [u32; 3] {
    [colour >> 16, colour >> 8 & 255, colour & 255]
}

proptest! {
    #![proptest_config(config(600))]

    #[test]
    fn sparse_dense_and_the_slow_text_agree(picture in pictures(), rule in rules()) {
        let (colours, filled) = picture.filled(rule, Form::Sparse);
        prop_assert_eq!(&picture.filled(rule, Form::Dense), &(colours.clone(), filled));
        let width = picture.size[0] as usize;
        let mut count = 0;
        for channel in 0..3 {
            let cell = |index: usize| slow::Cell {
                validity: if picture.known[index] { 16 } else { 0 },
                depth: picture.depths[index].into(),
                value: i64::from(channels(picture.colours[index])[channel]) << 2,
            };
            let rows: slow::Level = (0..picture.size[1] as usize)
                .map(|y| (0..width).map(|x| cell(y * width + x)).collect())
                .collect();
            let threshold = i64::from(rule.threshold);
            let slow = slow::filled(&rows, rule.gamma, threshold);
            count = 0;
            for hole in picture.holes() {
                let expected = slow[hole / width][hole % width].map(|value| (value + 2) >> 2);
                count += u32::from(expected.is_some());
                let before = i64::from(channels(picture.colours[hole])[channel]);
                prop_assert_eq!(i64::from(channels(colours[hole])[channel]), expected.unwrap_or(before), "cell {}", hole);
            }
        }
        prop_assert_eq!(filled, count);
    }

    #[test]
    fn what_is_filled_lies_within_what_is_known_and_nothing_known_changes(picture in pictures(), rule in rules()) {
        let (colours, filled) = picture.filled(rule, Form::Sparse);
        let known = || picture.known.iter().zip(&picture.colours).filter(|(known, _)| **known).map(|(_, colour)| *colour);
        let changed: Vec<usize> = (0..colours.len()).filter(|&cell| colours[cell] != picture.colours[cell]).collect();
        prop_assert!(changed.iter().all(|&cell| !picture.known[cell]));
        for channel in 0..3 {
            let (low, high) = (known().map(|c| channels(c)[channel]).min(), known().map(|c| channels(c)[channel]).max());
            for &cell in &changed {
                let level = Some(channels(colours[cell])[channel]);
                prop_assert!(low <= level && level <= high);
            }
        }
        // Without a difference of depths, everything is filled as soon as anything is known.
        let holes = picture.holes().count() as u32;
        if rule.threshold == u32::MAX {
            prop_assert_eq!(filled, if known().next().is_some() { holes } else { 0 });
        }
        prop_assert!(filled <= holes);
    }

    #[test]
    fn what_lies_in_a_hole_does_not_matter(picture in pictures(), rule in rules(), other in 0..1u32 << 24) {
        let mut painted = picture.clone();
        for hole in picture.holes() {
            painted.colours[hole] = other;
        }
        let (one, filled) = picture.filled(rule, Form::Sparse);
        let (two, filled_too) = painted.filled(rule, Form::Sparse);
        prop_assert_eq!(filled, filled_too);
        let left = |cell: usize| one[cell] == picture.colours[cell] && two[cell] == other;
        prop_assert!((0..one.len()).all(|cell| one[cell] == two[cell] || left(cell)));
    }

    /// In a mirror the halves that go up are others: a quarter of a step a level, at most.
    #[test]
    fn a_mirrored_picture_gives_a_mirrored_result(mut picture in pictures(), rule in rules(), logs in (0..5u32, 0..5u32)) {
        let (width, height) = (1 << logs.0, 1 << logs.1);
        let cells = (width * height) as usize;
        picture.size = [width, height];
        for cell in picture.colours.len()..cells {
            picture.colours.push(picture.colours[cell % 3 % picture.colours.len()]);
            picture.known.push(cell % 3 == 0);
            picture.depths.push(20);
        }
        (picture.colours, picture.known, picture.depths) = (
            picture.colours[..cells].to_vec(), picture.known[..cells].to_vec(), picture.depths[..cells].to_vec(),
        );
        let (one, filled) = picture.filled(rule, Form::Sparse);
        let (other, filled_too) = picture.mirrored().filled(rule, Form::Sparse);
        prop_assert_eq!(filled, filled_too);
        let turned = Holed { colours: other, ..picture.clone() }.mirrored().colours;
        for (a, b) in one.iter().zip(&turned) {
            for (a, b) in channels(*a).into_iter().zip(channels(*b)) {
                prop_assert!(a.abs_diff(b) <= 2, "{:06x} and {:06x}", a, b);
            }
        }
    }
}

/// All validities of a width of three steps, all depths of two, values at both ends: 4 cells, 12^4 pulls and more.
#[test]
fn pulling_four_cells_is_what_the_rule_says_for_all_of_a_small_width() {
    let one = |code: u32| {
        let value = Tint::of(&Colour::GRAY8, [0, 255, 100][(code / 6 % 3) as usize]);
        (Known { validity: [0, 5, 16][(code % 3) as usize], depth: code / 3 % 2 * 3, value }, code / 6 % 3)
    };
    let mut seen = 0;
    for code in 0..18u32.pow(4) {
        let cells = [code % 18, code / 18 % 18, code / 324 % 18, code / 5832].map(one).map(|(cell, _)| cell);
        for gamma in Gamma::ALL {
            for threshold in [0, 2, 3] {
                let tie = code & 1;
                let rule = Rule { gamma, threshold };
                let pulled = pulled(&cells, &rule, tie);
                let farthest = cells.iter().map(|cell| cell.depth).max().unwrap();
                let kept = cells.iter().filter(|cell| cell.depth + threshold >= farthest);
                let (sum, weighted) = kept.fold((0, 0), |(sum, weighted), cell| {
                    (sum + cell.validity, weighted + cell.validity * cell.value.channels()[2])
                });
                assert_eq!((pulled.depth, pulled.validity), (farthest, gamma.raised(sum)));
                if sum > 0 {
                    let (mean, low) = (pulled.value.channels()[2], 2 * weighted);
                    // The nearest whole number; of two equally near ones that of the place.
                    let nearest = |mean: u32| low.abs_diff(2 * sum * mean);
                    assert!(nearest(mean) < sum || nearest(mean) == sum && (2 * sum * mean > low) == (tie == 1));
                }
                seen += 1;
            }
        }
    }
    assert_eq!(seen, 9 * 18u32.pow(4));
}

/// A picture of one colour, of noise around it: from level to level it becomes neither brighter nor darker.
#[test]
fn brightness_does_not_drift_over_levels() {
    const SIDE: u32 = 512;
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 24
    };
    let colours: Vec<u32> = (0..SIDE * SIDE).map(|_| next() * 0x01_0101).collect();
    let mean = colours.iter().map(|&colour| u64::from(colour & 255)).sum::<u64>() as f64 / f64::from(SIDE * SIDE);
    // One hole, and a weight of one all the way up: what it gets is the mean of the whole picture.
    let mut memory = vec![Cell::default(); levels::cells(SIDE, SIDE)];
    let mut states = vec![0; state_words(memory.len())];
    let mut pyramid = Pyramid::new(SIDE, SIDE, &mut memory, &mut states).unwrap();
    let mut held = colours.clone();
    let known = vec![u32::MAX; (SIDE * SIDE / 32) as usize];
    let mut picture = Masked::new(SIDE, SIDE, Colour::RGB888, &mut held, &known, &[]).unwrap();
    dense(&mut picture, &mut pyramid, &Rule { gamma: Gamma::Zero, threshold: u32::MAX });
    let top = pyramid.known(pyramid.index(pyramid.levels().top(), 0, 0)).value.channels()[1];
    assert!((f64::from(top) / 4.0 - mean).abs() < 0.3, "{} and not {mean}", f64::from(top) / 4.0);
    assert_eq!(held, colours);
}

#[test]
fn one_known_cell_fills_any_picture() {
    for (width, height) in [(1, 1), (1, 37), (64, 1), (33, 20), (128, 128)] {
        for at in [0, (width * height) as usize / 2, (width * height) as usize - 1] {
            for gamma in Gamma::ALL {
                let cells = (width * height) as usize;
                let mut picture = Holed {
                    size: [width, height],
                    colours: vec![0; cells],
                    known: vec![false; cells],
                    depths: vec![7; cells],
                };
                (picture.colours[at], picture.known[at]) = (0xfe_0180, true);
                let (colours, filled) = picture.filled(Rule { gamma, threshold: 0 }, Form::Sparse);
                assert_eq!(filled as usize, cells - 1);
                assert!(colours.iter().all(|&colour| colour == 0xfe_0180));
            }
        }
    }
}

#[test]
fn foreground_stays_out_of_the_background() {
    // A red foreground on the left, a hole beside it, a green background on the right.
    let (width, height) = (32u32, 16u32);
    let kind = |cell: u32| match cell % width {
        0..10 => 0,
        10..15 => 1,
        _ => 2,
    };
    let cells = || 0..width * height;
    let picture = Holed {
        size: [width, height],
        colours: cells().map(|cell| [0xff_0000, 0, 0x00_ff00][kind(cell)]).collect(),
        known: cells().map(|cell| kind(cell) != 1).collect(),
        depths: cells().map(|cell| [10, 900, 900][kind(cell)]).collect(),
    };
    for gamma in Gamma::ALL {
        let (aware, _) = picture.filled(Rule { gamma, threshold: 50 }, Form::Sparse);
        assert!(picture.holes().all(|hole| aware[hole] == 0x00_ff00), "{gamma:?}");
        let (plain, _) = picture.filled(Rule { gamma, threshold: u32::MAX }, Form::Sparse);
        assert!(picture.holes().any(|hole| plain[hole] >> 16 > 100), "{gamma:?}: a plain one bleeds");
    }
}

#[test]
fn memory_that_does_not_fit_is_refused() {
    let pyramid = |width, height, cells: usize, states: usize| {
        let (mut memory, mut states) = (vec![Cell::<Tint>::default(); cells], vec![0; states]);
        Pyramid::new(width, height, &mut memory, &mut states).map(|_| ()).unwrap_err()
    };
    assert_eq!(pyramid(8, 8, 20, 2), SetupError::TooShort { plane: "pyramid", need: 21, have: 20 });
    assert_eq!(pyramid(8, 8, 21, 1), SetupError::TooShort { plane: "pyramid's states", need: 2, have: 1 });
    for (width, height) in [(0, 8), (8, 0), (32769, 1)] {
        assert_eq!(pyramid(width, height, 20, 2), SetupError::Size { width, height });
    }
    let picture = |colours: usize, known: usize, depths: usize| {
        let (mut colours, known, depths) = (vec![0; colours], vec![0; known], vec![0; depths]);
        Masked::new(8, 8, Colour::RGB888, &mut colours, &known, &depths).map(|_| ()).unwrap_err()
    };
    let short = |plane, need, have| SetupError::TooShort { plane, need, have };
    assert_eq!(picture(63, 2, 0), short("picture", 64, 63));
    assert_eq!(picture(64, 1, 0), short("mask", 2, 1));
    assert_eq!(picture(64, 2, 1), short("depth", 64, 1));
    // What a screen of these sizes needs.
    assert_eq!(levels::cells(128, 64) * size_of::<Cell<Tint>>(), 21_848);
    assert_eq!(levels::cells(320, 240) * size_of::<Cell<Tint>>(), 204_872);
    assert_eq!(levels::cells(1024, 1024) * size_of::<Cell<Tint>>(), 2_796_200);
}

/// The tables of docs/notes/inpainting.md.
#[test]
fn memory_is_what_the_documents_say() {
    let sizes = [(128, 64), (320, 240), (1024, 1024)];
    let line = |what: &str, cell: usize| {
        let bytes = sizes.map(|(width, height)| {
            let cells = levels::cells(width, height);
            thousands(cells * cell + 4 * state_words(cells))
        });
        format!("| {what} | {} |", bytes.join(" | "))
    };
    let table = [
        line("push-pull of colours", size_of::<Cell<Tint>>()),
        line("push-pull with motion", size_of::<Cell<galpix_core::inpaint::paint::Moving>>()),
    ];
    println!("{}", table.join("\n"));
    let documents =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/notes/inpainting.md")).unwrap();
    assert!(table.iter().all(|line| documents.contains(line)), "docs/notes/inpainting.md needs\n{}", table.join("\n"));
}

/// A number with its digits in threes.
fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let threes: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|three| std::str::from_utf8(three).unwrap()).collect();
    threes.join(" ")
}
