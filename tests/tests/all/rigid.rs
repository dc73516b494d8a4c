//! What moves alike stays together: all galpixels share a frame's threshold, so that a rigid patch is never torn.

use fixed::types::I32F32;
use galpix_core::record::Scale;
use galpix_core::stages::{snap, step_position};
use galpix_core::{Bits, Class, Demand, Dynamic, FillMode, Format, Galpixel, Layout, Rounding, Settings};
use galpix_tests::memory::{Shape, with_controller};
use galpix_tests::profiles::dynamic;
use galpix_tests::random;

const SIDE: i32 = 4;
const FRAMES: u32 = 16;

fn format() -> Dynamic {
    dynamic(Layout::FULL, Bits::derive(Demand { extent: 256, recog: 8, prop: FRAMES }).unwrap())
}

/// Returns a number of any of 2^12 parts of a range of `width` around 0.
fn drawn(generator: &mut impl rand::Rng, width: f64) -> I32F32 {
    I32F32::from_num((f64::from(random::below(generator, 4096)) / 4096.0 - 0.5) * width)
}

/// Patches of 4x4 with one motion and one sub-pixel phase, over 16 frames: each frame shows a square without gap or
/// overlap.
#[test]
fn a_rigid_patch_is_never_torn() {
    let shape = Shape::plain(48, 48);
    for rounding in Rounding::ALL {
        let mut generator = random::generator(7);
        for patch in 0..150 {
            let motion = Galpixel {
                offset: [drawn(&mut generator, 1.0), drawn(&mut generator, 1.0)],
                velocity: [drawn(&mut generator, 2.0), drawn(&mut generator, 2.0), I32F32::ZERO],
                acceleration: [drawn(&mut generator, 0.1), drawn(&mut generator, 0.1), I32F32::ZERO],
                ..Galpixel::default()
            };
            with_controller(shape, format(), None, |controller| {
                let settings = Settings { rounding, fill_mode: FillMode::Hold, ..Settings::for_depth(16) };
                for y in 0..SIDE {
                    for x in 0..SIDE {
                        controller.front_mut().store(22 + x, 22 + y, &motion).unwrap();
                    }
                }
                for frame in 1..=FRAMES {
                    let tally = controller.step(&settings);
                    let at = format!("{rounding:?}, patch {patch}, frame {frame}");
                    assert_eq!((tally.moved, tally.lost, tally.collided), (16, 0, 0), "{at}");
                    let there: Vec<(i32, i32)> = (0..48)
                        .flat_map(|y| (0..48).map(move |x| (x, y)))
                        .filter(|&(x, y)| controller.front().load(x, y).unwrap().class == Class::Galpixel)
                        .collect();
                    let (left, top) = there[0];
                    let square = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (left + x, top + y)));
                    assert!(there.iter().copied().eq(square), "{at}: torn into {there:?}");
                }
            });
        }
    }
}

/// The guard itself: thresholds that differ from cell to cell tear patches apart, and that can be seen.
#[test]
fn thresholds_of_each_cell_would_tear_patches() {
    let scale: Scale = format().record().scales[0];
    let down = scale.down;
    assert!(Layout::FULL.acceleration && down > 2);
    let mut torn = 0;
    for v in 0..64 {
        let (mut one, mut other, mut apart) = (0, 0, false);
        for frame in 0..FRAMES {
            one = step_position(&scale, Rounding::LowDiscrepancy.threshold(frame, down), one, v, 1);
            other = step_position(&scale, Rounding::LowDiscrepancy.threshold(frame + 5, down), other, v, 1);
            apart |= snap(&scale, one) != snap(&scale, other);
        }
        torn += u32::from(apart);
    }
    assert!(torn > 0);
}
