//! A board's program in an emulator: its screen, its serial line, its clock.

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use galpix_sim::picture::Picture;
use galpix_sim::source::capture;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::boards::{Board, Filling};
use crate::failure::Failure;
use crate::line::Line;

/// How long the emulator may take to do something.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running board.
pub struct Emulator {
    board: Board,
    child: Process,
    folder: TempDir,
    commands: BufReader<UnixStream>,
    /// The serial line.
    pub line: Line,
}

/// How fast its processor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// As fast as the host can.
    Free,
    /// An instruction takes 2 to this power nanoseconds, exactly.
    Shift(u32),
}

impl Emulator {
    /// Starts the program of a board.
    ///
    /// *Errors:* no program, no emulator, or one that does not answer.
    pub fn start(board: Board, filling: Filling, firmware: &Path, pace: Pace) -> Result<Self, Failure> {
        let program = board.program(firmware, filling);
        if !program.is_file() {
            return Err(Failure::new(format!(
                "{} is missing: build the firmware first, with `firmware/test.sh build`",
                program.display()
            )));
        }
        let folder = tempfile::tempdir()?;
        let (monitor, serial) = (folder.path().join("qmp"), folder.path().join("serial"));
        let listener = UnixListener::bind(&monitor)?;
        let serial_listener = UnixListener::bind(&serial)?;
        let mut command = match board {
            Board::Rp2040 => pico(firmware, &program, &monitor, &serial),
            Board::Lm3s6965evb | Board::VexpressA9 => qemu(board, &program, &monitor, &serial),
        };
        if let Pace::Shift(shift) = pace {
            command.arg("-icount").arg(format!("shift={shift},sleep=off"));
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let name = command.get_program().to_string_lossy().into_owned();
        let child = command
            .spawn()
            .map_err(|error| Failure::new(format!("{name} cannot be started ({error}): install {name}")))?;
        let mut child = Process(child);
        let serial = accept(&serial_listener, &mut child, board)?;
        let commands = accept(&listener, &mut child, board)?;
        let mut emulator =
            Self { board, child, folder, commands: BufReader::new(commands), line: Line::new(serial, board) };
        emulator.read_line()?;
        emulator.command(&json!({ "execute": "qmp_capabilities" }))?;
        emulator.line.greet()?;
        Ok(emulator)
    }

    fn read_line(&mut self) -> Result<Value, Failure> {
        let mut line = String::new();
        if self.commands.read_line(&mut line)? == 0 {
            return Err(Failure::new(format!("{}: the emulator has ended", self.board.name())));
        }
        serde_json::from_str(&line)
            .map_err(|error| Failure::new(format!("the emulator's answer is no JSON ({error}): {line}")))
    }

    fn command(&mut self, command: &Value) -> Result<(), Failure> {
        writeln!(self.commands.get_mut(), "{command}")?;
        loop {
            let answer = self.read_line()?;
            if answer.get("return").is_some() {
                return Ok(());
            }
            if let Some(error) = answer.get("error") {
                return Err(Failure::new(format!("the emulator refuses {command}: {error}")));
            }
        }
    }

    /// Returns what its panel shows.
    pub fn screen(&mut self) -> Result<Picture, Failure> {
        let file = self.folder.path().join("screen.png");
        self.command(&json!({
            "execute": "screendump",
            "arguments": { "filename": file.display().to_string(), "format": "png" }
        }))?;
        let screen = capture::picture(&file)
            .map_err(|error| Failure::new(format!("the emulator's screen cannot be read: {error}")))?;
        self.board.pixels(&screen)
    }

    /// Returns whether the program still runs.
    pub fn runs(&mut self) -> bool {
        matches!(self.child.0.try_wait(), Ok(None))
    }
}

/// Returns the command that runs a program in QEMU.
fn qemu(board: Board, program: &Path, monitor: &Path, serial: &Path) -> Command {
    let mut command = Command::new("qemu-system-arm");
    command
        .args(["-M", board.name(), "-display", "none", "-monitor", "none"])
        .args(["-semihosting-config", "enable=on,target=native"])
        .args(["-audiodev", "none,id=snd"])
        .arg("-qmp")
        .arg(format!("unix:{}", monitor.display()))
        .arg("-chardev")
        .arg(format!("socket,id=line,path={}", serial.display()))
        .args(["-serial", "chardev:line"])
        .arg("-kernel")
        .arg(program);
    command
}

/// Returns the command that runs a program on an emulated Pico, which has a monitor like QEMU's.
fn pico(firmware: &Path, program: &Path, monitor: &Path, serial: &Path) -> Command {
    let mut command = Command::new("node");
    command.arg(firmware.join("emulators/rp2040/run.mjs")).arg(program);
    command.arg("--serial").arg(serial).arg("--monitor").arg(monitor);
    command
}

/// A process that ends with its owner.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits until the emulator connects.
fn accept(listener: &UnixListener, emulator: &mut Process, board: Board) -> Result<UnixStream, Failure> {
    listener.set_nonblocking(true)?;
    let begin = Instant::now();
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                return Ok(stream);
            }
            Err(_) if begin.elapsed() < PATIENCE => {
                if let Ok(Some(status)) = emulator.0.try_wait() {
                    return Err(Failure::new(format!("{}: the emulator ended at once, {status}", board.name())));
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            Err(error) => return Err(error.into()),
        }
    }
}
