//! The memory that a budget promises is the memory that is needed, and every setup that cannot be is refused with a
//! sentence.

use fixed::types::I32F32;
use galpix_core::record::{Component, Shave};
use galpix_core::{
    Bits, BudgetError, Colour, Controller, Demand, Dynamic, Format, Galpixel, Galpixmap, Grid, Layout, Margin, Profile,
    Record, Scratch, SetupError, Static, stages,
};
use galpix_tests::profiles::{ODD, PANEL, PAPER, SCENE, SLIDE, UNEVEN, dynamic};

const STALE: u32 = 0xa5a5_a5a5;

fn memory_is_what_is_promised(layout: Layout, bits: Bits) {
    let format = dynamic(layout, bits);
    for (width, height, margin) in [(1, 1, Margin::NONE), (17, 5, Margin::NONE), (4, 3, Margin::all(2))] {
        let mut starts = vec![0; Grid::rows(height, margin)];
        let grid = Grid::new(width, height, margin, &mut starts).unwrap();
        let words = Galpixmap::words(&grid, format);
        let bytes = Galpixmap::bytes_per_galpixel(format);
        assert_eq!(4 * words, bytes * grid.cells() as usize);
        assert_eq!(bytes, 4 * (format.record().bits() as usize).div_ceil(32), "no word more than the bits need");

        // One word short: refused, and left as it was.
        for have in [0, words - 1] {
            let mut memory = vec![STALE; have];
            let expected = SetupError::TooShort { plane: "galpixmap", need: words, have };
            assert_eq!(Galpixmap::new(grid, format, &mut memory).err(), Some(expected));
            assert_eq!(Galpixmap::over(grid, format, &mut memory).err(), Some(expected));
            assert!(memory.iter().all(|&word| word == STALE));
        }

        // Exactly enough, and with a surplus, which stays untouched.
        for surplus in [0, 3] {
            let mut memory = vec![STALE; words + surplus];
            let mut map = Galpixmap::new(grid, format, &mut memory).unwrap();
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
    memory_is_what_is_promised(Layout::FULL, PAPER);
    memory_is_what_is_promised(Layout::TAGGED, ODD);
    memory_is_what_is_promised(Layout::SHADED, UNEVEN);
    memory_is_what_is_promised(Layout::FLAT565, SCENE);
    memory_is_what_is_promised(Layout::VELOCITY565, SLIDE);
    memory_is_what_is_promised(Layout::VELOCITY_GRAY8, PANEL);
    memory_is_what_is_promised(Layout::VELOCITY_GRAY4, PANEL);
    memory_is_what_is_promised(Layout::STILL, PAPER);
}

#[test]
fn the_papers_example_takes_20_bytes_and_a_small_panel_8() {
    assert_eq!(Galpixmap::bytes_per_galpixel(dynamic(Layout::FULL, PAPER)), 20);
    assert_eq!(Static::<Paper>::RECORD.bytes(), 20);
    assert!(Galpixmap::bytes_per_galpixel(dynamic(Layout::VELOCITY565, PANEL)) <= 8);
    assert!(Galpixmap::bytes_per_galpixel(dynamic(Layout::STILL, PAPER)) <= 4);
}

#[derive(Clone, Copy, Debug)]
struct Paper;

impl Profile for Paper {
    const LAYOUT: Layout = Layout::FULL;
    const BITS: Bits = PAPER;
}

#[test]
fn a_format_fixed_at_compile_time_takes_no_memory() {
    assert_eq!(size_of_val(&Static::<Paper>::new()), 0);
    assert_eq!(size_of_val(&Static::<Paper>::default()), 0);
    let (fixed, chosen) = (size_of::<Galpixmap<'_, Static<Paper>>>(), size_of::<Galpixmap<'_, Dynamic>>());
    assert!(fixed + size_of::<Record>() <= chosen + align_of::<usize>(), "{fixed} and {chosen}");
}

/// Each part of a layout adds exactly its fields; one that is left out adds nothing.
#[test]
fn absent_fields_take_no_bit() {
    let bits = PAPER;
    let (x, z) = (bits.x, bits.z);
    let cost = |layout: Layout| Record::plan(bits, layout).unwrap().bits();
    let mut layout = Layout::STILL;
    let mut expected = 2 + 24;
    assert_eq!(cost(layout), expected, "class and colour are always there");
    layout.depth_bits = 16;
    expected += 16;
    assert_eq!(cost(layout), expected, "depth");
    layout.velocity = true;
    expected += 2 * (x.position_frac + x.velocity_bits());
    assert_eq!(cost(layout), expected, "velocity");
    layout.acceleration = true;
    expected += 2 * x.acceleration_bits();
    assert_eq!(cost(layout), expected, "acceleration");
    layout.depth_motion = true;
    expected += z.motion_bits();
    assert_eq!(cost(layout), expected, "depth motion");
    layout.luminosity = true;
    expected += bits.luminosity_int + 2 * bits.luminosity_frac;
    assert_eq!(cost(layout), expected, "luminosity");
    layout.tag_bits = 8;
    expected += 8;
    assert_eq!(cost(layout), expected, "tag");
    let still = Record::plan(bits, Layout::STILL).unwrap();
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

/// What a person writes comes back, rounded to the budget: half a last bit away at most; what is too much is clamped
/// and counted.
fn stored_is_loaded(layout: Layout, bits: Bits) {
    let mut starts = [0];
    let grid = Grid::new(1, 1, Margin::NONE, &mut starts).unwrap();
    let mut memory = [0; 8];
    let mut map = Galpixmap::new(grid, dynamic(layout, bits), &mut memory).unwrap();
    let unit = |frac: u32| 0.5f64.powi(frac as i32);
    let range = f64::from(1u32 << bits.depth_int);
    let components = [bits.x, bits.y, bits.z];
    for n in -20..=20 {
        // In cells per frame, or bins of depth per frame; the depth is handed over as a part of its range.
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
                // Off by half of the budget's last bit, and by the last bit of the number handed over.
                let most = unit(frac + 1) + 2.0 * unit(32) * scale;
                let back = back.to_num::<f64>() * scale;
                assert!((back - written).abs() <= most, "{name} {i} of {bits:?}: {written} became {back}");
            }
        }
        if layout.luminosity {
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
    let fields = 6 + u32::from(layout.luminosity);
    assert_eq!(map.store(0, 0, &wild), Some(fields), "every field of motion is clamped");
    let back = map.load(0, 0).unwrap();
    assert!(back.velocity[0] > 0 && back.velocity[1] < 0 && back.velocity[2] > 0, "{back:?}");
    assert!(back.acceleration[0] < 0 && back.acceleration[1] > 0 && back.acceleration[2] < 0, "{back:?}");
    assert!(back.depth > 0.9999 && (back.luminosity_rate < 0) == layout.luminosity, "{back:?}");
}

#[test]
fn what_is_stored_is_loaded_to_the_last_bit_of_the_budget() {
    for bits in [PAPER, SCENE, ODD, UNEVEN] {
        stored_is_loaded(Layout::SHADED, bits);
    }
    // Velocities in depth that are finer than the numbers that a person writes.
    stored_is_loaded(Layout::FULL, Bits::derive(Demand { extent: 1 << 14, recog: 64, prop: 1024 }).unwrap());
}

#[test]
fn grids_that_cannot_be_laid_out_are_refused() {
    let mut starts = vec![STALE; 1 << 16];
    for (width, height, margin) in [
        (0, 5, Margin::NONE),
        (5, 0, Margin::NONE),
        (0, 0, Margin::all(3)),
        ((1 << 15) + 1, 1, Margin::NONE),
        (1, (1 << 15) + 1, Margin::NONE),
        (1 << 15, 1, Margin { left: 1, ..Margin::NONE }),
        (1 << 15, 1 << 15, Margin::NONE),
        (u32::MAX, u32::MAX, Margin::all(u32::MAX)),
        (1, 1, Margin { top: u32::MAX, ..Margin::NONE }),
    ] {
        assert_eq!(Grid::new(width, height, margin, &mut starts), Err(SetupError::Size { width, height }));
        assert_eq!(Grid::cells_for(width, height, margin), 0);
    }
    assert!(starts.iter().all(|&start| start == STALE), "refused, and left as it was");
    let expected = SetupError::TooShort { plane: "table of row starts", need: 9, have: 8 };
    assert_eq!(Grid::new(4, 5, Margin::all(2), &mut starts[..8]), Err(expected));
    assert!(Grid::new(1 << 15, 1 << 13, Margin::NONE, &mut starts).is_ok(), "2^28 cells are the most");
}

#[test]
fn controllers_that_cannot_work_are_refused() {
    let format = dynamic(Layout::FULL, PAPER);
    let (mut starts, mut fewer) = (vec![0; 4], vec![0; 3]);
    let grid = Grid::new(11, 4, Margin::NONE, &mut starts).unwrap();
    let other = Grid::new(11, 3, Margin::NONE, &mut fewer).unwrap();
    let attempt = |back_grid: Grid<'_>, winners: usize, edges: usize| {
        let (mut front, mut back) = (vec![0; 5 * 44], vec![0; 5 * 44]);
        let (mut winners, mut edges) = (vec![0; winners], vec![0; edges]);
        let front = Galpixmap::new(grid, format, &mut front).unwrap();
        let back = Galpixmap::new(back_grid, format, &mut back).unwrap();
        Controller::new(front, back, Scratch { winners: &mut winners, edges: &mut edges }).err()
    };
    assert_eq!(attempt(grid, 44, 2), None);
    assert_eq!(attempt(grid, 0, 0), None);
    assert_eq!(attempt(other, 44, 2), Some(SetupError::GridsDiffer));
    assert_eq!(attempt(grid, 43, 2), Some(SetupError::TooShort { plane: "winner map", need: 44, have: 43 }));
    assert_eq!(attempt(grid, 44, 1), Some(SetupError::TooShort { plane: "edge map", need: 2, have: 1 }));
    assert_eq!(stages::words(&grid), 2);
}

/// Every refusal is one sentence: what is wrong, its numbers, and after a colon how to correct it.
#[test]
fn every_refusal_says_what_is_wrong_and_how_to_mend_it() {
    let base = Demand { extent: 1024, recog: 8, prop: 16 };
    let component = Component::derive(base).unwrap();
    let planned = |layout: Layout| Record::plan(PAPER, layout).unwrap_err();
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
        (planned(Layout { depth_bits: 3, ..Layout::FULL }), "DepthTooCoarse", "7 bits cannot hold 2^10"),
        (
            Record::plan(
                Bits::derive(Demand { extent: 1 << 14, recog: 2, prop: 32 }).unwrap(),
                Layout { depth_bits: 20, tag_bits: 32, ..Layout::SHADED },
            )
            .unwrap_err(),
            "RecordTooLong",
            "261 bits",
        ),
        (planned(Layout { velocity: false, ..Layout::FULL }), "FieldWithoutItsBase", "add what is missing"),
        (Colour::gray(9).unwrap_err(), "ChannelBits", "give it 1 to 8"),
    ];
    let mut sentences: Vec<(String, &str)> = Vec::new();
    for (error, name, detail) in refusals {
        let error: BudgetError = error;
        assert!(format!("{error:?}").starts_with(name), "{error:?} is no {name}");
        sentences.push((error.to_string(), detail));
    }
    for (error, detail) in [
        (SetupError::TooShort { plane: "edge map", need: 12, have: 7 }, "edge map needs 12 words and 7 were provided"),
        (SetupError::Size { width: 0, height: 9 }, "0x9"),
        (SetupError::GridsDiffer, "same one"),
        (SetupError::NoTag, "tag bits"),
    ] {
        sentences.push((error.to_string(), detail));
    }
    for (sentence, detail) in sentences {
        assert!(sentence.contains(detail), "{sentence:?} lacks {detail:?}");
        assert!(sentence.contains(": ") && !sentence.contains('\n') && !sentence.ends_with('.'), "{sentence:?}");
    }
}
