//! What is checked of the firmware on the host. `firmware/test.sh` builds and runs what is read here.
//!
//! ```text
//! galpix-check cost [--write] [RUN.csv...]    counted instructions beside firmware/cost.csv
//! galpix-check machine-code ELF [NAME...]     what the functions of these names reach
//! galpix-check size ELF...                    what programs take of flash and RAM
//! galpix-check text [--write] ELF...          bytes of a frame's code by layout, beside firmware/text.csv
//! ```
//!
//! Without files `cost` reads standard input; without names `machine-code` takes those that begin with `proof_`.
//!
//! Ends with 1 where something is not as it must be, with 2 where it could not be looked at.

mod cost;
mod machine_code;
mod size;
mod text;

use std::process::ExitCode;

/// What a command found, as lines to print.
#[derive(Debug, Default)]
struct Findings {
    /// For standard output.
    report: String,
    /// What is not as it must be.
    faults: Vec<String>,
}

const USAGE: &str = "usage: galpix-check cost [--write] [RUN.csv...]\n       galpix-check machine-code ELF [NAME...]\n       galpix-check size ELF...\n       galpix-check text [--write] ELF...";

fn run(arguments: &[&str]) -> Result<Findings, String> {
    match arguments {
        ["cost", "--write", files @ ..] => cost::run(files, true),
        ["cost", files @ ..] => cost::run(files, false),
        ["size", files @ ..] => size::run(files),
        ["text", "--write", files @ ..] => text::run(files, true),
        ["text", files @ ..] => text::run(files, false),
        ["machine-code", file, names @ ..] => machine_code::run(file, names),
        _ => Err(USAGE.to_owned()),
    }
}

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    match run(&arguments) {
        Ok(Findings { report, faults }) => {
            print!("{report}");
            for fault in &faults {
                eprintln!("{fault}");
            }
            if faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}
