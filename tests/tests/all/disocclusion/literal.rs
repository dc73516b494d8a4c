//! What the algorithms as printed miss.

use galpix_core::Galpixmap;
use galpix_core::disocclusion::{Border, Extents, Reach, mark};
use galpix_core::record::Component;
use galpix_tests::layouts::TINY_DEEP_SLIDE;
use galpix_tests::profiles::dynamic;

use super::printed::{self, Layer, Owner};
use super::tiny::{CELLS, Memory, SIDE, Scene, State, bits, uncovered, with_grid};

/// Whole cells per frame, from -4 to 3.
const WHOLE: Component =
    Component { position_frac: 0, velocity_int: 3, velocity_frac: 0, acceleration_int: 0, acceleration_frac: 0 };

fn mask(extents: &[printed::Extents]) -> u16 {
    extents.iter().enumerate().map(|(cell, extents)| u16::from(extents.iter().any(|&e| e > 0)) << cell).sum()
}

/// The cells that a near surface uncovers in one frame, over maps and all motions of up to 3 cells before a still one;
/// and how many of them are missed by the printed algorithms; by these with the extents at the nearer cell; by the
/// printed spreading of our own sources; by ours.
#[test]
fn printed_algorithms_miss_what_ours_cover() {
    let format = dynamic(TINY_DEEP_SLIDE, bits(WHOLE));
    let (mut total, mut missed, mut covered) = (0, [0; 4], [0; 4]);
    let mut smallest: Option<([i32; 3], u16, u16)> = None;
    for velocity in (-3..=3).flat_map(|y| (-3..=3).map(move |x| [x, y])) {
        let scene = Scene { format, near: State { velocity, ..State::default() }, far: State::default() };
        let words = scene.words();
        let mut memory = Memory::new();
        with_grid(|grid| {
            // A quarter of the maps, another one for each velocity, and all small ones.
            let turn = (velocity[0] + 8 * velocity[1]) as u32;
            let some = (0..=u16::MAX).filter(|&near| {
                near.count_ones() < 4 || u32::from(near).wrapping_add(turn).wrapping_mul(0x9e37_79b1) >> 30 == 0
            });
            for near in some {
                let open = uncovered(near, [velocity, [0, 0]], Border::Continues);
                let cells = (0..CELLS).map(|cell| if near >> cell & 1 == 1 { (0, velocity) } else { (1, [0, 0]) });
                let layer = Layer { width: SIDE, height: SIDE, cells: cells.collect() };
                let reach = Reach { frames: 1, separation: 1, border: Border::Continues, tears: true, through: false };
                let (ours, _) = memory.covered(grid, format, words, near, &reach);
                let map = Galpixmap::over(grid, format, &mut memory.map).unwrap();
                mark(&map, &mut memory.extents, &reach);
                let sources = memory.extents.map(|word| {
                    let Extents { left, right, above, below } = Extents::of(word);
                    [left, right, below, above].map(i32::from)
                });
                let printed = [
                    mask(&printed::spread(SIDE, SIDE, &layer.initialised(Owner::Current))),
                    mask(&printed::spread(SIDE, SIDE, &layer.initialised(Owner::Nearer))),
                    mask(&printed::spread(SIDE, SIDE, &sources)),
                    ours,
                ];
                total += open.count_ones();
                for ((missed, covered), by) in missed.iter_mut().zip(&mut covered).zip(printed) {
                    *missed += (open & !by).count_ones();
                    *covered += by.count_ones();
                }
                let size = [velocity[0].abs() + velocity[1].abs(), near.count_ones() as i32, velocity[1]];
                if open & !printed[2] != 0 && smallest.is_none_or(|(other, ..)| size < other) {
                    smallest = Some((size, near, open & !printed[2]));
                }
            }
        });
    }
    println!("{total} cells are uncovered");
    let names = ["as printed", "extents at the nearer cell", "our sources, printed spreading", "ours"];
    for ((name, missed), covered) in names.into_iter().zip(missed).zip(covered) {
        println!("{name}: {missed} missed, {covered} covered");
    }
    println!("smallest that the printed spreading misses: {smallest:x?}");
    assert_eq!(missed[3], 0);
    assert!(missed[..3].iter().all(|&missed| missed > 0), "{missed:?}");
}
