//! Updates over a serial line to a display controller: fitted to its panel, stored as its maps store them, row by row.
//!
//! The host requests the device's status, makes it show only what is sent, takes its frame counter as the stamp of an
//! update, sends it, and requests the status again: the device's counters show what arrived. A scene gives a new update
//! every few frames *of the device*, at the scene's time then; a device in lockstep is told to make them. All galpixels
//! of an update carry its number as their tag. What the frames are is in `docs/link.md`.
//!
//! While an update is on the line the device is held in lockstep: lines are so slow that a whole update takes longer
//! than the device makes up for. On one that went on, 55 to 72 of the 192 frames of a small panel arrived in time.

mod address;
mod error;
mod line;
mod pack;
mod talk;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use galpix_core::{Class, Galpixel};
use galpix_link::frame::{Frame, Galpixels, NO_SCENE, Status};
use galpix_link::panel::{self, Description};
use galpix_link::rejected::{Rejected, Rejections};
use schemars::JsonSchema;
use serde::Serialize;

pub use address::{Address, OpenError};
pub use error::SendError;
pub use line::Line;
pub use pack::{Packed, pack};
use talk::Talk;

use crate::source::Source;
use crate::source::fit;

/// The time between two requests for the device's frame counter.
const POLL: Duration = Duration::from_millis(10);
/// How long the counter may stay unchanged while an update waits for its frame.
const STANDSTILL: Duration = Duration::from_secs(5);
/// After this time a device in lockstep that has not moved gets the command again: it was lost.
const AGAIN: Duration = Duration::from_secs(1);
/// How often the command to wait, or to go on, is repeated until the device obeys: it may be lost.
const TELLINGS: u32 = 4;

/// What to send.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// The panel; the device's if absent.
    pub panel: Option<Description>,
    /// How many updates.
    pub updates: u32,
    /// Frames of the device between two updates.
    pub every: u32,
    /// Whether the device's built-in scene goes on underneath.
    pub over_scene: bool,
}

impl Request {
    /// Refuses what cannot be sent, before a line is opened.
    ///
    /// *Errors:* [`SendError::OneUpdate`] and, for a file, [`SendError::NoPanel`].
    pub fn check(&self, source: &Source, to: &Address) -> Result<(), SendError> {
        match source {
            Source::Capture(capture) if self.updates > 1 => {
                Err(SendError::OneUpdate { source_name: capture.name.clone(), updates: self.updates })
            }
            _ if self.panel.is_none() && matches!(to, Address::File(_)) => {
                Err(SendError::NoPanel { to: to.to_string() })
            }
            _ => Ok(()),
        }
    }
}

/// What was sent, and what the device reports.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    /// The scene or the capture.
    pub source: String,
    /// The panel.
    pub panel: &'static str,
    /// Columns of the panel.
    pub width: u16,
    /// Rows of the panel.
    pub height: u16,
    /// Each update.
    pub updates: Vec<Sent>,
    /// Frames of galpixels sent, all updates together.
    pub frames: u32,
    /// Bytes sent, questions included.
    pub bytes: u64,
    /// The time from the first byte to the last answer.
    pub seconds: f64,
    /// The device's answers; `None` if nothing can answer.
    pub device: Option<Device>,
}

/// An update that was sent.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Sent {
    /// Its number.
    pub update: u16,
    /// The device's frame counter at which it is exact.
    pub stamp: u32,
    /// Its time in the scene, in frames.
    pub time: u32,
    /// Cells with a galpixel.
    pub galpixels: u32,
    /// Cells that are empty because their motion is unknown.
    pub empty: u32,
    /// Fields that had to be clamped to the panel's range.
    pub saturated: u32,
}

/// What the device counted from the first request to the last.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Device {
    /// The frame counter at the end.
    pub frame: u32,
    /// Frames of galpixels that went into its map.
    pub accepted: u32,
    /// Frames of any kind that it refused.
    pub refused: u32,
    /// The same by cause.
    pub rejected: BTreeMap<String, u32>,
    /// Frames that were not ready at their vsync.
    pub late: u32,
}

/// Sends updates of a source over a line to `to`. `progress` gets the rows sent and the rows to send.
///
/// *Errors:* one sentence that says what, where and how to correct it.
pub fn send(
    source: &Source,
    request: &Request,
    line: &mut dyn Line,
    to: &Address,
    mut progress: impl FnMut(u64, u64),
) -> Result<Report, SendError> {
    request.check(source, to)?;
    let to = &to.to_string();
    let mut talk = Talk::new(line, to);
    let started = Instant::now();
    let first = talk.ask()?;
    let panel = panel_of(request.panel, first.as_ref(), to)?;
    let rows = u64::from(request.updates) * u64::from(panel.height);
    let mut base = first.map_or(0, |status| status.frame);
    // Who has put it into lockstep may keep it there.
    let held = first.is_some_and(|status| !status.lockstep);
    if !request.over_scene {
        talk.put(&Frame::Scene { number: NO_SCENE });
    }
    let (mut last, mut updates, mut frames) = (first, Vec::new(), 0);
    for update in 0..request.updates {
        let due = update.saturating_mul(request.every);
        if update > 0
            && let Some(status) = &mut last
        {
            *status = wait(&mut talk, *status, base, due)?;
        }
        if held {
            last = hold(&mut talk, true)?;
        }
        if let Some(status) = last
            && update == 0
        {
            base = status.frame;
        }
        let time = last.map_or(due, |status| status.frame.wrapping_sub(base));
        let galpixels = galpixels(source, time, &panel, update);
        let packed = pack(&panel, &galpixels)?;
        let stamp = base.wrapping_add(time);
        let head = Galpixels { update: update as u16, stamp, fingerprint: panel.fingerprint, y: 0, x: 0, words: &[] };
        for (y, row) in (0u16..).zip(packed.rows(&panel)) {
            frames += send_row(&mut talk, &Galpixels { y, ..head }, row, &panel)?;
            progress(u64::from(update) * u64::from(panel.height) + u64::from(y) + 1, rows);
        }
        if held {
            last = hold(&mut talk, false)?;
        }
        let empty = galpixels.iter().filter(|galpixel| galpixel.class == Class::Empty).count() as u32;
        updates.push(Sent {
            update: update as u16,
            stamp,
            time,
            galpixels: galpixels.len() as u32 - empty,
            empty,
            saturated: packed.saturated,
        });
    }
    if !held {
        last = talk.ask()?;
    }
    Ok(Report {
        source: source.name().to_owned(),
        panel: panel.name,
        width: panel.width,
        height: panel.height,
        updates,
        frames,
        bytes: talk.sent(),
        seconds: started.elapsed().as_secs_f64(),
        device: first.zip(last).map(|(first, last)| device(&first, &last)),
    })
}

/// Returns the requested panel, or the one that answers; the two must not differ.
fn panel_of(wanted: Option<Description>, status: Option<&Status>, to: &str) -> Result<Description, SendError> {
    let to = to.to_owned();
    let Some(&Status { fingerprint, width, height, words, .. }) = status else {
        return wanted.ok_or(SendError::NoPanel { to });
    };
    match (wanted, panel::with_fingerprint(fingerprint)) {
        (Some(wanted), _) if wanted.fingerprint == fingerprint => Ok(wanted),
        (Some(wanted), found) => {
            let found = found.map_or_else(
                || format!("{width}x{height} galpixels of {words} words with the fingerprint {fingerprint:08x}"),
                |found| found.name.to_owned(),
            );
            Err(SendError::OtherPanel { to, wanted: wanted.name, found })
        }
        (None, Some(found)) => Ok(found),
        (None, None) => Err(SendError::Stranger { to, width, height, words, fingerprint }),
    }
}

/// Returns the galpixels of a source `time` frames after its update, on a panel; their tag is `tag`, of which they keep
/// the low bits.
fn galpixels(source: &Source, time: u32, panel: &Description, tag: u32) -> Vec<Galpixel> {
    let (width, height) = (usize::from(panel.width), usize::from(panel.height));
    let mut galpixels = match source {
        Source::Scene(scene) => fit::scene(*scene, f64::from(time), width, height),
        Source::Capture(capture) => fit::update(&capture.update, width, height),
    };
    for galpixel in &mut galpixels {
        galpixel.tag = tag;
    }
    galpixels
}

/// Puts the device into lockstep, or takes it out, and returns its status.
fn hold(talk: &mut Talk<'_>, on: bool) -> Result<Option<Status>, SendError> {
    let mut status = None;
    for _ in 0..TELLINGS {
        talk.put(&Frame::Lockstep { on });
        status = talk.ask()?;
        if status.is_none_or(|status| status.lockstep == on) {
            break;
        }
    }
    Ok(status)
}

/// Waits until the device's frame counter is `due` frames beyond `base`. In lockstep it is told to make these
/// frames.
fn wait(talk: &mut Talk<'_>, mut status: Status, base: u32, due: u32) -> Result<Status, SendError> {
    let mut moved = Instant::now();
    let mut commanded: Option<(u32, Instant)> = None;
    loop {
        let Some(now) = talk.ask()? else { return Ok(status) };
        if now.frame.wrapping_sub(base) >= due {
            return Ok(now);
        }
        if now.frame != status.frame {
            moved = Instant::now();
        } else if moved.elapsed() > STANDSTILL {
            return Err(SendError::Standstill { to: talk.to().to_owned(), frame: now.frame });
        }
        // Once a frame, and not once a question: it would run ahead of the answers.
        if now.lockstep && commanded.is_none_or(|(frame, when)| frame != now.frame || when.elapsed() > AGAIN) {
            talk.put(&Frame::Go);
            talk.flush()?;
            commanded = Some((now.frame, Instant::now()));
        }
        status = now;
        std::thread::sleep(POLL);
    }
}

/// Sends one row in as many frames as it needs, and returns how many these are.
fn send_row(talk: &mut Talk<'_>, head: &Galpixels<'_>, row: &[u8], panel: &Description) -> Result<u32, SendError> {
    let most = panel.galpixels_per_frame();
    let mut frames = 0;
    for words in row.chunks((most * panel.bytes_per_galpixel()).max(1)) {
        talk.put(&Frame::Galpixels(Galpixels { x: (frames as usize * most) as u16, words, ..*head }));
        frames += 1;
    }
    talk.flush()?;
    Ok(frames)
}

/// Returns what a device counted between two answers.
fn device(first: &Status, last: &Status) -> Device {
    let rejected: Rejections = last.rejected.since(&first.rejected);
    Device {
        frame: last.frame,
        accepted: last.accepted.wrapping_sub(first.accepted),
        refused: rejected.total(),
        rejected: Rejected::ALL.into_iter().map(|cause| (cause.name().replace(' ', "_"), rejected.of(cause))).collect(),
        late: last.late.wrapping_sub(first.late),
    }
}
