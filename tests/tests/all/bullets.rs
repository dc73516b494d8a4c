//! What was filled never displaces a galpixel.

use fixed::types::I32F32;
use galpix_core::{Bits, Class, Demand, Dynamic, FillMode, Format, Galpixel, Layout, Settings};
use galpix_tests::memory::{Mode, Shape, with_controller};

/// Depths of two bits, three fraction bits of a position.
fn tiny() -> Dynamic {
    let bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 16, recog: 4, prop: 8 }));
    let format = Dynamic::new(bits, Layout { depth_bits: 2, ..Layout::VELOCITY565 }).unwrap();
    assert_eq!((format.record().depth().bits, format.record().offset_y().bits), (2, 3));
    format
}

const COLOUR: [u8; 3] = [255, 0, 0];

/// A galpixel with a depth of `depth` quarters and a velocity of so many eighths of a cell.
fn galpixel(depth: u32, velocity: [i64; 2]) -> Galpixel {
    Galpixel {
        depth: I32F32::from_bits(i64::from(depth) << 30),
        velocity: [I32F32::from_bits(velocity[0] << 29), I32F32::from_bits(velocity[1] << 29), I32F32::ZERO],
        ..Galpixel::default()
    }
}

/// The cell in the middle becomes a bullet hole between galpixels of any depth, and a galpixel of any depth arrives
/// there a frame later, from a smaller or a larger source.
#[test]
fn a_bullet_never_displaces_a_galpixel_whatever_the_depths() {
    let shape = Shape::plain(3, 3);
    let mut frames = 0;
    let fill_modes = FillMode::ALL.into_iter().filter(|fill_mode| fill_mode.uses_edges());
    for (fill_mode, mode) in fill_modes.flat_map(|fill_mode| Mode::ALL.map(|mode| (fill_mode, mode))) {
        let settings = Settings { fill_mode, edge_threshold: u32::MAX, ..Settings::for_depth(2) };
        for (number, from_below) in (0..1u32 << 8).flat_map(|number| [false, true].map(|below| (number, below))) {
            let depth = |place: u32| number >> (2 * place) & 3;
            let (from, opposite, down) = if from_below { (2, 0, -1) } else { (0, 2, 1) };
            with_controller(shape, tiny(), None, |controller| {
                let front = controller.front_mut();
                for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
                    front.store(x, y, &galpixel(3, [0, 0]));
                }
                front.store(0, 1, &galpixel(depth(0), [0, 0]));
                front.store(1, 1, &galpixel(depth(1), [8, 0]));
                front.store(2, 1, &galpixel(3, [8, 0]));
                front.store(1, opposite, &galpixel(depth(2), [0, 0]));
                // It stays in its cell for one frame.
                front.store(1, from, &Galpixel { colour: COLOUR, ..galpixel(depth(3), [0, 3 * down]) });
                let tally = mode.step(controller, &settings);
                assert_eq!((tally.holes, tally.bullets), (1, 1), "{fill_mode:?} {number}");
                let bullet = controller.front().load(1, 1).unwrap();
                assert_eq!(bullet.class, Class::Debris);
                mode.step(controller, &settings);
                let there = controller.front().load(1, 1).unwrap();
                assert_eq!((there.class, there.colour), (Class::Galpixel, COLOUR), "{fill_mode:?} {number}");
                assert_eq!(there.depth, I32F32::from_bits(i64::from(depth(3)) << 30));
                frames += 2;
            });
        }
    }
    assert_eq!(frames, 3 * Mode::ALL.len() * 2 * 256 * 2);
}
