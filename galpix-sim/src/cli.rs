//! The command line. Results go to standard output, progress and messages to standard error.

mod budget;
mod choices;
mod demo;
mod run;
mod scenes;

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Why a command did not do what it was asked.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// Arguments or input that cannot be used: exit code 2.
    #[error("{0}")]
    Unusable(String),
    /// Anything else: exit code 1.
    #[error("{0}")]
    Failed(String),
}

impl CliError {
    /// Input that cannot be used.
    fn unusable(reason: impl ToString) -> Self {
        Self::Unusable(reason.to_string())
    }

    /// A file or folder that cannot be written.
    fn unwritable(path: &std::path::Path, error: &std::io::Error) -> Self {
        Self::Unusable(format!("{} cannot be written ({error}): choose another folder with --out", path.display()))
    }
}

/// Pictures that keep moving between updates: a simulator of galpixmaps in fixed point.
#[derive(Debug, Parser)]
#[command(name = "galpix", version, about, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs the built-in scenes and writes a report (this is what galpix does without a command)
    Demo(demo::Demo),
    /// Extrapolates one update of a scene or a capture, writes each frame and compares it with the truth
    Run(run::Run),
    /// Prints every width of a bit budget, its bytes, and its certificate
    Budget(budget::Budget),
    /// Lists the built-in scenes and what each of them stresses
    Scenes(scenes::Scenes),
}

/// Parses the arguments, does what they say, and tells how it ended.
#[must_use]
pub fn main() -> ExitCode {
    let command = Arguments::parse().command.unwrap_or(Command::Demo(demo::Demo::default()));
    let result = match command {
        Command::Demo(demo) => demo.run(),
        Command::Run(run) => run.run(),
        Command::Budget(budget) => budget.run(),
        Command::Scenes(scenes) => scenes.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("galpix: {error}");
            ExitCode::from(if matches!(error, CliError::Unusable(_)) { 2 } else { 1 })
        }
    }
}

/// Prints a line, or several, on standard output. A reader that has gone away is no failure.
fn print(text: &str) -> Result<(), CliError> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(CliError::Failed(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints one JSON document on standard output.
fn print_json(value: &impl serde::Serialize) -> Result<(), CliError> {
    let text = serde_json::to_string_pretty(value).map_err(|error| CliError::Failed(error.to_string()))?;
    print(&text)
}
