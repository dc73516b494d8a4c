//! The serial line of `galpix-link`: frames come back, corruption is refused and costs no more than it must, panels
//! know each other.

mod document;
mod panels;
mod wire;

use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, Galpixels, MAX_ENCODED, MAX_PAYLOAD, MAX_WORD_BYTES, NO_SCENE, Status};
use galpix_link::panel::{Oled, Panel};
use galpix_link::picture::PictureHash;
use galpix_link::rejected::{Rejected, Rejections};
use galpix_tests::random;
use rand::{Rng, RngExt};
use wire::{Received, crc32, encoded, line, receive};

const OLED: u32 = Oled::DESCRIPTION.fingerprint;

/// Returns a frame of galpixels over these words.
fn galpixels(words: &[u8]) -> Frame<'_> {
    Frame::Galpixels(Galpixels { update: 7, stamp: 0x0102_0304, fingerprint: OLED, y: 63, x: 72, words })
}

const STATUS: Status = Status {
    frame: u32::MAX,
    fingerprint: OLED,
    width: 128,
    height: 64,
    words: 1,
    scene: 0,
    lockstep: true,
    accepted: 0,
    rejected: Rejections::from_counts([0, 1, 2, 3, 4, 5, 0x1000_0000, 7]),
    late: 0x0101_0101,
    busy: 1,
    ticks: u32::MAX,
    stack_used: 0,
    stack: 0x0100,
};

/// Frames of every kind, with extreme numbers, as the line carries them.
fn frames() -> Vec<Vec<u8>> {
    let mut generator = random::generator(1);
    let mut words = vec![vec![0; 4], vec![0; MAX_WORD_BYTES], vec![0xFF; MAX_WORD_BYTES], vec![1; 56]];
    words.extend((1..=MAX_WORD_BYTES / 4).map(|count| {
        // Mostly zeros, so that groups of every length are on the line.
        (0..4 * count).map(|_| if generator.random_bool(0.5) { 0 } else { generator.random() }).collect()
    }));
    let mut frames = vec![
        Frame::Hello,
        Frame::Scene { number: 0 },
        Frame::Scene { number: NO_SCENE },
        Frame::Lockstep { on: false },
        Frame::Lockstep { on: true },
        Frame::Go,
        Frame::Overlay { on: false },
        Frame::Overlay { on: true },
        Frame::Status(STATUS),
        Frame::Status(Status::default()),
        Frame::Shown { frame: 0, hash: 0 },
        Frame::Shown { frame: 1, hash: u32::MAX },
    ];
    frames.extend(words.iter().map(|words| galpixels(words)));
    frames.iter().map(encoded).collect()
}

#[test]
fn every_kind_comes_back() {
    for frame in frames() {
        assert!(frame.len() <= MAX_ENCODED);
        assert_eq!(frame.iter().position(|&byte| byte == 0), Some(frame.len() - 1), "the only 0 is the last byte");
        assert_eq!(receive(&frame), [Ok(frame.clone())]);
    }
    let mut decoder = Decoder::new();
    let mut received = None;
    for byte in encoded(&Frame::Status(STATUS)) {
        received = decoder.push(byte).map(|received| received == Ok(Frame::Status(STATUS)));
    }
    assert_eq!(received, Some(true), "not only the bytes come back, but their meaning");
}

#[test]
fn a_frame_on_the_line_is_what_the_document_says() {
    let words = [0x11, 0, 0, 0, 0xFF, 0xEE, 0, 0];
    let mut payload = vec![2, 7, 0, 4, 3, 2, 1];
    payload.extend(OLED.to_le_bytes());
    payload.extend([63, 0, 72, 0]);
    payload.extend(words);
    assert_eq!(encoded(&galpixels(&words)), line(&payload));
    let mut status = vec![0x81, 0xFF, 0xFF, 0xFF, 0xFF];
    status.extend(OLED.to_le_bytes());
    status.extend([128, 0, 64, 0, 1, 0, 1, 0, 0, 0, 0]);
    for count in [0u32, 1, 2, 3, 4, 5, 0x1000_0000, 7, 0x0101_0101, 1, u32::MAX, 0, 0x0100] {
        status.extend(count.to_le_bytes());
    }
    assert_eq!(encoded(&Frame::Status(STATUS)), line(&status));
    for (frame, payload) in [
        (Frame::Hello, &[1][..]),
        (Frame::Scene { number: 9 }, &[3, 9]),
        (Frame::Scene { number: NO_SCENE }, &[3, 0xFF]),
        (Frame::Lockstep { on: true }, &[4, 1]),
        (Frame::Go, &[5]),
        (Frame::Overlay { on: true }, &[6, 1]),
        (Frame::Shown { frame: 0x0403_0201, hash: 0x0807_0605 }, &[0x82, 1, 2, 3, 4, 5, 6, 7, 8]),
    ] {
        assert_eq!(encoded(&frame), line(payload));
    }
}

#[test]
fn what_cannot_be_sent_is_refused() {
    let mut buffer = [0; MAX_ENCODED];
    let words = [0; MAX_WORD_BYTES + 4];
    assert_eq!(galpixels(&words).encode(&mut buffer), Err(Rejected::TooLong));
    assert_eq!(galpixels(&[]).encode(&mut buffer), Err(Rejected::WrongLength));
    assert_eq!(galpixels(&words[..6]).encode(&mut buffer), Err(Rejected::WrongLength));
}

#[test]
fn every_cause_is_told() {
    let refused = |payload: &[u8], cause| assert_eq!(receive(&line(payload)), [Err(cause)], "{payload:02x?}");
    for kind in 0..=255 {
        let known = matches!(kind, 1..=6 | 0x81 | 0x82);
        // No kind has three bytes.
        refused(&[kind, 0, 0], if known { Rejected::WrongLength } else { Rejected::UnknownKind });
    }
    refused(&[1, 0], Rejected::WrongLength);
    refused(&[3], Rejected::WrongLength);
    refused(&[4, 2], Rejected::UnknownKind);
    refused(&[6, 2], Rejected::UnknownKind);
    refused(&[2; 15], Rejected::WrongLength);
    refused(&[2; 18], Rejected::WrongLength);
    refused(&[1; MAX_PAYLOAD], Rejected::WrongLength);
    refused(&[1; MAX_PAYLOAD + 1], Rejected::TooLong);
    refused(&[1; 5000], Rejected::TooLong);
    refused(&[], Rejected::CutShort);
    for bytes in [&[2, 0][..], &[1, 0], &[5, 1, 1, 1, 1, 0], &[0xFF; 5000], &[0xFF, 1, 0]] {
        let ended = [bytes, &[0]].concat();
        let cause = if bytes.len() > MAX_ENCODED { Rejected::TooLong } else { Rejected::CutShort };
        assert_eq!(receive(&ended), [Err(cause)], "{bytes:02x?}");
    }
    let mut wrong = encoded(&Frame::Hello);
    wrong[3] ^= 0x40;
    assert_eq!(receive(&wrong), [Err(Rejected::WrongChecksum)]);
    assert_eq!(receive(&[0; 100]), [], "empty frames are nothing");
}

#[test]
fn a_frame_cut_anywhere_costs_itself_alone() {
    let next = encoded(&Frame::Go);
    for frame in frames() {
        for cut in 0..frame.len() {
            // The line was interrupted, and what comes next starts with a 0, as a host's first byte is.
            let received = receive(&[&frame[..cut], &[0], &next].concat());
            match received.as_slice() {
                [last] if cut == 0 => assert_eq!(*last, Ok(next.clone())),
                [first, last] => {
                    // Cut before its 0, the frame has got one again.
                    assert_eq!(*first == Ok(frame.clone()), cut == frame.len() - 1, "{cut}");
                    assert!(first.is_err() || cut == frame.len() - 1, "{first:?}");
                    assert_eq!(*last, Ok(next.clone()));
                }
                more => panic!("{more:?}"),
            }
            // Without that 0 it takes the next frame with it and no more.
            let received = receive(&[&frame[..cut], &next, &next].concat());
            assert_eq!(received.last(), Some(&Ok(next.clone())));
            assert_eq!(received.len(), 2);
            assert!(cut == 0 || received[0].is_err());
        }
    }
}

/// Three frames of this kind between two others; the changes are made within the three.
fn stream(frame: &[u8], neighbours: &[Vec<u8>; 2]) -> Vec<u8> {
    [&neighbours[0], frame, frame, frame, &neighbours[1]].concat()
}

/// Checks what came of a stream of five frames, and returns how many of them are lost.
fn lost(received: &[Received], frame: &[u8], neighbours: &[Vec<u8>; 2], place: &str) -> usize {
    assert_eq!(received.first(), Some(&Ok(neighbours[0].clone())), "{place}");
    assert_eq!(received.last(), Some(&Ok(neighbours[1].clone())), "{place}");
    let accepted: Vec<_> =
        received[1..received.len() - 1].iter().filter_map(|received| received.as_ref().ok()).collect();
    assert!(accepted.iter().all(|accepted| *accepted == frame), "{place}: a frame that was not sent: {accepted:02x?}");
    assert!(accepted.len() <= 3, "{place}");
    3 - accepted.len()
}

#[test]
fn no_change_of_one_byte_gets_through_and_none_costs_more_than_two_frames() {
    let neighbours = [encoded(&Frame::Scene { number: 1 }), encoded(&Frame::Scene { number: 2 })];
    let (mut changes, mut losses) = (0, [0; 3]);
    // Every change of frames of all kinds, of some lengths: both ends of each length's range of COBS groups.
    let all = frames();
    for frame in all.iter().take(18).chain(all.iter().skip(18).step_by(20)) {
        let stream = stream(frame, &neighbours);
        let start = neighbours[0].len() + frame.len();
        for at in start..start + frame.len() {
            for change in 1..=255 {
                let mut changed = stream.clone();
                changed[at] ^= change;
                let lost = lost(&receive(&changed), frame, &neighbours, &format!("byte {at} ^ {change:02x}"));
                assert!(lost >= 1, "byte {at} ^ {change:02x}: changed and accepted");
                changes += 1;
                losses[lost] += 1;
            }
        }
    }
    assert!(changes > 300_000, "{changes}");
    assert_eq!(losses[0], 0);
    assert!(losses[2] > 0, "a lost 0 merges two frames");
    println!("{changes} changes of one byte: {} cost one frame, {} cost two", losses[1], losses[2]);
}

#[test]
fn a_lost_or_added_byte_costs_two_frames_at_most() {
    let neighbours = [encoded(&Frame::Scene { number: 1 }), encoded(&Frame::Scene { number: 2 })];
    let mut generator = random::generator(2);
    for frame in frames() {
        let stream = stream(&frame, &neighbours);
        let start = neighbours[0].len() + frame.len();
        for at in start..start + frame.len() {
            let mut shorter = stream.clone();
            let removed = shorter.remove(at);
            let cost = lost(&receive(&shorter), &frame, &neighbours, &format!("without byte {at}"));
            assert_eq!(cost, if removed == 0 { 2 } else { 1 }, "without byte {at}");
            let mut longer = stream.clone();
            longer.insert(at, generator.random());
            let added = longer[at];
            let cost = lost(&receive(&longer), &frame, &neighbours, &format!("{added:02x} before byte {at}"));
            // A 0 next to the 0 of a frame ends no frame.
            let nothing = added == 0 && (at == start || at == start + frame.len() - 1);
            assert_eq!(cost, usize::from(!nothing), "{added:02x} before byte {at}");
        }
    }
}

#[test]
fn noise_is_refused_for_every_reason_and_leaves_the_receiver_in_step() {
    let mut noise = vec![0; 1_000_000];
    random::generator(3).fill_bytes(&mut noise);
    // Small numbers in the second half: they are COBS much more often, so that checksums are reached.
    for byte in noise.iter_mut().skip(500_000) {
        *byte &= 3;
    }
    let received = receive(&noise);
    let mut rejections = Rejections::new();
    for received in &received {
        match received {
            Ok(frame) => panic!("noise was a frame: {frame:02x?}"),
            Err(cause) => rejections.count(*cause),
        }
    }
    assert!(rejections.total() as usize <= noise.iter().filter(|&&byte| byte == 0).count());
    for cause in [Rejected::TooLong, Rejected::CutShort, Rejected::WrongChecksum] {
        assert!(rejections.of(cause) > 10, "{cause}: {rejections:?}");
    }
    println!("1000000 random bytes: {rejections:?}");
    noise.push(0);
    noise.extend(encoded(&Frame::Hello));
    assert_eq!(receive(&noise).last(), Some(&Ok(encoded(&Frame::Hello))));
}

#[test]
fn a_picture_is_hashed_row_by_row() {
    let mut hash = PictureHash::new();
    hash.row([0x1234, 0xFFFF_0005]);
    hash.row([0xF]);
    assert_eq!(hash.finish(), crc32(&[0x34, 0x12, 0x05, 0, 0x0F, 0]));
    assert_eq!(PictureHash::default().finish(), 0);
    assert_eq!(crc32(b"123456789"), 0xCBF4_3926, "the check value of CRC-32/ISO-HDLC");
}
