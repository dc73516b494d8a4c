//! Manifests that are refused, and files that do not agree with theirs.

use super::super::{ImportOptions, load};
use super::encode;
use super::folder::{Folder, check_refusal, colour, manifest};

/// A manifest that is accepted.
const GOOD: &str = r#"
frames = 8
[update]
color = "color.png"
depth = { kind = "z", file = "z.npy", scale = 1.0 }
motion = { kind = "flow", file = "a.flo", frames = 1 }
[[truth]]
frame = 8
color = "color.png"
mask = "mask.png"
"#;

fn folder() -> Folder {
    Folder::new()
        .with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]))
        .with("a.flo", encode::pieh(4, 3, &[1.0; 24]))
        .with("mask.png", encode::png8(4, 3, png::ColorType::Grayscale, &[255; 12]))
}

#[test]
fn names_and_texts() {
    let folder = folder();
    let capture = folder.load(GOOD).unwrap();
    assert_eq!((capture.frames, capture.about.as_str()), (8, ""));
    assert_eq!(capture.name, folder.path().file_name().unwrap().to_string_lossy());
    let capture = folder.load(&format!("name = \"n\"\nabout = \"a\"\n{GOOD}")).unwrap();
    assert_eq!((capture.name.as_str(), capture.about.as_str()), ("n", "a"));
    // The manifest may have any name.
    folder.write("other.toml", format!("name = \"other\"\n{GOOD}"));
    assert_eq!(load(&folder.path().join("other.toml"), &ImportOptions::default()).unwrap().name, "other");
}

#[test]
fn every_bad_manifest_is_refused_with_a_hint() {
    let folder = folder();
    // (text of the manifest, its replacement, text of the refusal)
    let changes = [
        // Unknown keys at every level.
        ("frames = 8", "frames = 8\nframe = 8", "unknown key `frame`"),
        ("[update]", "[update]\ncolour = 1", "unknown key `colour`"),
        ("scale = 1.0", "Scale = 1.0", "unknown key `Scale`"),
        ("frames = 1", "frame = 1", "unknown key `frame`"),
        ("mask =", "masks =", "unknown key `masks`"),
        ("\"color.png\"\ndepth", "{ file = \"color.png\", chanel = \"R\" }\ndepth", "unknown key `chanel`"),
        ("[[truth]]", "acceleration = { kind = \"next-flow\", file = \"a.flo\", x = 1 }\n[[truth]]", "unknown key `x`"),
        ("kind = \"z\", file = \"z.npy\", scale = 1.0", "kind = \"speed\", file = \"z.npy\"", "unknown key `file`"),
        // Missing keys.
        ("frames = 8", "", "missing key `frames`"),
        ("[update]", "[updates]", "unknown key `updates`"),
        ("color = \"color.png\"\ndepth", "depth", "missing key `color`"),
        ("kind = \"z\", ", "", "missing key `kind`"),
        ("file = \"z.npy\", ", "", "missing key `file`"),
        ("frame = 8\n", "", "missing key `frame`"),
        ("kind = \"flow\"", "kind = \"disparity\"", "missing key `sign`"),
        // Wrong types and variants.
        ("frames = 8", "frames = \"8\"", "invalid type"),
        ("frames = 8", "frames = 8.5", "invalid type"),
        ("frames = 8", "frames = -8", "-8"),
        ("frames = 8", "frames = 99999999999", "99999999999"),
        ("color = \"color.png\"\ndepth", "color = 7\ndepth", "a file's name or { file, channel }"),
        ("scale = 1.0", "invalid = \"0\"", "`invalid` must be a number or a list of numbers"),
        ("\"z\"", "\"Z\"", "unknown variant `Z`"),
        ("\"flow\"", "\"optical\"", "unknown variant `optical`"),
        ("[[truth]]", "background = \"sky\"\n[[truth]]", "unknown variant `sky`"),
        ("[[truth]]", "acceleration = \"no\"\n[[truth]]", "false or { kind = \"next-flow\""),
        ("[[truth]]", "[truth]", "invalid type"),
        ("frames = 8", "frames = ", "line 2"),
        ("frames = 8", "frames = 8\nframes = 8", "duplicate key"),
        // Values.
        ("frames = 8", "frames = 0", "frames is 0"),
        ("frames = 8", "frames = 65536", "frames is 65536"),
        ("frames = 1", "frames = 0", "motion.frames is 0"),
        ("scale = 1.0", "scale = -1.0", "depth.scale is -1"),
        ("scale = 1.0", "scale = 0.0", "depth.scale is 0"),
        ("scale = 1.0", "scale = nan", "depth.scale is NaN"),
        ("scale = 1.0", "scale = inf", "depth.scale is inf"),
        ("scale = 1.0", "far = nan", "depth.far is not a number"),
        ("frame = 8", "frame = 0", "truth.frame is 0, outside of 1 to 8"),
        ("frame = 8", "frame = 9", "truth.frame is 9, outside of 1 to 8"),
        ("[[truth]]", "[[truth]]\nframe = 8\ncolor = \"color.png\"\n[[truth]]", "two truths for frame 8"),
        (
            "[[truth]]",
            "acceleration = { kind = \"next-flow\", file = \"a.flo\", frames = 0 }\n[[truth]]",
            "acceleration.frames is 0",
        ),
    ];
    for (from, to, what) in changes {
        assert!(GOOD.contains(from), "{from} is not in the manifest");
        folder.refused(&GOOD.replacen(from, to, 1), "capture.toml", what);
    }
    let motions = [
        ("kind = \"disparity\", file = \"z.npy\", sign = -2", "motion.sign is -2"),
        ("kind = \"disparity\", file = \"z.npy\", sign = nan", "motion.sign is NaN"),
        ("kind = \"disparity\", file = \"z.npy\", sign = 1, scale = 0", "motion.scale is 0"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = 0, intrinsics = [0, 1, 1, 1]", "focal length"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = 0, intrinsics = [1, nan, 1, 1]", "focal length"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = 0, intrinsics = [1, 1, inf, 1]", "not finite"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = 0, intrinsics = [1, 1, 1]", "invalid length"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = 0, pixel_centre = 0.25", "pixel_centre is 0.25"),
        ("kind = \"camera\", poses = \"p\", format = \"log\", pose = -1", "-1"),
        ("kind = \"camera\", poses = \"p\", format = \"bundler\", pose = 0", "unknown variant `bundler`"),
    ];
    for (motion, what) in motions {
        let text = manifest("{ kind = \"z\", file = \"z.npy\" }", &format!("{{ {motion} }}"), "");
        folder.refused(&text, "capture.toml", what);
    }
}

#[test]
fn files_that_are_missing_empty_or_something_else() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("directory")).unwrap();
    folder.write("empty", "");
    folder.write("noise", "this is neither a picture nor numbers");
    let names = ["\"color.png\"\ndepth", "\"z.npy\"", "\"a.flo\"", "\"color.png\"\nmask", "\"mask.png\""];
    for name in names {
        for (other, what) in [
            ("absent", "cannot be read"),
            ("directory", "not a regular file"),
            ("empty", "does not begin like"),
            ("noise", "does not begin like"),
        ] {
            let rest = name.split_once('\n').map_or(String::new(), |(_, rest)| format!("\n{rest}"));
            folder.refused(&GOOD.replacen(name, &format!("\"{other}\"{rest}"), 1), other, what);
        }
    }
    // No file's name can break the line.
    folder.refused(&GOOD.replace("z.npy", "a\\nb\\u0007c"), "a b c", "cannot be read");
    folder.refused(&GOOD.replace("z.npy", "a\\u0000b"), "a b", "cannot be read");
}

#[test]
#[cfg(unix)]
fn a_pipe_is_refused_at_once() {
    let folder = folder();
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("pipe")).status();
    if !made.is_ok_and(|status| status.success()) {
        eprintln!("skipped: mkfifo is absent");
        return;
    }
    folder.refused(&GOOD.replace("z.npy", "pipe"), "pipe", "not a regular file");
}

#[test]
fn everything_has_the_size_of_the_colour_picture() {
    let folder = folder();
    let rgb = |w: usize, h: usize| (0..w * h).flat_map(|i| colour(i % w, i / w)).collect::<Vec<u8>>();
    let wrong = encode::png8(3, 4, png::ColorType::Rgb, &rgb(3, 4));
    let what = "is 3x4 but the update's colour is 4x3";
    folder.write("wrong.png", &wrong);
    folder.write("grey.png", encode::png8(3, 4, png::ColorType::Grayscale, &[1; 12]));
    folder.write("wrong.flo", encode::pieh(3, 4, &[0.0; 24]));
    folder.write("tall.png", encode::png8(4, 4, png::ColorType::Rgb, &rgb(4, 4)));
    folder.refused(&GOOD.replace("mask.png", "tall.png"), "tall.png", "is 4x4 but the update's colour is 4x3");
    for (from, to) in [("z.npy", "grey.png"), ("a.flo", "wrong.flo"), ("mask.png", "wrong.png")] {
        folder.refused(&GOOD.replace(from, to), to, what);
    }
    folder.refused(&GOOD.replace("color = \"color.png\"\nmask", "color = \"wrong.png\"\nmask"), "wrong.png", what);
}

#[test]
fn the_manifest_itself_may_be_missing_or_no_text() {
    let folder = Folder::new();
    let refused =
        |what: &str| check_refusal(&load(folder.path(), &ImportOptions::default()).unwrap_err(), "capture.toml", what);
    refused("cannot be read");
    for (bytes, what) in [
        (&b"frames = 8 # \xff\xfe"[..], "is not a text file"),
        (b"\xff\xfef\0r\0", "is not a text file"),
        (b"", "missing key"),
        (b"\0\0\0", "line 1"),
        (&[b'['; 100_000], ""),
        (b"update = 3\nframes = 1", "invalid type"),
    ] {
        folder.write("capture.toml", bytes);
        refused(what);
    }
    std::fs::remove_file(folder.path().join("capture.toml")).unwrap();
    std::fs::create_dir(folder.path().join("capture.toml")).unwrap();
    refused("not a regular file");
}
