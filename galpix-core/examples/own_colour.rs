//! A colour format of one's own: RGB332 with shading inertia. `cargo run -p galpix-core --example own_colour`.

use galpix_core::fixed::types::I32F32;
use galpix_core::{
    Bits, Colour, Controller, Demand, Dynamic, Galpixel, Galpixmap, Grid, Layout, Margin, Scratch, Settings,
};

const RGB332: Colour = Colour::must(Colour::rgb(3, 3, 2));

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let layout = Layout { colour: RGB332, velocity: true, luminosity: true, ..Layout::STILL };
    let format = Dynamic::new(Bits::derive_without_acceleration(Demand { extent: 16, recog: 8, prop: 16 })?, layout)?;
    let (mut rows, mut starts) = ([0; 1], Vec::new());
    let grid = Grid::new(16, 1, Margin::NONE, &mut rows)?;
    let words = Galpixmap::words(&grid, format);
    starts.resize(2 * words, 0);
    let (front, back) = starts.split_at_mut(words);
    let mut front = Galpixmap::new(grid, format, front)?;
    // Red that moves right by a cell a frame and brightens by eight code values per frame.
    front.store(
        0,
        0,
        &Galpixel {
            colour: [96, 0, 0],
            velocity: [I32F32::ONE, I32F32::ZERO, I32F32::ZERO],
            luminosity_rate: I32F32::lit("8"),
            ..Galpixel::default()
        },
    );
    let mut controller = Controller::new(front, Galpixmap::new(grid, format, back)?, Scratch::default())?;
    for frame in 1..=12 {
        controller.step(&Settings::for_depth(0));
        println!("frame {frame:>2}: {:?}", controller.front().rgb888(frame, 0).unwrap_or_default());
    }
    Ok(())
}
