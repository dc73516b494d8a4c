//! The firmware in an emulator, compared with the simulator.
//!
//! Each command starts the boards' programs in QEMU, talks to them over their serial lines as any host does, and looks
//! at their emulated screens. `firmware/test.sh` builds the programs and calls this.

mod boards;
mod emulator;
mod expected;
mod failure;
mod faults;
mod film;
mod line;
mod pace;
mod screens;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use boards::Board;
use failure::Failure;

/// The firmware in an emulator, compared with the simulator.
#[derive(Debug, Parser)]
#[command(name = "device", max_term_width = 100)]
struct Arguments {
    /// The firmware's workspace, in which the boards have been built with `--release`
    #[arg(long, default_value = "firmware")]
    firmware: PathBuf,
    /// Only this board, which may be given again [default: all]
    #[arg(long = "board", value_enum, value_name = "BOARD", global = true)]
    boards: Vec<Board>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compares every pixel of the emulated screens with the simulator, and both with the kept hashes
    Screens {
        /// Frames of each scene
        #[arg(long, default_value_t = 32)]
        frames: u32,
        /// Keeps the hashes of this run instead of comparing with the kept ones
        #[arg(long)]
        write: bool,
    },
    /// Sends random and corrupted frames: the picture must go on, and every refusal be counted
    Faults {
        /// Frames to send
        #[arg(long, default_value_t = 10_000)]
        count: u32,
    },
    /// Frame rate, missed vsyncs, busy time and stack at stated instructions a second
    Pace {
        /// Fails if a figure is worse than what the boards are meant to reach
        #[arg(long)]
        check: bool,
    },
    /// Makes the films of both panels for firmware/README.md
    Film {
        /// Frames of each scene
        #[arg(long, default_value_t = 48)]
        frames: u32,
    },
}

fn main() -> ExitCode {
    let Arguments { firmware, boards, command } = Arguments::parse();
    let boards = if boards.is_empty() { Board::ALL.to_vec() } else { boards };
    let result = match command {
        Command::Screens { frames, write } => screens::run(&firmware, &boards, frames, write),
        Command::Faults { count } => faults::run(&firmware, &boards, count),
        Command::Pace { check } => pace::run(&firmware, &boards, check),
        Command::Film { frames } => film::run(&firmware, frames),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure(reason)) => {
            eprintln!("device: {reason}");
            ExitCode::FAILURE
        }
    }
}
