//! Motion from flows and disparities.

use png::ColorType;

use super::encode::{self, Precision};
use super::folder::{Folder, H, SIZE, W, cells, check_refusal, empty, flow_of, known, near, source};

const SPEED: &str = "{ kind = \"speed\" }";

/// Returns a displacement that KITTI's steps of 1/64 pixel and half floats hold exactly.
fn uv(x: usize, y: usize) -> [f32; 2] {
    [x as f32 - 1.5, 0.25 * y as f32 - 2.0]
}

#[track_caller]
fn check(bytes: Vec<u8>) {
    let found = flow_of(&source("a.flow", bytes), SIZE).unwrap();
    for (found, wanted) in found.iter().zip(cells(uv)) {
        near(&found.expect("known"), &wanted.map(f64::from), 0.0);
    }
}

/// 16-bit RGB as in KITTI.
fn kitti(valid: impl Fn(usize, usize) -> u16) -> Vec<u8> {
    let code = |v: f32| (v * 64.0 + 32_768.0) as u16;
    let rgb = cells(|x, y| [code(uv(x, y)[0]), code(uv(x, y)[1]), valid(x, y)]).concat();
    encode::png16(4, 3, ColorType::Rgb, &rgb)
}

#[test]
fn flows_of_every_format_are_read_exactly() {
    let pairs: Vec<f32> = cells(uv).concat();
    check(encode::pieh(4, 3, &pairs));
    check(kitti(|_, _| 1));
    check(encode::npy_f4("(3, 4, 2)", &pairs));
    let triples: Vec<f32> = cells(|x, y| [uv(x, y)[0], uv(x, y)[1], 99.0]).concat();
    for little in [false, true] {
        check(encode::pfm(W, H, 3, little, &triples));
    }
    let planar: Vec<u8> =
        (0..2).flat_map(|b| (0..W).flat_map(move |x| (0..H).flat_map(move |y| uv(x, y)[b].to_le_bytes()))).collect();
    check(encode::npy(1, "<f4", true, "(3, 4, 2)", &planar));
    for (bytes, what) in [
        (encode::pfm(W, H, 1, true, &[0.0; 12]), "one number a pixel"),
        (encode::npy_f4("(3, 4)", &[0.0; 12]), "one number a pixel"),
        (encode::pieh(4, 3, &[0.0; 12]), "holds 48 bytes of values where its header promises 96"),
        (encode::png8(4, 3, ColorType::Rgb, &[0; 36]), "16-bit RGB"),
        (encode::jpeg(4, 3, &[0; 36]), "no optical flow"),
        (encode::exr(W, H, Precision::Half, &[("VX", vec![0.0; 12])]), "none whose name says that it is the motion"),
    ] {
        check_refusal(&flow_of(&source("a.flow", bytes), SIZE).unwrap_err(), "a.flow", what);
    }
}

#[test]
fn unknown_flow_starts_empty_and_is_counted() {
    let mut pairs: Vec<f32> = cells(uv).concat();
    (pairs[0], pairs[3], pairs[4]) = (f32::NAN, 1.7e9, f32::NEG_INFINITY);
    let folder = Folder::new().with("a.flo", encode::pieh(4, 3, &pairs)).with("k.png", kitti(|x, _| u16::from(x > 0)));
    let capture = folder.update(SPEED, "{ kind = \"flow\", file = \"a.flo\" }", "").unwrap();
    assert_eq!((0..4).map(|x| empty(&capture, x, 0)).collect::<Vec<_>>(), [true, true, true, false]);
    assert_eq!((capture.census.known, capture.census.unknown_motion), (9, 3));
    let capture = folder.update(SPEED, "{ kind = \"flow\", file = \"k.png\" }", "").unwrap();
    assert!((0..3).all(|y| empty(&capture, 0, y) && !empty(&capture, 1, y)));
    assert_eq!((capture.census.known, capture.census.unknown_motion), (9, 3));
    // An empty cell keeps its colour.
    assert_eq!(capture.update.samples[4].colour, super::folder::colour(0, 1));
}

#[test]
fn velocity_is_displacement_over_frames() {
    let folder = Folder::new().with("a.flo", encode::pieh(4, 3, &cells(uv).concat()));
    for (frames, count) in [("", 1.0), (", frames = 8", 8.0)] {
        let motion = format!("{{ kind = \"flow\", file = \"a.flo\"{frames} }}");
        let capture = folder.update(SPEED, &motion, "").unwrap();
        for (x, y) in SIZE.positions() {
            let [u, v] = uv(x, y).map(|v| f64::from(v) / count);
            let sample = known(&capture, x, y);
            near(&sample.velocity, &[u, v, 0.0], 1e-12);
            near(&sample.acceleration, &[0.0; 3], 0.0);
        }
    }
}

#[test]
fn disparity_moves_along_the_row() {
    let raw = cells(|x, y| (4 * x + 20 * y) as u8);
    let folder = Folder::new().with("d.png", encode::png8(4, 3, ColorType::Grayscale, &raw));
    for sign in [-1.0, 1.0] {
        let motion = format!(
            "{{ kind = \"disparity\", file = \"d.png\", scale = 0.25, sign = {sign}, frames = 2, invalid = [0, 4] }}"
        );
        let capture = folder.update(SPEED, &motion, "").unwrap();
        assert!(empty(&capture, 0, 0) && empty(&capture, 1, 0));
        assert_eq!(capture.census.unknown_motion, 2);
        near(&known(&capture, 3, 1).velocity, &[sign * 32.0 * 0.25 / 2.0, 0.0, 0.0], 1e-12);
    }
    let packed = cells(|x, y| (256 * x + 64 * y) as u16);
    folder.write("k.png", encode::png16(4, 3, ColorType::Grayscale, &packed));
    let motion = "{ kind = \"disparity\", file = \"k.png\", format = \"kitti-disparity\", sign = -1 }";
    let capture = folder.update(SPEED, motion, "").unwrap();
    assert!(empty(&capture, 0, 0));
    near(&known(&capture, 3, 2).velocity, &[-3.5, 0.0, 0.0], 1e-12);
    let rgb = cells(|x, y| [x as u8, 64 * y as u8, 0]).concat();
    folder.write("s.png", encode::png8(4, 3, ColorType::Rgb, &rgb));
    let motion = "{ kind = \"disparity\", file = \"s.png\", format = \"sintel-disparity\", sign = -1 }";
    near(&known(&folder.update(SPEED, motion, "").unwrap(), 3, 2).velocity, &[-14.0, 0.0, 0.0], 1e-12);
}
