//! Damaged files: truncated at every length, with random bytes, with absurd sizes. Refused or read, never a panic.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use png::ColorType;

use super::super::manifest::MapFormat;
use super::super::source::{Size, Source};
use super::super::{CaptureError, ImportOptions, colour, load};
use super::encode::{self, Precision};
use super::folder::{self, Folder, H, SIZE, W, cells, check_refusal, source};

/// Random changes to each file, unless the time is over.
const CHANGES: u64 = 3000;
const TIME: Duration = Duration::from_millis(900);
/// Fewer where each change is written to a file.
const TEXT_CHANGES: u64 = 300;

type Reader = fn(&Source) -> Result<(), CaptureError>;

fn picture(source: &Source) -> Result<(), CaptureError> {
    folder::picture(source, None, Some(SIZE)).map(|picture| assert_eq!(picture.pixels.len(), W * H))
}

fn picture_of_any_size(source: &Source) -> Result<(), CaptureError> {
    folder::picture(source, None, None).map(|p| assert_eq!(p.pixels.len(), p.width * p.height))
}

fn mask(source: &Source) -> Result<(), CaptureError> {
    colour::mask(source, SIZE).map(|mask| assert_eq!(mask.len(), W * H))
}

fn map(source: &Source, format: MapFormat, channel: Option<&str>) -> Result<(), CaptureError> {
    folder::numbers(source, channel, format).map(|numbers| assert_eq!(numbers.len(), W * H))
}

fn raw(source: &Source) -> Result<(), CaptureError> {
    map(source, MapFormat::Raw, None)
}

fn flow(source: &Source) -> Result<(), CaptureError> {
    folder::flow_of(source, SIZE).map(|flow| assert_eq!(flow.len(), W * H))
}

/// Returns one small file of each format, and who reads it.
fn files() -> Vec<(&'static str, Vec<u8>, Reader)> {
    let ramp = cells(|x, y| x as f32 + y as f32 + 1.0);
    let doubled: Vec<f32> = ramp.iter().flat_map(|&v| [v, -v]).collect();
    let tripled: Vec<f32> = ramp.iter().flat_map(|&v| [v, -v, 0.0]).collect();
    let wide: Vec<u16> = tripled.iter().map(|v| (v * 512.0 + 20_000.0) as u16).collect();
    let narrow: Vec<u8> = tripled.iter().map(|v| (v * 10.0 + 90.0) as u8).collect();
    let combined = ["R", "G", "B"].map(|n| (n, ramp.clone()));
    let parts = [("Depth", vec![("Z", ramp.clone())]), ("Mist", vec![("M", ramp.clone())])];
    vec![
        ("rgb8.png", encode::png8(4, 3, ColorType::Rgb, &narrow), picture),
        ("rgb16.png", encode::png16(4, 3, ColorType::Rgb, &wide), picture),
        ("any.png", encode::png8(4, 3, ColorType::Rgb, &narrow), picture_of_any_size),
        ("a.jpg", encode::jpeg(4, 3, &narrow), picture),
        ("any.jpg", encode::jpeg(4, 3, &narrow), picture_of_any_size),
        ("half.exr", encode::exr(W, H, Precision::Half, &combined), picture),
        ("any.exr", encode::exr(W, H, Precision::Float, &combined), picture_of_any_size),
        ("z.exr", encode::exr(W, H, Precision::Float, &combined[..1]), raw),
        ("parts.exr", encode::exr_parts(W, H, &parts), |s| map(s, MapFormat::Raw, Some("Depth.Z"))),
        ("mask.png", encode::png8(4, 3, ColorType::Grayscale, &narrow[..12]), mask),
        ("grey16.png", encode::png16(4, 3, ColorType::Grayscale, &wide[..12]), raw),
        ("kitti.png", encode::png16(4, 3, ColorType::Rgb, &wide), flow),
        ("kitti-d.png", encode::png16(4, 3, ColorType::Grayscale, &wide[..12]), |s| {
            map(s, MapFormat::KittiDisparity, None)
        }),
        ("sintel-d.png", encode::png8(4, 3, ColorType::Rgb, &narrow), |s| map(s, MapFormat::SintelDisparity, None)),
        ("a.flo", encode::pieh(4, 3, &doubled), flow),
        ("a.dpt", encode::pieh(4, 3, &ramp), raw),
        ("a.npy", encode::npy_f4("(3, 4)", &ramp), raw),
        ("flow.npy", encode::npy_f4("(3, 4, 2)", &doubled), flow),
        ("long.npy", encode::npy(3, "<f4", true, "(3, 4)", &[0; 48]), raw),
        ("a.npz", encode::npz(&[("z", encode::npy_f4("(3, 4)", &ramp))], false), raw),
        ("packed.npz", encode::npz(&[("f", encode::npy_f4("(3, 4, 2)", &doubled))], true), flow),
        ("turned.jpg", encode::jpeg_with_exif(&encode::jpeg(4, 3, &narrow), &encode::exif(3)), picture),
        ("window.exr", encode::exr_window([2, 2], [1, 1], [4, 3], &[("Z", vec![2.0; 4])]), raw),
        ("motion.exr", encode::exr(W, H, Precision::Half, &[("u", ramp.clone()), ("v", ramp.clone())]), flow),
        ("rgb24.png", encode::png8(4, 3, ColorType::Rgb, &narrow), |s| map(s, MapFormat::Rgb24, None)),
        ("a.pfm", encode::pfm(W, H, 1, false, &ramp), raw),
        ("flow.pfm", encode::pfm(W, H, 3, true, &tripled), flow),
    ]
}

/// Runs `reader`, and reports which file made it panic.
fn run(name: &str, bytes: Vec<u8>, reader: Reader, about: &str) -> Result<(), CaptureError> {
    let source = source(name, bytes);
    catch_unwind(AssertUnwindSafe(|| reader(&source)))
        .unwrap_or_else(|_| panic!("{name}, {about}: the reader panicked on {:02x?}", source.bytes))
}

#[test]
fn whole_files_are_read() {
    for (name, bytes, reader) in files() {
        assert_eq!(run(name, bytes, reader, "whole"), Ok(()));
    }
}

#[test]
fn truncated_at_any_length_they_are_refused() {
    for (name, bytes, reader) in files() {
        for length in 0..bytes.len() {
            match run(name, bytes[..length].to_vec(), reader, &format!("{length} bytes")) {
                Ok(()) => panic!("{name} of {} bytes is accepted with {length}", bytes.len()),
                Err(error) => drop(check_refusal(&error, name, "")),
            }
        }
    }
}

/// xorshift64*, Vigna 2016.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % bound
    }

    /// Returns `bytes` with one to four of them replaced, sometimes by an extreme one, sometimes one inserted or
    /// removed.
    fn damage(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            match self.below(8) {
                0 => bytes.insert(at, self.below(256) as u8),
                1 if bytes.len() > 1 => drop(bytes.remove(at)),
                2 => bytes[at] = 0xff,
                3 => bytes[at] = 0,
                4 => bytes[at] ^= 1 << self.below(8),
                _ => bytes[at] = self.below(256) as u8,
            }
        }
        bytes
    }
}

#[test]
fn random_damage_never_panics() {
    std::thread::scope(|scope| {
        for (name, bytes, reader) in files() {
            scope.spawn(move || {
                let (start, mut random) = (Instant::now(), Random(0x9e37_79b9_7f4a_7c15));
                for change in 0..CHANGES {
                    let damaged = random.damage(&bytes);
                    if let Err(error) = run(name, damaged, reader, &format!("change {change}")) {
                        check_refusal(&error, name, "");
                    }
                    if start.elapsed() > TIME && change >= 100 {
                        eprintln!("{name}: {} of {CHANGES} changes in time", change + 1);
                        break;
                    }
                }
            });
        }
    });
}

/// The texts of a capture: its manifest and a path in each layout.
#[test]
fn damaged_texts_never_panic() {
    let path = "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n".repeat(3);
    let identity = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
    let frame = format!("{{\"transform_matrix\": {identity}}}");
    let texts = [
        ("log", path),
        ("tum", "1 0 0 0 0 0 0 1\n".repeat(3)),
        ("tartanair", "0 0 0 0 0 0 1\n".repeat(3)),
        ("kitti", "1 0 0 0 0 1 0 0 0 0 1 0\n".repeat(3)),
        ("euroc", "1000000000,0,0,0,1,0,0,0\n2000000000,0,0,0,1,0,0,0\n3000000000,0,0,0,1,0,0,0\n".to_owned()),
        ("colmap", "1 1 0 0 0 0 0 0 1 a1.png\n\n2 1 0 0 0 0 0 0 1 a2.png\n\n3 1 0 0 0 0 0 0 1 a3.png\n\n".to_owned()),
        ("transforms", format!("{{\"fl_x\": 9, \"cx\": 2, \"cy\": 1, \"frames\": [{frame}, {frame}, {frame}]}}")),
        ("matrix-files", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n".to_owned()),
    ];
    let folder = Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]));
    let mut random = Random(0xdead_beef_cafe_f00d);
    let check = |name: &str| {
        let loaded = catch_unwind(AssertUnwindSafe(|| load(folder.path(), &ImportOptions::default())));
        match loaded.unwrap_or_else(|_| panic!("{name}: panicked on {:?}", std::fs::read(folder.path().join(name)))) {
            Ok(capture) => {
                for sample in &capture.update.samples {
                    assert!(sample.velocity.iter().chain(&sample.acceleration).all(|v| v.is_finite()));
                }
            }
            Err(error) => drop(check_refusal(&error, "", "")),
        }
    };
    for (format, text) in texts {
        let poses = if format == "matrix-files" { "p{}" } else { "p1" };
        let manifest = super::folder::manifest(
            "{ kind = \"z\", file = \"z.npy\" }",
            &format!(
                "{{ kind = \"camera\", format = \"{format}\", poses = \"{poses}\", pose = 1, intrinsics = [9, 9, 2, 1] }}"
            ),
            "",
        );
        for number in 0..3 {
            folder.write(&format!("p{number}"), &text);
        }
        folder.load(&manifest).unwrap();
        for _ in 0..TEXT_CHANGES {
            folder.write("p1", random.damage(text.as_bytes()));
            check("p1");
        }
        folder.write("p1", &text);
        for _ in 0..TEXT_CHANGES {
            folder.write("capture.toml", random.damage(manifest.as_bytes()));
            check("capture.toml");
        }
    }
}

/// Returns `bytes` with `new` at `at`.
fn patched(mut bytes: Vec<u8>, at: usize, new: &[u8]) -> Vec<u8> {
    bytes[at..at + new.len()].copy_from_slice(new);
    bytes
}

/// Returns a PNG whose header is sound and says `side` x `side`.
fn png_of(side: u32) -> Vec<u8> {
    let sides = [side.to_be_bytes(), side.to_be_bytes()].concat();
    let mut file = patched(encode::png8(4, 3, ColorType::Grayscale, &[0; 12]), 16, &sides);
    let sum = file[12..29].iter().fold(!0_u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 })
    });
    file[29..33].copy_from_slice(&(!sum).to_be_bytes());
    file
}

#[test]
fn absurd_sizes_are_refused_before_anything_is_allocated() {
    let mut exr =
        encode::exr(W, H, Precision::Float, &[("R", vec![0.0; 12]), ("G", vec![0.0; 12]), ("B", vec![0.0; 12])]);
    // Windows are two corners, the second one included: (0, 0) to (3, 2).
    let window: Vec<u8> = [0, 0, 3, 2].iter().flat_map(|v: &i32| v.to_le_bytes()).collect();
    let places: Vec<usize> = exr.windows(16).enumerate().filter(|(_, w)| *w == window).map(|(at, _)| at).collect();
    assert_eq!(places.len(), 2, "data window and display window");
    for at in places {
        exr = patched(exr, at + 8, &[0xfe, 0xff, 0xff, 0x7f, 0xfe, 0xff, 0xff, 0x7f]);
    }
    let jpeg = encode::jpeg(4, 3, &[0; 36]);
    let frame = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
    let huge = i32::MAX.to_le_bytes();
    let huge_pieh = patched(encode::pieh(4, 3, &[0.0; 24]), 4, &[huge, huge].concat());
    let any = |s: &Source| folder::picture(s, None, None).map(drop);
    let cases: [(&str, Vec<u8>, Reader); 12] = [
        ("a.png", png_of(2_000_000_000), any),
        ("b.png", png_of(16_384), any),
        ("a.jpg", patched(jpeg.clone(), frame + 5, &[0xff; 4]), any),
        ("a.exr", exr, any),
        ("a.flo", huge_pieh.clone(), flow),
        ("a.dpt", huge_pieh, raw),
        ("n.flo", encode::pieh(-4, -3, &[0.0; 24]), flow),
        ("a.npy", encode::npy_f4("(4000000000, 4000000000)", &[0.0; 12]), raw),
        ("b.npy", encode::npy_f4("(18446744073709551615, 18446744073709551615, 4)", &[0.0; 12]), raw),
        ("c.npy", encode::npy_f4("(18446744073709551616, 1)", &[0.0; 12]), raw),
        ("a.pfm", b"Pf\n4000000000 4000000000\n-1.0\n0000".to_vec(), raw),
        ("b.pfm", b"PF\n99999999999999999999 3\n-1.0\n0000".to_vec(), flow),
    ];
    for (name, bytes, reader) in cases {
        let start = Instant::now();
        let error = run(name, bytes, reader, "absurd size").expect_err(name);
        check_refusal(&error, name, "");
        assert!(start.elapsed() < Duration::from_millis(100), "{name} took {:?}", start.elapsed());
    }
    // The largest sizes that are allowed, in files that hold nothing of it.
    let allowed = Size { width: 16_384, height: 4096 };
    let error = folder::flow_of(&source("l.flo", encode::pieh(16_384, 4096, &[0.0; 24])), allowed).unwrap_err();
    check_refusal(&error, "l.flo", "where its header promises 536870912");
}

/// A tile that the header makes larger than any picture costs nothing.
#[test]
fn tiles_far_beyond_the_picture_are_refused() {
    let exr = encode::exr_tiled(W, H, &[("Z", vec![2.0; W * H])]);
    raw(&source("tiled.exr", exr.clone())).unwrap();
    let tag = b"tiledesc\0\x09\0\0\0";
    let at = exr.windows(tag.len()).position(|window| window == tag).unwrap() + tag.len();
    let huge = patched(exr, at, &[0x40, 0, 0xf8, 0]);
    let error = raw(&source("tiled.exr", huge)).unwrap_err();
    check_refusal(&error, "tiled.exr", "has tiles of 16252992x64, beyond its picture of 4x3");
}

/// The decoder would paint what is not there.
#[test]
fn a_jpeg_that_is_too_short_for_its_size_is_refused() {
    let jpeg = encode::jpeg(W as u32, H as u32, &cells(folder::colour).concat());
    picture(&source("short.jpg", jpeg.clone())).unwrap();
    // The frame header: its length, the precision, rows, columns.
    let at = jpeg.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap() + 5;
    let large = patched(jpeg, at, &[0x10, 0, 0x20, 0]);
    let error = picture_of_any_size(&source("short.jpg", large)).unwrap_err();
    check_refusal(&error, "short.jpg", "too short for the 8192x4096 pixels");
}
