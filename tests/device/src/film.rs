//! Films of both panels, for the firmware's README.

use std::path::Path;

use galpix_controller::scene;
use galpix_link::frame::Frame;
use galpix_sim::output::film::{apng_within, side_by_side};
use galpix_sim::picture::Picture;

use crate::boards::{Board, Filling};
use crate::emulator::{Emulator, Pace};
use crate::failure::Failure;
use crate::screens::lockstep;

/// The largest film.
const MOST_BYTES: usize = 1_500_000;

/// Captures `frames` frames of each scene on both panels and makes one film of them.
pub fn run(firmware: &Path, frames: u32) -> Result<(), Failure> {
    let mut shots: Vec<Vec<Picture>> = Vec::new();
    for board in [Board::Lm3s6965evb, Board::VexpressA9] {
        let mut emulator = Emulator::start(board, Filling::FillMode, firmware, Pace::Free)?;
        lockstep(&mut emulator)?;
        let mut of_board = Vec::new();
        for number in 0..scene::ALL.len() as u8 {
            emulator.line.send(&Frame::Scene { number })?;
            for frame in 0..frames * 2 {
                emulator.line.send(&Frame::Go)?;
                emulator.line.shown()?;
                // Every second frame: a film of 30 a second.
                if frame % 2 == 0 {
                    let screen = emulator.screen()?;
                    of_board.push(if board == Board::Lm3s6965evb { doubled(&screen) } else { screen });
                }
            }
        }
        shots.push(of_board);
    }
    let film: Vec<Picture> = (0..shots[0].len())
        .map(|index| side_by_side(&shots.iter().map(|of_board| &of_board[index]).collect::<Vec<_>>(), 8))
        .collect();
    let (bytes, _) = apng_within(&film, 33, MOST_BYTES).map_err(|error| Failure::new(error.to_string()))?;
    let file = firmware.join("panels.png");
    std::fs::write(&file, bytes)
        .map_err(|error| Failure::new(format!("{} cannot be written: {error}", file.display())))?;
    println!("{}", file.display());
    Ok(())
}

/// Twice as large.
fn doubled(picture: &Picture) -> Picture {
    let (width, height) = (picture.width * 2, picture.height * 2);
    let pixels = (0..width * height).map(|at| picture.at(at % width / 2, at / width / 2)).collect();
    Picture { width, height, pixels }
}
