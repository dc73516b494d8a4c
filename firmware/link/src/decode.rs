//! Bytes in, frames or the causes of their refusal out.

use cobs::{DecodeResult, DecoderState};

use crate::CRC;
use crate::frame::Frame;
use crate::rejected::Rejected;
use crate::size::{CHECKSUM, MAX_PAYLOAD};

/// A receiver. Takes bytes one at a time and never loses step for longer than to the next 0.
#[derive(Debug)]
pub struct Decoder {
    cobs: DecoderState,
    /// What has been taken out of the COBS of this frame; `length` bytes of it count.
    frame: [u8; MAX_PAYLOAD + CHECKSUM],
    length: usize,
    too_long: bool,
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

impl Decoder {
    /// A receiver that has received nothing.
    #[must_use]
    pub const fn new() -> Self {
        Self { cobs: DecoderState::Idle, frame: [0; MAX_PAYLOAD + CHECKSUM], length: 0, too_long: false }
    }

    /// Takes the next byte off the line. At the 0 that ends a frame there is an answer: the frame, or why it is
    /// refused. A 0 right after another one ends nothing.
    ///
    /// *Errors:* the five causes that can be told without a map.
    pub fn push(&mut self, byte: u8) -> Option<Result<Frame<'_>, Rejected>> {
        match self.cobs.feed(byte) {
            Ok(DecodeResult::NoData) => return None,
            Ok(DecodeResult::DataStart) => {
                (self.length, self.too_long) = (0, false);
                return None;
            }
            Ok(DecodeResult::DataContinue(byte)) => {
                match self.frame.get_mut(self.length) {
                    Some(to) => {
                        *to = byte;
                        self.length += 1;
                    }
                    None => self.too_long = true,
                }
                return None;
            }
            Ok(DecodeResult::DataComplete) if !self.too_long => {}
            Ok(DecodeResult::DataComplete) => return Some(Err(Rejected::TooLong)),
            Err(_) => return Some(Err(if self.too_long { Rejected::TooLong } else { Rejected::CutShort })),
        }
        Some(checked(self.frame.get(..self.length).unwrap_or_default()))
    }
}

/// The frame in a payload and its checksum.
fn checked(bytes: &[u8]) -> Result<Frame<'_>, Rejected> {
    match bytes.split_last_chunk() {
        Some((payload, checksum)) if !payload.is_empty() => {
            if CRC.checksum(payload) == u32::from_le_bytes(*checksum) {
                Frame::read(payload)
            } else {
                Err(Rejected::WrongChecksum)
            }
        }
        _ => Err(Rejected::CutShort),
    }
}
