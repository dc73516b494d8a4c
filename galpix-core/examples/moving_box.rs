//! A box that moves between two updates: `cargo run -p galpix-core --example moving_box`.

use galpix_core::fixed::types::I32F32;
use galpix_core::{Bits, Controller, Demand, Galpixel, Galpixmap, Grid, Layout};
use galpix_core::{Margin, Profile, Scratch, Settings, SetupError, Static, scan_out};

/// A panel of 32 x 8 pixels, recognition in 8 frames, an update every 16.
struct Panel;
impl Profile for Panel {
    const LAYOUT: Layout = Layout::VELOCITY_GRAY4;
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 32, recog: 8, prop: 16 }));
}
const CELLS: usize = 32 * 8;
const WORDS: usize = CELLS * Static::<Panel>::RECORD.words();

fn main() -> Result<(), SetupError> {
    let (mut rows, mut front, mut back) = ([0; 8], [0; WORDS], [0; WORDS]);
    let (mut winners, mut edges) = ([0; CELLS], [0; CELLS / 32]);
    let grid = Grid::new(32, 8, Margin::NONE, &mut rows)?;
    let mut front = Galpixmap::new(grid, Static::<Panel>::new(), &mut front)?;
    for (y, x) in (0..8).flat_map(|y| (0..32).map(move |x| (y, x))) {
        let in_box = (2..8).contains(&x) && (2..6).contains(&y);
        let moving = Galpixel {
            colour: [255; 3],
            depth: I32F32::lit("0.25"),
            velocity: [I32F32::lit("1.5"), I32F32::ZERO, I32F32::ZERO],
            ..Galpixel::default()
        };
        let still = Galpixel { colour: [64; 3], depth: I32F32::lit("0.75"), ..Galpixel::default() };
        front.store(x, y, if in_box { &moving } else { &still });
    }
    let back = Galpixmap::new(grid, Static::<Panel>::new(), &mut back)?;
    let mut controller = Controller::new(front, back, Scratch { winners: &mut winners, edges: &mut edges })?;
    for frame in 1..=8 {
        let tally = controller.step(&Settings::for_depth(4));
        let row = scan_out::row(controller.front(), 4).map(|gray| if gray > 8 { '#' } else { '.' });
        println!("frame {frame}: {}  {} holes", row.collect::<String>(), tally.holes);
    }
    Ok(())
}
