//! Pictures with holes: what metamers do to them, and what they leave alone.

extern crate std;
use std::vec;
use std::vec::Vec;

use super::super::kernel::Known;
use super::super::push_pull::{self, Holed};
use super::super::validity::{FULL, Gamma};
use super::*;

/// A picture whose holes have a depth, and whose cells all move alike.
#[derive(Clone)]
struct Plate {
    width: u32,
    height: u32,
    tones: Vec<Tone>,
    known: Vec<bool>,
    holes: Vec<bool>,
    depths: Vec<u32>,
    /// Cells a frame.
    motion: [i32; 2],
}

impl Plate {
    /// All known, at depth 100.
    fn new(width: u32, height: u32, rgb: impl Fn(i32, i32) -> [u8; 3]) -> Self {
        let cells = width * height;
        let place = |cell: u32| ((cell % width) as i32, (cell / width) as i32);
        let tone = |cell: u32| Tone { channels: ycbcr::of_rgb(rgb(place(cell).0, place(cell).1)), source: cell };
        Self {
            width,
            height,
            tones: (0..cells).map(tone).collect(),
            known: vec![true; cells as usize],
            holes: vec![false; cells as usize],
            depths: vec![100; cells as usize],
            motion: [0; 2],
        }
    }

    fn with_holes(mut self, hole: impl Fn(i32, i32) -> bool) -> Self {
        for cell in 0..self.width * self.height {
            if hole((cell % self.width) as i32, (cell / self.width) as i32) {
                self.holes[cell as usize] = true;
                self.known[cell as usize] = false;
            }
        }
        self
    }

    fn hole_tones(&self) -> Vec<Tone> {
        self.tones.iter().zip(&self.holes).filter(|(_, hole)| **hole).map(|(tone, _)| *tone).collect()
    }
}

impl Holed for Plate {
    type Value = Tone;

    fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    fn known(&self, x: u32, y: u32) -> Known<Tone> {
        let cell = (y * self.width + x) as usize;
        Known { validity: if self.known[cell] { FULL } else { 0 }, depth: self.depths[cell], value: self.tones[cell] }
    }

    fn fill_holes(&mut self, mut value: impl FnMut(&Self, u32, u32) -> Option<Tone>) -> u32 {
        let before = self.clone();
        let mut filled = self.clone();
        self.each_hole(|x, y| filled.put(x, y, value(&before, x, y).unwrap()));
        *self = filled;
        0
    }
}

impl Scene for Plate {
    fn each_hole(&mut self, mut hole: impl FnMut(u32, u32)) {
        for cell in 0..self.width * self.height {
            if self.holes[cell as usize] {
                hole(cell % self.width, cell / self.width);
            }
        }
    }

    fn displacement(&self, _: u32, age: u32) -> [i32; 2] {
        self.motion.map(|motion| motion * age as i32)
    }

    fn put(&mut self, x: u32, y: u32, tone: Tone) {
        self.tones[(y * self.width + x) as usize].channels = tone.channels;
    }
}

/// What a plate is filled with.
#[derive(Clone, Copy, Debug)]
struct Case {
    gamma: Gamma,
    recipe: Recipe,
    age: u32,
}

impl Case {
    /// Gamma 1/2, as the paper's.
    fn of(recipe: Recipe) -> Self {
        Self { gamma: Gamma::Half, recipe, age: 0 }
    }

    fn inpainting(&self) -> Inpainting<'static> {
        Inpainting { gamma: self.gamma, threshold: 8, quads: false, mask: &[] }
    }

    fn filled(&self, plate: &Plate) -> Plate {
        let mut plate = plate.clone();
        let mut memory = vec![u32::MAX; Metamer::words(plate.width, plate.height, self.recipe.levels)];
        let mut workspace = MetamerWorkspace::new();
        let mut metamer = Metamer::new(plate.width, plate.height, self.recipe, &mut memory, &mut workspace).unwrap();
        let count = metamer.fill(&mut plate, &self.inpainting(), self.age).unwrap();
        // Where nothing at all is known, nothing is filled.
        let holes = plate.holes.iter().filter(|hole| **hole).count();
        assert_eq!(count as usize, if plate.known.contains(&true) { holes } else { 0 });
        plate
    }

    fn filled_by_reference(&self, plate: &Plate) -> Plate {
        let mut plate = plate.clone();
        reference::metamers(&mut plate, &self.inpainting(), &self.recipe, self.age);
        plate
    }
}

fn noise(x: i32, y: i32, layer: u32) -> i32 {
    i32::from(noise::white(x, y, layer, 77)[0]) / 8
}

/// Gravel: white noise of three sizes of grain, in colour.
fn gravel(x: i32, y: i32) -> [u8; 3] {
    let grain = (noise(x, y, 20) + noise(x >> 1, y >> 1, 21) + noise(x >> 2, y >> 2, 22)) / 4;
    [120 + grain, 110 + grain * 3 / 4, 90 + grain / 2 + noise(x >> 1, y, 23) / 16]
        .map(|level| level.clamp(0, 255) as u8)
}

fn slivers(x: i32, y: i32) -> bool {
    (x + y / 7) % 41 < 4 || (20..30).contains(&x) && (30..47).contains(&y)
}

fn cases() -> impl Iterator<Item = Case> {
    let gammas = Gamma::ALL.into_iter().flat_map(|gamma| (1..=6).map(move |levels| (gamma, levels)));
    gammas.map(|(gamma, levels)| Case {
        gamma,
        recipe: Recipe { levels, coloured: levels % 2 == 1, ..Recipe::default() },
        age: 3,
    })
}

#[test]
fn what_is_worked_out_lazily_has_the_bits_of_the_reference() {
    for (width, height) in [(101, 67), (64, 64), (40, 9), (2, 1), (1, 33), (1, 1)] {
        let mut plate = Plate::new(width, height, gravel).with_holes(slivers);
        // A nearer surface next to the slivers, and debris, which is no hole.
        for cell in 0..plate.depths.len() {
            let (x, y) = (cell as i32 % width as i32, cell as i32 / width as i32);
            if (x + y / 7) % 41 > 30 {
                plate.depths[cell] = 40;
            }
            if (x * 7 + y * 13) % 97 == 0 {
                plate.known[cell] = false;
            }
        }
        plate.motion = [3, -1];
        for case in cases() {
            let (lazy, reference) = (case.filled(&plate), case.filled_by_reference(&plate));
            assert!(lazy.tones == reference.tones, "{width} x {height}, {case:?}");
        }
    }
}

#[test]
fn what_is_known_stays_and_what_lies_in_holes_does_not_matter() {
    let case = Case::of(Recipe::default());
    let plate = Plate::new(90, 60, gravel).with_holes(slivers);
    let mut other = plate.clone();
    for (tone, hole) in other.tones.iter_mut().zip(&plate.holes) {
        if *hole {
            tone.channels = [500, -1000, 1000];
        }
    }
    let (first, second) = (case.filled(&plate), case.filled(&other));
    assert!(first.tones == second.tones);
    for ((before, after), hole) in plate.tones.iter().zip(&first.tones).zip(&plate.holes) {
        assert!(*hole || before == after);
    }
}

#[test]
fn an_even_picture_stays_even() {
    for case in cases() {
        let plate = Plate::new(80, 50, |_, _| [200, 30, 90]).with_holes(slivers);
        let after = case.filled(&plate);
        assert!(after.tones.iter().all(|tone| tone.channels == plate.tones[0].channels), "{case:?}");
    }
}

#[test]
fn foreground_lends_no_texture() {
    // Even background left of a gravelly foreground, the hole between them.
    let mut plate = Plate::new(96, 64, |x, y| if x < 48 { [60, 70, 80] } else { gravel(x, y) })
        .with_holes(|x, _| (42..48).contains(&x));
    for (cell, depth) in plate.depths.iter_mut().enumerate() {
        *depth = if cell % 96 < 48 { 100 } else { 20 };
    }
    let even = plate.tones[0].channels;
    let filled = Case::of(Recipe::default()).filled(&plate);
    assert!(filled.hole_tones().iter().all(|tone| tone.channels == even));
}

/// Mean square of the difference between neighbours in a row, both of them holes: how much of a texture there is.
fn texture(plate: &Plate, channel: usize) -> f64 {
    let (mut sum, mut count) = (0, 0);
    for cell in 1..plate.tones.len() {
        if plate.holes[cell] && plate.holes[cell - 1] {
            let step = plate.tones[cell].channels[channel] - plate.tones[cell - 1].channels[channel];
            sum += i64::from(step) * i64::from(step);
            count += 1;
        }
    }
    sum as f64 / f64::from(count)
}

/// Variance within holes.
fn variance_of(plate: &Plate, channel: usize) -> f64 {
    let tones: Vec<f64> = plate.hole_tones().iter().map(|tone| f64::from(tone.channels[channel])).collect();
    let mean = tones.iter().sum::<f64>() / tones.len() as f64;
    tones.iter().map(|tone| (tone - mean) * (tone - mean)).sum::<f64>() / tones.len() as f64
}

#[test]
fn holes_vary_as_what_surrounds_them_does() {
    let truth = Plate::new(160, 120, gravel).with_holes(slivers);
    let coloured = Recipe { coloured: true, ..Recipe::default() };
    let metamer = Case::of(coloured).filled(&truth);
    let paper = Case::of(Recipe { noise: Scale::Interval, ..coloured }).filled(&truth);
    let mut bare = truth.clone();
    let levels = Levels::new(truth.width, truth.height);
    let mut memory = vec![0; Pyramid::<Tone>::words(levels.cells())];
    let mut pyramid = Pyramid::over(levels, &mut memory).unwrap();
    push_pull::fill(&mut bare, &mut pyramid, &Case::of(coloured).inpainting());
    for channel in 0..3 {
        let ratio = |plate: &Plate| {
            (
                variance_of(plate, channel) / variance_of(&truth, channel),
                texture(plate, channel) / texture(&truth, channel),
            )
        };
        std::println!(
            "channel {channel}: metamer {:.2?}, interval {:.2?}, push-pull {:.2?}",
            ratio(&metamer),
            ratio(&paper),
            ratio(&bare)
        );
        let (variance, texture) = ratio(&metamer);
        assert!((0.6..1.6).contains(&variance) && (0.6..1.6).contains(&texture), "{channel}: {variance} {texture}");
        for plate in [&paper, &bare] {
            assert!(ratio(plate).0 < 0.5 * variance && ratio(plate).1 < 0.5 * texture);
        }
        assert!(ratio(&bare).1 < ratio(&paper).1);
    }
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let centred = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| value - mean).collect::<Vec<_>>()
    };
    let (a, b) = (centred(a), centred(b));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}

#[test]
fn noise_moves_with_the_surface_and_not_with_the_screen() {
    // A picture that moves by 3 cells per frame, and with it a hole; the same area some frames later.
    let seen = |age: i32, motion: i32| {
        let mut plate = Plate::new(192, 96, |x, y| gravel(x - 3 * age, y))
            .with_holes(|x, y| (40..72).contains(&(x - 3 * age)) && (32..64).contains(&y));
        plate.motion = [motion, 0];
        let recipe = Recipe { levels: 2, ..Recipe::default() };
        let after = Case { age: age as u32, ..Case::of(recipe) }.filled(&plate);
        move |x: i32, y: i32| f64::from(after.tones[(y * 192 + x) as usize].channels[0])
    };
    for age in [2, 5, 8] {
        let measure = |motion: i32| {
            let (first, second) = (seen(0, motion), seen(age, motion));
            let places = || (34..62).flat_map(|y| (64..72).map(move |x| (x, y)));
            let here: Vec<f64> = places().map(|(x, y)| first(x, y)).collect();
            // At the same cell of the screen, and at the same one of the surface; both are in both holes.
            let screen: Vec<f64> = places().map(|(x, y)| second(x, y)).collect();
            let surface: Vec<f64> = places().map(|(x, y)| second(x + 3 * age, y)).collect();
            (correlation(&here, &screen), correlation(&here, &surface))
        };
        let (moving, still) = (measure(3), measure(0));
        std::println!(
            "age {age}: moving, with the screen {:.2}, with the surface {:.2}; still {still:.2?}",
            moving.0,
            moving.1
        );
        assert!(moving.1 > 0.8 && moving.0.abs() < 0.5, "{moving:?}");
        assert!(still.1 < 0.5, "{still:?}");
    }
}

#[test]
fn memory_is_as_stated() {
    let kib = |width, height| Metamer::bytes(width, height, 4).div_ceil(1024);
    assert_eq!([kib(128, 64), kib(320, 240), kib(1024, 1024)], [179, 1453, 19_483]);
    // What firmware/README.md says of boards: a single cell, and the largest picture of 4 to 3 with 512 KiB.
    assert_eq!(Metamer::bytes(1, 1, 4).div_ceil(1024), 27);
    assert!(Metamer::bytes(184, 138, 4) <= 512 << 10 && Metamer::bytes(188, 141, 4) > 512 << 10);
}

#[test]
fn memory_that_is_too_short_is_refused() {
    let need = Metamer::words(20, 10, 4);
    let made = |width, height, have: usize| {
        let (mut memory, mut workspace) = (vec![0; have], MetamerWorkspace::new());
        let mut plate = Plate::new(20, 10, gravel).with_holes(slivers);
        let before = plate.tones.clone();
        let mut metamer = Metamer::new(width, height, Recipe::default(), &mut memory, &mut workspace)?;
        let filled = metamer.fill(&mut plate, &Inpainting::classic(), 0);
        assert!(filled.is_ok() || plate.tones == before);
        filled
    };
    assert!(made(20, 10, need).is_ok());
    let too_short = |have| Err(SetupError::TooShort { plane: "metamer", need, have });
    assert_eq!(made(20, 10, need - 1), too_short(need - 1));
    // Memory for a smaller scene is too short, for a larger one long enough.
    assert_eq!(made(8, 8, need - 1), too_short(need - 1));
    assert!(made(64, 64, Metamer::words(64, 64, 4)).is_ok());
    assert_eq!(made(0, 8, need), Err(SetupError::Size { width: 0, height: 8 }));
}
