//! How long frames are.

/// The most bytes of a payload.
pub const MAX_PAYLOAD: usize = 240;
/// Bytes of a checksum.
pub const CHECKSUM: usize = 4;
/// The most bytes of a frame on the line, its 0 included. Below 254 bytes COBS adds a single one.
pub const MAX_ENCODED: usize = 1 + MAX_PAYLOAD + CHECKSUM + 1;
/// Bytes of a frame of galpixels before the words.
const GALPIXELS_HEAD: usize = 15;
/// The most bytes of stored words in one frame: whole words.
pub const MAX_WORD_BYTES: usize = (MAX_PAYLOAD - GALPIXELS_HEAD) / 4 * 4;
