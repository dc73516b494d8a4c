//! Instruments that stay where they are over a picture that moves (needs the feature `embedded-graphics`).

use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_5X8};
use embedded_graphics::pixelcolor::{Rgb565, RgbColor};
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use galpix_core::fixed::types::I32F32;
use galpix_core::overlay::{self, Overlay};
use galpix_core::{Bits, Controller, Demand, Dynamic, Galpixel, Galpixmap, Grid, Layout, Margin, Scratch, Settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 40, recog: 8, prop: 16 })?;
    let format = Dynamic::new(bits, Layout::VELOCITY565)?;
    let (mut rows, mut hud_rows, mut pinned) = ([0; 10], [0; 10], [0; 40 * 10]);
    let grid = Grid::new(40, 10, Margin::NONE, &mut rows)?;
    let mut memory = vec![0; 2 * Galpixmap::words(&grid, format)];
    let (front, back) = memory.split_at_mut(Galpixmap::words(&grid, format));
    let mut front = Galpixmap::new(grid, format, front)?;
    for (y, x) in (0..10).flat_map(|y| (0..40).map(move |x| (y, x))) {
        let level = if (x / 4) % 2 == 0 { 40 } else { 90 };
        let velocity = [I32F32::lit("0.5"), I32F32::ZERO, I32F32::ZERO];
        front.store(x, y, &Galpixel { colour: [level; 3], velocity, ..Galpixel::default() });
    }
    let mut controller = Controller::new(front, Galpixmap::new(grid, format, back)?, Scratch::default())?;

    let display = Grid::new(40, 10, Margin::NONE, &mut hud_rows)?;
    let mut hud = Overlay::new(display, Layout::VELOCITY565.colour, &mut pinned)?;
    let style = MonoTextStyle::new(&FONT_5X8, Rgb565::WHITE);
    Text::new("ALT 120", Point::new(2, 7), style).draw(&mut hud.canvas::<Rgb565>())?;

    controller.step(&Settings::for_depth(16));
    for y in 0..10 {
        let shade = |word: u32| if word == 0xffff { '#' } else { [' ', ':'][usize::from(word > 0x4000)] };
        println!("{}", overlay::row(controller.front(), &hud, y).map(shade).collect::<String>());
    }
    Ok(())
}
