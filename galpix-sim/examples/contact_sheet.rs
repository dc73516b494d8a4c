//! Writes one PNG that shows every built-in scene, a row each, at the update and at three later times up to its last
//! frame.
//!
//! `cargo run --release --example contact_sheet [FILE]`, by default `contact-sheet.png` in the current folder.

use galpix_sim::picture::Picture;
use galpix_sim::source::scene::{all, render};
use std::path::PathBuf;
use std::time::Instant;

const TIMES: usize = 4;
const GAP: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("contact-sheet.png"), PathBuf::from);
    let (width, height) = all().iter().fold((0, 0), |(w, h), scene| (scene.width().max(w), scene.height().max(h)));
    let (cell_width, cell_height) = (width + GAP, height + GAP);
    let mut sheet = Picture::filled(GAP + TIMES * cell_width, GAP + all().len() * cell_height, [32; 3]);
    let started = Instant::now();
    for (row, scene) in all().iter().enumerate() {
        println!("{:<11} {}", scene.name(), scene.about());
        for column in 0..TIMES {
            let t = f64::from(scene.frames()) * column as f64 / (TIMES - 1) as f64;
            paste(&mut sheet, &render(*scene, t), GAP + column * cell_width, GAP + row * cell_height);
        }
    }
    sheet.write_png(&path)?;
    println!("{} pictures in {:.1?}: {}", TIMES * all().len(), started.elapsed(), path.display());
    Ok(())
}

fn paste(sheet: &mut Picture, picture: &Picture, left: usize, top: usize) {
    for (y, row) in picture.pixels.chunks_exact(picture.width).enumerate() {
        sheet.pixels[(top + y) * sheet.width + left..][..picture.width].copy_from_slice(row);
    }
}
