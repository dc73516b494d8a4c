//! Camera paths as other tools write them: the same motion in each layout and convention.
//!
//! `f = 100`, depth 2: a step of the camera by 0.02 to the right moves the picture by one pixel to the left.

use super::super::{Capture, CaptureError};
use super::encode;
use super::folder::{Folder, known, manifest, near};

const DEPTH: &str = "{ kind = \"z\", file = \"z.npy\" }";
const INTRINSICS: &str = "intrinsics = [100, 100, 2, 1]";

fn folder() -> Folder {
    Folder::new().with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]))
}

/// Where the camera is at a time, to the right: v = -1 and a = -0.25 pixels at 2.
fn at(t: f64) -> f64 {
    0.02 * (t - 2.0) + 0.0025 * (t - 2.0) * (t - 2.0)
}

/// Turned by 90 degrees about the axis, so that the order of matrices and of quaternions matters: camera x is world y.
const TURNED: [f64; 4] = [0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2];

fn load(folder: &Folder, keys: &str) -> Result<Capture, CaptureError> {
    folder.update(DEPTH, &format!("{{ kind = \"camera\", {keys} }}"), "")
}

#[track_caller]
fn is_right(folder: &Folder, keys: &str, note: &str) {
    let capture = load(folder, keys).unwrap_or_else(|error| panic!("{keys}: {error}"));
    near(&known(&capture, 1, 1).velocity[..2], &[-1.0, 0.0], 1e-6);
    near(&known(&capture, 1, 1).acceleration[..2], &[-0.25, 0.0], 1e-6);
    let notes = &capture.census.notes;
    assert_eq!(notes.len(), usize::from(!note.is_empty()), "{keys}: {notes:?}");
    assert!(notes.iter().all(|found| found.contains(note)), "{keys}: {notes:?}");
}

fn lines(times: &[f64], line: impl Fn(f64) -> String) -> String {
    times.iter().map(|&t| line(t) + "\n").collect()
}

const TIMES: [f64; 5] = [0.0, 1.0, 2.0, 3.0, 4.0];

fn tum(t: f64) -> String {
    let [x, y, z, w] = TURNED;
    format!("{t} 0 {} 0 {x} {y} {z} {w}", at(t))
}

#[test]
fn every_layout_gives_the_same_motion() {
    let [x, y, z, w] = TURNED;
    let folder = folder()
        .with("tum.txt", lines(&TIMES, tum))
        .with("bom.txt", ["\u{feff}# t\n", &lines(&TIMES, tum)].concat())
        .with("comma.txt", lines(&TIMES, |t| tum(t).replace(' ', ", ")).replace('\n', "\r\n"))
        .with("wxyz.txt", lines(&TIMES, |t| format!("{t} 0 {} 0 {w} {x} {y} {z}", at(t))))
        .with("kitti.txt", lines(&TIMES, |t| format!("0 -1 0 0 1 0 0 {} 0 0 1 0", at(t))))
        // World to camera: R' = Rᵀ, t' = -Rᵀ c.
        .with("inverse.txt", lines(&TIMES, |t| format!("0 1 0 {} -1 0 0 0 0 0 1 0", -at(t))))
        .with(
            "euroc.csv",
            "#time [ns], p, q\n".to_owned()
                + &lines(&TIMES, |t| {
                    format!("{},0,{},0,{w},{x},{y},{z},0,0,0", 1_403_636_580_000_000_000_i64 + (t * 1e9) as i64, at(t))
                }),
        )
        .with(
            "images.txt",
            "# ids\n".to_owned()
                + &lines(&TIMES, |t| {
                    format!(
                        "{} {w} {x} {y} {} {} 0 0 1 left/{:04}.png\n{}",
                        t + 1.0,
                        -z,
                        -at(t),
                        t,
                        if t > 2.0 { "1 2 -1" } else { "" }
                    )
                }),
        );
    let turned = "mount = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
    for keys in [
        "format = \"tum\", poses = \"tum.txt\", pose = 2",
        "format = \"tum\", poses = \"bom.txt\", pose = 2",
        "format = \"tum\", poses = \"comma.txt\", pose = 2",
        "format = \"tum\", poses = \"tum.txt\", time = 2.0",
        "format = \"tum\", poses = \"wxyz.txt\", quaternion = \"wxyz\", pose = 2",
        "format = \"kitti\", poses = \"kitti.txt\", pose = 2",
        "format = \"kitti\", poses = \"inverse.txt\", transform = \"world-to-camera\", pose = 2",
        "format = \"colmap\", poses = \"images.txt\", pose = 2",
    ] {
        is_right(&folder, &format!("{keys}, {INTRINSICS}, pixel_centre = 0.0"), "");
    }
    // The body is not turned where the camera on it is turned back.
    let euroc = format!("format = \"euroc\", poses = \"euroc.csv\", pose = 2, {INTRINSICS}");
    is_right(&folder, &euroc, "body");
    let capture = load(&folder, &format!("{euroc}, {turned}")).unwrap();
    near(&known(&capture, 1, 1).velocity[..2], &[0.0, -1.0], 1e-6);
}

#[test]
fn poses_are_taken_by_their_times() {
    let unsorted = [4.0, 2.0, 0.0, 1.0, 3.0];
    let cases: [(&[f64], &str, &str); 5] = [
        (&unsorted, "pose = 2", "sorted"),
        (&[0.0, 1.0, 2.0, 3.0, 3.0, 4.0], "pose = 2", "left out"),
        // A pose is missing before, and one after.
        (&[-2.0, -1.0, 0.0, 2.0, 3.0, 4.0], "pose = 3", "2.000 steps away"),
        (&[-8.0, 2.0, 3.0, 4.0, 5.0], "pose = 1", "10.000 steps away"),
        (&[-1.0, 0.0, 1.0, 2.0, 12.0], "pose = 3", "10.000 steps away"),
    ];
    for (times, pose, note) in cases {
        let folder = folder().with("p.txt", lines(times, tum));
        is_right(&folder, &format!("format = \"tum\", poses = \"p.txt\", {pose}, {INTRINSICS}"), note);
    }
    // Four poses in each display frame, and a display frame in 0.1 of the time's unit.
    let dense: Vec<f64> = (0..17).map(|i| f64::from(i) / 4.0).collect();
    let text = lines(&dense, |t| tum(t).replacen(&t.to_string(), &(t / 10.0).to_string(), 1));
    let folder = folder().with("p.txt", text);
    is_right(&folder, &format!("format = \"tum\", poses = \"p.txt\", time = 0.2, rate = 10.0, {INTRINSICS}"), "");
    // Times in a file of their own.
    let matrices = lines(&[0.0, 2.0, 3.0, 4.0], |t| format!("1 0 0 {} 0 1 0 0 0 0 1 0", at(t)));
    folder.write("k.txt", matrices);
    folder.write("times.txt", "0\n2\n3\n4\n");
    let keys = format!("format = \"kitti\", poses = \"k.txt\", times = \"times.txt\", pose = 1, {INTRINSICS}");
    is_right(&folder, &keys, "2.000 steps away");
    folder.write("times.txt", "0\n2\n3\n");
    let text = manifest(DEPTH, &format!("{{ kind = \"camera\", {keys} }}"), "");
    folder.refused(&text, "times.txt", "3 times for 4 poses");
    let text = |keys: &str| manifest(DEPTH, &format!("{{ kind = \"camera\", {keys}, {INTRINSICS} }}"), "");
    folder.refused(&text("format = \"tum\", poses = \"p.txt\", time = 77.0"), "p.txt", "no pose at the time 77");
    folder.refused(&text("format = \"kitti\", poses = \"k.txt\", rate = 3.0, pose = 1"), "k.txt", "no time stamps");
    folder.refused(&text("format = \"tum\", poses = \"p.txt\""), "capture.toml", "no key pose");
}

#[test]
fn a_cut_before_or_after_is_left_out() {
    let grey = encode::png8(64, 48, png::ColorType::Grayscale, &[9; 64 * 48]);
    let folder = Folder::new().with("z.npy", encode::npy_f4("(48, 64)", &[2.0; 64 * 48])).with("color.png", grey);
    let keys = format!("format = \"tum\", poses = \"p.txt\", pose = 2, {INTRINSICS}");
    for (side, from, to) in [("before", -1.0, 2.0), ("after", 2.5, 9.0)] {
        let cut = |t: f64| if t > from && t < to { tum(t).replacen(" 0 ", " 900 ", 1) } else { tum(t) };
        folder.write("p.txt", lines(&TIMES, cut));
        is_right(&folder, &keys, &format!("{side} the update is elsewhere"));
    }
}

/// A `transforms.json` with these further keys, and frames in this order with theirs.
fn transforms(keys: &str, order: &[usize], frame: impl Fn(usize) -> String) -> String {
    let frames: Vec<String> = order
        .iter()
        .map(|&i| {
            let matrix = format!("[[1,0,0,{}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", at(i as f64));
            format!("{{\"file_path\": \"images/f{}.png\", {} \"transform_matrix\": {matrix}}}", i + 8, frame(i))
        })
        .collect();
    format!("{{ {keys} \"frames\": [{}] }}", frames.join(", "))
}

#[test]
fn transforms_say_their_order_size_and_intrinsics() {
    let sorted = [0, 1, 2, 3, 4];
    let own = "\"fl_x\": 100, \"fl_y\": 100, \"cx\": 2, \"cy\": 1.5,";
    let none = |_: usize| String::new();
    // camera_angle_x: f = w / 2 / tan(angle / 2).
    let angle = format!("\"camera_angle_x\": {},", 2.0 * (2.0_f64 / 100.0).atan());
    let doubled = "\"w\": 8, \"h\": 6, \"fl_x\": 200, \"fl_y\": 200, \"cx\": 4, \"cy\": 3,";
    let cases = [
        (transforms(own, &sorted, none), ""),
        (["\u{feff}", &transforms(own, &sorted, none)].concat(), ""),
        // Numbers in names count by their size: f9 before f10.
        (transforms(own, &[4, 2, 1, 3, 0], none), "sorted"),
        (transforms(&angle, &sorted, none), ""),
        (transforms(doubled, &sorted, none), "scaled to 4x3"),
        (transforms("", &sorted, |_| own.to_owned()), ""),
        (transforms(&format!("\"k1\": 0.1, {own}"), &sorted, none), "distortion"),
        (transforms(own, &[3, 1, 0, 2, 4], |i| format!("\"time\": {i},")), "sorted"),
        (transforms(own, &[0, 2, 3, 4], none), "2.000 steps away"),
    ];
    for (text, note) in cases {
        let pose = if note.contains("steps") { 1 } else { 2 };
        let folder = folder().with("t.json", text);
        is_right(&folder, &format!("format = \"transforms\", poses = \"t.json\", pose = {pose}"), note);
    }
    let refused = |text: String, what: &str| {
        let motion = "{ kind = \"camera\", format = \"transforms\", poses = \"t.json\", pose = 2 }";
        folder().with("t.json", text).refused(&manifest(DEPTH, motion, ""), "t.json", what);
    };
    refused(transforms(&format!("\"w\": 9, \"h\": 90, {own}"), &sorted, none), "9x90");
    refused(transforms(&format!("\"camera_model\": \"OPENCV_FISHEYE\", {own}"), &sorted, none), "OPENCV_FISHEYE");
}

#[test]
fn a_zoom_moves_the_picture() {
    // The camera stands still; f = 100, 110, 120: a pixel at r from the axis goes to r f / 110.
    let text = transforms("\"cx\": 2, \"cy\": 1.5,", &[0, 1, 2], |i| format!("\"fl_x\": {},", 100 + 10 * i));
    let still = text.replace(&at(0.0).to_string(), "0").replace(&at(1.0).to_string(), "0");
    let folder = folder().with("t.json", still);
    let capture = load(&folder, "format = \"transforms\", poses = \"t.json\", pose = 1").unwrap();
    near(&known(&capture, 3, 1).velocity[..2], &[1.5 / 11.0, 0.0], 1e-6);
}

#[test]
fn the_cameras_of_a_colmap_model_are_used() {
    let images = lines(&TIMES, |t| format!("{} 1 0 0 0 {} 0 0 7 {:04}.png\n", t + 1.0, -at(t), t));
    let folder = folder().with("images.txt", &images);
    let keys = "format = \"colmap\", poses = \"images.txt\", pose = 2";
    for (camera, note) in [
        ("7 PINHOLE 4 3 100 100 2 1.5", ""),
        ("7 SIMPLE_PINHOLE 8 6 200 4 3", "scaled"),
        ("# a comment\n7 SIMPLE_RADIAL 4 3 100 2 1.5 0.02", "distortion"),
    ] {
        folder.write("cameras.txt", camera);
        is_right(&folder, keys, note);
    }
    folder.write("cameras.txt", "7 OPENCV_FISHEYE 4 3 100 100 2 1.5 0 0 0 0");
    folder.refused(&manifest(DEPTH, &format!("{{ kind = \"camera\", {keys} }}"), ""), "cameras.txt", "OPENCV_FISHEYE");
    folder.write("cameras.txt", "8 PINHOLE 4 3 100 100 2 1.5");
    folder.refused(&manifest(DEPTH, &format!("{{ kind = \"camera\", {keys} }}"), ""), "cameras.txt", "no camera 7");
}

#[test]
fn a_convention_of_the_camera_that_meets_the_truth_is_named() {
    let (w, h) = (48_usize, 32_usize);
    let noise = |x: i64, y: i64| [x * 37 + y * 91, x * 53 + y * 17, x * x + y * 29].map(|v| (v.rem_euclid(251)) as u8);
    let picture = |moved: i64| {
        let rgb: Vec<u8> = (0..h as i64).flat_map(|y| (0..w as i64).flat_map(move |x| noise(x + moved, y))).collect();
        encode::png8(w as u32, h as u32, png::ColorType::Rgb, &rgb)
    };
    // The camera moves by 0.04 a frame to the right: two pixels, of which the file says the inverse.
    let folder = Folder::new()
        .with("color.png", picture(0))
        .with("t.png", picture(4))
        .with("z.npy", encode::npy_f4(&format!("({h}, {w})"), &vec![2.0; w * h]))
        .with("p.txt", lines(&TIMES, |t| format!("1 0 0 {} 0 1 0 0 0 0 1 0", -0.04 * t)));
    let truth = "[[truth]]\nframe = 2\ncolor = \"t.png\"";
    let read = |keys: &str| {
        let motion =
            format!("{{ kind = \"camera\", format = \"kitti\", poses = \"p.txt\", pose = 2, {INTRINSICS}{keys} }}");
        folder.update(DEPTH, &motion, truth).unwrap().census.notes
    };
    let notes = read("");
    assert!(
        notes.len() == 1 && notes[0].contains("with transform = \"world-to-camera\" it would be 100.0 dB"),
        "{notes:?}"
    );
    assert_eq!(read(", transform = \"world-to-camera\""), Vec::<String>::new());
}
