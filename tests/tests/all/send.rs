//! `galpix send` from end to end: a device at the other end of a socket, of a serial line, or none at all.

mod device;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use device::{Device, connection, memory, port};
use galpix_core::Galpixel;
use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, Galpixels, NO_SCENE};
use galpix_link::panel::{Lcd, Oled, Panel};
use galpix_link::rejected::Rejected;
use galpix_sim::send::{self, Address, Report, Request, SendError};
use galpix_sim::source::Source;
use galpix_sim::source::capture::ImportOptions;
use galpix_sim::source::{fit, scene};
use galpix_tests::random;
use rand::RngExt;

const ONE: Request = Request { panel: None, updates: 1, every: 8, over_scene: false };

fn marbles() -> Source {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles/capture.toml");
    Source::open(&manifest.to_string_lossy(), &ImportOptions::default()).unwrap()
}

fn scene_source(name: &str) -> Source {
    Source::open(name, &ImportOptions::default()).unwrap()
}

/// Returns a scene on a panel, as the first update.
fn scene_on<P: Panel>(name: &str, time: u32) -> Vec<Galpixel> {
    tagged::<P>(name, time, 0)
}

/// Returns the same as update number `tag`.
fn tagged<P: Panel>(name: &str, time: u32, tag: u32) -> Vec<Galpixel> {
    let galpixels = fit::scene(scene::find(name).unwrap(), f64::from(time), P::WIDTH.into(), P::HEIGHT.into());
    galpixels.into_iter().map(|galpixel| Galpixel { tag, ..galpixel }).collect()
}

/// Sends to an address.
fn sent(source: &Source, request: &Request, to: &Address) -> Result<Report, SendError> {
    let mut line = to.open(None).unwrap_or_else(|error| panic!("{error}"));
    let (mut rows, mut all) = (0, 0);
    let report = send::send(source, request, line.as_mut(), to, |done, total| (rows, all) = (done, total));
    assert!(report.is_err() || (rows == all && rows > 0), "{rows} of {all} rows");
    report
}

/// Sends to a device at a port of its own, and returns how both saw it.
fn over_tcp(
    source: &Source,
    request: &Request,
    mut device: Device,
    noise: impl FnMut(usize, &mut Vec<u8>) + Send,
) -> (Result<Report, SendError>, Device) {
    let (listener, address) = port();
    thread::scope(|scope| {
        let living = scope.spawn(move || {
            device.live(connection(&listener), &AtomicBool::new(false), noise);
            device
        });
        let report = sent(source, request, &address);
        (report, living.join().unwrap())
    })
}

fn no_noise(_: usize, _: &mut Vec<u8>) {}

#[test]
fn every_galpixel_of_a_scene_arrives() {
    let (report, device) = over_tcp(&scene_source("drift"), &ONE, Device::new::<Oled>(), no_noise);
    let report = report.unwrap();
    assert!(device.memory == memory::<Oled>(&scene_on::<Oled>("drift", 0)), "another map");
    // 128 galpixels per row, 56 in a frame at most; the device's counter stood at 1003 at the request.
    assert_eq!((report.panel, report.frames, report.bytes), ("oled", 3 * 64, 3 * 64 * 21 + 64 * 128 * 4 + 6 * 8));
    assert_eq!(report.updates.len(), 1);
    assert_eq!((report.updates[0].stamp, report.updates[0].time, report.updates[0].galpixels), (1003, 0, 8192));
    assert_eq!(device.stamps, vec![(0, 1003, 0); 192]);
    assert_eq!(device.status.scene, NO_SCENE, "only what is sent is seen");
    assert!(!device.status.lockstep, "it goes on");
    let answer = report.device.unwrap();
    assert_eq!((answer.frame, answer.accepted, answer.refused, answer.late), (1006, 192, 0, 0));
}

#[test]
fn a_capture_arrives_on_the_larger_panel() {
    let source = marbles();
    let (report, device) = over_tcp(&source, &ONE, Device::new::<Lcd>(), no_noise);
    let report = report.unwrap();
    assert!(device.memory == memory::<Lcd>(&fit::update(&source.update(), 320, 240)), "another map");
    assert_eq!((report.panel, report.frames), ("lcd", 18 * 240));
    assert_eq!(report.device.unwrap().accepted, 18 * 240);
    assert_eq!(report.updates[0].galpixels + report.updates[0].empty, 320 * 240);
}

#[test]
fn a_tenth_of_the_frames_is_corrupted_and_the_rest_is_right() {
    let mut generator = random::generator(5);
    let (mut corrupted, mut lost) = (0, Vec::new());
    let noise = |count: usize, frame: &mut Vec<u8>| {
        // Not the first request: it would be repeated.
        if count % 10 == 5 {
            let mut decoder = Decoder::new();
            let whole: Vec<u8> = frame.iter().copied().chain([0]).collect();
            for byte in whole {
                if let Some(Ok(Frame::Galpixels(galpixels))) = decoder.push(byte) {
                    let Galpixels { x, y, words, .. } = galpixels;
                    let first = usize::from(y) * 128 + usize::from(x);
                    lost.extend(first..first + words.len() / 4);
                }
            }
            let at = generator.random_range(0..frame.len());
            frame[at] = frame[at] % 255 + 1;
            corrupted += 1;
        }
    };
    let (report, device) = over_tcp(&scene_source("crossing"), &ONE, Device::new::<Oled>(), noise);
    let report = report.unwrap();
    assert_eq!(corrupted, 20, "of 192 frames of galpixels and six others");
    assert!(report.updates[0].saturated > 0, "the tram is faster than 4 cells a frame");
    let answer = report.device.unwrap();
    assert_eq!((report.frames, answer.accepted, answer.refused), (192, 192 - 20, 20), "{:?}", answer.rejected);
    let rejected = device.status.rejected;
    assert_eq!(rejected.of(Rejected::WrongChecksum) + rejected.of(Rejected::CutShort), 20);
    assert_eq!(answer.rejected["wrong_checksum"], rejected.of(Rejected::WrongChecksum));
    // What was lost is as it was before; a word is a galpixel here.
    let (mut expected, before) = (memory::<Oled>(&scene_on::<Oled>("crossing", 0)), memory::<Oled>(&[]));
    assert!(lost.len() > 500, "{}", lost.len());
    for cell in lost {
        expected[cell] = before[cell];
    }
    assert!(device.memory == expected, "another map");
}

#[test]
fn a_scene_follows_the_devices_frames() {
    let request = Request { updates: 4, every: 20, ..ONE };
    let (report, device) = over_tcp(&scene_source("drift"), &request, Device::new::<Oled>(), no_noise);
    let report = report.unwrap();
    // The counter goes on by 3 with each question: it is 21 and 42 frames on when 20, 40 and 60 are due.
    let stamps: Vec<_> = report.updates.iter().map(|sent| (sent.update, sent.stamp, sent.time)).collect();
    assert_eq!(stamps, [(0, 1003, 0), (1, 1024, 21), (2, 1045, 42), (3, 1063, 60)]);
    assert!(device.memory == memory::<Oled>(&tagged::<Oled>("drift", 60, 3)), "another map");
    assert!(device.memory != memory::<Oled>(&scene_on::<Oled>("drift", 60)), "the tag is stored");
    let mut expected: Vec<_> = stamps.iter().map(|&(update, stamp, _)| (update, stamp, 0)).collect();
    expected = expected.iter().flat_map(|&stamp| [stamp; 192]).collect();
    assert_eq!(device.stamps, expected);
    assert_eq!(report.device.unwrap().accepted, 4 * 192);
}

#[test]
fn a_device_in_lockstep_is_told_to_go_on() {
    let mut device = Device::new::<Lcd>();
    (device.status.lockstep, device.pace) = (true, 1);
    let request = Request { updates: 2, every: 5, ..ONE };
    let (report, device) = over_tcp(&scene_source("drift"), &request, device, no_noise);
    let stamps: Vec<_> = report.unwrap().updates.iter().map(|sent| (sent.stamp, sent.time)).collect();
    assert_eq!(stamps, [(1000, 0), (1005, 5)], "not a frame more than is due");
    assert!(device.memory == memory::<Lcd>(&tagged::<Lcd>("drift", 5, 1)), "another map");
    assert!(device.stamps.iter().all(|&(_, _, age)| age == 0));
    assert!(device.status.lockstep, "it was before");
}

#[test]
fn a_device_is_told_again_to_go_on() {
    // A question, the scene, lockstep, a question, the update: then it shall go on, and does not hear it.
    let noise = |count: usize, frame: &mut Vec<u8>| {
        if count == 4 + 192 {
            frame.clear();
        }
    };
    let (report, device) = over_tcp(&scene_source("still"), &ONE, Device::new::<Oled>(), noise);
    assert_eq!(report.unwrap().device.unwrap().accepted, 192);
    assert!(!device.status.lockstep);
}

#[test]
fn a_scene_of_the_device_may_stay() {
    let request = Request { over_scene: true, ..ONE };
    let (report, device) = over_tcp(&scene_source("drift"), &request, Device::new::<Oled>(), no_noise);
    assert_eq!((report.unwrap().frames, device.status.scene), (192, 0));
}

#[test]
fn a_lost_question_is_asked_again() {
    let noise = |count: usize, frame: &mut Vec<u8>| {
        if count == 0 {
            frame.clear();
        }
    };
    let (report, device) = over_tcp(&scene_source("still"), &ONE, Device::new::<Oled>(), noise);
    assert_eq!(report.unwrap().device.unwrap().accepted, 192);
    assert!(device.memory == memory::<Oled>(&scene_on::<Oled>("still", 0)), "another map");
}

#[test]
fn devices_that_cannot_be_served_are_refused_in_a_sentence() {
    let refused = |request: &Request, device: Device, words: &[&str], unusable: bool| {
        let (report, device) = over_tcp(&scene_source("still"), request, device, no_noise);
        let error = report.unwrap_err();
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
        assert_eq!(error.unusable(), unusable, "{error}");
        device
    };
    let wanted = Request { panel: Some(Lcd::DESCRIPTION), ..ONE };
    let device = refused(&wanted, Device::new::<Oled>(), &["no lcd", "but oled"], true);
    assert!(device.stamps.is_empty(), "nothing was sent");
    let mut stranger = Device::new::<Oled>();
    stranger.status.fingerprint ^= 1;
    refused(&ONE, stranger, &["128x64 galpixels of 1 words", "no panel's here"], true);
    let mut standing = Device::new::<Oled>();
    standing.pace = 0;
    refused(&Request { updates: 2, ..ONE }, standing, &["stands still at frame 1000"], false);
}

#[test]
fn a_line_without_a_device_is_told() {
    // Something listens, and does not answer.
    let (listener, address) = port();
    let error = sent(&scene_source("still"), &ONE, &address).unwrap_err();
    assert!(error.unusable() && error.to_string().contains("did not answer a Hello within 2 s"), "{error}");
    drop(listener);
    // Nothing listens.
    let Err(error) = address.open(None) else { panic!("{address} is reached") };
    assert!(error.to_string().contains("cannot be reached"), "{error}");
    // Somebody hangs up.
    let (listener, address) = port();
    let error = thread::scope(|scope| {
        scope.spawn(|| drop(listener.accept().unwrap()));
        sent(&scene_source("still"), &ONE, &address).unwrap_err()
    });
    assert!(!error.unusable() && error.to_string().contains("broke after"), "{error}");
}

#[test]
fn a_capture_is_one_update() {
    let (_listener, address) = port();
    let error = Request { updates: 2, ..ONE }.check(&marbles(), &address).unwrap_err();
    assert!(error.unusable() && error.to_string().contains("is one update: leave out --updates 2"), "{error}");
}

#[test]
fn a_file_keeps_the_stream() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("stream");
    let address = Address::File(path.clone());
    let request = Request { panel: Some(Oled::DESCRIPTION), updates: 2, every: 5, ..ONE };
    let report = sent(&scene_source("drift"), &request, &address).unwrap();
    assert!(report.device.is_none());
    assert_eq!(report.updates.iter().map(|sent| sent.stamp).collect::<Vec<_>>(), [0, 5]);
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(bytes.len() as u64, report.bytes);
    // A device that gets the stream later, as from `cat`.
    let mut device = Device::new::<Oled>();
    let line = std::io::Cursor::new(bytes);
    device.live(ReadOnly(line), &AtomicBool::new(false), no_noise);
    assert!(device.memory == memory::<Oled>(&tagged::<Oled>("drift", 5, 1)), "another map");
    assert_eq!(device.stamps.len(), 2 * 192);
}

/// A line whose answers are lost.
struct ReadOnly<R>(R);

impl<R: std::io::Read> std::io::Read for ReadOnly<R> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.0.read(bytes)
    }
}

impl<R> std::io::Write for ReadOnly<R> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(unix)]
#[test]
fn a_socket_in_the_file_system_carries_it_too() {
    use std::os::unix::net::UnixListener;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("uart");
    let listener = UnixListener::bind(&path).unwrap();
    let device = thread::scope(|scope| {
        let living = scope.spawn(|| {
            let mut device = Device::new::<Oled>();
            device.live(listener.accept().unwrap().0, &AtomicBool::new(false), no_noise);
            device
        });
        let report = sent(&scene_source("drift"), &ONE, &Address::Unix(path.clone())).unwrap();
        assert_eq!(report.device.unwrap().accepted, 192);
        living.join().unwrap()
    });
    assert!(device.memory == memory::<Oled>(&scene_on::<Oled>("drift", 0)), "another map");
}

#[cfg(target_os = "linux")]
#[test]
fn a_serial_line_carries_it_too() {
    use serialport::{SerialPort, TTYPort};
    // A pseudo-terminal: the device holds one end, and the other one is opened by its path.
    let (controller, held_open) = TTYPort::pair().expect("a pseudo-terminal");
    let path = held_open.name().expect("its path");
    let stop = AtomicBool::new(false);
    let device = thread::scope(|scope| {
        let living = scope.spawn(|| {
            let mut device = Device::new::<Oled>();
            device.live(controller, &stop, no_noise);
            device
        });
        let report = sent(&scene_source("drift"), &ONE, &Address::Serial(path));
        stop.store(true, Ordering::Relaxed);
        assert_eq!(report.unwrap().device.unwrap().accepted, 192);
        living.join().unwrap()
    });
    assert!(device.memory == memory::<Oled>(&scene_on::<Oled>("drift", 0)), "another map");
}
