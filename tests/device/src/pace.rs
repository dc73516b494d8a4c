//! How fast the boards are: frames, missed vsyncs, busy time and stack, at stated instructions a second.

use std::path::Path;
use std::time::{Duration, Instant};

use galpix_controller::scene;
use galpix_link::frame::Frame;

use crate::boards::{Board, Filling};
use crate::emulator::{Emulator, Pace};
use crate::failure::Failure;

/// Frames that are watched.
const fn frames(board: Board) -> u32 {
    match board {
        // Its emulator is some fifty times slower than QEMU.
        Board::Rp2040 => 24,
        Board::Lm3s6965evb | Board::VexpressA9 => 240,
    }
}

/// A speed of a processor: what the emulator is told, and millions of instructions a second, of cycles on the Pico.
type Speed = (Pace, f64);

/// Returns the speeds at which a program is measured: at the first one it is meant to miss nothing.
fn speeds(board: Board, clean: u32) -> Vec<Speed> {
    match board {
        // This emulator counts cycles, at the clock that the program sets.
        Board::Rp2040 => vec![(Pace::Free, 125.0)],
        Board::Lm3s6965evb | Board::VexpressA9 => {
            [clean, clean + 1].map(|shift| (Pace::Shift(shift), 1000.0 / f64::from(1 << shift))).to_vec()
        }
    }
}

/// Returns what a board is meant to reach at a pace: the longest frame takes at most so many million instructions (on
/// the Pico cycles) a second at its frames a second, and no vsync is missed if that is less than the pace.
const fn meant(board: Board, filling: Filling) -> (u32, f64) {
    match (board, filling) {
        (Board::Lm3s6965evb, Filling::FillMode) => (4, 55.0),
        (Board::Lm3s6965evb, Filling::PushPull) => (3, 130.0),
        (Board::Rp2040, _) => (0, 110.0),
        (Board::VexpressA9, Filling::FillMode) => (0, 1000.0),
        // The emulator has no faster one.
        (Board::VexpressA9, Filling::PushPull) => (0, 1600.0),
    }
}

/// Measures both boards.
pub fn run(firmware: &Path, boards: &[Board], check: bool) -> Result<(), Failure> {
    println!(
        "| board | million instructions a second | scene | frames a second | missed vsyncs | needed at full rate | stack |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (board, filling) in Board::programs(boards) {
        let (clean, most) = meant(board, filling);
        for (number, (pace, speed)) in speeds(board, clean).into_iter().enumerate() {
            let first = number == 0;
            let mut emulator = Emulator::start(board, filling, firmware, pace)?;
            for (number, scene) in (0..).zip(&scene::ALL) {
                emulator.line.send(&Frame::Scene { number })?;
                // What was late before, and the scene's first update, do not count.
                let begin = wait(&mut emulator, board, 8)?;
                let end = wait(&mut emulator, board, frames(board))?;
                let (frames, late) = (end.frame.wrapping_sub(begin.frame), end.late.wrapping_sub(begin.late));
                let rate = board.rate() * f64::from(frames) / f64::from(frames + late);
                // Of the time from a vsync to the next, at this speed.
                let needed = f64::from(end.busy) / f64::from(end.ticks) * speed;
                println!(
                    "| {}{} | {speed:.1} | {} | {rate:.1} | {late} | {needed:.1} | {} of {} |",
                    board.name(),
                    filling.suffix(),
                    scene.name,
                    end.stack_used,
                    end.stack
                );
                if check && first && (late > 0 && most <= speed || needed > most) {
                    return Err(Failure::new(format!(
                        "{}{}: {}: {late} vsyncs missed at {speed:.1} million instructions a second, {needed:.1} needed where \
                         {most:.0} are meant to do",
                        board.name(),
                        filling.suffix(),
                        scene.name
                    )));
                }
            }
        }
    }
    Ok(())
}

/// Waits until so many more frames have been shown: how the board is then, and how busy in the longest of them, for it
/// begins anew with each request.
fn wait(emulator: &mut Emulator, board: Board, frames: u32) -> Result<galpix_link::frame::Status, Failure> {
    // A frame that sends a Status does not count as busy: most of them must not.
    let pause = Duration::from_millis(if board == Board::Rp2040 { 1000 } else { 20 });
    let begin = emulator.line.status()?.frame;
    let (started, mut busy) = (Instant::now(), 0);
    loop {
        let status = emulator.line.status()?;
        busy = status.busy.max(busy);
        if status.frame.wrapping_sub(begin) >= frames {
            return Ok(galpix_link::frame::Status { busy, ..status });
        }
        if started.elapsed() > Duration::from_secs(120) {
            return Err(Failure::new(format!("frame {} is not left behind", status.frame)));
        }
        std::thread::sleep(pause);
    }
}
