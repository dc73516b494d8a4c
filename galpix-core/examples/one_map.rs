//! One map in static memory and a window of rows in place of a second map: `cargo run -p galpix-core --example
//! one_map`.

use galpix_core::fixed::types::I32F32;
use galpix_core::rolling::{Rolling, rows};
use galpix_core::{
    Bits, Demand, Galpixel, Galpixmap, Grid, Layout, Margin, Profile, Scratch, Settings, SetupError, Static,
};

struct Panel;
impl Profile for Panel {
    const LAYOUT: Layout = Layout::VELOCITY_GRAY4;
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(Demand { extent: 128, recog: 16, prop: 16 }));
}
const WIDTH: u32 = 128;
const HEIGHT: u32 = 64;
/// Rows that galpixels reach in a frame, and those whose holes are not filled yet.
const WINDOW: u32 = rows(&Static::<Panel>::RECORD, 1);
const WORDS: usize = Static::<Panel>::RECORD.words() * WIDTH as usize;

fn main() -> Result<(), SetupError> {
    // On a board these are `static`s that a cell type hands out once.
    let (mut starts, mut window_starts) = ([0; HEIGHT as usize], [0; HEIGHT as usize]);
    let (mut map, mut window) = ([0; WORDS * HEIGHT as usize], [0; WORDS * WINDOW as usize]);
    let (mut winners, mut edges) = ([0; (WIDTH * WINDOW) as usize], [0; (WIDTH * HEIGHT / 32) as usize]);
    let bytes = 4 * (map.len() + window.len() + winners.len() + edges.len());
    let grid = Grid::new(WIDTH, HEIGHT, Margin::NONE, &mut starts)?;
    let part = Grid::window(&grid, WINDOW, &mut window_starts)?;
    let mut map = Galpixmap::new(grid, Static::<Panel>::new(), &mut map)?;
    let velocity = [I32F32::lit("1.25"), I32F32::lit("0.5"), I32F32::ZERO];
    map.store(10, 10, &Galpixel { colour: [255; 3], velocity, ..Galpixel::default() });
    let window = Galpixmap::new(part, Static::<Panel>::new(), &mut window)?;
    let mut rolling = Rolling::new(map, window, Scratch { winners: &mut winners, edges: &mut edges })?;
    for _ in 0..16 {
        rolling.step(&Settings::for_depth(4));
    }
    println!("{bytes} bytes; at (30, 18): {:?}", rolling.map().rgb888(30, 18));
    Ok(())
}
