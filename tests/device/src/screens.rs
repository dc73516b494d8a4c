//! Every pixel of the emulated screens against the simulator.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use galpix_controller::scene;
use galpix_core::Class;
use galpix_link::frame::{Frame, Galpixels, NO_SCENE};
use galpix_sim::send::pack;
use galpix_sim::source::{fit, scene as sources};

use crate::boards::Board;
use crate::emulator::{Emulator, Pace};
use crate::expected::{self, Shows};
use crate::failure::Failure;

/// Where the hashes are kept, in the firmware's folder.
const KEPT: &str = "hashes.txt";

/// The simulator's scene that is sent, and what it is called among the hashes.
const SENT: (&str, &str) = ("crossing", "sent-crossing");

/// The number of its update, and the tag of its galpixels.
const UPDATE: u16 = 1;

/// Hashes of pictures: by board, scene and frame.
type Hashes = BTreeMap<(String, String, u32), u32>;

/// Rows of it that are sent.
const ROWS_SENT: usize = 64;

/// Compares `frames` frames of each built-in scene, and of one that is sent over the line, on each board with either
/// filling.
pub fn run(firmware: &Path, boards: &[Board], frames: u32, write: bool) -> Result<(), Failure> {
    let mut hashes = Hashes::new();
    for (board, filling) in Board::programs(boards) {
        let named = |scene: &str| format!("{scene}{}", filling.suffix());
        let mut emulator = Emulator::start(board, filling, firmware, Pace::Free)?;
        lockstep(&mut emulator)?;
        for (number, scene) in (0..).zip(&scene::ALL) {
            // The overlay in every second scene: it must neither be missing nor leave anything behind.
            let overlay = number % 2 == 1;
            align(&mut emulator, board)?;
            emulator.line.send(&Frame::Overlay { on: overlay })?;
            emulator.line.send(&Frame::Scene { number })?;
            let first = emulator.line.status()?.frame;
            let expected = expected::frames((board, filling), Shows::Scene(number), first, frames, overlay)?;
            for (age, expected) in (1..).zip(&expected) {
                compare(&mut emulator, board, &named(scene.name), expected)?;
                hashes.insert((board.name().into(), named(scene.name), age), expected.hash);
            }
            println!("{}: {}: {frames} frames, 0 pixels differ", board.name(), named(scene.name));
        }
        align(&mut emulator, board)?;
        let (first, words) = sent(&mut emulator, board)?;
        for (age, expected) in
            (1..).zip(&expected::frames((board, filling), Shows::Sent(&words), first, frames, false)?)
        {
            compare(&mut emulator, board, &named(SENT.1), expected)?;
            hashes.insert((board.name().into(), named(SENT.1), age), expected.hash);
        }
        println!("{}: {}: {frames} frames, 0 pixels differ", board.name(), named(SENT.1));
    }
    keep(firmware, boards, hashes, write)
}

/// Sends an update that is exact at the frame which the board shows: that frame, and all words of each galpixel, row by
/// row.
fn sent(emulator: &mut Emulator, board: Board) -> Result<(u32, Vec<u32>), Failure> {
    let panel = board.panel();
    let source = sources::find(SENT.0).ok_or_else(|| Failure::new(format!("there is no scene {}", SENT.0)))?;
    let mut galpixels = fit::scene(source, 0.0, panel.width.into(), panel.height.into());
    for (cell, galpixel) in galpixels.iter_mut().enumerate() {
        galpixel.tag = UPDATE.into();
        // Of a large picture the upper part: the emulated line is slow. The rest stays empty, on both sides.
        if cell >= usize::from(panel.width) * ROWS_SENT {
            galpixel.class = Class::Empty;
        }
    }
    let packed = pack(&panel, &galpixels).map_err(|error| Failure::new(error.to_string()))?;
    emulator.line.send(&Frame::Overlay { on: false })?;
    emulator.line.send(&Frame::Scene { number: NO_SCENE })?;
    let before = emulator.line.status()?;
    let most = panel.galpixels_per_frame();
    let mut count = 0;
    for (y, row) in (0..).zip(packed.rows(&panel).take(ROWS_SENT)) {
        for (x, words) in (0..).step_by(most).zip(row.chunks(most * panel.bytes_per_galpixel())) {
            let (update, stamp, fingerprint) = (UPDATE, before.frame, panel.fingerprint);
            emulator.line.send(&Frame::Galpixels(Galpixels { update, stamp, fingerprint, y, x, words }))?;
            count += 1;
        }
        // No more is in transmission than the line holds.
        emulator.line.status()?;
    }
    let after = emulator.line.status()?;
    let accepted = after.accepted.wrapping_sub(before.accepted);
    if (accepted, after.frame) != (count, before.frame) {
        return Err(Failure::new(format!(
            "{}: {accepted} of {count} frames of galpixels were accepted, at frame {} of {}: {:?}",
            board.name(),
            after.frame,
            before.frame,
            after.rejected.since(&before.rejected).counts()
        )));
    }
    let words = packed.bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
    Ok((before.frame, words))
}

/// Makes a board wait after each frame, and takes note of the one that it shows.
pub fn lockstep(emulator: &mut Emulator) -> Result<(), Failure> {
    emulator.line.send(&Frame::Lockstep { on: true })?;
    emulator.line.shown()?;
    Ok(())
}

/// Lets the board make frames until its rounding begins anew: else the pictures, and so the kept hashes, would depend
/// on how many frames it had made before it was first spoken to.
fn align(emulator: &mut Emulator, board: Board) -> Result<(), Failure> {
    let mut frame = emulator.line.status()?.frame;
    while frame & (board.period() - 1) != 0 {
        emulator.line.send(&Frame::Go)?;
        (frame, _) = emulator.line.shown()?;
    }
    Ok(())
}

/// Lets the board make its next frame, and compares it.
fn compare(emulator: &mut Emulator, board: Board, scene: &str, expected: &expected::Expected) -> Result<(), Failure> {
    emulator.line.send(&Frame::Go)?;
    let (frame, hash) = emulator.line.shown()?;
    let screen = emulator.screen()?;
    let what = format!("{}: {scene}: frame {frame}", board.name());
    if frame != expected.frame {
        return Err(Failure::new(format!("{what} where frame {} was expected", expected.frame)));
    }
    let differ = screen.pixels.iter().zip(&expected.picture.pixels).filter(|(a, b)| a != b).count();
    if differ > 0 || hash != expected.hash {
        return Err(Failure::new(format!(
            "{what}: {differ} pixels differ from the simulator's, the hash is {hash:08x} and not {:08x}",
            expected.hash
        )));
    }
    Ok(())
}

/// The first line of the file of kept hashes.
const HEAD: &str = "# Hashes of what the panels show: board, scene, frames since it began, CRC-32.";

/// Compares with the kept hashes of these boards, or keeps these and leaves those of other boards.
fn keep(firmware: &Path, boards: &[Board], mut hashes: Hashes, write: bool) -> Result<(), Failure> {
    let file = firmware.join(KEPT);
    let kept = match std::fs::read_to_string(&file) {
        Err(error) if !write => {
            let file = file.display();
            return Err(Failure::new(format!("{file} cannot be read ({error}): make it with --write")));
        }
        kept => kept.unwrap_or_default(),
    };
    let of_these = |board: &str| boards.iter().any(|known| known.name() == board);
    let (mut before, mut others) = (Hashes::new(), Hashes::new());
    for line in kept.lines().filter(|line| !line.starts_with('#')) {
        let [board, scene, age, hash] = line.split(' ').collect::<Vec<_>>()[..] else {
            return Err(Failure::new(format!("{}: `{line}` is no hash", file.display())));
        };
        let (Ok(age), Ok(hash)) = (age.parse(), u32::from_str_radix(hash, 16)) else {
            return Err(Failure::new(format!("{}: `{line}` is no hash", file.display())));
        };
        let of = if of_these(board) { &mut before } else { &mut others };
        of.insert((board.to_owned(), scene.to_owned(), age), hash);
    }
    if write {
        let count = hashes.len();
        hashes.extend(others);
        let mut text = format!("{HEAD}\n");
        for ((board, scene, age), hash) in &hashes {
            let _ = writeln!(text, "{board} {scene} {age} {hash:08x}");
        }
        std::fs::write(&file, text)
            .map_err(|error| Failure::new(format!("{} cannot be written: {error}", file.display())))?;
        println!("{count} hashes kept in {}", file.display());
        return Ok(());
    }
    if hashes == before {
        println!("{} hashes are the kept ones", hashes.len());
        return Ok(());
    }
    let changed = hashes.iter().find(|(key, hash)| before.get(*key) != Some(hash));
    let what = match changed {
        Some(((board, scene, age), hash)) => format!("{board} {scene} {age} has now {hash:08x}"),
        None => "frames are kept that were not compared".to_owned(),
    };
    Err(Failure::new(format!(
        "what the panels show has changed: {what}; if that is meant, make {} anew with --write",
        file.display()
    )))
}
