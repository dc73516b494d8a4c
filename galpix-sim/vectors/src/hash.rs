//! What is kept of the vectors: a hash of every case and of every frame.

use std::fmt::Write as _;

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::case::{Case, Content};

/// Returns the SHA-256 of some bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut digits, byte| {
        let _ = write!(digits, "{byte:02x}");
        digits
    })
}

/// Returns the hash of a frame: of the words of its map, plane by plane, the least significant byte of each first.
pub fn frame(map: &[u32]) -> String {
    let bytes: Vec<u8> = map.iter().flat_map(|word| word.to_le_bytes()).collect();
    sha256(&bytes)
}

/// Returns the CRC-32 (that of Ethernet and PNG) of the same bytes, which a test bench in logic computes easily.
pub fn crc32(map: &[u32]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    map.iter().for_each(|word| hasher.update(&word.to_le_bytes()));
    hasher.finalize()
}

/// Returns one JSON document on a line.
pub fn json(value: &impl Serialize) -> String {
    // Keys are strings and numbers are integers: JSON can hold all of them.
    serde_json::to_string(value).unwrap_or_default() + "\n"
}

/// Returns the hashes of all cases and frames as the project keeps them, a line each.
#[must_use]
pub fn hashes(cases: &[Case]) -> String {
    let mut lines = String::new();
    for case in cases {
        let _ = writeln!(lines, "{} {}", sha256(json(case).as_bytes()), case.name);
        if let Content::Frame(frames) = &case.content {
            for (frame, n) in frames.frames.iter().zip(1..) {
                let _ = writeln!(lines, "{} {} frame {n}", frame.sha256, case.name);
            }
        }
    }
    lines
}
