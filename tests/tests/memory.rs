//! The memory that a budget promises is the memory that is lent, and every setup that cannot be is refused with a sentence.

use fixed::types::I32F32;
use galpix_core::budget::{Bits, Component, Demand, Shave};
use galpix_core::colour::Colour;
use galpix_core::edge;
use galpix_core::error::{BudgetError, SetupError};
use galpix_core::frame::{Controller, Scratch};
use galpix_core::galpixel::{Budget, Chosen, Fixed, Galpixel, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layout::{
    Flat565, Full, Lanes, Layout, Shaded, Still, Tagged, Velocity565, VelocityGray4, VelocityGray8,
};
use galpix_core::record::Record;
use galpix_tests::profiles::{Odd, Panel, Paper, Scene, Slide, Uneven};

const STALE: u32 = 0xa5a5_a5a5;

fn memory_is_what_is_promised<L: Layout>(bits: Bits) {
    let budget = Chosen::<L>::new(bits).unwrap();
    for (width, height, wings) in [(1, 1, Wings::NONE), (17, 5, Wings::NONE), (4, 3, Wings::all(2))] {
        let mut starts = vec![0; Grid::rows(height, wings)];
        let grid = Grid::new(width, height, wings, &mut starts).unwrap();
        let words = Galpixmap::<L, _>::words(&grid, budget);
        let bytes = Galpixmap::<L, Chosen<L>>::bytes_per_galpixel(budget);
        assert_eq!(4 * words, bytes * grid.cells() as usize);
        assert_eq!(bytes, 4 * (budget.record().bits() as usize).div_ceil(32), "no word more than the bits need");

        // One word short: refused, and left as it was.
        for have in [0, words - 1] {
            let mut memory = vec![STALE; have];
            let expected = SetupError::TooShort { plane: "galpixmap", need: words, have };
            assert_eq!(Galpixmap::<L, _>::new(grid, budget, &mut memory).err(), Some(expected));
            assert_eq!(Galpixmap::<L, _>::over(grid, budget, &mut memory).err(), Some(expected));
            assert!(memory.iter().all(|&word| word == STALE));
        }

        // Exactly enough, and with a surplus, which stays untouched.
        for surplus in [0, 3] {
            let mut memory = vec![STALE; words + surplus];
            let mut map = Galpixmap::<L, _>::new(grid, budget, &mut memory).unwrap();
            let (right, bottom) = (grid.width() as i32 - 1, grid.height() as i32 - 1);
            for (x, y) in [(0, 0), (right, bottom)] {
                assert!(map.store(x, y, &Galpixel { colour: [255; 3], ..Galpixel::default() }).is_some());
                assert_eq!(map.rgb888(x, y), Some([255; 3]));
            }
            for (x, y) in [(-1, 0), (0, -1), (right + 1, 0), (0, bottom + 1), (i32::MIN, i32::MAX)] {
                assert_eq!(map.store(x, y, &Galpixel::default()), None, "outside");
                assert_eq!(map.load(x, y), None, "outside");
            }
            assert!(memory[words..].iter().all(|&word| word == STALE), "the surplus was touched");
        }
    }
}

#[test]
fn every_layout_takes_the_memory_that_it_promises() {
    memory_is_what_is_promised::<Full>(Paper::BITS);
    memory_is_what_is_promised::<Tagged>(Odd::BITS);
    memory_is_what_is_promised::<Shaded>(Uneven::BITS);
    memory_is_what_is_promised::<Flat565>(Scene::BITS);
    memory_is_what_is_promised::<Velocity565>(Slide::BITS);
    memory_is_what_is_promised::<VelocityGray8>(Panel::BITS);
    memory_is_what_is_promised::<VelocityGray4>(Panel::BITS);
    memory_is_what_is_promised::<Still>(Paper::BITS);
}

#[test]
fn the_papers_example_takes_20_bytes_and_a_small_panel_8() {
    assert!(Galpixmap::<Full, Chosen<Full>>::bytes_per_galpixel(Chosen::new(Paper::BITS).unwrap()) <= 20);
    assert_eq!(<Static<Paper> as Fixed<Full>>::BYTES_PER_GALPIXEL, 20);
    let panel = Chosen::<Velocity565>::new(Panel::BITS).unwrap();
    assert!(Galpixmap::<Velocity565, _>::bytes_per_galpixel(panel) <= 8);
    assert!(Galpixmap::<Still, Chosen<Still>>::bytes_per_galpixel(Chosen::new(Paper::BITS).unwrap()) <= 4);
}

#[test]
fn a_budget_fixed_at_compile_time_takes_no_memory() {
    assert_eq!(size_of_val(&Static::<Paper>::new()), 0);
    assert_eq!(size_of_val(&Static::<Uneven>::default()), 0);
    let (fixed, chosen) =
        (size_of::<Galpixmap<'_, Full, Static<Paper>>>(), size_of::<Galpixmap<'_, Full, Chosen<Full>>>());
    assert!(fixed + size_of::<Record>() <= chosen + align_of::<usize>(), "{fixed} and {chosen}");
}

/// Each lane adds exactly its fields; a lane that is left out adds nothing.
#[test]
fn absent_lanes_take_no_bit() {
    let bits = Paper::BITS;
    let (x, z) = (bits.x, bits.z);
    let cost = |lanes: Lanes| Record::plan(bits, lanes, 24).unwrap().bits();
    let mut lanes = Lanes::NONE;
    let mut expected = 2 + 24;
    assert_eq!(cost(lanes), expected, "class and colour are always there");
    lanes.depth_bits = 16;
    expected += 16;
    assert_eq!(cost(lanes), expected, "depth");
    lanes.velocity = true;
    expected += 2 * (x.position_frac + x.velocity_bits());
    assert_eq!(cost(lanes), expected, "velocity");
    lanes.acceleration = true;
    expected += 2 * x.acceleration_bits();
    assert_eq!(cost(lanes), expected, "acceleration");
    lanes.depth_motion = true;
    expected += z.motion_bits();
    assert_eq!(cost(lanes), expected, "depth motion");
    lanes.luminosity = true;
    expected += bits.luminosity_int + 2 * bits.luminosity_frac;
    assert_eq!(cost(lanes), expected, "luminosity");
    lanes.tag_bits = 8;
    expected += 8;
    assert_eq!(cost(lanes), expected, "tag");
    let still = Record::plan(bits, Lanes::NONE, 24).unwrap();
    for field in [
        still.depth(),
        still.offset_x(),
        still.offset_y(),
        still.velocity(0),
        still.velocity(2),
        still.acceleration(1),
        still.tag(),
        still.luminosity(),
        still.luminosity_rate(),
    ] {
        assert!(!field.present());
    }
}

/// What a person writes comes back, rounded to the budget: half a last bit away at most; what is too much is clamped and
/// counted.
fn stored_is_loaded<L: Layout>(bits: Bits) {
    let mut starts = [0];
    let grid = Grid::new(1, 1, Wings::NONE, &mut starts).unwrap();
    let mut memory = [0; 8];
    let mut map = Galpixmap::<L, _>::new(grid, Chosen::<L>::new(bits).unwrap(), &mut memory).unwrap();
    let unit = |frac: u32| 0.5f64.powi(frac as i32);
    let range = f64::from(1u32 << bits.depth_int);
    let components = [bits.x, bits.y, bits.z];
    for n in -20..=20 {
        // In cells a frame, or bins of depth a frame; the depth is handed over as a part of its range.
        let velocity = components.map(|component| f64::from(n) * 0.77 * unit(component.velocity_frac));
        let acceleration = components.map(|component| f64::from(n) * 0.61 * unit(component.acceleration_frac));
        let handed = |[x, y, z]: [f64; 3]| [x, y, z / range].map(I32F32::from_num);
        let galpixel = Galpixel {
            velocity: handed(velocity),
            acceleration: handed(acceleration),
            depth: I32F32::from_num(f64::from(n + 20) / 41.0),
            luminosity_rate: I32F32::from_num(f64::from(n) / 3.0),
            ..Galpixel::default()
        };
        assert_eq!(map.store(0, 0, &galpixel), Some(0), "nothing to clamp");
        let back = map.load(0, 0).unwrap();
        for (i, component) in components.iter().enumerate() {
            let scale = if i == 2 { range } else { 1.0 };
            for (name, back, written, frac) in [
                ("velocity", back.velocity[i], velocity[i], component.velocity_frac),
                ("acceleration", back.acceleration[i], acceleration[i], component.acceleration_frac),
            ] {
                // Beside the budget's last bit there is the last bit of the number that was handed over.
                let most = unit(frac + 1) + 2.0 * unit(32) * scale;
                let back = back.to_num::<f64>() * scale;
                assert!((back - written).abs() <= most, "{name} {i} of {bits:?}: {written} became {back}");
            }
        }
        if L::LANES.luminosity {
            assert!((back.luminosity_rate - galpixel.luminosity_rate).abs() <= unit(bits.luminosity_frac + 1));
        }
    }
    let wild = Galpixel {
        velocity: [I32F32::MAX, I32F32::MIN, I32F32::MAX],
        acceleration: [I32F32::MIN, I32F32::MAX, I32F32::MIN],
        luminosity_rate: I32F32::MIN,
        depth: I32F32::MAX,
        ..Galpixel::default()
    };
    let fields = 6 + u32::from(L::LANES.luminosity);
    assert_eq!(map.store(0, 0, &wild), Some(fields), "every field of motion is clamped");
    let back = map.load(0, 0).unwrap();
    assert!(back.velocity[0] > 0 && back.velocity[1] < 0 && back.velocity[2] > 0, "{back:?}");
    assert!(back.acceleration[0] < 0 && back.acceleration[1] > 0 && back.acceleration[2] < 0, "{back:?}");
    assert!(back.depth > 0.9999 && (back.luminosity_rate < 0) == L::LANES.luminosity, "{back:?}");
}

#[test]
fn what_is_stored_is_loaded_to_the_last_bit_of_the_budget() {
    for bits in [Paper::BITS, Scene::BITS, Odd::BITS, Uneven::BITS] {
        stored_is_loaded::<Shaded>(bits);
    }
    // Velocities in depth that are finer than the numbers that a person writes.
    stored_is_loaded::<Full>(Bits::derive(Demand { extent: 1 << 14, recog: 64, prop: 1024 }).unwrap());
}

#[test]
fn grids_that_cannot_be_laid_out_are_refused() {
    let mut starts = vec![STALE; 1 << 16];
    for (width, height, wings) in [
        (0, 5, Wings::NONE),
        (5, 0, Wings::NONE),
        (0, 0, Wings::all(3)),
        ((1 << 15) + 1, 1, Wings::NONE),
        (1, (1 << 15) + 1, Wings::NONE),
        (1 << 15, 1, Wings { left: 1, ..Wings::NONE }),
        (1 << 15, 1 << 15, Wings::NONE),
        (u32::MAX, u32::MAX, Wings::all(u32::MAX)),
        (1, 1, Wings { top: u32::MAX, ..Wings::NONE }),
    ] {
        assert_eq!(Grid::new(width, height, wings, &mut starts), Err(SetupError::Size { width, height }));
        assert_eq!(Grid::cells_for(width, height, wings), 0);
    }
    assert!(starts.iter().all(|&start| start == STALE), "refused, and left as it was");
    let expected = SetupError::TooShort { plane: "table of row starts", need: 9, have: 8 };
    assert_eq!(Grid::new(4, 5, Wings::all(2), &mut starts[..8]), Err(expected));
    assert!(Grid::new(1 << 15, 1 << 13, Wings::NONE, &mut starts).is_ok(), "2^28 cells are the most");
}

#[test]
fn controllers_that_cannot_work_are_refused() {
    let budget = Chosen::<Full>::new(Paper::BITS).unwrap();
    let (mut starts, mut fewer) = (vec![0; 4], vec![0; 3]);
    let grid = Grid::new(11, 4, Wings::NONE, &mut starts).unwrap();
    let other = Grid::new(11, 3, Wings::NONE, &mut fewer).unwrap();
    let attempt = |back_grid: Grid<'_>, winners: usize, edges: usize| {
        let (mut front, mut back) = (vec![0; 5 * 44], vec![0; 5 * 44]);
        let (mut winners, mut edges) = (vec![0; winners], vec![0; edges]);
        let front = Galpixmap::<Full, _>::new(grid, budget, &mut front).unwrap();
        let back = Galpixmap::new(back_grid, budget, &mut back).unwrap();
        Controller::new(front, back, Scratch { winners: &mut winners, edges: &mut edges }).err()
    };
    assert_eq!(attempt(grid, 44, 2), None);
    assert_eq!(attempt(grid, 0, 0), None);
    assert_eq!(attempt(other, 44, 2), Some(SetupError::GridsDiffer));
    assert_eq!(attempt(grid, 43, 2), Some(SetupError::TooShort { plane: "winner map", need: 44, have: 43 }));
    assert_eq!(attempt(grid, 44, 1), Some(SetupError::TooShort { plane: "edge map", need: 2, have: 1 }));
    assert_eq!(edge::words(&grid), 2);
}

/// Every refusal is one sentence: what is wrong, its numbers, and after a colon how to mend it.
#[test]
fn every_refusal_says_what_is_wrong_and_how_to_mend_it() {
    let base = Demand { extent: 1024, recog: 8, prop: 16 };
    let component = Component::derive(base).unwrap();
    let planned = |lanes: Lanes| Record::plan(Paper::BITS, lanes, <Full as Layout>::Colour::BITS).unwrap_err();
    let derived = |demand: Demand| Component::derive(demand).unwrap_err();
    let refusals = [
        (derived(Demand { extent: 0, ..base }), "Zero", "positive number"),
        (derived(Demand { prop: 1, ..base }), "PropagationTooShort", "2 frames or more"),
        (derived(Demand { extent: 2, recog: 16, prop: 4 }), "VelocityVanishes", "equation (8) gives 0"),
        (derived(Demand { extent: 64, recog: 64, prop: 4 }), "AccelerationVanishes", "equation (9) gives -2"),
        (derived(Demand { prop: 1 << 12, ..base }), "FieldTooWide", "33 bits"),
        (component.shaved(Shave { velocity_int: 10, ..Shave::default() }).unwrap_err(), "ShavedAway", "shave fewer"),
        (
            component.shaved(Shave { velocity_frac: 1, ..Shave::default() }).unwrap_err(),
            "VelocityCoarserThanAcceleration",
            "6 fraction bits and the acceleration 7",
        ),
        (planned(Lanes { depth_bits: 3, ..Lanes::FULL }), "DepthTooCoarse", "7 bits cannot hold 2^10"),
        (
            Record::plan(
                Bits::derive(Demand { extent: 1 << 14, recog: 2, prop: 32 }).unwrap(),
                Lanes { depth_bits: 20, luminosity: true, tag_bits: 32, ..Lanes::FULL },
                32,
            )
            .unwrap_err(),
            "RecordTooLong",
            "269 bits",
        ),
        (planned(Lanes { velocity: false, ..Lanes::FULL }), "LaneWithoutItsBase", "add the missing lane"),
    ];
    let mut sentences: Vec<(String, &str)> = Vec::new();
    for (error, name, detail) in refusals {
        let error: BudgetError = error;
        assert!(format!("{error:?}").starts_with(name), "{error:?} is no {name}");
        sentences.push((error.to_string(), detail));
    }
    for (error, detail) in [
        (SetupError::TooShort { plane: "edge map", need: 12, have: 7 }, "edge map needs 12 words and 7 were lent"),
        (SetupError::Size { width: 0, height: 9 }, "0x9"),
        (SetupError::GridsDiffer, "same one"),
    ] {
        sentences.push((error.to_string(), detail));
    }
    for (sentence, detail) in sentences {
        assert!(sentence.contains(detail), "{sentence:?} lacks {detail:?}");
        assert!(sentence.contains(": ") && !sentence.contains('\n') && !sentence.ends_with('.'), "{sentence:?}");
    }
}
