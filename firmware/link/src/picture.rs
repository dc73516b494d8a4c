//! The hash of what a display shows, to compare pictures over a line that is too slow for them.

use crate::CRC;

/// CRC-32/ISO-HDLC over the colour words of a picture: row by row from the top, in each row from left to right, each
/// word as 16 bits with the low byte first. Gray levels of 4 bits thus take two bytes as well, the second of which is
/// 0.
#[derive(Clone)]
pub struct PictureHash(crc::Digest<'static, u32>);

impl Default for PictureHash {
    fn default() -> Self {
        Self::new()
    }
}

impl PictureHash {
    /// Of no pixel yet.
    #[must_use]
    pub fn new() -> Self {
        Self(CRC.digest())
    }

    /// Goes on with a row of colour words, such as those of `galpix_core::scan_out::row`. Only their low 16 bits count.
    pub fn row(&mut self, colours: impl IntoIterator<Item = u32>) {
        for colour in colours {
            self.0.update(&(colour as u16).to_le_bytes());
        }
    }

    /// The hash of all rows so far.
    #[must_use]
    pub fn finish(self) -> u32 {
        self.0.finalize()
    }
}
