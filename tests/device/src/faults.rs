//! Random and corrupted frames over the line: the picture goes on, and every refusal is counted.

use std::path::Path;

use galpix_controller::session::OLDEST;
use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, Galpixels, MAX_ENCODED, MAX_WORD_BYTES};
use galpix_link::panel::Description;
use galpix_link::rejected::{Rejected, Rejections};
use rand::rngs::SmallRng;
use rand::{Rng, RngExt, SeedableRng};

use crate::boards::{Board, Filling};
use crate::emulator::{Emulator, Pace};
use crate::failure::Failure;

/// Frames that are sent before the board's status is requested.
const BATCH: u32 = 100;

/// Sends `count` frames to each board.
pub fn run(firmware: &Path, boards: &[Board], count: u32) -> Result<(), Failure> {
    for &board in boards {
        // The Pico's emulator is some fifty times slower than QEMU.
        let count = if board == Board::Rp2040 { count.div_ceil(10) } else { count };
        let mut emulator = Emulator::start(board, Filling::FillMode, firmware, Pace::Free)?;
        let before = emulator.line.status()?;
        let mut random = SmallRng::seed_from_u64(count.into());
        let (mut accepted, mut rejected) = (0u32, Rejections::new());
        let (mut last, mut sent) = (before.frame, 0);
        // A receiver like the board's gives the expected counts.
        let mut decoder = Decoder::new();
        // Where the host is slow, a batch takes so many frames that the board may find good galpixels too old.
        let (mut now, mut late) = (before.frame, false);
        while sent < count {
            let then = core::mem::replace(&mut now, emulator.line.status()?.frame);
            late |= now.wrapping_sub(then) > OLDEST;
            let batch = BATCH.min(count - sent);
            for number in 1..=batch {
                let mut bytes = hostile(&mut random, &board.panel(), now);
                if number == batch {
                    // Ends what is open: the question how the board is must not be part of it.
                    bytes.push(0);
                }
                emulator.line.send_bytes(&bytes)?;
                for byte in bytes {
                    match decoder.push(byte) {
                        None => {}
                        Some(Err(cause)) => rejected.count(cause),
                        Some(Ok(Frame::Galpixels(galpixels))) => match galpixels.stored(&board.panel()) {
                            Err(cause) => rejected.count(cause),
                            // Ages are far from the limit, on whatever frame they arrive.
                            Ok(_) if galpixels.age(now) > 1 << 16 => rejected.count(Rejected::TooOld),
                            Ok(_) => accepted += 1,
                        },
                        Some(Ok(Frame::Scene { number })) if number > 2 => rejected.count(Rejected::UnknownKind),
                        Some(Ok(Frame::Status(_) | Frame::Shown { .. })) => rejected.count(Rejected::UnknownKind),
                        Some(Ok(_)) => {}
                    }
                }
                sent += 1;
            }
            if !emulator.runs() {
                return Err(Failure::new(format!("{}: the program ended after {sent} frames", board.name())));
            }
        }
        let after = emulator.line.status()?;
        let counted = after.rejected.since(&before.rejected);
        late |= after.frame.wrapping_sub(now) > OLDEST;
        for _ in rejected.of(Rejected::TooOld)..counted.of(Rejected::TooOld) {
            if late && accepted > 0 {
                accepted -= 1;
                rejected.count(Rejected::TooOld);
            }
        }
        let total = after.accepted.wrapping_sub(before.accepted) + counted.total();
        if total != accepted + rejected.total() || counted != rejected {
            return Err(Failure::new(format!(
                "{}: the board counted {:?} refused and {} accepted, the host {:?} and {accepted}",
                board.name(),
                counted.counts(),
                after.accepted.wrapping_sub(before.accepted),
                rejected.counts(),
            )));
        }
        // The picture goes on.
        for _ in 0..3 {
            let now = emulator.line.status()?.frame;
            if now == last {
                return Err(Failure::new(format!("{}: the picture stands still at frame {now}", board.name())));
            }
            last = now;
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
        println!(
            "{}: {sent} frames sent, {accepted} accepted, {} refused and all of them counted, {} frames shown meanwhile",
            board.name(),
            counted.total(),
            last.wrapping_sub(before.frame)
        );
    }
    Ok(())
}

/// Returns the bytes of a frame that is random, broken, or good and absurd.
fn hostile(random: &mut SmallRng, panel: &Description, now: u32) -> Vec<u8> {
    let galpixels = panel.bytes_per_galpixel() * random.random_range(1..=4);
    let words: Vec<u8> = (0..galpixels.min(MAX_WORD_BYTES)).map(|_| random.random()).collect();
    let good = Galpixels {
        update: random.random(),
        stamp: now,
        fingerprint: panel.fingerprint,
        y: random.random_range(0..panel.height),
        x: random.random_range(0..panel.width - 4),
        words: &words,
    };
    let mut buffer = [0; MAX_ENCODED];
    let mut encode = |frame: Frame<'_>| frame.encode(&mut buffer).map(<[u8]>::to_vec).unwrap_or_default();
    let kind = random.random_range(0..12u32);
    let mut bytes = match kind {
        // Far in the past or in the future.
        0 => encode(Frame::Galpixels(Galpixels { stamp: now.wrapping_sub(1 << 20 | random.next_u32() >> 8), ..good })),
        // For another display, or outside of this one.
        1 => encode(Frame::Galpixels(Galpixels { fingerprint: random.random(), ..good })),
        2 => encode(Frame::Galpixels(Galpixels { x: panel.width, y: random.random(), ..good })),
        // No whole galpixels, where galpixels have several words.
        3 => encode(Frame::Galpixels(Galpixels { words: &words[..4], ..good })),
        // A scene that may not exist, and what only devices send.
        4 => encode(Frame::Scene { number: random.random_range(0..200) }),
        5 => encode(Frame::Shown { frame: random.random(), hash: random.random() }),
        // Nothing but noise.
        6 => (0..random.random_range(1..400)).map(|_| random.random()).collect(),
        _ => encode(Frame::Galpixels(good)),
    };
    match kind {
        // A bit flipped, a piece cut out, the end missing, or twice.
        7 => {
            let at = random.random_range(0..bytes.len());
            bytes[at] ^= 1 << random.random_range(0..8u32);
        }
        8 => {
            let from = random.random_range(0..bytes.len());
            bytes.truncate(from);
        }
        9 => {
            let at = random.random_range(0..bytes.len() - 1);
            bytes.remove(at);
        }
        10 => bytes.extend_from_within(..),
        _ => {}
    }
    bytes
}
