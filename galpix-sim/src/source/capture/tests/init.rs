//! Manifests for folders that have none.

use std::path::Path;

use png::ColorType;

use super::super::{ImportOptions, InitOptions, Proposal, init, load, plausible};
use super::data::data;
use super::encode;
use super::folder::check_refusal;

const W: usize = 48;
const H: usize = 32;
const USUAL: InitOptions = InitOptions { step: 1, intrinsics: None };

/// A picture in which every place is different, moved by so many pixels.
fn picture(right: usize, down: usize) -> Vec<u8> {
    let value = |x: usize, y: usize| [(x * 37 + y * 11) % 251, (x * x + 3 * y) % 253, (5 * x + y * y) % 249];
    let (x0, y0) = (100 - right, 100 - down);
    let cells = (0..H).flat_map(|y| (0..W).map(move |x| value(x + x0, y + y0)));
    encode::png8(W as u32, H as u32, ColorType::Rgb, &cells.flat_map(|v| v.map(|v| v as u8)).collect::<Vec<u8>>())
}

/// Writes files into an empty folder and returns what is proposed for it, or the refusal, which must be a sentence.
fn proposed(files: &[(&str, Vec<u8>)], options: &InitOptions) -> Result<Proposal, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let found = init(folder.path(), options);
    let count = walk(folder.path());
    assert_eq!(count, files.len(), "a file was written");
    found.map_err(|error| check_refusal(&error, "", ""))
}

fn walk(folder: &Path) -> usize {
    let of = |path: &Path| if path.is_dir() { walk(path) } else { 1 };
    std::fs::read_dir(folder).unwrap().map(|entry| of(&entry.unwrap().path())).sum()
}

fn flo(u: f32, v: f32) -> Vec<u8> {
    encode::pieh(W as i32, H as i32, &[u, v].repeat(W * H))
}

#[track_caller]
fn says(proposal: &Proposal, what: &[&str]) {
    for what in what {
        assert!(proposal.manifest.contains(what), "no {what} in\n{}", proposal.manifest);
    }
}

/// The pictures move by (2, 1): whatever the vectors call it, that is found.
#[test]
fn vectors_are_read_in_the_convention_that_fits() {
    for (u, v, keys) in [
        (2.0, 1.0, "file = \"m/07.flo\", frames = 1 }"),
        (-2.0, -1.0, "sign = -1 }"),
        (2.0, -1.0, "y = \"up\" }"),
        (-2.0, 1.0, "sign = -1, y = \"up\" }"),
        (2.0 / W as f32, 1.0 / H as f32, "units = \"picture\" }"),
        (4.0 / W as f32, -2.0 / H as f32, "units = \"ndc\", y = \"up\" }"),
    ] {
        let files = [
            ("rgb/07.png", picture(0, 0)),
            ("rgb/08.png", picture(2, 1)),
            ("rgb/10.png", picture(6, 3)),
            ("m/07.flo", flo(u, v)),
        ];
        let proposal = proposed(&files, &USUAL).unwrap();
        says(&proposal, &[keys, "color = \"rgb/07.png\"", "kind = \"speed\"", "frame = 3\n", "frames = 3\n"]);
        assert!(proposal.moved_db > proposal.still_db, "{keys}: {:?} {:?}", proposal.moved_db, proposal.still_db);
        assert!(proposal.unused.is_empty());
    }
}

/// Three poses before the first picture's: only the pictures can say so.
#[test]
fn the_update_is_found_among_poses_and_the_depth_has_its_unit() {
    let poses: String = (0..8).map(|at| format!("1 0 0 {} 0 1 0 0 0 0 1 0\n", -0.05 * f64::from(at * at))).collect();
    // At 2.5 m, 50 px of focal length: a pixel for each 5 cm.
    let depth = |value: u16| encode::png16(W as u32, H as u32, ColorType::Grayscale, &vec![value; W * H]);
    let moved = |at: i32| picture((at * at - 9) as usize, 0);
    let files = [
        ("left_03.png", moved(3)),
        ("left_04.png", moved(4)),
        ("left_05.png", moved(5)),
        ("depth_03.png", depth(2500)),
        ("depth_04.png", depth(2500)),
        ("trajectory.txt", poses.into_bytes()),
    ];
    let error = proposed(&files, &USUAL).unwrap_err();
    assert!(error.contains("--intrinsics FX,FY,CX,CY"), "{error}");
    let options = InitOptions { step: 1, intrinsics: Some([50.0, 50.0, 24.0, 16.0]) };
    let proposal = proposed(&files, &options).unwrap();
    says(&proposal, &["pose = 4", "format = \"kitti\"", "scale = 0.001", "color = \"left_04.png\""]);
    let mut files = files.to_vec();
    files.push(("K.txt", b"50 0 24\n0 50 16\n0 0 1\n".to_vec()));
    let with_file = proposed(&files, &InitOptions { step: 4, ..USUAL }).unwrap();
    says(&with_file, &["intrinsics = [50.0, 50.0, 24.0, 16.0]", "frames = 4", "frame = 4\n"]);
}

#[test]
fn channels_of_an_exr_are_found_by_what_they_are_called() {
    let plane = |value: f32| vec![value; W * H];
    let list = [("Z", plane(3.0)), ("VX", plane(2.0)), ("VY", plane(1.0)), ("VZ", plane(0.0))];
    let blender = [
        ("View.Depth.Z", [&plane(3.0)[1..], &[1e10]].concat()),
        ("View.Vector.X", plane(0.0)),
        ("View.Vector.Y", plane(0.0)),
        ("View.Vector.Z", plane(-2.0)),
        ("View.Vector.W", plane(1.0)),
    ];
    for (list, wanted) in [
        (&list[..], &["kind = \"planes\"", "channel = \"Z\""][..]),
        (
            &blender,
            &["kind = \"blender-vector\"", "channel = \"View.Vector\"", "channel = \"View.Depth.Z\"", "far = 1e9"],
        ),
    ] {
        let exr = encode::exr(W, H, encode::Precision::Float, list);
        let files = [("0001.png", picture(0, 0)), ("0002.png", picture(2, 1)), ("passes.exr", exr)];
        let proposal = proposed(&files, &USUAL).unwrap();
        says(&proposal, wanted);
        assert!(proposal.moved_db.unwrap() > proposal.still_db.unwrap() + 3.0, "{:?}", proposal.moved_db);
    }
}

#[test]
fn what_is_missing_is_said() {
    let colour = ("a.png", picture(0, 0));
    for (files, what) in [
        (vec![], "no picture in colour"),
        (vec![("a.flo", flo(1.0, 0.0))], "no picture in colour"),
        (vec![colour.clone()], "no motion for it"),
        (vec![colour.clone(), ("depth.npy", encode::npy_f4("(32, 48)", &vec![1.0; W * H]))], "no motion for it"),
        (vec![colour.clone(), ("a.flo", encode::pieh(2, 2, &[1.0; 8]))], "is 2x2 but the update's colour is 48x32"),
        (vec![colour, ("mask.png", encode::png8(1, 1, ColorType::Rgb, &[1, 2, 3]))], "no motion for it"),
    ] {
        let error = proposed(&files, &USUAL).unwrap_err();
        assert!(error.contains(what), "{error}");
    }
    check_refusal(&init(Path::new("not-there"), &USUAL).unwrap_err(), "not-there", "cannot be listed");
}

/// A name with quotes and line breaks is still one string, and what is written runs.
#[test]
fn names_are_quoted() {
    let odd = "a \"b\"\n7.png";
    let proposal = proposed(&[(odd, picture(0, 0)), ("m.flo", flo(1.0, 0.0)), ("x\ny", vec![0])], &USUAL).unwrap();
    assert_eq!(proposal.unused, ["x\ny"]);
    assert!(proposal.manifest.lines().all(|line| line != "y"), "{}", proposal.manifest);
}

/// Without its own manifest a capture of the test data comes as near to its first truth as with it.
#[test]
fn the_captures_of_the_test_data_are_found_again() {
    let Some(data) = data() else { return };
    let tartanair = Some([320.0, 320.0, 320.0, 240.0]);
    for (name, intrinsics) in [
        ("blender/ball", None),
        ("blender/pan_aa", None),
        ("kitti_flow", None),
        ("middlebury_flow/RubberWhale", None),
        ("middlebury_stereo/teddy", None),
        ("middlebury_stereo/venus", None),
        ("sevenscenes", None),
        ("tartanair_a", tartanair),
    ] {
        let folder = data.join(name);
        let proposal = init(&folder, &InitOptions { step: 1, intrinsics }).unwrap_or_else(|e| panic!("{name}: {e}"));
        let capture = load(&folder, &ImportOptions::default()).unwrap();
        let own = plausible::shown_db(&capture.update, &capture.truths[0], true).unwrap();
        let found = proposal.moved_db.unwrap();
        assert!(found > own - 0.5, "{name}: {found:.2} dB, its own manifest {own:.2} dB\n{}", proposal.manifest);
    }
}
