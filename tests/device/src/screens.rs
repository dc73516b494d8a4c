//! Every pixel of the emulated screens against the simulator.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use galpix_controller::scene;
use galpix_core::Class;
use galpix_link::frame::{Frame, Galpixels, NO_SCENE};
use galpix_sim::send::pack;
use galpix_sim::source::{fit, scene as sources};

use crate::boards::{Board, Filling};
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
pub fn run(firmware: &Path, frames: u32, write: bool) -> Result<(), Failure> {
    let mut hashes = Hashes::new();
    for (board, filling) in Board::ALL.into_iter().flat_map(|board| Filling::ALL.map(|filling| (board, filling))) {
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
    keep(firmware, &hashes, write)
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

/// Compares with the kept hashes, or keeps these.
fn keep(firmware: &Path, hashes: &Hashes, write: bool) -> Result<(), Failure> {
    let file = firmware.join(KEPT);
    let mut text = String::from("# Hashes of what the panels show: board, scene, frames since it began, CRC-32.\n");
    for ((board, scene, age), hash) in hashes {
        let _ = writeln!(text, "{board} {scene} {age} {hash:08x}");
    }
    if write {
        std::fs::write(&file, text)
            .map_err(|error| Failure::new(format!("{} cannot be written: {error}", file.display())))?;
        println!("{} hashes kept in {}", hashes.len(), file.display());
        return Ok(());
    }
    let kept = std::fs::read_to_string(&file)
        .map_err(|error| Failure::new(format!("{} cannot be read ({error}): make it with --write", file.display())))?;
    let different = text.lines().zip(kept.lines()).find(|(a, b)| a != b);
    match different {
        None if text.lines().count() == kept.lines().count() => {
            println!("{} hashes are the kept ones", hashes.len());
            Ok(())
        }
        None => Err(Failure::new(format!("{} has other frames: make it anew with --write", file.display()))),
        Some((now, kept)) => Err(Failure::new(format!(
            "what the panels show has changed: now `{now}`, kept `{kept}`; if that is meant, make {} anew with --write",
            file.display()
        ))),
    }
}
