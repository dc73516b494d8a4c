//! What a display controller of galpixmaps and its host say to each other over a serial line.
//!
//! A *frame* on the line is `COBS(payload || CRC-32 of the payload, little-endian)` and a 0 byte. No other 0 is ever on
//! the line, so after any corruption a receiver is in step again at the next 0; a bad frame costs itself, and the next
//! one if the 0 between them was lost. `docs/link.md` is the normative text.
//!
//! - [`frame`]: the kinds of frames, and their payloads
//! - [`decode`]: bytes in, frames or the causes of their refusal out
//! - [`rejected`]: those causes, counted apart
//! - [`panel`]: the displays that both ends know, and fingerprints of their stored forms
//! - [`picture`]: the hash of what a display shows
//!
//! Either end encodes and decodes every kind. Nothing here allocates or panics.
//!
//! ```
//! use galpix_link::decode::Decoder;
//! use galpix_link::frame::{Frame, MAX_ENCODED};
//!
//! let mut buffer = [0; MAX_ENCODED];
//! let sent = Frame::Scene { number: 3 }.encode(&mut buffer)?;
//! let mut decoder = Decoder::new();
//! for &byte in sent {
//!     if let Some(received) = decoder.push(byte) {
//!         assert_eq!(received, Ok(Frame::Scene { number: 3 }));
//!     }
//! }
//! # Ok::<(), galpix_link::rejected::Rejected>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod decode;
pub mod frame;
pub mod panel;
pub mod picture;
pub mod rejected;
mod size;

/// The checksum of frames, fingerprints and pictures: CRC-32/ISO-HDLC, as in Ethernet and zip.
static CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
