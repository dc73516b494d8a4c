//! What is known behind an update: a second layer, or pictures from elsewhere.

use super::super::Capture;
use super::encode::{self, Precision};
use super::folder::{Folder, H, W, cells, manifest, near};
use crate::update::{Known, Sample};

const DEPTH: &str = "{ kind = \"z\", file = \"z.npy\" }";
const FLOW: &str = "{ kind = \"flow\", file = \"a.flo\" }";
const LAYER: &str = "color = \"second.png\", depth = { kind = \"z\", file = \"second.npy\" }";

fn flow(u: f32, v: f32) -> Vec<u8> {
    encode::pieh(4, 3, &cells(|_, _| [u, v]).concat())
}

/// Returns a first layer at distance 2 that moves by (1, 0), and files of a second one: distances 2.5, 3, NaN and 0 in
/// the columns, all moving by (-2, 0.5).
fn folder() -> Folder {
    let second = cells(|x, _| [2.5, 3.0, f32::NAN, 0.0][x]);
    let rgb: Vec<u8> = cells(|x, y| [200, 30 * x as u8, 50 * y as u8]).concat();
    Folder::new()
        .with("z.npy", encode::npy_f4("(3, 4)", &[2.0; 12]))
        .with("a.flo", flow(1.0, 0.0))
        .with("second.npy", encode::npy_f4("(3, 4)", &second))
        .with("second.flo", flow(-2.0, 0.5))
        .with("second.png", encode::png8(4, 3, png::ColorType::Rgb, &rgb))
}

fn layer(more: &str) -> String {
    format!("hidden = {{ kind = \"layer\", {LAYER}, {more} }}")
}

const OWN_FLOW: &str = "motion = { kind = \"flow\", file = \"second.flo\" }";

fn behind(capture: &Capture, x: usize, y: usize) -> Option<Sample> {
    let hidden = capture.hidden.as_ref().expect("something is behind");
    assert_eq!((hidden.width, hidden.height), (capture.update.width, capture.update.height));
    Some(hidden.samples[y * hidden.width + x]).filter(|sample| sample.known == Known::Motion)
}

#[test]
fn a_second_layer_is_read_like_the_first_and_measured_in_its_unit() {
    let capture = folder().update(DEPTH, FLOW, &layer(OWN_FLOW)).unwrap();
    // The nearest of the first layer is at 2, so that the depth of z is 1 - 1 / z in both.
    near(&[capture.update.samples[0].depth], &[0.5], 1e-12);
    for y in 0..H {
        let sample = behind(&capture, 0, y).unwrap();
        near(&[sample.depth], &[0.6], 1e-12);
        near(&sample.velocity, &[-2.0, 0.5, 0.0], 1e-6);
        assert_eq!(sample.colour, [200, 0, 50 * y as u8]);
        near(&[behind(&capture, 1, y).unwrap().depth], &[1.0 - 1.0 / 3.0], 1e-12);
        assert!(behind(&capture, 2, y).is_none() && behind(&capture, 3, y).is_none(), "NaN and 0 are no distances");
    }
    assert_eq!(capture.census.hidden, Some(6));
    assert_eq!((capture.census.known, capture.census.unknown_depth), (12, 0), "the first layer's are its own");
    assert_eq!(folder().update(DEPTH, FLOW, "").unwrap().census.hidden, None);
}

#[test]
fn what_is_in_front_of_the_first_layer_is_not_hidden() {
    let folder = folder();
    folder.write("second.npy", encode::npy_f4("(3, 4)", &cells(|x, _| [1.9, 2.0, 2.1, 1e9][x])));
    // Unknown in front: whatever is behind is seen.
    folder.write("z.npy", encode::npy_f4("(3, 4)", &cells(|x, y| if (x, y) == (0, 0) { 0.0 } else { 2.0 })));
    let capture = folder.update(DEPTH, FLOW, &layer(OWN_FLOW)).unwrap();
    assert!(behind(&capture, 0, 1).is_none() && behind(&capture, 0, 0).is_some());
    assert!(behind(&capture, 1, 1).is_some() && behind(&capture, 2, 1).is_some() && behind(&capture, 3, 1).is_some());
    // Of disparities the smaller one is behind.
    let disparity = "{ kind = \"disparity\", file = \"z.npy\" }";
    let text = layer(OWN_FLOW).replace("kind = \"z\"", "kind = \"disparity\"");
    let capture = folder.update(disparity, FLOW, &text).unwrap();
    assert!(behind(&capture, 0, 1).is_some() && behind(&capture, 2, 1).is_none());
}

#[test]
fn layers_may_be_channels_of_one_file() {
    let band = |value: f32| vec![value; 12];
    let list = ["A.Z", "B.Z", "A.V.VX", "A.V.VY", "B.V.VX", "B.V.VY", "B.C.R", "B.C.G", "B.C.B"];
    let values = [2.0, 4.0, 1.0, 0.0, 3.0, -1.0, 0.0, 1.0, 0.0];
    let channels: Vec<(String, Vec<f32>)> =
        list.iter().zip(values).map(|(name, value)| ((*name).to_owned(), band(value))).collect();
    let folder = Folder::new().with("p.exr", encode::exr(W, H, Precision::Float, &encode::borrowed(&channels)));
    let depth = |layer: &str| format!("{{ kind = \"z\", file = \"p.exr\", channel = \"{layer}.Z\" }}");
    let motion = |layer: &str| format!("{{ kind = \"planes\", file = \"p.exr\", channel = \"{layer}.V\" }}");
    let hidden = format!(
        "[update.hidden]\nkind = \"layer\"\ncolor = {{ file = \"p.exr\", channel = \"B.C\" }}\ndepth = {}\nmotion = {}",
        depth("B"),
        motion("B")
    );
    let capture = folder.update(&depth("A"), &motion("A"), &hidden).unwrap();
    let sample = behind(&capture, 3, 2).unwrap();
    near(&sample.velocity, &[3.0, -1.0, 0.0], 1e-12);
    near(&[sample.depth], &[0.75], 1e-12);
    assert_eq!(sample.colour, [0, 255, 0]);
}

/// Three poses, each 0.1 to the right of the one before; `f = 20`, so that a point at distance 2 moves by one pixel to
/// the left.
const PATH: &str = "0 0 0 0 0 0 1\n0.1 0 0 0 0 0 1\n0.2 0 0 0 0 0 1\n0.3 0 0 0 0 0 1\n";

fn camera() -> String {
    "{ kind = \"camera\", format = \"tartanair\", axes = \"opencv\", poses = \"p.txt\", pose = 1, intrinsics = [20, 20, 0, 0] }".into()
}

#[test]
fn a_camera_moves_the_second_layer_too() {
    let folder = folder().with("p.txt", PATH);
    folder.write("second.npy", encode::npy_f4("(3, 4)", &[4.0; 12]));
    let capture = folder.update(DEPTH, &camera(), &layer("")).unwrap();
    near(&capture.update.samples[5].velocity, &[-1.0, 0.0, 0.0], 1e-9);
    near(&behind(&capture, 1, 1).unwrap().velocity, &[-0.5, 0.0, 0.0], 1e-9);
}

/// A near column in front of a wall at 4. From pose 3 the wall is seen half a pixel times 2 = 1 pixel to the left of
/// where the update has it, and the near column at 1 by 4 pixels: it is out of the picture, and the wall is seen whole.
#[test]
fn a_picture_from_elsewhere_sees_behind_the_first_layer() {
    let first = cells(|x, _| if x == 2 { 1.0_f32 } else { 4.0 });
    let rgb: Vec<u8> = cells(|x, y| [10 * x as u8, 20 * y as u8, 99]).concat();
    let folder = Folder::new()
        .with("z.npy", encode::npy_f4("(3, 4)", &first))
        .with("view.npy", encode::npy_f4("(3, 4)", &[4.0; 12]))
        .with("view.png", encode::png8(4, 3, png::ColorType::Rgb, &rgb))
        .with("p.txt", PATH);
    let view = "{ pose = 3, color = \"view.png\", depth = { file = \"view.npy\" } }";
    let load = |more: &str| {
        let hidden = format!("hidden = {{ kind = \"views\", views = [{view}] {more} }}");
        folder.update(DEPTH, &camera(), &hidden).unwrap()
    };
    let capture = load("");
    for (x, y) in cells(|x, y| (x, y)) {
        // Column 1 of the view is column 2 of the update.
        match behind(&capture, x, y) {
            Some(sample) => {
                assert_eq!((x, sample.colour), (2, [10, 20 * y as u8, 99]));
                near(&sample.velocity, &[-0.5, 0.0, 0.0], 1e-9);
                // The nearest is at 1: d = 1 - 0.5 / z.
                near(&[sample.depth], &[0.875], 1e-9);
            }
            None => assert_ne!(x, 2),
        }
    }
    assert_eq!(capture.census.hidden, Some(3));
    // 0.5 and 0.875 are 0.375 apart.
    assert_eq!(load(", separation = 0.37").census.hidden, Some(3));
    assert_eq!(load(", separation = 0.38").census.hidden, Some(0));
}

#[test]
fn what_does_not_fit_is_refused_in_a_sentence() {
    let folder = folder().with("p.txt", PATH);
    folder.write("large.npy", encode::npy_f4("(4, 4)", &[3.0; 16]));
    folder.write("large.png", encode::png8(4, 4, png::ColorType::Rgb, &[0; 48]));
    let refused = |depth: &str, motion: &str, more: &str, file: &str, what: &str| {
        folder.refused(&manifest(depth, motion, more), file, what);
    };
    let own = layer(OWN_FLOW);
    for (change, to, file, what) in [
        ("second.png", "large.png", "large.png", "is 4x4 but the update's colour is 4x3"),
        ("second.npy", "large.npy", "large.npy", "is 4x4 but the update's colour is 4x3"),
        ("second.npy", "absent.npy", "absent.npy", "cannot be read"),
        ("second.flo", "z.npy", "z.npy", "one number a pixel"),
        ("kind = \"layer\"", "kind = \"layers\"", "capture.toml", "unknown variant `layers`"),
        ("kind = \"layer\",", "kind = \"layer\", tag = 1,", "capture.toml", "unknown key `tag`"),
        ("color = \"second.png\",", "", "capture.toml", "missing key `color`"),
        (
            "depth = { kind = \"z\", file = \"second.npy\" }",
            "depth = { kind = \"z\", file = \"second.npy\", scale = 0 }",
            "capture.toml",
            "hidden.depth.scale is 0",
        ),
        (
            "depth = { kind = \"z\", file = \"second.npy\" }",
            "depth = { kind = \"speed\" }",
            "capture.toml",
            "another kind than update.depth",
        ),
        (OWN_FLOW, "", "capture.toml", "without a motion"),
        (
            OWN_FLOW,
            "motion = { kind = \"flow\", file = \"second.flo\", frames = 0 }",
            "capture.toml",
            "hidden.motion.frames is 0",
        ),
    ] {
        assert!(own.contains(change), "{change}");
        refused(DEPTH, FLOW, &own.replace(change, to), file, what);
    }
    let speed = layer(OWN_FLOW).replace("{ kind = \"z\", file = \"second.npy\" }", "{ kind = \"speed\" }");
    refused("{ kind = \"speed\" }", FLOW, &speed, "capture.toml", "no depth that says what is behind");

    let view = "{ pose = 3, color = \"second.png\", depth = { file = \"z.npy\" } }";
    let views = |list: &str, more: &str| format!("hidden = {{ kind = \"views\", views = [{list}] {more} }}");
    assert!(folder.update(DEPTH, &camera(), &views(view, "")).is_ok());
    for (text, file, what) in [
        (views("", ""), "capture.toml", "has 0 hidden.views"),
        (views(&vec![view; 65].join(", "), ""), "capture.toml", "has 65 hidden.views"),
        (views(view, ", separation = 1.0"), "capture.toml", "hidden.separation is 1"),
        (views(view, ", separation = nan"), "capture.toml", "hidden.separation is NaN"),
        (views(&view.replace("pose = 3", "pose = 4"), ""), "p.txt", "pose 4 is not among them"),
        (views(&view.replace("z.npy", "large.npy"), ""), "large.npy", "is 4x4 but the update's colour is 4x3"),
        (views(&view.replace("second.png", "large.png"), ""), "large.png", "is 4x4 but the update's colour is 4x3"),
        (views(&view.replace("pose = 3,", ""), ""), "capture.toml", "missing key `pose`"),
    ] {
        refused(DEPTH, &camera(), &text, file, what);
    }
    refused(DEPTH, FLOW, &views(view, ""), "capture.toml", "whose camera is unknown");
}
