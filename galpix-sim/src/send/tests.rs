use galpix_link::panel::{Lcd, Oled, Panel};

use super::*;
use crate::source::scene;

#[test]
fn addresses_are_distinguished() {
    let address = |text: &str| text.parse::<Address>();
    assert_eq!(address("tcp:localhost:5000"), Ok(Address::Tcp("localhost:5000".to_owned())));
    assert_eq!(address("tcp:[::1]:5000"), Ok(Address::Tcp("[::1]:5000".to_owned())));
    assert_eq!(address("unix:/tmp/uart.sock"), Ok(Address::Unix("/tmp/uart.sock".into())));
    assert_eq!(address("file:a:b"), Ok(Address::File("a:b".into())));
    assert_eq!(address("/dev/ttyUSB0"), Ok(Address::Serial("/dev/ttyUSB0".to_owned())));
    assert_eq!(address("COM3"), Ok(Address::Serial("COM3".to_owned())));
    for text in ["", "tcp:", "tcp:localhost", "tcp::5000", "tcp:localhost:", "tcp:localhost:65536", "unix:", "file:"] {
        let sentence = address(text).unwrap_err();
        assert!(sentence.contains("tcp:HOST:PORT"), "{text}: {sentence}");
    }
    for text in ["tcp:localhost:5000", "unix:/tmp/uart.sock", "file:stream", "/dev/ttyUSB0"] {
        assert_eq!(address(text).unwrap().to_string(), text);
    }
}

#[test]
fn a_speed_is_for_serial_devices() {
    for text in ["tcp:localhost:5000", "unix:/tmp/uart.sock", "file:stream"] {
        let Err(error) = text.parse::<Address>().unwrap().open(Some(9600)) else { panic!("{text} has a speed") };
        assert!(matches!(error, OpenError::NoBaud(_)), "{error}");
    }
}

#[test]
fn the_panel_is_the_devices_and_must_be_the_one_asked_for() {
    let status = |fingerprint| Status { fingerprint, width: 5, height: 4, words: 3, ..Status::default() };
    let (oled, lcd) = (Oled::DESCRIPTION, Lcd::DESCRIPTION);
    let found = |wanted, status: Option<&Status>| panel_of(wanted, status, "here").map_err(|error| error.to_string());
    assert_eq!(found(None, Some(&status(lcd.fingerprint))), Ok(lcd));
    assert_eq!(found(Some(lcd), Some(&status(lcd.fingerprint))), Ok(lcd));
    assert_eq!(found(Some(oled), None), Ok(oled));
    let refused = |wanted, status: Option<&Status>, words: &[&str]| {
        let sentence = found(wanted, status).unwrap_err();
        assert!(words.iter().all(|word| sentence.contains(word)), "{sentence}");
    };
    refused(None, None, &["--panel oled"]);
    refused(Some(oled), Some(&status(lcd.fingerprint)), &["no oled", "but lcd", "leave out --panel"]);
    refused(Some(oled), Some(&status(0xABC)), &["no oled", "5x4 galpixels of 3 words", "00000abc"]);
    refused(None, Some(&status(0xABC)), &["5x4 galpixels of 3 words", "00000abc", "the same sources"]);
}

#[test]
fn words_of_a_galpixel_stand_side_by_side() {
    let crossing = scene::find("crossing").unwrap();
    for panel in panel::ALL {
        let (width, height) = (usize::from(panel.width), usize::from(panel.height));
        let packed = pack(&panel, &fit::scene(crossing, 0.0, width, height)).unwrap();
        assert_eq!(packed.bytes.len(), width * height * panel.bytes_per_galpixel());
        assert_eq!(packed.rows(&panel).count(), height);
        let empty = pack(&panel, &[]).unwrap();
        let bytes = panel.bytes_per_galpixel();
        assert!(empty.bytes.chunks(bytes).all(|galpixel| *galpixel == empty.bytes[..bytes]), "{}", panel.name);
        // The first galpixel is stored like any other one with the same content.
        let first = pack(&panel, &fit::scene(crossing, 0.0, width, height)[..1]).unwrap();
        assert_eq!(first.bytes[..bytes], packed.bytes[..bytes]);
        assert_eq!(first.bytes[bytes..], empty.bytes[bytes..]);
    }
}
