//! A wall in the base, a ball before it in a layer: nothing that the ball hides is lost.

use galpix_core::fixed::types::I32F32;
use galpix_core::layers::{Layer, Layers, composite_words};
use galpix_core::{Bits, Controller, Demand, Dynamic, Galpixel, Galpixmap, Grid, Layout};
use galpix_core::{Margin, Scratch, Settings, scan_out};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bits = Bits::derive_without_acceleration(Demand { extent: 32, recog: 8, prop: 16 })?;
    let format = Dynamic::new(bits, Layout::VELOCITY565)?;
    let mut rows = [0; 4];
    let grid = Grid::new(32, 4, Margin::NONE, &mut rows)?;
    let words = Galpixmap::words(&grid, format);
    let mut memory = vec![0; 4 * words];
    let mut maps = memory.chunks_mut(words).map(|memory| Galpixmap::new(grid, format, memory));
    let mut next = || maps.next().expect("memory for four maps");
    let (mut wall, back, mut ball, ball_back) = (next()?, next()?, next()?, next()?);
    for (y, x) in (0..4).flat_map(|y| (0..32).map(move |x| (y, x))) {
        wall.store(x, y, &Galpixel { colour: [64; 3], depth: I32F32::lit("0.75"), ..Galpixel::default() });
        if (4..10).contains(&x) {
            let velocity = [I32F32::lit("2"), I32F32::ZERO, I32F32::ZERO];
            let depth = I32F32::lit("0.25");
            ball.store(x, y, &Galpixel { colour: [255; 3], depth, velocity, ..Galpixel::default() });
        }
    }
    let mut flags = vec![0; composite_words(&grid)];
    let mut hidden = [Layer::new(ball, ball_back, Scratch::default(), &mut flags)?];
    let mut layers = Layers::new(Controller::new(wall, back, Scratch::default())?, &mut hidden)?;
    for frame in 1..=6 {
        let tally = layers.step(&Settings::for_depth(16));
        let row = scan_out::row(layers.front(), 1).map(|word| if word > 0x8000 { '#' } else { '.' });
        let (row, ball) = (row.collect::<String>(), layers.hidden()[0].shown());
        println!("frame {frame}: {row}  {} holes, {ball} cells of the ball", tally.holes);
    }
    Ok(())
}
