//! The command line. Results go to standard output, progress and messages to standard error.

mod budget;
mod call;
mod check;
mod choices;
mod compare;
mod ddoc;
mod demo;
mod describe;
mod document;
mod drive;
mod error;
mod fills;
mod fit;
mod graft;
mod hidden;
mod init;
mod layers;
mod logic;
mod plan;
mod progress;
mod rtl;
mod run;
mod scenes;
mod schema;
mod send;
mod stability;
mod vectors;

use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};

use document::print_json;

use crate::source::Source;

/// The exit code after an interruption, that of shells.
const INTERRUPTED: i32 = 130;

/// Why a command failed.
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
    pub(crate) fn unusable(reason: impl ToString) -> Self {
        Self::Unusable(reason.to_string())
    }

    /// Returns the exit code of a command that fails like this.
    const fn code(&self) -> u8 {
        match self {
            Self::Unusable(_) => 2,
            Self::Failed(_) => 1,
        }
    }

    /// Creates a file or folder that cannot be written.
    fn unwritable(path: &std::path::Path, error: &std::io::Error) -> Self {
        Self::Unusable(format!("{} cannot be written ({error}): choose another folder with --out", path.display()))
    }
}

/// Pictures that keep moving between updates: a simulator of galpixmaps in fixed point.
#[derive(Debug, Parser)]
#[command(
    name = "galpix",
    version,
    max_term_width = 100,
    after_help = "Exit codes: 0 done, 2 unusable arguments or input, 1 anything else."
)]
struct Arguments {
    /// Say nothing on standard error but what went wrong
    #[arg(long, short, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs the built-in scenes and writes a report (this is what galpix does without a command)
    Demo(demo::Demo),
    /// Extrapolates one update of a scene or a capture, writes each frame and compares it with the truth
    Run(run::Run),
    /// Writes a capture.toml for a folder of files that has none
    Init(init::Init),
    /// Loads a source and says what was read: motion, depth, the first frame, all keys and notes
    Check(check::Check),
    /// Two runs side by side, as their JSON says: two budgets, two fills, two versions
    Compare(compare::Compare),
    /// Error against run time over budgets, fields, roundings and fill modes: tables, plots, the Pareto front
    Error(error::Error),
    /// Every fill side by side: what each makes of the cells that the warp leaves open, and at what cost
    Fills(fills::Fills),
    /// The strategies for hidden samples compared: samples, missing pixels, error, cost
    Layers(layers::LayersArguments),
    /// Objects updated at rates of their own against updates of the whole view, at the same number of cells a second
    Graft(graft::Graft),
    /// Depth images that look around edges: what a frame from another place lacks, compared with plain depth images
    Ddoc(ddoc::Ddoc),
    /// Prints every width of a bit budget, its bytes, and its certificate
    Budget(budget::Budget),
    /// Whether a map fits a chip and its panel: memory, code, instructions and frames a second of each layout and fill
    Fit(fit::Fit),
    /// Says what a source does not need for a position error: fields, bits, rounding, fill mode
    Plan(plan::PlanArguments),
    /// Runs the stiff and extreme suite: errors by cause, and whether anything wraps or grows
    Stability(stability::Stability),
    /// Streams a scene or a capture as galpixels to a display controller
    Send(send::Send),
    /// Prints the JSON schema of what a command prints with --json
    Schema(schema::Schema),
    /// Lists the built-in scenes and what each of them stresses
    Scenes(scenes::Scenes),
    /// Writes golden vectors for other implementations and for test benches in logic
    Vectors(vectors::Vectors),
    /// Writes a budget as parameters of the reference design in logic
    Rtl(rtl::Rtl),
    /// Prints the completions of a shell
    Completions(describe::Completions),
    /// Prints the manual page, or writes one for each command
    Man(describe::Man),
}

/// Parses the arguments, runs the command, and returns how it ended.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return unparsed(&error),
    };
    // Where signals cannot be handled, what they leave is removed by the next run.
    let _ = ctrlc::set_handler(|| crate::output::save::leave(INTERRUPTED));
    QUIET.store(arguments.quiet, Ordering::Relaxed);
    let result = match arguments.command.unwrap_or(Command::Demo(demo::Demo::default())) {
        Command::Demo(demo) => demo.run(),
        Command::Run(run) => run.run(),
        Command::Init(init) => init.run(),
        Command::Check(check) => check.run(),
        Command::Compare(compare) => compare.run(),
        Command::Error(error) => error.run(),
        Command::Fills(fills) => fills.run(),
        Command::Layers(layers) => layers.run(),
        Command::Graft(graft) => graft.run(),
        Command::Ddoc(ddoc) => ddoc.run(),
        Command::Budget(budget) => budget.run(),
        Command::Fit(fit) => fit.run(),
        Command::Plan(plan) => plan.run(),
        Command::Stability(stability) => stability.run(),
        Command::Send(send) => send.run(),
        Command::Schema(schema) => schema.run(),
        Command::Scenes(scenes) => scenes.run(),
        Command::Vectors(vectors) => vectors.run(),
        Command::Rtl(rtl) => rtl.run(),
        Command::Completions(completions) => completions.run(),
        Command::Man(man) => man.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&error),
    }
}

/// Says what went wrong, on standard error, and with `--json` as a document on standard output too.
fn failed(error: &CliError) -> ExitCode {
    complain(&format!("galpix: {error}"));
    if std::env::args_os().any(|argument| argument == "--json") {
        // Where standard output takes nothing, the sentence and the exit code are left.
        let _ = document::print_error(error);
    }
    ExitCode::from(error.code())
}

/// Prints help or version if requested, or why the arguments cannot be used, in one sentence.
fn unparsed(error: &clap::Error) -> ExitCode {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        return match printed(error.print()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => failed(&error),
        };
    }
    let text = error.to_string();
    let reason: Vec<&str> = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more information"))
        .filter(|line| !line.is_empty())
        .collect();
    let reason = reason.join(" ");
    let reason = printable(reason.trim_start_matches("error: "));
    let reason = PLAIN.iter().fold(reason, |reason, (rust, plain)| reason.replace(rust, plain));
    failed(&CliError::Unusable(format!("{reason}; `--help` lists what can be given")))
}

/// What Rust says of numbers that cannot be read, and what that means.
const PLAIN: [(&str, &str); 4] = [
    ("invalid digit found in string", "give a whole number, not below 0"),
    ("cannot parse integer from empty string", "give a whole number"),
    ("number too large to fit in target type", "that is too large"),
    ("number too small to fit in target type", "that is too small"),
];

/// Whether nothing is said on standard error but what went wrong.
static QUIET: AtomicBool = AtomicBool::new(false);
/// Writes what is noteworthy of a capture on standard error: after what may refuse it, which is one sentence alone.
fn remark(source: &Source) {
    remarks(source).iter().for_each(|text| note(text));
}

/// Returns what is noteworthy of a capture, line by line.
fn remarks(source: &Source) -> Vec<String> {
    let notes = source.census().map(|census| census.notes.as_slice()).unwrap_or_default();
    notes.iter().map(|text| format!("{}: note: {}", printable(source.name()), printable(text))).collect()
}

/// Writes a line on standard error. A reader that has gone away is no failure.
fn complain(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

/// Writes a line on standard error, unless that is to be quiet.
fn note(text: &str) {
    if !quiet() {
        complain(text);
    }
}

fn quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Returns a text from outside without the characters that command a terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// Returns the same for a text of several lines.
fn printable_lines(text: &str) -> String {
    text.lines().map(printable).collect::<Vec<_>>().join("\n")
}

/// Prints a line, or several, on standard output. A reader that has gone away is no failure.
fn print(text: &str) -> Result<(), CliError> {
    printed(writeln!(io::stdout(), "{text}"))
}

/// Returns how it ended that something was written to standard output.
fn printed(result: io::Result<()>) -> Result<(), CliError> {
    match result.and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::Failed(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}
