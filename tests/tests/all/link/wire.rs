//! The line once more, slowly: COBS and CRC by their definitions, and what a receiver makes of some bytes.

use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, MAX_ENCODED};
use galpix_link::rejected::Rejected;

/// CRC-32/ISO-HDLC, bit by bit.
pub fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

/// Returns a payload as the line carries it: checksum, COBS, and the 0.
pub fn line(payload: &[u8]) -> Vec<u8> {
    let mut bytes = payload.to_vec();
    bytes.extend(crc32(payload).to_le_bytes());
    let mut line = Vec::new();
    // Each group between zeros gets its length and one more in front; groups of 254 bytes need no 0 after them.
    for group in bytes.split(|&byte| byte == 0) {
        let mut rest = group;
        while rest.len() >= 254 {
            line.push(255);
            line.extend(&rest[..254]);
            rest = &rest[254..];
        }
        line.push(rest.len() as u8 + 1);
        line.extend(rest);
    }
    line.push(0);
    line
}

/// Returns a frame as the product encodes it.
pub fn encoded(frame: &Frame<'_>) -> Vec<u8> {
    frame.encode(&mut [0; MAX_ENCODED]).unwrap().to_vec()
}

/// A frame that was accepted, encoded anew, or why it was not. Payloads and their encodings belong to each other one by
/// one, so that frames are the same if their bytes are.
pub type Received = Result<Vec<u8>, Rejected>;

/// Returns what a receiver makes of these bytes.
pub fn receive(bytes: &[u8]) -> Vec<Received> {
    let mut decoder = Decoder::new();
    let mut received = Vec::new();
    for &byte in bytes {
        if let Some(frame) = decoder.push(byte) {
            received.push(frame.map(|frame| encoded(&frame)));
        }
    }
    received
}
