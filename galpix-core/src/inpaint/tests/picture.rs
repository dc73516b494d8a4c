//! Metamers in plain pictures: what a galpixmap of the same cells gets, and nothing where something is known.

extern crate std;

use std::string::ToString;
use std::vec;
use std::vec::Vec;

use super::map::mask;
use super::{Holed, Random, inpainting};
use crate::error::SetupError;
use crate::format::budget::{Bits, Demand};
use crate::format::colour::Colour;
use crate::format::layout::Layout;
use crate::format::{Dynamic, Format};
use crate::inpaint::map::metamers;
use crate::inpaint::metamer::reference;
use crate::inpaint::metamer::tone::Tone;
use crate::inpaint::{Inpainting, Metamer, MetamerWorkspace, Picture, Recipe, Scale};
use crate::layers::displacement_word;
use crate::map::Galpixmap;
use crate::map::galpixel::Class;
use crate::map::grid::{Grid, Margin};

/// What a picture becomes: its colours, and how many holes were filled.
type Filled = Result<(Vec<u32>, u32), SetupError>;

fn recipe(random: &mut Random) -> Recipe {
    Recipe {
        levels: random.below(10),
        noise: random.one_of(&Scale::ALL),
        coloured: random.below(2) == 1,
        seed: random.next(),
    }
}

/// Fills a picture of a colour format. `memory_for` is the size that memory is provided for.
fn filled(
    holed: &Holed,
    (format, recipe): (Colour, Recipe),
    inpainting: &Inpainting<'_>,
    moved: &[u32],
    memory_for: [u32; 2],
) -> Filled {
    let [width, height] = holed.size;
    let mut memory = vec![u32::MAX; Metamer::words(memory_for[0], memory_for[1], recipe.levels)];
    let mut workspace = MetamerWorkspace::new();
    let mut metamer = Metamer::new(memory_for[0], memory_for[1], recipe, &mut memory, &mut workspace)?;
    let mut colours = holed.colours.clone();
    let mut picture = Picture::new(width, height, format, &mut colours, &holed.known)?.with_depths(&holed.depths)?;
    let before = holed.colours.clone();
    match metamer.fill_picture(&mut picture, inpainting, moved) {
        Ok(filled) => Ok((colours, filled)),
        Err(error) => {
            assert_eq!(colours, before);
            Err(error)
        }
    }
}

/// Whole cells a frame, each different, all alike, or none.
fn velocities(random: &mut Random, cells: usize) -> Vec<[i32; 2]> {
    let kind = random.below(3);
    let any = |random: &mut Random| [0; 2].map(|_| random.below(41) as i32 - 20);
    let all = any(random);
    (0..cells).map(|_| [[0; 2], all, any(random)][kind as usize]).collect()
}

/// Depths of few bits, and of more than a pyramid has.
const LAYOUTS: [Layout; 4] = [
    Layout::FULL,
    Layout { depth_bits: 28, depth_motion: false, ..Layout::FULL },
    Layout::VELOCITY565,
    Layout::VELOCITY_GRAY4,
];

/// Still pictures, and such as have moved by whole cells: since then a galpixel has gone its velocity times the age.
#[test]
fn a_picture_gets_what_a_galpixmap_of_the_same_cells_gets() {
    let bits = Bits::derive(Demand { extent: 1024, recog: 8, prop: 16 }).unwrap();
    let mut random = Random::new(5);
    let mut seen = [0; 3];
    for round in 0..160 {
        let format = Dynamic::new(bits, random.one_of(&LAYOUTS)).unwrap();
        let record = *format.record();
        let colour = *record.colour_format();
        let mut holed = Holed::random(&mut random);
        let fits = |words: &mut Vec<u32>, bits: u32| words.iter_mut().for_each(|word| *word &= (1 << bits) - 1);
        fits(&mut holed.colours, colour.bits());
        fits(&mut holed.depths, record.depth().bits.into());
        let velocities = velocities(&mut random, holed.colours.len());
        let age = random.one_of(&[0, 1, 3, 17]);

        let [width, height] = holed.size;
        let mut rows = vec![0; height as usize];
        let grid = Grid::new(width, height, Margin::NONE, &mut rows).unwrap();
        let mut words = vec![0; Galpixmap::words(&grid, format)];
        let mut map = Galpixmap::new(grid, format, &mut words).unwrap();
        let fewer = u32::from(record.depth().bits).saturating_sub(Inpainting::DEPTH_BITS);
        for (cell, velocity) in (0..).zip(&velocities) {
            let mut words = map.words_at(cell).unwrap();
            let class = if holed.is_known(cell as usize) { Class::Galpixel } else { Class::JustUnobscured };
            record.class().set(&mut words, class as u32);
            record.depth().set(&mut words, holed.depths[cell as usize] << fewer);
            record.colour().set(&mut words, holed.colours[cell as usize]);
            for (component, cells) in velocity.iter().enumerate() {
                let up = record.scales[component].velocity_frac;
                record.velocity(component).set(&mut words, (cells << up) as u32);
            }
            map.put(cell, &words);
        }

        let (recipe, mask) = (recipe(&mut random), mask(&mut random, grid.cells()));
        let inpainting = Inpainting { mask: &mask, ..inpainting(&mut random) };
        let moved: Vec<u32> =
            velocities.iter().map(|velocity| displacement_word(velocity.map(|cells| cells * age))).collect();
        let moved = if moved.iter().all(|&word| word == 0) && round % 2 == 0 { &[][..] } else { &moved };
        let (colours, count) = filled(&holed, (colour, recipe), &inpainting, moved, holed.size).unwrap();

        let mut memory = vec![u32::MAX; Metamer::words(width, height, recipe.levels)];
        let mut workspace = MetamerWorkspace::new();
        let mut metamer = Metamer::new(width, height, recipe, &mut memory, &mut workspace).unwrap();
        let of_map = metamers(&mut map, &inpainting, &mut metamer, age as u32).unwrap();
        let of_map = ((0..grid.cells()).map(|cell| map.colour(cell)).collect::<Vec<_>>(), of_map);
        assert!(of_map == (colours, count), "round {round}");
        seen[if moved.is_empty() { 0 } else { 1 + usize::from(age > 0) }] += u32::from(count > 20);
    }
    assert!(seen.iter().all(|&rounds| rounds > 4), "{seen:?}");
}

/// Any words as colours, displacements and depths, also such as no pyramid can hold.
#[test]
fn what_is_known_or_masked_stays_and_any_numbers_give_the_bits_of_the_reference() {
    let mut random = Random::new(6);
    let mut seen = 0;
    for round in 0..150 {
        let mut holed = Holed::random(&mut random);
        let cells = holed.colours.len();
        let any = |random: &mut Random| random.next() << 1 ^ random.next();
        if round % 2 == 0 {
            holed.colours.iter_mut().for_each(|word| *word = any(&mut random));
            holed.depths.iter_mut().for_each(|word| *word = any(&mut random) >> random.one_of(&[0, 0, 7, 30]));
        }
        let moved: Vec<u32> = (0..cells + random.below(3) as usize).map(|_| any(&mut random)).collect();
        let (recipe, mask) = (recipe(&mut random), mask(&mut random, cells as u32));
        let threshold = random.one_of(&[0, 1 << 20, 1 << 27, u32::MAX]);
        let inpainting = Inpainting { mask: &mask, threshold, ..inpainting(&mut random) };
        // Memory for a larger picture is enough.
        let memory_for = holed.size.map(|side| side + random.below(2) * 9);
        let (colours, count) = filled(&holed, (Colour::RGB888, recipe), &inpainting, &moved, memory_for).unwrap();

        let mut expected = holed.colours.clone();
        let mut picture = holed.picture(&mut expected);
        let mut holes = picture.holes::<Tone>(&mask, &moved);
        let expected_count = reference::metamers(&mut holes, &inpainting, &recipe, 7);
        assert!((&colours, count) == (&expected, expected_count), "round {round}");

        let in_mask = |cell: usize| mask.get(cell / 32).is_some_and(|word| word >> (cell % 32) & 1 != 0);
        let is_hole = |cell: usize| !holed.is_known(cell) && (mask.is_empty() || in_mask(cell));
        assert!((0..cells).all(|cell| is_hole(cell) || colours[cell] == holed.colours[cell]), "round {round}");
        assert!(count as usize <= (0..cells).filter(|&cell| is_hole(cell)).count());
        seen += u32::from(count > 20);
    }
    assert!(seen > 30, "{seen}");
}

#[test]
fn a_picture_without_holes_stays_as_it_is() {
    let mut random = Random::new(7);
    for _ in 0..20 {
        let mut holed = Holed::random(&mut random);
        holed.known.fill(u32::MAX);
        let format = (Colour::RGB888, recipe(&mut random));
        let made = filled(&holed, format, &inpainting(&mut random), &[], holed.size);
        assert_eq!(made, Ok((holed.colours.clone(), 0)));
    }
}

#[test]
fn displacements_of_some_cells_only_and_memory_that_is_too_short_are_refused() {
    let holed = Holed { size: [8, 8], colours: vec![1; 64], known: vec![0xff; 2], depths: vec![0; 64] };
    let filled = |moved: usize, memory_for: [u32; 2]| {
        let format = (Colour::RGB888, Recipe::default());
        filled(&holed, format, &Inpainting::classic(), &vec![0; moved], memory_for).map(|(_, filled)| filled)
    };
    for moved in [0, 64, 65, 1000] {
        assert_eq!(filled(moved, [8, 8]), Ok(48));
    }
    for have in [1, 63] {
        let refused = filled(have, [8, 8]).unwrap_err();
        assert_eq!(refused, SetupError::TooShort { plane: "plane of displacements", need: 64, have });
        let sentence =
            std::format!("the plane of displacements needs 64 words and {have} were provided: provide a longer slice");
        assert_eq!(refused.to_string(), sentence);
    }
    let [need, have] = [8, 4].map(|side| Metamer::words(side, side, 4));
    assert_eq!(filled(64, [4, 4]), Err(SetupError::TooShort { plane: "metamer", need, have }));
}
