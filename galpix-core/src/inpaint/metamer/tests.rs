//! Pictures with holes: what metamers do to them, and what they leave alone.

extern crate std;
use std::vec;
use std::vec::Vec;

use super::*;
use crate::inpaint::push_pull;

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

impl Picture for Plate {
    type Value = Tone;

    fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    fn known(&self, x: u32, y: u32) -> Known<Tone> {
        let cell = (y * self.width + x) as usize;
        Known { validity: if self.known[cell] { FULL } else { 0 }, depth: self.depths[cell], value: self.tones[cell] }
    }

    fn fill_holes(&mut self, mut value: impl FnMut(&Self, u32, u32) -> Option<Tone>) -> u32 {
        let mut filled = self.clone();
        self.holes(|x, y| filled.put(x, y, value(self, x, y).unwrap()));
        *self = filled;
        0
    }
}

impl Scene for Plate {
    fn holes(&self, mut hole: impl FnMut(u32, u32)) {
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

fn filled(
    plate: &Plate,
    recipe: &Recipe,
    run: fn(&mut Plate, &mut Scratch<'_>, &Recipe) -> Result<u32, SetupError>,
) -> Plate {
    let mut plate = plate.clone();
    let count = cells(plate.width, plate.height);
    let mut scratch = Scratch {
        tones: &mut vec![Cell::unknown(Tone::default()); count],
        moments: &mut vec![Cell::unknown(Moments::default()); count],
        states: [&mut vec![0; state_words(count)], &mut vec![0; state_words(count)]],
        needs: &mut vec![Default::default(); needs::tiles(plate.width, plate.height, MOST_LEVELS)],
        workspace: &mut Workspace::new(),
        noise: &mut noise::Tiles::default(),
    };
    let count = run(&mut plate, &mut scratch, recipe).unwrap();
    // Where nothing at all is known, nothing is filled.
    let holes = plate.holes.iter().filter(|hole| **hole).count();
    assert_eq!(count as usize, if plate.known.contains(&true) { holes } else { 0 });
    plate
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

fn recipes() -> impl Iterator<Item = Recipe> {
    let gammas = Gamma::ALL.into_iter().flat_map(|gamma| (1..=6).map(move |levels| (gamma, levels)));
    gammas.map(|(gamma, levels)| Recipe {
        rule: Rule { gamma, threshold: 8 },
        levels,
        coloured: levels % 2 == 1,
        ..Recipe::new(8, 3)
    })
}

#[test]
fn what_is_worked_out_on_demand_has_the_same_bits() {
    for (width, height) in [(101, 67), (64, 64), (40, 9), (2, 1), (1, 33)] {
        let mut plate = Plate::new(width, height, gravel).with_holes(slivers);
        // A nearer surface beside the slivers, and debris, which is no hole.
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
        for recipe in recipes() {
            let (sparse, dense) = (filled(&plate, &recipe, sparse), filled(&plate, &recipe, dense));
            assert!(sparse.tones == dense.tones, "{width} x {height}, {recipe:?}");
        }
    }
}

#[test]
fn what_is_known_stays_and_what_lies_in_holes_does_not_matter() {
    let recipe = Recipe::new(8, 0);
    let plate = Plate::new(90, 60, gravel).with_holes(slivers);
    let mut other = plate.clone();
    for (tone, hole) in other.tones.iter_mut().zip(&plate.holes) {
        if *hole {
            tone.channels = [500, -1000, 1000];
        }
    }
    let (first, second) = (filled(&plate, &recipe, sparse), filled(&other, &recipe, sparse));
    assert!(first.tones == second.tones);
    for ((before, after), hole) in plate.tones.iter().zip(&first.tones).zip(&plate.holes) {
        assert!(*hole || before == after);
    }
}

#[test]
fn an_even_picture_stays_even() {
    for recipe in recipes() {
        let plate = Plate::new(80, 50, |_, _| [200, 30, 90]).with_holes(slivers);
        let after = filled(&plate, &recipe, sparse);
        assert!(after.tones.iter().all(|tone| tone.channels == plate.tones[0].channels), "{recipe:?}");
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
    assert!(filled(&plate, &Recipe::new(8, 0), sparse).hole_tones().iter().all(|tone| tone.channels == even));
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
    let coloured = Recipe { coloured: true, ..Recipe::new(8, 0) };
    let metamer = filled(&truth, &coloured, sparse);
    let paper = filled(&truth, &Recipe { noise: Scale::Interval, ..coloured }, sparse);
    let mut bare = truth.clone();
    let count = cells(truth.width, truth.height);
    let (mut tones, mut states) = (vec![Cell::unknown(Tone::default()); count], vec![0; state_words(count)]);
    let mut pyramid = Pyramid::new(truth.width, truth.height, &mut tones, &mut states).unwrap();
    push_pull::sparse(&mut bare, &mut pyramid, &Recipe::new(8, 0).rule);
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
    // A picture that moves by 3 cells a frame, and with it a hole; the same area some frames later.
    let seen = |age: i32, motion: i32| {
        let mut plate = Plate::new(192, 96, |x, y| gravel(x - 3 * age, y))
            .with_holes(|x, y| (40..72).contains(&(x - 3 * age)) && (32..64).contains(&y));
        plate.motion = [motion, 0];
        let recipe = Recipe { levels: 2, ..Recipe::new(8, age as u32) };
        let after = filled(&plate, &recipe, sparse);
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
    let kib = |width, height| bytes(width, height, 4).div_ceil(1024);
    assert_eq!([kib(128, 64), kib(320, 240), kib(1024, 1024)], [179, 1453, 19_483]);
    assert_eq!((size_of::<Cell<Tone>>(), size_of::<Cell<Moments>>()), (16, 40));
    // What firmware/README.md says of boards: a single cell, and the largest picture of 4 to 3 with 512 KiB.
    assert_eq!(bytes(1, 1, 4).div_ceil(1024), 27);
    assert!(bytes(184, 138, 4) <= 512 << 10 && bytes(188, 141, 4) > 512 << 10);
}
