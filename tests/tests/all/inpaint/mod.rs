//! Push-pull of plain pictures: what must hold for any of them. That the bits are those of the rules is tested inside
//! the core.

mod map;
mod metamer;

use galpix_core::inpaint::{Gamma, Motion, Picture, PushPull};
use galpix_core::{Colour, Inpainting};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(2021), ..ProptestConfig::default() }
}

/// A picture with holes, as [`Picture`] takes it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Holed {
    size: [u32; 2],
    colours: Vec<u32>,
    known: Vec<bool>,
    depths: Vec<u32>,
}

impl Holed {
    /// Returns the colours after the holes were filled, and how many were.
    fn filled(&self, inpainting: &Inpainting<'_>) -> (Vec<u32>, u32) {
        let [width, height] = self.size;
        let mut bits = vec![0u32; self.known.len().div_ceil(32)];
        for (cell, _) in self.known.iter().enumerate().filter(|(_, known)| **known) {
            bits[cell / 32] |= 1 << (cell % 32);
        }
        let mut colours = self.colours.clone();
        let mut memory = vec![u32::MAX; PushPull::words(width, height, Motion::Kept)];
        let mut push_pull = PushPull::new(width, height, Motion::Kept, &mut memory).unwrap();
        let picture = Picture::new(width, height, Colour::RGB888, &mut colours, &bits).unwrap();
        let filled = push_pull.fill_picture(&mut picture.with_depths(&self.depths).unwrap(), inpainting);
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

fn inpaintings() -> impl Strategy<Value = Inpainting<'static>> {
    let threshold = prop_oneof![Just(u32::MAX), Just(0u32), 0..40u32];
    (prop::sample::select(&Gamma::ALL[..]), threshold).prop_map(|(gamma, threshold)| of(gamma, threshold))
}

/// Returns an inpainting that counts in a plain picture.
fn of(gamma: Gamma, threshold: u32) -> Inpainting<'static> {
    Inpainting { gamma, threshold, ..Inpainting::classic() }
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
    fn what_is_filled_lies_within_what_is_known_and_nothing_known_changes(
        picture in pictures(), inpainting in inpaintings(),
    ) {
        let (colours, filled) = picture.filled(&inpainting);
        let cells = || picture.known.iter().zip(&picture.colours);
        let known = || cells().filter(|(known, _)| **known).map(|(_, colour)| *colour);
        let changed: Vec<usize> = (0..colours.len()).filter(|&cell| colours[cell] != picture.colours[cell]).collect();
        prop_assert!(changed.iter().all(|&cell| !picture.known[cell]));
        for channel in 0..3 {
            let levels = || known().map(|colour| channels(colour)[channel]);
            let (low, high) = (levels().min(), levels().max());
            for &cell in &changed {
                let level = Some(channels(colours[cell])[channel]);
                prop_assert!(low <= level && level <= high);
            }
        }
        // Without a difference of depths, everything is filled as soon as anything is known.
        let holes = picture.holes().count() as u32;
        if inpainting.threshold == u32::MAX {
            prop_assert_eq!(filled, if known().next().is_some() { holes } else { 0 });
        }
        prop_assert!(filled <= holes);
    }

    #[test]
    fn what_lies_in_a_hole_does_not_matter(picture in pictures(), inpainting in inpaintings(), other in 0..1u32 << 24) {
        let mut painted = picture.clone();
        for hole in picture.holes() {
            painted.colours[hole] = other;
        }
        let (one, filled) = picture.filled(&inpainting);
        let (two, filled_too) = painted.filled(&inpainting);
        prop_assert_eq!(filled, filled_too);
        let left = |cell: usize| one[cell] == picture.colours[cell] && two[cell] == other;
        prop_assert!((0..one.len()).all(|cell| one[cell] == two[cell] || left(cell)));
    }

    /// In a mirror the halves that go up are others: a quarter of a step a level, at most.
    #[test]
    fn a_mirrored_picture_gives_a_mirrored_result(
        mut picture in pictures(), inpainting in inpaintings(), logs in (0..5u32, 0..5u32),
    ) {
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
        let (one, filled) = picture.filled(&inpainting);
        let (other, filled_too) = picture.mirrored().filled(&inpainting);
        prop_assert_eq!(filled, filled_too);
        let turned = Holed { colours: other, ..picture.clone() }.mirrored().colours;
        for (a, b) in one.iter().zip(&turned) {
            for (a, b) in channels(*a).into_iter().zip(channels(*b)) {
                prop_assert!(a.abs_diff(b) <= 2, "{:06x} and {:06x}", a, b);
            }
        }
    }
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
                let (colours, filled) = picture.filled(&of(gamma, 0));
                assert_eq!(filled as usize, cells - 1);
                assert!(colours.iter().all(|&colour| colour == 0xfe_0180));
            }
        }
    }
}

#[test]
fn foreground_stays_out_of_the_background() {
    // A red foreground on the left, a hole next to it, a green background on the right.
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
        let (aware, _) = picture.filled(&of(gamma, 50));
        assert!(picture.holes().all(|hole| aware[hole] == 0x00_ff00), "{gamma:?}");
        let (plain, _) = picture.filled(&of(gamma, u32::MAX));
        assert!(picture.holes().any(|hole| plain[hole] >> 16 > 100), "{gamma:?}: a plain one bleeds");
    }
}

/// The table of docs/notes/inpainting.md.
#[test]
fn memory_is_what_the_documents_say() {
    let sizes = [(128, 64), (320, 240), (1024, 1024)];
    let line = |what: &str, motion: Motion| {
        let bytes = sizes.map(|(width, height)| thousands(PushPull::words(width, height, motion) * size_of::<u32>()));
        format!("| {what} | {} |", bytes.join(" | "))
    };
    let table = [line("push-pull of colours", Motion::Kept), line("push-pull with motion", Motion::Inpainted)];
    println!("{}", table.join("\n"));
    let documents =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/notes/inpainting.md")).unwrap();
    assert!(table.iter().all(|line| documents.contains(line)), "docs/notes/inpainting.md needs\n{}", table.join("\n"));
}

/// Returns a number with its digits in threes.
fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let threes: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|three| std::str::from_utf8(three).unwrap()).collect();
    threes.join(" ")
}
