//! The kinds of frames and their payloads: a byte for the kind, then its fields without gaps, little-endian.

mod bytes;

use bytes::{Reader, Writer};

use galpix_core::record::MAX_WORDS;

use crate::CRC;
use crate::panel::Description;
use crate::rejected::{CAUSES, Rejected, Rejections};
use crate::size::CHECKSUM;
pub use crate::size::{MAX_ENCODED, MAX_PAYLOAD, MAX_WORD_BYTES};

/// In [`Frame::Scene`]: an empty map, in which only what the host sends is seen.
pub const NO_SCENE: u8 = 0xff;

/// The first byte of each kind. Those of the device have the top bit set.
mod kind {
    pub const HELLO: u8 = 0x01;
    pub const GALPIXELS: u8 = 0x02;
    pub const SCENE: u8 = 0x03;
    pub const LOCKSTEP: u8 = 0x04;
    pub const GO: u8 = 0x05;
    pub const OVERLAY: u8 = 0x06;
    pub const STATUS: u8 = 0x81;
    pub const SHOWN: u8 = 0x82;
}

/// One frame. The first six kinds go from the host to the device, the last two back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Frame<'a> {
    /// The host asks for a [`Status`].
    Hello,
    /// Neighbours along a row of the map.
    Galpixels(Galpixels<'a>),
    /// Show a built-in scene, or [`NO_SCENE`].
    Scene {
        /// Its number, from 0 on, in the device's order.
        number: u8,
    },
    /// Whether the device waits after each shown frame for a [`Frame::Go`].
    Lockstep {
        /// Whether it does.
        on: bool,
    },
    /// Make the next frame and show it. Without lockstep it means nothing.
    Go,
    /// Whether the device draws a line of text over the picture.
    Overlay {
        /// Whether it does.
        on: bool,
    },
    /// How the device is.
    Status(Status),
    /// The device shows a frame.
    Shown {
        /// The frame counter.
        frame: u32,
        /// The [`crate::picture::PictureHash`] of what it shows.
        hash: u32,
    },
}

/// Neighbours along a row of the map, in their stored form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Galpixels<'a> {
    /// Which update they belong to; counts up, wraps.
    pub update: u16,
    /// The device's frame counter at which they are exact.
    pub stamp: u32,
    /// The stored form and the display, see [`Description::fingerprint`].
    pub fingerprint: u32,
    /// Row.
    pub y: u16,
    /// Column of the first one.
    pub x: u16,
    /// All words of the first galpixel, then all of its right neighbour, and so on; each word 4 bytes, the lowest
    /// first. 4 to [`MAX_WORD_BYTES`] bytes.
    pub words: &'a [u8],
}

/// One galpixel of a frame: its cell and its words; those beyond the record's are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stored {
    /// Column.
    pub x: u16,
    /// Row.
    pub y: u16,
    /// The words; `words[k]` belongs into plane `k` of a map.
    pub words: [u32; MAX_WORDS],
}

/// How a device is. Counters wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Status {
    /// The frame counter: frames made since the device was started.
    pub frame: u32,
    /// The stored form and the display, see [`Description::fingerprint`].
    pub fingerprint: u32,
    /// Columns of the display.
    pub width: u16,
    /// Rows of the display.
    pub height: u16,
    /// Words of a stored galpixel.
    pub words: u8,
    /// The built-in scene that is shown.
    pub scene: u8,
    /// Whether the device waits after each shown frame.
    pub lockstep: bool,
    /// Frames of galpixels that went into the map.
    pub accepted: u32,
    /// Frames of any kind that were refused, by cause.
    pub rejected: Rejections,
    /// Frames that were not ready at their vsync.
    pub late: u32,
    /// Ticks that the longest frame took since the last status, without those in which the device told one, and ticks
    /// from one vsync to the next.
    pub busy: u32,
    /// See [`Self::busy`].
    pub ticks: u32,
    /// Bytes of the stack that were ever used, and bytes that it has; 0 where the board does not know.
    pub stack_used: u32,
    /// See [`Self::stack_used`].
    pub stack: u32,
}

impl<'a> Galpixels<'a> {
    /// The galpixels, one by one, if they may enter a map of this display.
    ///
    /// *Errors:* [`Rejected::WrongFingerprint`], [`Rejected::WrongLength`] if they are no whole galpixels,
    /// [`Rejected::Outside`]; the first of them that applies. Whether they are too old the receiver decides, see
    /// [`Self::age`].
    pub fn stored(&self, panel: &Description) -> Result<impl ExactSizeIterator<Item = Stored> + use<'a>, Rejected> {
        if self.fingerprint != panel.fingerprint {
            return Err(Rejected::WrongFingerprint);
        }
        let bytes = panel.bytes_per_galpixel();
        if bytes == 0 || self.words.is_empty() || !self.words.len().is_multiple_of(bytes) {
            return Err(Rejected::WrongLength);
        }
        let count = self.words.len() / bytes;
        if self.y >= panel.height || usize::from(self.x) + count > usize::from(panel.width) {
            return Err(Rejected::Outside);
        }
        let Self { x, y, words: all, .. } = *self;
        // By counting, not by chunks: these would divide once more.
        Ok((0..count as u16).map(move |index| {
            let galpixel = all.get(usize::from(index) * bytes..).unwrap_or_default();
            let mut words = [0; MAX_WORDS];
            for (word, bytes) in words.iter_mut().take(bytes / 4).zip(galpixel.as_chunks().0) {
                *word = u32::from_le_bytes(*bytes);
            }
            Stored { x: x + index, y, words }
        }))
    }

    /// Frames since they were exact, where the frame counter is `now`. A stamp that lies ahead of the counter gives a
    /// huge age.
    #[must_use]
    pub const fn age(&self, now: u32) -> u32 {
        now.wrapping_sub(self.stamp)
    }
}

impl<'a> Frame<'a> {
    /// Writes the frame as it goes over the line, its 0 included, and returns the bytes written.
    ///
    /// *Errors:* galpixels that are none, no whole words ([`Rejected::WrongLength`]) or too many
    /// ([`Rejected::TooLong`]); what the receiver would say too.
    pub fn encode<'b>(&self, buffer: &'b mut [u8; MAX_ENCODED]) -> Result<&'b [u8], Rejected> {
        let mut payload = [0; MAX_PAYLOAD + CHECKSUM];
        let mut writer = Writer::new(&mut payload);
        self.write(&mut writer)?;
        let checksum = CRC.checksum(writer.written());
        writer.u32(checksum);
        let encoded = {
            let (frame, _) = buffer.split_at_mut(MAX_ENCODED - 1);
            cobs::try_encode(writer.written(), frame).map_err(|_| Rejected::TooLong)?
        };
        let frame = buffer.get_mut(..=encoded).ok_or(Rejected::TooLong)?;
        if let Some(last) = frame.last_mut() {
            *last = 0;
        }
        Ok(frame)
    }

    /// The payload.
    fn write(&self, to: &mut Writer<'_>) -> Result<(), Rejected> {
        match self {
            Self::Hello => to.u8(kind::HELLO),
            Self::Galpixels(Galpixels { update, stamp, fingerprint, y, x, words }) => {
                if words.len() > MAX_WORD_BYTES {
                    return Err(Rejected::TooLong);
                }
                if !whole_words(words) {
                    return Err(Rejected::WrongLength);
                }
                to.u8(kind::GALPIXELS);
                to.u16(*update);
                to.u32(*stamp);
                to.u32(*fingerprint);
                to.u16(*y);
                to.u16(*x);
                to.bytes(words);
            }
            Self::Scene { number } => {
                to.u8(kind::SCENE);
                to.u8(*number);
            }
            Self::Lockstep { on } => {
                to.u8(kind::LOCKSTEP);
                to.u8(u8::from(*on));
            }
            Self::Go => to.u8(kind::GO),
            Self::Overlay { on } => {
                to.u8(kind::OVERLAY);
                to.u8(u8::from(*on));
            }
            Self::Status(status) => {
                to.u8(kind::STATUS);
                to.u32(status.frame);
                to.u32(status.fingerprint);
                to.u16(status.width);
                to.u16(status.height);
                to.u8(status.words);
                to.u8(status.scene);
                to.u8(u8::from(status.lockstep));
                to.u32(status.accepted);
                for count in status.rejected.counts() {
                    to.u32(count);
                }
                for number in [status.late, status.busy, status.ticks, status.stack_used, status.stack] {
                    to.u32(number);
                }
            }
            Self::Shown { frame, hash } => {
                to.u8(kind::SHOWN);
                to.u32(*frame);
                to.u32(*hash);
            }
        }
        Ok(())
    }

    /// The frame of a payload whose checksum holds.
    pub(crate) fn read(payload: &'a [u8]) -> Result<Self, Rejected> {
        let mut from = Reader::new(payload);
        let frame = match from.u8()? {
            kind::HELLO => Self::Hello,
            kind::GALPIXELS => Self::Galpixels(Galpixels {
                update: from.u16()?,
                stamp: from.u32()?,
                fingerprint: from.u32()?,
                y: from.u16()?,
                x: from.u16()?,
                words: Some(from.rest()).filter(|words| whole_words(words)).ok_or(Rejected::WrongLength)?,
            }),
            kind::SCENE => Self::Scene { number: from.u8()? },
            kind::LOCKSTEP => Self::Lockstep { on: from.flag()? },
            kind::GO => Self::Go,
            kind::OVERLAY => Self::Overlay { on: from.flag()? },
            kind::STATUS => Self::Status(Status {
                frame: from.u32()?,
                fingerprint: from.u32()?,
                width: from.u16()?,
                height: from.u16()?,
                words: from.u8()?,
                scene: from.u8()?,
                lockstep: from.flag()?,
                accepted: from.u32()?,
                rejected: {
                    let mut counts = [0; CAUSES];
                    for count in &mut counts {
                        *count = from.u32()?;
                    }
                    Rejections::from_counts(counts)
                },
                late: from.u32()?,
                busy: from.u32()?,
                ticks: from.u32()?,
                stack_used: from.u32()?,
                stack: from.u32()?,
            }),
            kind::SHOWN => Self::Shown { frame: from.u32()?, hash: from.u32()? },
            _ => return Err(Rejected::UnknownKind),
        };
        if from.rest().is_empty() { Ok(frame) } else { Err(Rejected::WrongLength) }
    }
}

/// Whether these bytes are whole words, and at least one.
fn whole_words(bytes: &[u8]) -> bool {
    !bytes.is_empty() && bytes.len().is_multiple_of(4)
}
