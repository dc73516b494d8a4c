//! `docs/link.md` describes what the product does.

use std::path::Path;

use galpix_link::frame::{Frame, Galpixels, MAX_ENCODED, MAX_PAYLOAD, MAX_WORD_BYTES, Status};
use galpix_link::panel::{self, Lcd, Oled, Panel, Tft};
use galpix_link::rejected::Rejected;

use super::wire::{encoded, receive};

fn document() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/link.md")).unwrap()
}

/// Returns the cells of the table row that starts with these.
fn row<'d>(document: &'d str, cells: &[&str]) -> Vec<&'d str> {
    let start = format!("| {} |", cells.join(" | "));
    let line = document.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("no row {start}"));
    line[start.len()..].split('|').map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

/// Returns the bytes of the example, `number` from 0 on.
fn example(document: &str, number: usize) -> Vec<u8> {
    let block = document.split("```hex\n").nth(number + 1).and_then(|rest| rest.split("```").next()).unwrap();
    block.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect()
}

#[test]
fn the_examples_are_frames() {
    let document = document();
    let words = [0x0F, 0, 0, 0x80, 0, 0, 0, 0];
    let galpixels =
        Galpixels { update: 1, stamp: 1000, fingerprint: Oled::DESCRIPTION.fingerprint, y: 2, x: 5, words: &words };
    for (number, frame) in [Frame::Hello, Frame::Galpixels(galpixels)].iter().enumerate() {
        let bytes = example(&document, number);
        assert_eq!(bytes, encoded(frame), "example {number}: {:02x?}", encoded(frame));
        assert_eq!(receive(&bytes), [Ok(bytes.clone())]);
    }
}

#[test]
fn the_tables_are_those_of_the_product() {
    let document = document();
    for (panel, record) in
        [(Oled::DESCRIPTION, Oled::RECORD), (Tft::DESCRIPTION, Tft::RECORD), (Lcd::DESCRIPTION, Lcd::RECORD)]
    {
        let cells = row(&document, &[panel.name, &format!("{} x {}", panel.width, panel.height)]);
        let numbers =
            [record.words(), record.bits() as usize, panel.galpixels_per_frame()].map(|number| number.to_string());
        let fingerprint = format!("`{:08x}`", panel.fingerprint);
        let numbers = numbers.iter().map(String::as_str).chain([fingerprint.as_str()]).collect::<Vec<_>>();
        assert_eq!(cells, numbers, "{}", panel.name);
        for (name, field) in [
            ("class", record.class()),
            ("depth", record.depth()),
            ("offset in x", record.offset_x()),
            ("offset in y", record.offset_y()),
            ("velocity in x", record.velocity(0)),
            ("velocity in y", record.velocity(1)),
            ("acceleration in x", record.acceleration(0)),
            ("acceleration in y", record.acceleration(1)),
            ("colour", record.colour()),
            ("tag", record.tag()),
        ] {
            let cells = row(&document, &[panel.name, name]);
            let upper = field.bits - field.spill;
            let mut bits = match upper {
                0 => "–".to_owned(),
                1 => format!("word {}, bit {}", field.word, field.shift),
                upper => format!("word {}, bits {} to {}", field.word, field.shift + upper - 1, field.shift),
            };
            // The lower part is at the top of the next word.
            match field.spill {
                0 => {}
                1 => bits += &format!("; word {}, bit 31", field.word + 1),
                spill => bits += &format!("; word {}, bits 31 to {}", field.word + 1, 32 - spill),
            }
            assert_eq!(cells[0], bits, "{}, {name}", panel.name);
        }
    }
    for cause in Rejected::ALL {
        assert_eq!(row(&document, &[&(cause as u8).to_string(), cause.name()]).len(), 1);
    }
    let version = format!("Version {} ", panel::VERSION);
    assert!(document.contains(&version), "{version}");
    for number in [MAX_PAYLOAD, MAX_ENCODED, MAX_WORD_BYTES] {
        assert!(document.contains(&format!("{number} bytes")), "{number}");
    }
    // The payload is followed by the checksum, one byte of COBS and the 0.
    let status = encoded(&Frame::Status(Status::default())).len() - 6;
    assert!(document.contains(&format!("{status} bytes: Status")), "{status}");
}
