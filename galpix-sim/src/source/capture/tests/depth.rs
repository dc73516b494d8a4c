//! From raw numbers to depths: kinds, units, unknown cells, the background.

use super::encode::{self, Precision};
use super::folder::{Folder, H, W, cells, empty, known, near};
use crate::update::DepthKind;

const STILL: &str = "{ kind = \"flow\", file = \"still.flo\" }";

/// A folder with these raw depths, and a flow of (1, 2) everywhere.
fn folder(raw: [f32; 12]) -> Folder {
    let flow: Vec<f32> = cells(|_, _| [1.0, 2.0]).concat();
    Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &raw)).with("still.flo", encode::pieh(4, 3, &flow))
}

#[test]
fn z_becomes_inverse_distance_whatever_the_unit() {
    let mut raw = [4000.0; 12];
    (raw[0], raw[5]) = (1000.0, 2000.0);
    for scale in ["1.0", "0.001", "3"] {
        let depth = format!("{{ kind = \"z\", file = \"z.npy\", scale = {scale} }}");
        let capture = folder(raw).update(&depth, STILL, "").unwrap();
        assert_eq!(capture.update.depth_kind, DepthKind::Z);
        // d = 1 - near / z; near is half of the nearest distance.
        let depths = [known(&capture, 0, 0).depth, known(&capture, 1, 1).depth, known(&capture, 3, 2).depth];
        near(&depths, &[0.5, 0.75, 0.875], 1e-12);
    }
}

#[test]
fn disparity_is_already_inverse_distance() {
    let mut raw = [10.0; 12];
    (raw[0], raw[5], raw[6]) = (40.0, 20.0, 0.0);
    let depth = "{ kind = \"disparity\", file = \"z.npy\", scale = 0.25 }";
    let capture = folder(raw).update(depth, STILL, "").unwrap();
    assert_eq!(capture.update.depth_kind, DepthKind::Disparity);
    let depths = [known(&capture, 0, 0).depth, known(&capture, 1, 1).depth, known(&capture, 3, 2).depth];
    near(&depths, &[0.5, 0.75, 0.875], 1e-12);
    // No disparity at all is no parallax: infinitely far.
    assert_eq!(known(&capture, 2, 1).depth, 1.0);
    assert_eq!((capture.census.known, capture.census.far, capture.census.unknown_depth), (12, 1, 0));
    let depth = "{ kind = \"disparity\", file = \"z.npy\", scale = 0.25, invalid = 0 }";
    let capture = folder(raw).update(depth, STILL, "").unwrap();
    assert!(empty(&capture, 2, 1));
    assert_eq!((capture.census.known, capture.census.far, capture.census.unknown_depth), (11, 0, 1));
}

#[test]
fn without_depth_the_faster_is_nearer() {
    let mut flow = [0.0_f32; 24];
    (flow[0], flow[1], flow[2]) = (3.0, -4.0, 2.5);
    let folder = Folder::new().with("a.flo", encode::pieh(4, 3, &flow));
    let capture = folder.update("{ kind = \"speed\" }", "{ kind = \"flow\", file = \"a.flo\" }", "").unwrap();
    assert_eq!(capture.update.depth_kind, DepthKind::Speed);
    let depths = [known(&capture, 0, 0).depth, known(&capture, 1, 0).depth, known(&capture, 2, 0).depth];
    near(&depths, &[0.5, 0.75, 1.0], 1e-12);
    // Nothing moves: all is equally far, nothing divides by zero.
    folder.write("a.flo", encode::pieh(4, 3, &[0.0; 24]));
    let capture = folder.update("{ kind = \"speed\" }", "{ kind = \"flow\", file = \"a.flo\" }", "").unwrap();
    assert!(capture.update.samples.iter().all(|s| s.depth == 1.0));
}

#[test]
fn invalid_is_one_raw_value_or_a_list() {
    let mut raw = [5.0; 12];
    (raw[1], raw[2], raw[3]) = (0.1, 65_535.0, f32::NAN);
    (raw[4], raw[5], raw[6]) = (0.0, -1.0, f32::INFINITY);
    let count = |invalid: &str| {
        let depth = format!("{{ kind = \"z\", file = \"z.npy\", scale = 0.5 {invalid} }}");
        let capture = folder(raw).update(&depth, STILL, "").unwrap();
        // Never usable: NaN, zero, negative, infinite.
        for (x, y) in [(3, 0), (0, 1), (1, 1), (2, 1)] {
            assert!(empty(&capture, x, y));
        }
        assert_eq!(capture.census.known + capture.census.unknown_depth, 12);
        (capture.census.unknown_depth, empty(&capture, 1, 0), empty(&capture, 2, 0))
    };
    assert_eq!(count(""), (4, false, false));
    assert_eq!(count(", invalid = 65535"), (5, false, true));
    // The file holds 0.1 as a float32.
    assert_eq!(count(", invalid = 0.1"), (5, true, false));
    assert_eq!(count(", invalid = [0.1, 65535.0, 0.0]"), (6, true, true));
    assert_eq!(count(", invalid = []"), (4, false, false));
}

#[test]
fn far_cells_are_background() {
    let mut raw = [2.0; 12];
    (raw[0], raw[1], raw[2]) = (1e10, f32::INFINITY, 999.0);
    let depth = "{ kind = \"z\", file = \"z.npy\", far = 1000 }";
    for (background, velocity) in [("", [0.0, 0.0]), ("\"still\"", [0.0, 0.0]), ("\"given\"", [1.0, 2.0])] {
        let key = if background.is_empty() { String::new() } else { format!("background = {background}") };
        let capture = folder(raw).update(depth, STILL, &key).unwrap();
        for x in 0..2 {
            let sample = known(&capture, x, 0);
            assert_eq!((sample.depth, [sample.velocity[0], sample.velocity[1]]), (1.0, velocity));
        }
        near(&known(&capture, 2, 0).velocity, &[1.0, 2.0, 0.0], 0.0);
        assert_eq!((capture.census.known, capture.census.far), (12, 2));
    }
    let capture = folder(raw).update(depth, STILL, "background = \"empty\"").unwrap();
    assert!(empty(&capture, 0, 0) && empty(&capture, 1, 0) && !empty(&capture, 2, 0));
    assert_eq!((capture.census.known, capture.census.far), (10, 2));
    folder(raw).refused(
        &super::folder::manifest(depth, STILL, "background = \"camera\""),
        "capture.toml",
        "gives no camera",
    );
}

#[test]
fn the_background_stays_still_with_a_second_flow() {
    let mut raw = [2.0; 12];
    raw[0] = 1e10;
    let next: Vec<f32> = cells(|_, _| [5.0, 5.0]).concat();
    let folder = folder(raw).with("next.flo", encode::pieh(4, 3, &next));
    let next = "acceleration = { kind = \"next-flow\", file = \"next.flo\" }";
    let capture = folder.update("{ kind = \"z\", file = \"z.npy\", far = 1000 }", STILL, next).unwrap();
    let sample = known(&capture, 0, 0);
    assert_eq!((sample.velocity, sample.acceleration), ([0.0; 3], [0.0; 3]));
}

#[test]
fn every_known_number_is_finite_even_at_absurd_depths() {
    let raws = [[1e-44, 1.0, 3e38], [1e-44, 1e-44, 1e-44], [3e38, 3e38, 3e38]];
    for raw in raws {
        for scale in ["1.0", "1e-300", "1e300"] {
            let z = cells(|x, y| raw[(x + y) % 3]);
            let vz = ("VZ", vec![1e6; W * H]);
            let list = [("Z", z), ("VX", vec![1.0; W * H]), ("VY", vec![1.0; W * H]), vz];
            let folder = Folder::new().with("a.exr", encode::exr(W, H, Precision::Float, &list));
            for kind in ["z", "disparity"] {
                let depth = format!("{{ kind = \"{kind}\", file = \"a.exr\", channel = \"Z\", scale = {scale} }}");
                let Ok(capture) = folder.update(&depth, "{ kind = \"planes\", file = \"a.exr\" }", "") else {
                    continue;
                };
                for sample in &capture.update.samples {
                    let all = [&[sample.depth][..], &sample.velocity, &sample.acceleration].concat();
                    assert!(all.iter().all(|v| v.is_finite()), "{kind} {raw:?} x {scale}: {all:?}");
                }
            }
        }
    }
}
