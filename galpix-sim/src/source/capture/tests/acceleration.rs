//! Accelerations: chained flows, left out, limited, smoothed.

use super::super::AccelerationPolicy;
use super::encode::{self, Precision};
use super::folder::{Folder, H, SIZE, W, cells, known, near};

const SPEED: &str = "{ kind = \"speed\" }";

fn flo(uv: impl Fn(usize, usize) -> [f32; 2]) -> Vec<u8> {
    encode::pieh(4, 3, &cells(uv).concat())
}

/// Returns where a cell is after `t` frames.
fn place(sample: &crate::update::Sample, t: f64) -> [f64; 2] {
    [0, 1].map(|c| sample.velocity[c] * t + sample.acceleration[c] * t * t / 2.0)
}

#[test]
fn both_ends_of_two_chained_flows_are_reached_exactly() {
    // The first flow leads half a pixel to the right; the second is linear in x, so that bilinear is exact.
    let second = |x: f64, y: f64| [1.0 + 2.0 * x, 3.0 * y - 0.5 * x];
    let folder = Folder::new()
        .with("a.flo", flo(|_, y| [0.5, if y == 0 { 0.25 } else { -0.5 }]))
        .with("b.flo", flo(|x, y| second(x as f64, y as f64).map(|v| v as f32)));
    for (first_frames, second_frames) in [(1, 1), (8, 8), (8, 4), (2, 6)] {
        let motion = format!("{{ kind = \"flow\", file = \"a.flo\", frames = {first_frames} }}");
        let next = format!("acceleration = {{ kind = \"next-flow\", file = \"b.flo\", frames = {second_frames} }}");
        let capture = folder.update(SPEED, &motion, &next).unwrap();
        for (x, y) in [(0, 0), (2, 1), (1, 2)] {
            let sample = known(&capture, x, y);
            let first = [0.5, if y == 0 { 0.25 } else { -0.5 }];
            let then = second(x as f64 + first[0], y as f64 + first[1]);
            near(&place(&sample, f64::from(first_frames)), &first, 1e-6);
            let end = [first[0] + then[0], first[1] + then[1]];
            near(&place(&sample, f64::from(first_frames + second_frames)), &end, 1e-6);
        }
        // From the last column the first flow leads out of the picture.
        assert_eq!(known(&capture, 3, 1).acceleration, [0.0; 3]);
        assert_eq!(capture.census.unknown_acceleration, 3);
    }
}

#[test]
fn next_to_unknown_flow_the_velocity_stays_constant() {
    let folder = Folder::new()
        .with("a.flo", flo(|_, _| [0.5, 0.0]))
        .with("b.flo", flo(|x, y| if (x, y) == (1, 1) { [f32::NAN; 2] } else { [2.5, 0.0] }));
    let next = "acceleration = { kind = \"next-flow\", file = \"b.flo\" }";
    let capture = folder.update(SPEED, "{ kind = \"flow\", file = \"a.flo\" }", next).unwrap();
    for x in 0..2 {
        let sample = known(&capture, x, 1);
        assert_eq!((sample.velocity[0], sample.acceleration[0]), (0.5, 0.0));
    }
    assert_eq!(known(&capture, 0, 0).acceleration[0], 2.0);
    // Two cells next to the unknown one, three that leave the picture.
    assert_eq!(capture.census.unknown_acceleration, 5);
}

#[test]
fn cells_that_start_empty_are_not_counted_twice() {
    let mut raw = [2.0; 12];
    raw[0] = f32::NAN;
    let folder = Folder::new()
        .with("z.npy", encode::npy_f4("(3, 4)", &raw))
        .with("a.flo", flo(|_, _| [0.0, 0.0]))
        .with("b.flo", flo(|x, y| if (x, y) == (0, 0) { [f32::NAN; 2] } else { [1.0, 0.0] }));
    let next = "acceleration = { kind = \"next-flow\", file = \"b.flo\" }";
    let depth = "{ kind = \"z\", file = \"z.npy\" }";
    let census = folder.update(depth, "{ kind = \"flow\", file = \"a.flo\" }", next).unwrap().census;
    assert_eq!((census.known, census.unknown_depth, census.unknown_acceleration), (11, 1, 0));
}

/// Planes with VX = 1, VY = -2 and AX = `ax`, AY = 8.
fn planes(ax: impl Fn(usize, usize) -> f32) -> Folder {
    let list =
        [("VX", vec![1.0; 12]), ("VY", vec![-2.0; 12]), ("AX", cells(ax)), ("AY", vec![8.0; 12]), ("Z", vec![2.0; 12])];
    Folder::new().with("p.exr", encode::exr(W, H, Precision::Float, &list))
}

const DEPTH: &str = "{ kind = \"z\", file = \"p.exr\", channel = \"Z\" }";
const MOTION: &str = "{ kind = \"planes\", file = \"p.exr\" }";

#[test]
fn the_manifest_may_leave_the_acceleration_out() {
    let folder = planes(|_, _| 0.5);
    for (key, wanted) in [("", 8.0), ("acceleration = true", 8.0), ("acceleration = false", 0.0)] {
        let capture = folder.update(DEPTH, MOTION, key).unwrap();
        let sample = known(&capture, 1, 1);
        near(&[sample.velocity[1], sample.acceleration[1]], &[-2.0, wanted], 0.0);
    }
}

#[test]
fn the_user_may_leave_out_limit_or_smooth() {
    let folder = planes(|x, y| if (x, y) == (0, 0) { 12.0 } else { 0.0 });
    let text = super::folder::manifest(DEPTH, MOTION, "");
    let load = |policy| folder.load_with(&text, policy).unwrap();
    let off = load(AccelerationPolicy::Off);
    assert!(SIZE.positions().all(|(x, y)| known(&off, x, y).acceleration == [0.0; 3]));
    // Over 8 frames: a t² / 2 = |v| t at a = 2 |v| / 8.
    near(&known(&load(AccelerationPolicy::Clamp), 0, 0).acceleration, &[0.25, 0.5, 0.0], 1e-12);
    // 5x5 around, cut at the border: 3x3 cells around the corner, none of the spike at column 3.
    let smooth = load(AccelerationPolicy::Smooth);
    near(&known(&smooth, 0, 0).acceleration, &[12.0 / 9.0, 8.0, 0.0], 1e-12);
    near(&known(&smooth, 3, 0).acceleration, &[0.0, 8.0, 0.0], 1e-12);
    near(&known(&smooth, 2, 2).acceleration, &[1.0, 8.0, 0.0], 1e-12);
}

#[test]
fn smoothing_stops_at_another_surface() {
    let z = cells(|x, _| if x < 2 { 2.0 } else { 2.2 });
    let list =
        [("VX", vec![0.0; 12]), ("VY", vec![0.0; 12]), ("AX", cells(|x, _| if x < 2 { 1.0 } else { 5.0 })), ("Z", z)];
    let folder = Folder::new().with("p.exr", encode::exr(W, H, Precision::Float, &list));
    let text = super::folder::manifest(DEPTH, MOTION, "");
    let capture = folder.load_with(&text, AccelerationPolicy::Smooth).unwrap();
    near(&[known(&capture, 1, 1).acceleration[0], known(&capture, 2, 1).acceleration[0]], &[1.0, 5.0], 1e-12);
}
