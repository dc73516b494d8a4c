//! Camera paths in every layout, checked against pixel motion worked out on paper.
//!
//! `f = 100`, the optical axis meets pixel (2, 1), depth 2: a step of the camera by 0.02 to the right moves the picture
//! by one pixel to the left.

use super::super::Capture;
use super::super::CaptureError;
use super::encode;
use super::folder::{Folder, cells, known, manifest, near};

/// A camera seen from its first place: metres to the right, down, forward, and radians turned to the right.
type View = [f64; 4];

const FORMATS: [&str; 5] = ["log", "tum", "transforms", "tartanair", "matrix-files"];

fn text(rows: &[[f64; 4]]) -> String {
    let row = |r: &[f64; 4]| format!("{} {} {} {}\n", r[0], r[1], r[2], r[3]);
    rows.iter().map(row).collect::<String>() + "0 0 0 1\n"
}

/// World axes x right, y down, z forward: turning right takes z towards x.
fn opencv([right, down, forward, yaw]: View) -> [[f64; 4]; 3] {
    let (s, c) = yaw.sin_cos();
    [[c, 0.0, s, right], [0.0, 1.0, 0.0, down], [-s, 0.0, c, forward]]
}

/// World axes x right, y up, z backward: turning right takes -z towards x.
fn opengl([right, down, forward, yaw]: View) -> [[f64; 4]; 3] {
    let (s, c) = yaw.sin_cos();
    [[c, 0.0, -s, right], [0.0, 1.0, 0.0, -down], [s, 0.0, c, -forward]]
}

/// Returns the files of a path in `format`, and the name for `poses`.
fn write(folder: &Folder, format: &str, path: &[View]) -> &'static str {
    let quaternion = |yaw: f64| ((yaw / 2.0).sin(), (yaw / 2.0).cos());
    let (name, content) = match format {
        "log" => {
            let pose = |(i, view): (usize, &View)| format!("{i} {i} {}\n{}", i + 1, text(&opencv(*view)));
            ("p.log", path.iter().enumerate().map(pose).collect::<String>())
        }
        "tum" => {
            let pose = |(i, [r, d, f, yaw]): (usize, &View)| {
                let (s, c) = quaternion(*yaw);
                // Any length of the quaternion will do; this one has 2.
                format!("{}.5 {r} {d} {f} 0 {} 0 {}\n", i, 2.0 * s, 2.0 * c)
            };
            (
                "p.txt",
                "# stamp tx ty tz qx qy qz qw\n".to_owned() + &path.iter().enumerate().map(pose).collect::<String>(),
            )
        }
        "tartanair" => {
            // North, east, down: forward, right, down. Turning right turns about down.
            let pose = |[r, d, f, yaw]: &View| {
                let (s, c) = quaternion(*yaw);
                format!("{f} {r} {d} 0 0 {s} {c}\n")
            };
            ("p.txt", path.iter().map(pose).collect())
        }
        "transforms" => {
            let pose = |view: &View| {
                let [a, b, c] = opengl(*view);
                serde_json::json!({ "file_path": "x.png", "transform_matrix": [a, b, c, [0.0, 0.0, 0.0, 1.0]] })
            };
            let frames: Vec<_> = path.iter().map(pose).collect();
            // Pixel centres lie at +0.5 here.
            let all = serde_json::json!({ "fl_x": 100.0, "fl_y": 100.0, "cx": 2.5, "cy": 1.5, "frames": frames });
            ("p.json", all.to_string())
        }
        _ => {
            for (i, view) in path.iter().enumerate() {
                folder.write(&format!("pose-{i:06}.txt"), text(&opencv(*view)));
            }
            return "pose-{:06}.txt";
        }
    };
    folder.write(name, content);
    name
}

fn load(format: &str, path: &[View], pose: usize, more: &str) -> Result<Capture, CaptureError> {
    let mut raw = [2.0; 12];
    raw[3] = 1e9;
    let folder = Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &raw));
    let poses = write(&folder, format, path);
    let intrinsics = if format == "transforms" { "" } else { "intrinsics = [100, 100, 2, 1]," };
    let motion = format!(
        "{{ kind = \"camera\", format = \"{format}\", poses = \"{poses}\", {intrinsics} pose = {pose} {more} }}"
    );
    folder.update("{ kind = \"z\", file = \"z.npy\", far = 1e8 }", &motion, "background = \"camera\"")
}

#[test]
fn a_camera_that_slides_moves_the_picture_the_other_way() {
    // c(t) = (0.02 t + 0.002 t², 0.04 t - 0.003 t²), hence v = (-1, -2) and a = (-0.2, 0.3) pixels.
    let at = |t: f64| [0.02 * t + 0.002 * t * t, 0.04 * t - 0.003 * t * t, 0.0, 0.0];
    let path = [at(-2.0), at(-1.0), at(0.0), at(1.0), at(2.0)];
    for format in FORMATS {
        for (frames, more) in [(1.0, ""), (4.0, ", frames = 4")] {
            let capture = load(format, &path, 2, more).unwrap();
            for (x, y) in cells(|x, y| (x, y)).into_iter().filter(|at| *at != (3, 0)) {
                let sample = known(&capture, x, y);
                near(&sample.velocity, &[-1.0 / frames, -2.0 / frames, 0.0], 1e-9);
                near(&sample.acceleration, &[-0.2 / (frames * frames), 0.3 / (frames * frames), 0.0], 1e-9);
            }
            // The horizon stays where it is.
            near(&known(&capture, 3, 0).velocity, &[0.0; 3], 1e-9);
        }
        // The parabola through three poses on one side is the same one.
        for pose in [0, 4] {
            let capture = load(format, &path, pose, "").unwrap();
            let t = pose as f64 - 2.0;
            near(&known(&capture, 1, 1).velocity, &[-1.0 - 0.2 * t, -2.0 + 0.3 * t, 0.0], 1e-9);
            near(&known(&capture, 1, 1).acceleration, &[-0.2, 0.3, 0.0], 1e-9);
            let is_noted = capture.census.notes.iter().any(|note| note.contains("is missing"));
            assert!(is_noted, "{format} says nothing of the missing pose");
        }
        // With two poses in all there is no acceleration.
        let capture = load(format, &path[2..4], 0, "").unwrap();
        near(&known(&capture, 1, 1).velocity, &[-1.1, -1.85, 0.0], 1e-9);
        near(&known(&capture, 1, 1).acceleration, &[0.0; 3], 1e-9);
    }
}

#[test]
fn a_camera_that_advances_spreads_the_picture() {
    let path = [[0.0, 0.0, -0.2, 0.0], [0.0; 4], [0.0, 0.0, 0.2, 0.0]];
    for format in FORMATS {
        let capture = load(format, &path, 1, "").unwrap();
        // A pixel at r from the axis goes to r z / (z ∓ 0.2): r / 0.9 and r / 1.1.
        let (v, a) = ((1.0 / 0.9 - 1.0 / 1.1) / 2.0, 1.0 / 0.9 + 1.0 / 1.1 - 2.0);
        // z' = -0.2; near = 1, z = 2: d' = near z' / z², d'' = -2 near z'² / z³.
        near(&known(&capture, 0, 2).velocity, &[-2.0 * v, v, -0.05], 1e-9);
        near(&known(&capture, 0, 2).acceleration, &[-2.0 * a, a, -0.01], 1e-9);
        near(&known(&capture, 2, 1).velocity, &[0.0, 0.0, -0.05], 1e-9);
    }
}

#[test]
fn a_camera_that_turns_right_moves_near_and_far_to_the_left() {
    // It has turned before, so that the order of the products matters.
    for first in [0.0, 0.4, -2.0] {
        let path = [[0.0, 0.0, 0.0, first - 0.01], [0.0, 0.0, 0.0, first], [0.0, 0.0, 0.0, first + 0.01]];
        for format in FORMATS {
            let capture = load(format, &path, 1, "").unwrap();
            near(&known(&capture, 2, 1).velocity[..2], &[-100.0 * 0.01_f64.tan(), 0.0], 1e-9);
            // The far cell (3, 0) is at angles (0.01, -0.01) and turns to atan(0.01) ∓ 0.01.
            let (after, before) = ((0.01_f64.atan() - 0.01).tan(), (0.01_f64.atan() + 0.01).tan());
            near(&[known(&capture, 3, 0).velocity[0]], &[100.0 * (after - before) / 2.0], 1e-9);
            assert_eq!(known(&capture, 3, 0).depth, 1.0);
        }
    }
}

#[test]
fn axes_and_pixel_centres_may_be_given() {
    let path = [[0.0; 4], [0.0; 4], [0.0, 0.04, 0.2, 0.0]];
    // Camera axes as in OpenGL inside a world whose y is down: columns y and z of the matrix change their signs.
    let folder = Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]));
    for (i, view) in path.iter().enumerate() {
        let [r, d, f, _] = *view;
        folder.write(&format!("m{i}"), text(&[[1.0, 0.0, 0.0, r], [0.0, -1.0, 0.0, d], [0.0, 0.0, -1.0, f]]));
    }
    let depth = "{ kind = \"z\", file = \"z.npy\" }";
    let motion = "{ kind = \"camera\", format = \"matrix-files\", poses = \"m{}\", axes = \"opengl\", \
                  intrinsics = [100, 100, 2.5, 1.5], pixel_centre = 0.5, pose = 1 }";
    let capture = folder.update(depth, motion, "").unwrap();
    // Only the later pose differs: p+ = (0, -0.04 / 1.8 · 100), so v is half and a all of it.
    let p = -0.04 / 1.8 * 100.0;
    near(&known(&capture, 2, 1).velocity[..2], &[0.0, p / 2.0], 1e-9);
    near(&known(&capture, 2, 1).acceleration[..2], &[0.0, p], 1e-9);
}

#[test]
fn points_that_come_to_lie_behind_a_camera_start_empty() {
    let capture = load("log", &[[0.0; 4], [0.0; 4], [0.0, 0.0, 2.5, 0.0]], 1, "").unwrap();
    assert_eq!((capture.census.known, capture.census.unknown_motion, capture.census.far), (1, 11, 1));
}

#[test]
fn bad_paths_are_refused() {
    let matrix = text(&opencv([0.0; 4]));
    let blocks = |second: &str| format!("0 0 1\n{matrix}1 1 2\n{second}");
    let cases = [
        ("log", blocks(&matrix), 2, "holds 2 poses, pose 2 is not among them"),
        ("log", format!("0 0 1\n{matrix}"), 0, "no pose next to pose 0"),
        ("log", String::new(), 0, "holds 0 poses"),
        ("log", blocks("1 0 0 0\n"), 0, "line 6 begins a pose that is incomplete"),
        ("log", blocks(&matrix.replace("0 0 0 1", "0 0 1 1")), 0, "last row"),
        ("log", blocks(&matrix.replacen('1', "2", 1)), 0, "not a rotation"),
        ("log", blocks(&matrix.replacen('1', "-1", 1)), 0, "not a rotation"),
        ("log", blocks(&matrix.replacen('1', "nan", 1)), 0, "not finite"),
        ("log", blocks(&matrix.replacen('1', "one", 1)), 0, "\"one\" where a number belongs"),
        ("tum", "0 0 0 0 0 0 1\n".into(), 0, "line 1 has 7 numbers, not 8"),
        ("tum", "# a\n1 0 0 0 0 0 0 0\n".into(), 0, "line 2 has a quaternion of length zero"),
        ("tartanair", "0 0 0 0 0 inf 1\n".into(), 0, "not finite"),
        ("transforms", "{}".into(), 0, "no list \"frames\""),
        ("transforms", "{".into(), 0, "truncated or damaged"),
        ("transforms", "{\"frames\": [{}]}".into(), 0, "frame 0 has no transform_matrix"),
        ("transforms", "{\"frames\": [{\"transform_matrix\": [[1, 0], [\"a\"]]}]}".into(), 0, "3 numbers in a matrix"),
    ];
    let folder = Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]));
    let refused = |format: &str, poses: &str, pose: u32, intrinsics: &str, what: &str| {
        let motion =
            format!("{{ kind = \"camera\", format = \"{format}\", poses = \"{poses}\", {intrinsics} pose = {pose} }}");
        folder.refused(&manifest("{ kind = \"z\", file = \"z.npy\" }", &motion, ""), poses, what)
    };
    let intrinsics = "intrinsics = [100, 100, 2, 1],";
    for (format, content, pose, what) in cases {
        folder.write("p.txt", content);
        refused(format, "p.txt", pose, intrinsics, what);
    }
    folder.write("p.txt", blocks(&matrix));
    refused("log", "p.txt", 0, "", "holds no intrinsics");
    refused("log", "absent.txt", 0, intrinsics, "cannot be read");
    refused("matrix-files", "p.txt", 0, intrinsics, "no {:06}");
    let motion = format!(
        "{{ kind = \"camera\", format = \"matrix-files\", poses = \"m{{:02}}\", {intrinsics} pose = 4294967295 }}"
    );
    folder.refused(&manifest("{ kind = \"z\", file = \"z.npy\" }", &motion, ""), "m4294967295", "cannot be read");
    // Disparities are no distances that a pixel could be lifted with, and without depth there is nothing to lift.
    let motion = format!("{{ kind = \"camera\", format = \"log\", poses = \"p.txt\", {intrinsics} pose = 0 }}");
    for depth in ["{ kind = \"speed\" }", "{ kind = \"disparity\", file = \"z.npy\" }"] {
        folder.refused(&manifest(depth, &motion, ""), "capture.toml", "camera");
    }
}
