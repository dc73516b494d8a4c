//! Push-pull fills what a box uncovers of a gradient: `cargo run -p galpix-bench --bin inpainting`.

use galpix_core::fixed::types::I32F32;
use galpix_core::inpaint::{Gamma, Inpainting, Motion, PushPull};
use galpix_core::{Bits, Class, Controller, Demand, Dynamic, FillMode, Galpixel, Galpixmap, Grid, Layout};
use galpix_core::{Margin, Scratch, Settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 32, recog: 8, prop: 16 })?;
    let format = Dynamic::new(bits, Layout::VELOCITY_GRAY8)?;
    let (mut rows, mut winners, mut edges) = ([0; 8], [0; 32 * 8], [0; 8]);
    let grid = Grid::new(32, 8, Margin::NONE, &mut rows)?;
    let mut memory = vec![0; 2 * Galpixmap::words(&grid, format)];
    let (front, back) = memory.split_at_mut(Galpixmap::words(&grid, format));
    let mut front = Galpixmap::new(grid, format, front)?;
    for (y, x) in (0..8).flat_map(|y| (0..32).map(move |x| (y, x))) {
        let wall = Galpixel { colour: [7 * x as u8; 3], depth: I32F32::lit("0.75"), ..Galpixel::default() };
        let velocity = [I32F32::lit("3"), I32F32::ZERO, I32F32::ZERO];
        let moving = Galpixel { colour: [255; 3], depth: I32F32::lit("0.25"), velocity, ..Galpixel::default() };
        let in_box = (6..18).contains(&x) && (2..6).contains(&y);
        front.store(x, y, if in_box { &moving } else { &wall });
    }
    let back = Galpixmap::new(grid, format, back)?;
    let mut controller = Controller::new(front, back, Scratch { winners: &mut winners, edges: &mut edges })?;
    let mut memory = [0; PushPull::words(32, 8, Motion::Kept)];
    let mut push_pull = PushPull::new(32, 8, Motion::Kept, &mut memory)?;
    let shade = |galpixel: Galpixel| char::from(b"0123456789abcde#"[usize::from(galpixel.colour[0] / 16)]);
    let settings = Settings { fill_mode: FillMode::Extend, ..Settings::for_depth(8) };
    controller.step(&settings);
    let hole = |galpixel: Galpixel| if galpixel.class == Class::JustUnobscured { '?' } else { shade(galpixel) };
    let row = |y| (0..32).filter_map(|x| controller.front().load(x, y)).map(hole).collect::<String>();
    let before: Vec<String> = (0..8).map(row).collect();
    let filled = controller.inpaint(&settings, &Inpainting::for_depth(8, Gamma::Half), &mut push_pull);
    for (before, y) in before.iter().zip(0..) {
        let row = (0..32).filter_map(|x| controller.front().load(x, y)).map(shade).collect::<String>();
        println!("{before}  {row}");
    }
    println!("{filled} pixels filled");
    Ok(())
}
