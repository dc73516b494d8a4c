//! Motion from the channels of an EXR: the project's own planes and Blender's vector pass.

use super::encode::{self, Channel, Precision};
use super::folder::{Folder, H, W, cells, empty, known, near};

const DEPTH: &str = "{ kind = \"z\", file = \"z.npy\", scale = 0.5 }";

/// Returns a folder with raw depth 4 everywhere (2 after the scale) and `p.exr`.
fn folder(precision: Precision, list: &[Channel]) -> Folder {
    Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &[4.0; 12])).with("p.exr", encode::exr(W, H, precision, list))
}

#[test]
fn planes_give_velocity_acceleration_and_approach() {
    for precision in [Precision::Half, Precision::Float] {
        let list = [
            ("VX", cells(|x, _| x as f32)),
            ("VY", cells(|_, y| -(y as f32))),
            ("VZ", vec![-0.5; 12]),
            ("AX", vec![0.25; 12]),
            ("AY", vec![-4.0; 12]),
            ("AZ", vec![2.0; 12]),
        ];
        for frames in [1.0, 2.0] {
            let motion = format!("{{ kind = \"planes\", file = \"p.exr\", frames = {frames} }}");
            let capture = folder(precision, &list).update(DEPTH, &motion, "").unwrap();
            let sample = known(&capture, 3, 2);
            // z = 2, near = 1: d = 1 - 1 / z, d' = z' / z², d'' = z'' / z² - 2 z'² / z³, with z' = -0.25 and z'' = 1.
            near(&sample.velocity, &[3.0 / frames, -2.0 / frames, -0.0625 / frames], 1e-12);
            let squared = frames * frames;
            near(&sample.acceleration, &[0.25 / squared, -4.0 / squared, (0.25 - 0.015_625) / squared], 1e-12);
        }
    }
}

#[test]
fn planes_may_have_a_prefix_and_velocity_alone() {
    let list = [("Layer.VX", vec![1.0; 12]), ("Layer.VY", vec![2.0; 12]), ("Other.AX", vec![9.0; 12])];
    let folder = folder(Precision::Float, &list);
    let motion = "{ kind = \"planes\", file = \"p.exr\", channel = \"Layer\" }";
    let capture = folder.update(DEPTH, motion, "").unwrap();
    near(&known(&capture, 1, 1).velocity, &[1.0, 2.0, 0.0], 0.0);
    near(&known(&capture, 1, 1).acceleration, &[0.0; 3], 0.0);
    let text = super::folder::manifest(DEPTH, &motion.replace("Layer", "Wrong"), "");
    let refusal = folder.refused(&text, "p.exr", "no channel \"Wrong.VX\"");
    assert!(refusal.contains("Layer.VX, Layer.VY, Other.AX"), "does not list the channels: {refusal}");
}

#[test]
fn blender_vectors_have_their_measured_signs() {
    // On the screen (y down) the point was at (-3, 1) a frame ago and will be at (5, -2): v = (4, -1.5), a = (2, -1).
    // X, Y = (x(t-1) - x(t), up), Z, W = (x(t) - x(t+1), up), up being minus y.
    let list = [("X", -3.0), ("Y", -1.0), ("Z", -5.0), ("W", -2.0)];
    for prefix in ["ViewLayer.Vector", "Vector", "Scene.Vector"] {
        let names: Vec<(String, Vec<f32>)> =
            list.iter().map(|(name, v)| (format!("{prefix}.{name}"), vec![*v; 12])).collect();
        let folder = folder(Precision::Float, &encode::borrowed(&names));
        for key in [String::new(), format!(", channel = \"{prefix}\"")] {
            for frames in [1.0, 4.0] {
                let motion = format!("{{ kind = \"blender-vector\", file = \"p.exr\", frames = {frames} {key} }}");
                let sample = known(&folder.update(DEPTH, &motion, "").unwrap(), 2, 1);
                near(&sample.velocity, &[4.0 / frames, -1.5 / frames, 0.0], 1e-12);
                near(&sample.acceleration, &[2.0 / (frames * frames), -1.0 / (frames * frames), 0.0], 1e-12);
            }
        }
    }
}

#[test]
fn blender_vectors_in_parts_named_by_the_pass() {
    let flat = |v: f32| vec![v; W * H];
    let vector = vec![("X", flat(-1.0)), ("Y", flat(0.0)), ("Z", flat(-1.0)), ("W", flat(0.0))];
    let file = encode::exr_parts(W, H, &[("Depth", vec![("Z", flat(2.0))]), ("Vector", vector)]);
    let folder = Folder::new().with("p.exr", file);
    let depth = "{ kind = \"z\", file = \"p.exr\", channel = \"Depth.Z\" }";
    let capture = folder.update(depth, "{ kind = \"blender-vector\", file = \"p.exr\" }", "").unwrap();
    near(&known(&capture, 2, 1).velocity, &[1.0, 0.0, 0.0], 0.0);
}

#[test]
fn a_vector_averaged_over_a_border_is_replaced() {
    // Columns 0 to 3 are a near surface that moves by 4, the others a far one at rest; at the border the vector is a
    // mixture.
    let (width, height) = (9, 5);
    let row = |values: [f32; 9]| -> Vec<f32> { (0..height).flat_map(|_| values).collect() };
    let speed = [-4.0, -4.0, -4.0, -2.0, -2.0, 0.0, 0.0, 0.0, 0.0];
    let z = row([2.0, 2.0, 2.0, 2.0, 8.0, 8.0, 8.0, 8.0, 8.0]);
    let still = || row([0.0; 9]);
    let list =
        [("Vector.X", row(speed)), ("Vector.Y", still()), ("Vector.Z", row(speed)), ("Vector.W", still()), ("Z", z)];
    let folder = Folder::new().with("p.exr", encode::exr(width, height, Precision::Float, &list));
    folder.write("color.png", encode::png8(9, 5, png::ColorType::Grayscale, &[0; 45]));
    let depth = "{ kind = \"z\", file = \"p.exr\", channel = \"Z\" }";
    let capture = folder.update(depth, "{ kind = \"blender-vector\", file = \"p.exr\" }", "").unwrap();
    let row: Vec<f64> = (0..width).map(|x| known(&capture, x, 2).velocity[0]).collect();
    near(&row, &[4.0, 4.0, 4.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-12);
    assert_eq!(capture.census.notes.len(), 1);
}

#[test]
fn motion_that_is_not_finite_starts_empty() {
    let mut vx = vec![1.0; 12];
    (vx[0], vx[1], vx[2]) = (f32::NAN, f32::INFINITY, 3e9);
    let mut ay = vec![0.0; 12];
    ay[3] = f32::NEG_INFINITY;
    let list = [("VX", vx), ("VY", vec![0.0; 12]), ("AY", ay)];
    let folder = folder(Precision::Float, &list);
    let capture = folder.update(DEPTH, "{ kind = \"planes\", file = \"p.exr\" }", "").unwrap();
    assert!((0..4).all(|x| empty(&capture, x, 0)));
    assert_eq!((capture.census.known, capture.census.unknown_motion), (8, 4));
}
