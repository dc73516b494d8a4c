//! What both ends know about their displays.

use galpix_core::record::Field;
use galpix_link::frame::Galpixels;
use galpix_link::panel::{self, Lcd, Oled, Panel, Tft};
use galpix_link::rejected::Rejected;

use super::wire::crc32;

const OLED: u32 = Oled::DESCRIPTION.fingerprint;

#[test]
fn galpixels_go_into_the_map_of_their_panel_only() {
    let words: Vec<u8> = (0..24).collect();
    let frame = |fingerprint, y, x, words| Galpixels { update: 0, stamp: 0, fingerprint, y, x, words };
    let lcd = Lcd::DESCRIPTION;
    let stored: Vec<_> = frame(lcd.fingerprint, 239, 318, &words).stored(&lcd).unwrap().collect();
    assert_eq!(stored.len(), 2);
    assert_eq!((stored[0].x, stored[1].x, stored[1].y), (318, 319, 239));
    assert_eq!(stored[1].words, [0x0F0E_0D0C, 0x1312_1110, 0x1716_1514, 0, 0, 0, 0, 0]);
    let cause = |fingerprint, y, x, words| frame(fingerprint, y, x, words).stored(&lcd).map(|_| ()).unwrap_err();
    assert_eq!(cause(OLED, 0, 0, &words[..]), Rejected::WrongFingerprint);
    assert_eq!(cause(lcd.fingerprint, 0, 0, &words[..20]), Rejected::WrongLength);
    assert_eq!(cause(lcd.fingerprint, 0, 0, &[]), Rejected::WrongLength);
    assert_eq!(cause(lcd.fingerprint, 0, 319, &words[..]), Rejected::Outside);
    assert_eq!(cause(lcd.fingerprint, 240, 0, &words[..]), Rejected::Outside);
    assert_eq!(cause(lcd.fingerprint, 0, u16::MAX, &words[..]), Rejected::Outside);
    let stamped = Galpixels { stamp: u32::MAX, ..frame(lcd.fingerprint, 0, 0, &words) };
    assert_eq!((stamped.age(2), stamped.age(u32::MAX)), (3, 0));
}

/// Returns the bytes under a fingerprint, once more.
fn hashed<P: Panel>(channels: &[u8]) -> Vec<u8> {
    let record = P::RECORD;
    let mut bytes = vec![panel::VERSION];
    bytes.extend(P::WIDTH.to_le_bytes());
    bytes.extend(P::HEIGHT.to_le_bytes());
    bytes.push(record.words() as u8);
    let [x, y, z] = [0, 1, 2].map(|component| [record.velocity(component), record.acceleration(component)]);
    let head = [record.class(), record.depth(), record.offset_x(), record.offset_y()];
    let tail = [record.colour(), record.tag(), record.luminosity_rate(), record.luminosity()];
    for Field { bits, word, shift, spill } in [&head[..], &x, &y, &z, &tail].concat() {
        bytes.extend([bits, word, shift, spill]);
    }
    for scale in record.scales {
        bytes.extend([scale.acceleration_up, scale.down, scale.up, scale.position_frac].map(|number| number as u8));
        bytes.extend([scale.velocity_frac, scale.acceleration_frac, scale.velocity_bits].map(|number| number as u8));
    }
    bytes.push(record.luminosity_frac as u8);
    bytes.extend(channels);
    bytes
}

#[test]
fn fingerprints_are_of_what_gives_a_galpixel_its_meaning() {
    assert_eq!(Oled::DESCRIPTION.fingerprint, crc32(&hashed::<Oled>(&[0, 4])));
    assert_eq!(Tft::DESCRIPTION.fingerprint, crc32(&hashed::<Tft>(&[11, 5, 5, 6, 0, 5])));
    assert_eq!(Lcd::DESCRIPTION.fingerprint, crc32(&hashed::<Lcd>(&[11, 5, 5, 6, 0, 5])));
    for panel in panel::ALL {
        assert_eq!(panel::with_fingerprint(panel.fingerprint), Some(panel));
    }
    assert_eq!(panel::with_fingerprint(0), None);
}

#[test]
fn panels_fill_their_words() {
    assert_eq!((Oled::RECORD.words(), Oled::RECORD.bits(), Oled::DESCRIPTION.galpixels_per_frame()), (1, 32, 56));
    assert_eq!((Tft::RECORD.words(), Tft::RECORD.bits(), Tft::DESCRIPTION.galpixels_per_frame()), (2, 64, 28));
    assert_eq!((Lcd::RECORD.words(), Lcd::RECORD.bits(), Lcd::DESCRIPTION.galpixels_per_frame()), (3, 96, 18));
    assert_eq!((Oled::MAP_WORDS, Lcd::MAP_WORDS), (128 * 64, 3 * 320 * 240));
}
