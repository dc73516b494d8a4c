//! Why an update did not get to the device, each in one sentence with its remedy.

use galpix_core::SetupError;

/// Why an update did not get to the device.
#[derive(Debug, thiserror::Error)]
pub enum SendError {
    /// There is no device to query.
    #[error("{to} cannot report which panel it is for: give --panel oled or --panel lcd")]
    NoPanel {
        /// Where it was sent.
        to: String,
    },
    /// More updates than the source has.
    #[error("the capture {source_name} is one update: leave out --updates {updates}, or send a scene")]
    OneUpdate {
        /// The capture.
        source_name: String,
        /// The requested updates.
        updates: u32,
    },
    /// A device with an unknown stored form.
    #[error(
        "the device at {to} shows {width}x{height} galpixels of {words} words with the fingerprint {fingerprint:08x}, \
         which is no panel's here: build its firmware and galpix from the same sources"
    )]
    Stranger {
        /// Where it was sent.
        to: String,
        /// Columns.
        width: u16,
        /// Rows.
        height: u16,
        /// Words of a galpixel.
        words: u8,
        /// The device's fingerprint.
        fingerprint: u32,
    },
    /// A device with another panel than the requested one.
    #[error(
        "the device at {to} is no {wanted} as galpix knows it, but {found}: leave out --panel to send what it shows"
    )]
    OtherPanel {
        /// Where it was sent.
        to: String,
        /// The requested panel.
        wanted: &'static str,
        /// The device's panel, or that it is unknown.
        found: String,
    },
    /// No answer.
    #[error(
        "{to} did not answer a Hello within {seconds} s: is a display controller running there, at this baud rate, and \
         is no other program on the line?"
    )]
    Silent {
        /// Where it was sent.
        to: String,
        /// How long it was waited.
        seconds: u64,
    },
    /// The frame counter does not move.
    #[error(
        "the device at {to} stands still at frame {frame}, and an update waits for a later one: start the device again"
    )]
    Standstill {
        /// Where it was sent.
        to: String,
        /// The frame counter.
        frame: u32,
    },
    /// The line broke, or takes no more bytes.
    #[error("the line to {to} broke after {bytes} bytes ({error}): start galpix send again once the device is back")]
    Broken {
        /// Where it was sent.
        to: String,
        /// Bytes sent.
        bytes: u64,
        /// The system's error.
        error: std::io::Error,
    },
    /// The map of the panel cannot be laid out.
    #[error("{0}")]
    Setup(#[from] SetupError),
}

impl SendError {
    /// Returns whether the arguments or the device are at fault, and not the transmission.
    #[must_use]
    pub const fn unusable(&self) -> bool {
        !matches!(self, Self::Standstill { .. } | Self::Broken { .. } | Self::Setup(_))
    }
}
