//! Push-pull of plain pictures: the same bits as the reference and as a slow text of the same rules.

extern crate std;

mod map;
mod picture;
mod slow;

use std::vec;
use std::vec::Vec;

use super::kernel::{Known, pulled};
use super::levels::Levels;
use super::paint::{Tint, TintOf};
use super::reference;
use super::{Gamma, Inpainting, Motion, Picture, PushPull};
use crate::error::SetupError;
use crate::format::colour::Colour;

/// Numbers by chance.
pub struct Random(u64);

impl Random {
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    pub fn below(&mut self, end: u32) -> u32 {
        self.next() % end
    }

    pub fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.next() as usize % choices.len()]
    }
}

/// A picture with holes, as [`Picture`] takes it.
#[derive(Clone, Debug)]
struct Holed {
    size: [u32; 2],
    colours: Vec<u32>,
    known: Vec<u32>,
    depths: Vec<u32>,
}

impl Holed {
    /// Sides of any parity; holes from none to all, one of them large; depths of a few surfaces, or of one.
    fn random(random: &mut Random) -> Self {
        let [width, height] =
            if random.below(8) == 0 { [200, 90] } else { [1 + random.below(75), 1 + random.below(17)] };
        let cells = width * height;
        let share = random.one_of(&[0, 1, 3, 10, 50, 90, 100]);
        let [first, count] = random.one_of(&[[0, 64], [40, 4]]);
        let (left, top) = (random.below(width), random.below(height));
        let large = random.below(2) == 0;
        let mut known = vec![0; cells.div_ceil(32) as usize];
        for cell in 0..cells {
            let (x, y) = (cell % width, cell / width);
            let in_large = large && x >= left && y >= top && x < left + 70 && y < top + 60;
            if random.below(100) >= share && !in_large {
                known[(cell / 32) as usize] |= 1 << (cell % 32);
            }
        }
        let depth = |random: &mut Random| {
            if random.below(2) == 0 { 40 } else { first + random.below(count) }
        };
        Self {
            size: [width, height],
            colours: (0..cells).map(|_| random.below(1 << 24)).collect(),
            known,
            depths: (0..cells).map(|_| depth(random)).collect(),
        }
    }

    fn is_known(&self, cell: usize) -> bool {
        self.known[cell / 32] >> (cell % 32) & 1 != 0
    }

    fn picture<'p>(&'p self, colours: &'p mut [u32]) -> Picture<'p> {
        let [width, height] = self.size;
        let picture = Picture::new(width, height, Colour::RGB888, colours, &self.known).unwrap();
        picture.with_depths(&self.depths).unwrap()
    }

    /// The colours after the holes were filled, and how many were.
    fn filled(&self, motion: Motion, inpainting: &Inpainting<'_>) -> (Vec<u32>, u32) {
        let [width, height] = self.size;
        let mut memory = vec![u32::MAX; PushPull::words(width, height, motion)];
        let mut push_pull = PushPull::new(width, height, motion, &mut memory).unwrap();
        let mut colours = self.colours.clone();
        let filled = push_pull.fill_picture(&mut self.picture(&mut colours), inpainting);
        (colours, filled)
    }

    fn filled_by_reference(&self, inpainting: &Inpainting<'_>) -> (Vec<u32>, u32) {
        let [width, height] = self.size;
        let mut colours = self.colours.clone();
        let levels = Levels::new(width, height);
        let mut picture = self.picture(&mut colours);
        let filled = reference::push_pull(&mut picture.holes::<Tint>(inpainting.mask, &[]), &levels, inpainting);
        (colours, filled)
    }
}

pub fn inpainting(random: &mut Random) -> Inpainting<'static> {
    let threshold = [u32::MAX, 0, random.below(40)];
    Inpainting { gamma: random.one_of(&Gamma::ALL), threshold: random.one_of(&threshold), ..Inpainting::classic() }
}

fn channels(colour: u32) -> [u32; 3] {
    [colour >> 16, colour >> 8 & 255, colour & 255]
}

#[test]
fn push_pull_has_the_bits_of_the_reference_and_of_a_slow_text() {
    let mut random = Random::new(1);
    for round in 0..600 {
        let (holed, inpainting) = (Holed::random(&mut random), inpainting(&mut random));
        let (colours, filled) = holed.filled(Motion::Kept, &inpainting);
        assert!(holed.filled(Motion::Inpainted, &inpainting) == (colours.clone(), filled), "round {round}");
        assert!(holed.filled_by_reference(&inpainting) == (colours.clone(), filled), "round {round}");
        let width = holed.size[0] as usize;
        let mut count = 0;
        for channel in 0..3 {
            let cell = |index: usize| slow::Cell {
                validity: if holed.is_known(index) { 16 } else { 0 },
                depth: holed.depths[index].into(),
                value: i64::from(channels(holed.colours[index])[channel]) << 2,
            };
            let rows: slow::Level =
                (0..holed.size[1] as usize).map(|y| (0..width).map(|x| cell(y * width + x)).collect()).collect();
            let slow = slow::filled(&rows, inpainting.gamma, inpainting.threshold.into());
            count = 0;
            for hole in (0..colours.len()).filter(|&cell| !holed.is_known(cell)) {
                let expected = slow[hole / width][hole % width].map(|value| (value + 2) >> 2);
                count += u32::from(expected.is_some());
                let before = i64::from(channels(holed.colours[hole])[channel]);
                let after = i64::from(channels(colours[hole])[channel]);
                assert_eq!(after, expected.unwrap_or(before), "round {round}, cell {hole}");
            }
        }
        assert_eq!(filled, count, "round {round}");
    }
}

/// All validities of a width of three steps, all depths of two, values at both ends: 4 cells, 18^4 pulls and more.
#[test]
fn pulling_four_cells_is_what_the_rule_says_for_all_of_a_small_width() {
    let one = |code: u32| {
        let value = TintOf::new(&Colour::GRAY8).tint([0, 255, 100][(code / 6 % 3) as usize]);
        Known { validity: [0, 5, 16][(code % 3) as usize], depth: code / 3 % 2 * 3, value }
    };
    let mut seen = 0;
    for code in 0..18u32.pow(4) {
        let cells = [code % 18, code / 18 % 18, code / 324 % 18, code / 5832].map(one);
        for gamma in Gamma::ALL {
            for threshold in [0, 2, 3] {
                let tie = code & 1;
                let pulled = pulled(&cells, &Inpainting { gamma, threshold, ..Inpainting::classic() }, tie);
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

/// A picture of noise of one colour: from level to level it becomes neither brighter nor darker.
#[test]
fn brightness_does_not_drift_over_levels() {
    const SIDE: u32 = 512;
    let mut random = Random::new(1);
    let mut colours: Vec<u32> = (0..SIDE * SIDE).map(|_| random.below(256) * 0x01_0101).collect();
    let mean = colours.iter().map(|&colour| f64::from(colour & 255)).sum::<f64>() / f64::from(SIDE * SIDE);
    let known = vec![u32::MAX; (SIDE * SIDE / 32) as usize];
    let mut picture = Picture::new(SIDE, SIDE, Colour::RGB888, &mut colours, &known).unwrap();
    let holes = picture.holes::<Tint>(&[], &[]);
    let base = reference::Plane::new([SIDE, SIDE], |x, y| super::push_pull::Holed::known(&holes, x, y));
    let planes = reference::pulled_up(base, &Inpainting::classic());
    let top = planes.last().unwrap().at((0, 0)).value.channels()[1];
    assert!((f64::from(top) / 4.0 - mean).abs() < 0.3, "{} and not {mean}", f64::from(top) / 4.0);
}

#[test]
fn memory_that_does_not_fit_is_refused() {
    let too_short = |plane, need, have| Err(SetupError::TooShort { plane, need, have });
    let push_pull = |width, height, motion, have: usize| {
        let mut memory = vec![0; have];
        PushPull::new(width, height, motion, &mut memory).map(|push_pull| push_pull.motion())
    };
    // 21 cells, and two words of states.
    assert_eq!(push_pull(8, 8, Motion::Kept, 44), Ok(Motion::Kept));
    assert_eq!(push_pull(8, 8, Motion::Kept, 43), too_short("pyramid", 44, 43));
    assert_eq!(push_pull(8, 8, Motion::Inpainted, 65), Ok(Motion::Inpainted));
    assert_eq!(push_pull(8, 8, Motion::Inpainted, 64), too_short("pyramid", 65, 64));
    for (width, height) in [(0, 8), (8, 0), (32769, 1)] {
        assert_eq!(push_pull(width, height, Motion::Kept, 99), Err(SetupError::Size { width, height }));
    }
    let picture = |width, colours: usize, known: usize, depths: usize| {
        let (mut colours, known, depths) = (vec![0; colours], vec![0; known], vec![0; depths]);
        let picture = Picture::new(width, 8, Colour::RGB888, &mut colours, &known)?;
        picture.with_depths(&depths).map(|_| ())
    };
    assert_eq!(picture(8, 64, 2, 64), Ok(()));
    assert_eq!(picture(8, 63, 2, 64), Err(SetupError::TooShort { plane: "picture", need: 64, have: 63 }));
    assert_eq!(picture(8, 64, 1, 64), Err(SetupError::TooShort { plane: "mask", need: 2, have: 1 }));
    assert_eq!(picture(8, 64, 2, 1), Err(SetupError::TooShort { plane: "depth", need: 64, have: 1 }));
    assert_eq!(picture(0, 64, 2, 64), Err(SetupError::Size { width: 0, height: 8 }));
    // What a screen of these sizes needs, in bytes.
    let bytes = |width, height, motion| 4 * PushPull::words(width, height, motion);
    assert_eq!([128, 320, 1024].map(|width| bytes(width, width, Motion::Kept)), [45_056, 281_648, 2_883_584]);
}
