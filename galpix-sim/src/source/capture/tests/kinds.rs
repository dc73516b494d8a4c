//! The conventions of maps, vectors and pictures: what a file says of itself, and what the manifest says of it.

use png::ColorType;

use super::encode::{self, Precision};
use super::folder::{self, Folder, H, SIZE, W, cells, check_refusal, colour, empty, known, manifest, near, source};
use crate::update::{DepthKind, Known};

const SPEED: &str = "{ kind = \"speed\" }";
const FLOW: &str = "{ kind = \"flow\", file = \"f.flo\" }";
const Z: &str = "{ kind = \"z\", file = \"z.npy\" }";

/// A displacement that differs in each cell.
fn uv(x: usize, y: usize) -> [f64; 2] {
    [1.0 + x as f64, 0.5 * y as f64 - 2.0]
}

fn flo(value: impl Fn(usize, usize) -> [f64; 2]) -> Vec<u8> {
    encode::pieh(4, 3, &cells(|x, y| value(x, y).map(|v| v as f32)).concat())
}

#[track_caller]
fn moves(folder: &Folder, motion: &str, wanted: impl Fn(usize, usize) -> [f64; 2]) {
    let capture = folder.update(SPEED, motion, "").unwrap();
    for (x, y) in SIZE.positions() {
        near(&known(&capture, x, y).velocity[..2], &wanted(x, y), 1e-5);
    }
}

#[track_caller]
fn says(notes: &[String], what: &str) {
    assert!(notes.iter().any(|note| note.contains(what)), "nothing about {what:?}: {notes:?}");
}

#[test]
fn vectors_in_any_convention_mean_the_same() {
    let (w, h) = (W as f64, H as f64);
    type Written = fn([f64; 2], f64, f64) -> [f64; 2];
    let conventions: [(&str, Written); 9] = [
        ("", |v, _, _| v),
        (", units = \"color-pixels\"", |v, _, _| v),
        (", units = \"picture\"", |[x, y], w, h| [x / w, y / h]),
        (", units = \"ndc\", y = \"up\"", |[x, y], w, h| [2.0 * x / w, -2.0 * y / h]),
        (", sign = -1", |[x, y], _, _| [-x, -y]),
        (", y = \"up\"", |[x, y], _, _| [x, -y]),
        (", scale = 0.25", |[x, y], _, _| [4.0 * x, 4.0 * y]),
        (", scale = [0.5, -2.0], sign = -1", |[x, y], _, _| [-2.0 * x, 0.5 * y]),
        (", units = \"picture\", offset = -0.5", |[x, y], w, h| [x / w + 0.5, y / h + 0.5]),
    ];
    for (keys, written) in conventions {
        let folder = Folder::new().with("f.flo", flo(|x, y| written(uv(x, y), w, h)));
        moves(&folder, &format!("{{ kind = \"flow\", file = \"f.flo\"{keys} }}"), uv);
        let list = [0, 1].map(|i| cells(|x, y| written(uv(x, y), w, h)[i] as f32));
        let list = [("a.right", list[0].clone()), ("a.below", list[1].clone())];
        let folder = Folder::new().with("p.exr", encode::exr(W, H, Precision::Float, &list));
        let names = "channels = [\"a.right\", \"a.below\"]";
        for kind in ["planes", "flow"] {
            moves(&folder, &format!("{{ kind = \"{kind}\", file = \"p.exr\", {names}{keys} }}"), uv);
        }
    }
}

#[test]
fn vectors_of_half_the_size_grow_with_it() {
    let folder = Folder::new();
    let grey = encode::png8(8, 6, ColorType::Grayscale, &[9; 48]);
    folder.write("color.png", grey);
    folder.write("f.flo", flo(uv));
    let text = manifest(SPEED, FLOW, "");
    let refusal = folder.refused(&text, "f.flo", "is 4x3 but the update's colour is 8x6");
    assert!(refusal.contains("resize = true"), "{refusal}");
    for (units, grown) in [("", 2.0), (", units = \"color-pixels\"", 1.0)] {
        let motion = format!("{{ kind = \"flow\", file = \"f.flo\", resize = true{units} }}");
        let capture = folder.update(SPEED, &motion, "").unwrap();
        for (x, y) in (0..6).flat_map(|y| (0..8).map(move |x| (x, y))) {
            near(&known(&capture, x, y).velocity[..2], &uv(x / 2, y / 2).map(|v| grown * v), 1e-6);
        }
    }
    folder.write("color.png", encode::png8(8, 12, ColorType::Grayscale, &[9; 96]));
    let motion = "{ kind = \"flow\", file = \"f.flo\", resize = true }";
    folder.refused(&manifest(SPEED, motion, ""), "f.flo", "of another shape");
}

#[test]
fn unknown_vectors_may_be_marked_in_any_way() {
    let corner = |x: usize, y: usize| (x, y) == (1, 2);
    let is_counted = |folder: &Folder, motion: &str| {
        let capture = folder.update(SPEED, motion, "").unwrap();
        assert!(empty(&capture, 1, 2), "{motion}");
        assert_eq!((capture.census.known, capture.census.unknown_motion), (11, 1), "{motion}");
        capture.census.notes
    };
    let marked = flo(|x, y| if corner(x, y) { [-999.0, 0.0] } else { uv(x, y) });
    let folder = Folder::new().with("f.flo", marked);
    is_counted(&folder, "{ kind = \"flow\", file = \"f.flo\", invalid = -999 }");
    let folder = Folder::new().with("f.flo", flo(|x, y| if corner(x, y) { [0.0, 1e9] } else { uv(x, y) }));
    is_counted(&folder, FLOW);
    let mask = encode::png8(4, 3, ColorType::Grayscale, &cells(|x, y| if corner(x, y) { 0 } else { 9 }));
    let folder = Folder::new().with("f.flo", flo(uv)).with("m.png", &mask);
    is_counted(&folder, "{ kind = \"flow\", file = \"f.flo\", mask = \"m.png\" }");
    for one in [1.0, 255.0] {
        let bands = cells(|x, y| [uv(x, y)[0] as f32, uv(x, y)[1] as f32, if corner(x, y) { 0.0 } else { one }]);
        let file = encode::npy_f4("(3, 4, 3)", &bands.concat());
        let notes = is_counted(&Folder::new().with("f.npy", file), "{ kind = \"flow\", file = \"f.npy\" }");
        says(&notes, "third band");
    }
    // Any other third band is noted, and not used.
    let bands = cells(|x, y| [uv(x, y)[0] as f32, uv(x, y)[1] as f32, x as f32 - 1.0]);
    let folder = Folder::new().with("f.npy", encode::npy_f4("(3, 4, 3)", &bands.concat()));
    let capture = folder.update(SPEED, "{ kind = \"flow\", file = \"f.npy\" }", "").unwrap();
    assert_eq!(capture.census.known, 12);
    says(&capture.census.notes, "only the first two are used");
    // A mask that leaves nothing is refused.
    let folder = Folder::new().with("f.flo", flo(uv)).with("m.png", encode::png8(4, 3, ColorType::Grayscale, &[0; 12]));
    let motion = "{ kind = \"flow\", file = \"f.flo\", mask = \"m.png\" }";
    folder.refused(&manifest(SPEED, motion, ""), "capture.toml", "no cell with both depth and motion");
}

#[test]
fn arrays_in_any_order_of_sides_and_in_archives() {
    let pairs: Vec<f32> = cells(|x, y| uv(x, y).map(|v| v as f32)).concat();
    let planar: Vec<f32> = (0..2).flat_map(|i| cells(move |x, y| uv(x, y)[i] as f32)).collect();
    for (shape, values) in [("(3, 4, 2)", &pairs), ("(2, 3, 4)", &planar), ("(1, 2, 3, 4)", &planar)] {
        let folder = Folder::new().with("f.npy", encode::npy_f4(shape, values));
        moves(&folder, "{ kind = \"flow\", file = \"f.npy\" }", uv);
    }
    for compressed in [false, true] {
        let one = [("flow", encode::npy_f4("(3, 4, 2)", &pairs))];
        let folder = Folder::new().with("f.npz", encode::npz(&one, compressed));
        moves(&folder, "{ kind = \"flow\", file = \"f.npz\" }", uv);
        let two = [("z", encode::npy_f4("(3, 4)", &[2.0; 12])), ("flow", encode::npy_f4("(3, 4, 2)", &pairs))];
        let folder = Folder::new().with("f.npz", encode::npz(&two, compressed));
        moves(&folder, "{ kind = \"flow\", file = \"f.npz\", channel = \"flow\" }", uv);
        let text = manifest(SPEED, "{ kind = \"flow\", file = \"f.npz\" }", "");
        let refusal = folder.refused(&text, "f.npz", "has 2 arrays");
        assert!(refusal.contains("z, flow") || refusal.contains("flow, z"), "{refusal}");
        let text = manifest(SPEED, "{ kind = \"flow\", file = \"f.npz\", channel = \"v\" }", "");
        folder.refused(&text, "f.npz", "no array \"v\"");
    }
}

#[test]
fn what_an_exr_says_of_its_colours_and_losses_is_noted() {
    let bent = exr::meta::attribute::Chromaticities {
        red: exr::math::Vec2(0.7347, 0.2653),
        green: exr::math::Vec2(0.0, 1.0),
        blue: exr::math::Vec2(0.0001, -0.077),
        white: exr::math::Vec2(0.32168, 0.33767),
    };
    let list = ["R", "G", "B"].map(|name| (name, vec![0.5; 12]));
    let mut notes = Vec::new();
    let file = encode::exr_with(Some(bent), exr::prelude::Compression::PXR24, &list);
    super::super::colour::read(&source("c.exr", file), None, None, &mut notes).unwrap();
    says(&notes, "not those of sRGB");
    assert_eq!(notes.len(), 1);
    let list = [("VX", cells(|x, _| x as f32)), ("VY", vec![0.0; 12])];
    for (compression, noted) in [
        (exr::prelude::Compression::PXR24, true),
        (exr::prelude::Compression::B44, false),
        (exr::prelude::Compression::DWAA(None), true),
        (exr::prelude::Compression::PIZ, false),
    ] {
        let folder = Folder::new().with("p.exr", encode::exr_with(None, compression, &list));
        let capture = folder.update(SPEED, "{ kind = \"planes\", file = \"p.exr\" }", "").unwrap();
        let found = capture.census.notes.iter().any(|note| note.contains("losses"));
        assert_eq!(found, noted, "{compression}: {:?}", capture.census.notes);
    }
}

/// Returns the distances of a depth, from the depths as normalised: near is half of the nearest.
#[track_caller]
fn distances(folder: &Folder, depth: &str, nearest: f64, wanted: &[Option<f64>]) {
    let capture = folder.update(depth, FLOW, "").unwrap();
    for ((x, y), wanted) in SIZE.positions().zip(wanted) {
        match wanted {
            Some(z) => near(&[known(&capture, x, y).depth], &[1.0 - nearest / 2.0 / z], 1e-5),
            None => assert!(empty(&capture, x, y), "({x}, {y})"),
        }
    }
}

fn z(x: usize, y: usize) -> f64 {
    2.0 + x as f64 + 0.25 * y as f64
}

#[test]
fn distances_in_any_convention_mean_the_same() {
    let wanted: Vec<Option<f64>> = cells(|x, y| Some(z(x, y)));
    let base = || Folder::new().with("f.flo", flo(uv));
    type Written = fn(f64) -> f64;
    let conventions: [(&str, Written); 8] = [
        ("kind = \"z\"", |z| z),
        ("kind = \"z\", sign = -1", |z| -z),
        ("kind = \"z\", sign = -1, scale = 0.5", |z| -2.0 * z),
        ("kind = \"z\", offset = 1.5", |z| z - 1.5),
        ("kind = \"buffer\", planes = [0.5, 100.0]", |z| (1.0 / 0.5 - 1.0 / z) / (1.0 / 0.5 - 1.0 / 100.0)),
        ("kind = \"buffer\", planes = [inf, 0.5]", |z| 0.5 / z),
        ("kind = \"buffer\", planes = [0.5, inf], scale = 0.5, offset = 0.5", |z| 2.0 * (1.0 - 0.5 / z) - 1.0),
        ("kind = \"disparity\", baseline = 0.25, intrinsics = [40, 40, 1.5, 1]", |z| 10.0 / z),
    ];
    for (keys, written) in conventions {
        let raw: Vec<f32> = cells(|x, y| written(z(x, y)) as f32);
        let folder = base().with("z.npy", encode::npy_f4("(3, 4)", &raw));
        distances(&folder, &format!("{{ file = \"z.npy\", {keys} }}"), 2.0, &wanted);
        assert_eq!(
            folder.update(&format!("{{ file = \"z.npy\", {keys} }}"), FLOW, "").unwrap().update.depth_kind,
            DepthKind::Z
        );
        // Rows from the bottom, as read back from a graphics library.
        let turned: Vec<f32> = raw.chunks(W).rev().flatten().copied().collect();
        let folder = base().with("z.npy", encode::npy_f4("(3, 4)", &turned));
        distances(&folder, &format!("{{ file = \"z.npy\", rows = \"bottom-up\", {keys} }}"), 2.0, &wanted);
    }
    // Along the ray: the axis meets pixel (1, 1), f = 2.
    let raw = cells(|x, y| {
        let [a, b] = [(x as f64 - 1.0) / 2.0, (y as f64 - 1.0) / 2.0];
        (z(x, y) * (a * a + b * b + 1.0).sqrt()) as f32
    });
    let folder = base().with("z.npy", encode::npy_f4("(3, 4)", &raw));
    distances(&folder, "{ file = \"z.npy\", kind = \"ray\", intrinsics = [2, 2, 1, 1] }", 2.0, &wanted);
    let text = manifest("{ file = \"z.npy\", kind = \"ray\" }", FLOW, "");
    folder.refused(&text, "z.npy", "need the camera's intrinsics");
}

#[test]
fn packed_and_whole_numbers_are_depths() {
    let base = || Folder::new().with("f.flo", flo(uv));
    let wanted: Vec<Option<f64>> = cells(|x, y| Some(z(x, y)));
    let steps = cells(|x, y| (z(x, y) * 100_000.0) as u32);
    for (format, order) in [("rgb24", [0, 8, 16]), ("bgr24", [16, 8, 0])] {
        let rgb: Vec<u8> = steps.iter().flat_map(|&v| order.map(|shift| (v >> shift) as u8)).collect();
        let folder = base().with("z.png", encode::png8(4, 3, ColorType::Rgb, &rgb));
        let depth = format!("{{ kind = \"z\", file = \"z.png\", format = \"{format}\", scale = 1e-5 }}");
        distances(&folder, &depth, 2.0, &wanted);
    }
    let refusal = base()
        .with("z.png", encode::png8(4, 3, ColorType::Rgb, &cells(|x, _| [x as u8, 1, 2]).concat()))
        .refused(&manifest("{ kind = \"z\", file = \"z.png\" }", FLOW, ""), "z.png", "coloured picture");
    assert!(refusal.contains("rgb24"), "{refusal}");
    type Stored = fn(f64) -> Vec<u8>;
    let types: [(&str, Stored); 6] = [
        ("<i2", |v| (v as i16).to_le_bytes().to_vec()),
        (">i4", |v| (v as i32).to_be_bytes().to_vec()),
        ("<i4", |v| (v as i32).to_le_bytes().to_vec()),
        ("<u4", |v| (v as u32).to_le_bytes().to_vec()),
        ("<i8", |v| (v as i64).to_le_bytes().to_vec()),
        (">u8", |v| (v as u64).to_be_bytes().to_vec()),
    ];
    for (descr, bytes) in types {
        let body: Vec<u8> = cells(|x, y| bytes(z(x, y) * 1000.0)).concat();
        let folder = base().with("z.npy", encode::npy(1, descr, false, "(3, 4)", &body));
        distances(&folder, "{ kind = \"z\", file = \"z.npy\", scale = 0.001 }", 2.0, &wanted);
    }
}

#[test]
fn what_a_pfm_says_of_its_rows_and_scale() {
    let values: Vec<f32> = cells(|x, y| z(x, y) as f32);
    let wanted: Vec<Option<f64>> = cells(|x, y| Some(z(x, y)));
    let top_down: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let bottom_up = encode::pfm(W, H, 1, true, &values);
    let bottom_up = &bottom_up[bottom_up.len() - 48..];
    let with = |header: &str, body: &[u8]| {
        Folder::new().with("f.flo", flo(uv)).with("z.pfm", [header.as_bytes(), body].concat())
    };
    let read = "{ kind = \"z\", file = \"z.pfm\" }";
    let factors = [("-1000.0", 0.001), ("-1", 1.0), ("-0.00392157", 1.0)];
    for (scale, factor) in factors {
        let scaled: Vec<u8> = values.chunks(W).rev().flatten().flat_map(|v| (v * factor).to_le_bytes()).collect();
        let folder = with(&format!("Pf\n4 3\n{scale}\n"), &scaled);
        distances(&folder, read, 2.0, &wanted);
        let notes = folder.update(read, FLOW, "").unwrap().census.notes;
        assert_eq!(notes.iter().any(|note| note.contains("gives the scale")), scale != "-1", "{notes:?}");
    }
    for header in ["Pf\n# by a tool\n4 3\n-1\n", "Pf # one\n4 # two\n 3\n#three\n-1\n"] {
        distances(&with(header, bottom_up), read, 2.0, &wanted);
    }
    let folder = with("Pf\n4\n3\n-1\n", &top_down);
    distances(&folder, read, 2.0, &wanted);
    says(&folder.update(read, FLOW, "").unwrap().census.notes, "rows from top to bottom");
    distances(
        &with("Pf\n4\n3\n-1\n", bottom_up),
        "{ kind = \"z\", file = \"z.pfm\", rows = \"bottom-up\" }",
        2.0,
        &wanted,
    );
    distances(
        &with("Pf\n4 3\n-1\n", &top_down),
        "{ kind = \"z\", file = \"z.pfm\", rows = \"top-down\" }",
        2.0,
        &wanted,
    );
}

#[test]
fn depths_of_which_nothing_can_be_used_are_refused_with_what_to_do() {
    let cases: [([f32; 2], &str, &str); 7] = [
        ([-1.0, -5.0], "kind = \"z\"", "add sign = -1"),
        ([f32::NAN, f32::NAN], "kind = \"z\"", "NaN"),
        ([f32::INFINITY, f32::INFINITY], "kind = \"z\"", "far = inf"),
        ([7.0, 7.0], "kind = \"z\", invalid = 7", "key invalid"),
        ([0.0, 0.0], "kind = \"z\"", "numbers are zero"),
        ([2.0, 900.0], "kind = \"buffer\", planes = [0.1, 10.0]", "range from 0 to 1"),
        ([2.0, 5.0], "kind = \"z\", sign = -1", "correct the keys scale, offset, sign"),
    ];
    for (raw, keys, what) in cases {
        let folder =
            Folder::new().with("f.flo", flo(uv)).with("z.npy", encode::npy_f4("(3, 4)", &cells(|x, _| raw[x % 2])));
        folder.refused(&manifest(&format!("{{ file = \"z.npy\", {keys} }}"), FLOW, ""), "z.npy", what);
    }
}

/// Returns a folder with a picture of `width` x `height` and vectors and depths of each cell.
fn scene(
    width: usize,
    height: usize,
    uv: impl Fn(usize, usize) -> [f32; 2],
    z: impl Fn(usize, usize) -> f32,
) -> Folder {
    let each = || (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)));
    let noise = |x: usize, y: usize| [x * 37 + y * 91, x * 53 + y * 17, x * x + y * 29].map(|v| (v % 251) as u8);
    let rgb: Vec<u8> = each().flat_map(|(x, y)| noise(x, y)).collect();
    let pairs: Vec<f32> = each().flat_map(|(x, y)| uv(x, y)).collect();
    let depths: Vec<f32> = each().map(|(x, y)| z(x, y)).collect();
    let folder = Folder::new();
    folder.write("color.png", encode::png8(width as u32, height as u32, ColorType::Rgb, &rgb));
    folder.write("f.flo", encode::pieh(width as i32, height as i32, &pairs));
    folder.with("z.npy", encode::npy_f4(&format!("({height}, {width})"), &depths))
}

#[test]
fn one_outlier_costs_no_other_cell_its_order() {
    let outlier = |x: usize, y: usize| (x, y) == (3, 4);
    let near_half = |x: usize| x < 16;
    // Distance, disparity, and speed where no depth is known.
    let cases: [(f32, f32, f32, &str); 3] =
        [(1e-5, 2.0, 8.0, Z), (1e6, 8.0, 2.0, "{ kind = \"disparity\", file = \"z.npy\" }"), (9000.0, 8.0, 2.0, SPEED)];
    for (worst, nearer, farther, depth) in cases {
        let value = |x: usize, y: usize| match (outlier(x, y), near_half(x)) {
            (true, _) => worst,
            (_, true) => nearer,
            (_, false) => farther,
        };
        let speed = |x: usize, y: usize| [if depth == SPEED { value(x, y) } else { 1.0 }, 0.0];
        let capture = scene(32, 32, speed, value).update(depth, FLOW, "").unwrap();
        says(&capture.census.notes, "count as nearest");
        assert_eq!(known(&capture, 3, 4).depth, 0.0, "{depth}");
        near(&[known(&capture, 0, 0).depth, known(&capture, 31, 0).depth], &[0.5, 0.875], 1e-6);
        let usual = scene(32, 32, |x, _| speed(x, 0), |x, _| value(x, 0)).update(depth, FLOW, "").unwrap();
        assert_eq!(usual.update.samples[0].depth, capture.update.samples[0].depth);
        assert!(!usual.census.notes.iter().any(|note| note.contains("nearest")));
    }
}

#[test]
fn windows_of_an_exr_are_followed() {
    // The planes of a 6x5 data window, of which the display shows 4x3 from (1, 2) on.
    let value = |i: usize| 1.0 + (i % 6) as f32 + 10.0 * (i / 6) as f32;
    let list = [("VX", (0..30).map(value).collect::<Vec<_>>()), ("VY", vec![0.0; 30]), ("Z", vec![2.0; 30])];
    let planes = "{ kind = \"planes\", file = \"p.exr\" }";
    let depth = "{ kind = \"z\", file = \"p.exr\", channel = \"Z\" }";
    let folder = Folder::new().with("p.exr", encode::exr_window([6, 5], [-1, -2], [4, 3], &list));
    let capture = folder.update(depth, planes, "").unwrap();
    for (x, y) in SIZE.positions() {
        near(&[known(&capture, x, y).velocity[0]], &[f64::from(value(6 * (y + 2) + x + 1))], 0.0);
    }
    says(&capture.census.notes, "data window of 6x5 at (-1, -2)");
    // A data window inside of the display window leaves the rest open.
    let list = [("VX", vec![1.0; 4]), ("VY", vec![0.0; 4]), ("Z", vec![2.0; 4])];
    let folder = Folder::new().with("p.exr", encode::exr_window([2, 2], [1, 1], [4, 3], &list));
    let capture = folder.update(depth, planes, "").unwrap();
    assert!(SIZE.positions().all(|(x, y)| empty(&capture, x, y) != ((1..3).contains(&x) && y >= 1)));
    // Where just the data window is of the colour's size, it is that which was meant.
    let list = [("VX", vec![1.0; 12]), ("VY", vec![0.0; 12]), ("Z", vec![2.0; 12])];
    let folder = Folder::new().with("p.exr", encode::exr_window([4, 3], [20, 10], [64, 48], &list));
    let capture = folder.update(depth, planes, "").unwrap();
    assert_eq!(capture.census.known, 12);
    says(&capture.census.notes, "the data window is taken");
}

#[test]
fn a_colour_in_a_window_lies_where_it_is() {
    let list = ["R", "G", "B"].map(|name| (name, vec![1.0; 4]));
    let found =
        folder::picture(&source("c.exr", encode::exr_window([2, 2], [2, 1], [4, 3], &list)), None, None).unwrap();
    assert_eq!((found.width, found.height), (4, 3));
    let white = cells(|x, y| if x >= 2 && y >= 1 { [255; 3] } else { [0; 3] });
    assert_eq!(found.pixels, white);
}

#[test]
fn compressions_that_are_not_read_are_refused_by_their_names() {
    let file = encode::exr(W, H, Precision::Float, &[("Z", vec![1.0; 12])]);
    let name = b"compression\0compression\0\x01\0\0\0";
    let at = file.windows(name.len()).position(|window| window == name).unwrap() + name.len();
    for (code, wanted) in [(10, "HTJ2K"), (11, "HTJ2K"), (12, "newer")] {
        let mut file = file.clone();
        file[at] = code;
        let error = folder::numbers(&source("z.exr", file), None, super::super::manifest::MapFormat::Raw).unwrap_err();
        let text = check_refusal(&error, "z.exr", wanted);
        assert!(text.contains("ZIP") && !text.contains("damaged"), "{text}");
    }
}

#[test]
fn blenders_vectors_of_one_side_are_a_velocity() {
    for (list, wanted, side) in
        [([0.0, 0.0, -5.0, -2.0], [5.0, -2.0], "previous"), ([-3.0, -1.0, 0.0, 0.0], [3.0, -1.0], "next")]
    {
        let names = ["X", "Y", "Z", "W"].map(|name| format!("Vector.{name}"));
        let list: Vec<(String, Vec<f32>)> = names.into_iter().zip(list.map(|v| vec![v; 12])).collect();
        let folder = Folder::new().with("p.exr", encode::exr(W, H, Precision::Float, &encode::borrowed(&list)));
        let capture = folder.update(SPEED, "{ kind = \"blender-vector\", file = \"p.exr\" }", "").unwrap();
        near(&known(&capture, 1, 1).velocity[..2], &wanted, 1e-9);
        near(&known(&capture, 1, 1).acceleration, &[0.0; 3], 0.0);
        says(&capture.census.notes, &format!("no vector to the {side} frame"));
        let text = manifest(SPEED, "{ kind = \"blender-vector\", file = \"p.exr\", sign = -1 }", "");
        folder.refused(&text, "capture.toml", "does not belong to Blender's pass");
    }
}

#[test]
fn pictures_are_read_upright_and_their_profiles_noted() {
    let rgb: Vec<u8> = (0..16 * 32).flat_map(|i| if i / 16 < 16 { [250, 10, 10] } else { [10, 10, 250] }).collect();
    let file = encode::jpeg_with_exif(&encode::jpeg(16, 32, &rgb), &encode::exif(6));
    let mut notes = Vec::new();
    let found = super::super::colour::read(&source("a.jpg", file.clone()), None, None, &mut notes).unwrap();
    // What is stored as the upper half lies on the right when it is turned by 90 degrees.
    assert_eq!((found.width, found.height), (32, 16));
    assert!(found.pixels[0][2] > 200 && found.pixels[31][0] > 200);
    says(&notes, "turned by 90 degrees");
    for (orientation, corner) in [(1, 0), (2, 2), (3, 5), (4, 3)] {
        let turned = super::super::orientation::Orientation::of(&encode::exif(orientation));
        let found = turned.map_or(0, |turned| {
            turned.upright(super::super::source::Size { width: 3, height: 2 }, &[0, 1, 2, 3, 4, 5]).1[0]
        });
        assert_eq!(found, corner, "orientation {orientation}");
    }
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 4, 3);
    encoder.set_color(ColorType::Rgba);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.write_header().unwrap().write_image_data(&[9; 48]).unwrap();
    let mut notes = Vec::new();
    super::super::colour::read(&source("a.png", png), None, None, &mut notes).unwrap();
    says(&notes, "gamma is 1.000");
    says(&notes, "12 pixels that are not opaque");
}

#[test]
fn instruments_in_the_picture_empty_the_cells_under_them() {
    let pinned = |x: usize, y: usize| x == 2 && y > 0;
    let hud = cells(|x, y| if pinned(x, y) { [250, 0, 250, 255] } else { [0; 4] }).concat();
    let drawn = cells(|x, y| if pinned(x, y) { [250, 4, 250] } else { colour(x, y) }).concat();
    let folder = Folder::new().with("f.flo", flo(uv)).with("hud.png", encode::png8(4, 3, ColorType::Rgba, &hud));
    let clean = folder.update(SPEED, FLOW, "overlay = { file = \"hud.png\" }").unwrap();
    assert_eq!((clean.census.known, clean.census.under_overlay), (12, None));
    folder.write("color.png", encode::png8(4, 3, ColorType::Rgb, &drawn));
    let capture = folder.update(SPEED, FLOW, "overlay = { file = \"hud.png\" }").unwrap();
    assert_eq!((capture.census.known, capture.census.under_overlay), (10, Some(2)));
    for (x, y) in SIZE.positions() {
        assert_eq!(empty(&capture, x, y), pinned(x, y));
    }
    says(&capture.census.notes, "drawn into the colour");
}

#[test]
fn motion_that_cannot_be_meant_is_noted() {
    let flat = |_: usize, _: usize| 2.0;
    let tiny = scene(32, 32, |_, _| [0.01, 0.02], flat).update(Z, FLOW, "").unwrap();
    says(&tiny.census.notes, "units = \"picture\"");
    let huge = scene(32, 32, |_, _| [500.0, 0.0], flat).update(Z, FLOW, "").unwrap();
    says(&huge.census.notes, "are clamped");
    let few = |x: usize, y: usize| if (x, y) == (5, 5) { [-9999.0, 0.0] } else { [1.0, 0.0] };
    let few = scene(32, 32, few, flat).update(Z, FLOW, "").unwrap();
    says(&few.census.notes, "key invalid");
    let fine = scene(32, 32, |_, _| [1.0, 0.0], flat).update(Z, FLOW, "").unwrap();
    assert_eq!(fine.census.notes, Vec::<String>::new());
}

#[test]
fn a_convention_that_meets_the_truth_is_named() {
    // All moves by (3, 1): the truth after two frames is the picture from there.
    let (w, h) = (32, 32);
    let folder = scene(w, h, |_, _| [3.0, 1.0], |_, _| 2.0);
    let update = folder.update(Z, FLOW, "").unwrap().update.picture();
    let at = |x: i32, y: i32| {
        let inside = (0..w as i32).contains(&x) && (0..h as i32).contains(&y);
        if inside { update.pixels[y as usize * w + x as usize] } else { [0; 3] }
    };
    let rgb: Vec<u8> = (0..h as i32).flat_map(|y| (0..w as i32).flat_map(move |x| at(x - 6, y - 2))).collect();
    folder.write("t.png", encode::png8(w as u32, h as u32, ColorType::Rgb, &rgb));
    let truth = "[[truth]]\nframe = 2\ncolor = \"t.png\"";
    let notes = |uv: [f32; 2]| {
        folder.write("f.flo", encode::pieh(w as i32, h as i32, &[uv; 32 * 32].concat()));
        folder.update(Z, FLOW, truth).unwrap().census.notes
    };
    assert_eq!(notes([3.0, 1.0]), Vec::<String>::new());
    for (written, named) in [
        ([-3.0, -1.0], "with sign = -1 it would be 100.0 dB"),
        ([3.0, -1.0], "with y = \"up\" it"),
        ([1.0, 3.0], "with x and y exchanged it"),
        ([3.0 / 32.0, 1.0 / 32.0], "units = \"picture\""),
        ([3.0 / 16.0, 1.0 / 16.0], "units = \"ndc\""),
    ] {
        says(&notes(written), named);
    }
    says(&notes([-11.0, 7.0]), "may not belong to these pictures");
    let masked = format!("{truth}\nmask = \"m.png\"");
    folder.write("m.png", encode::png8(w as u32, h as u32, ColorType::Grayscale, &[0; 32 * 32]));
    says(&folder.update(Z, FLOW, &masked).unwrap().census.notes, "leaves nothing to compare");
}

#[test]
fn the_step_of_coarse_vectors_is_found_and_bounds_what_they_say() {
    let (step_x, step_y) = (0.94, 0.53);
    let smooth = |x: usize, y: usize| [4.0 + 0.31 * x as f64 + 0.07 * y as f64, -3.0 + 0.23 * y as f64];
    let stepped = |[x, y]: [f64; 2]| [(x / step_x).round() * step_x, (y / step_y).round() * step_y];
    let (w, h) = (40, 40);
    let coarse = |x: usize, y: usize| stepped(smooth(x, y)).map(|v| v as f32);
    let folder = scene(w, h, coarse, |_, _| 2.0);
    let capture = folder.update(Z, FLOW, "").unwrap();
    near(&[capture.census.motion_step_px.unwrap()], &[step_x], 1e-3);
    says(&capture.census.notes, "steps of 0.9400 px in x and 0.5300 px in y");
    // A second field of the same motion: what differs are steps, and no acceleration is made of them.
    let next: Vec<f32> = (0..h)
        .flat_map(|y| (0..w).flat_map(move |x| stepped(smooth(x, y).map(|v| v + 0.3)).map(|v| v as f32)))
        .collect();
    folder.write("next.flo", encode::pieh(w as i32, h as i32, &next));
    let key = "acceleration = { kind = \"next-flow\", file = \"next.flo\" }";
    let capture = folder.update(Z, FLOW, key).unwrap();
    let plain = folder.update(Z, FLOW, "").unwrap();
    for (with, without) in capture.update.samples.iter().zip(&plain.update.samples) {
        for (i, step) in [step_x, step_y].into_iter().enumerate() {
            if with.acceleration[i] == 0.0 {
                near(&[with.velocity[i]], &[without.velocity[i]], 1e-9);
            } else {
                assert!(with.acceleration[i].abs() > 1.99 * step);
            }
        }
    }
    says(&capture.census.notes, "that such steps can feign");
    // One far beyond the step is kept.
    let fast: Vec<f32> = (0..h)
        .flat_map(|y| (0..w).flat_map(move |x| stepped(smooth(x, y).map(|v| v + 8.0)).map(|v| v as f32)))
        .collect();
    folder.write("next.flo", encode::pieh(w as i32, h as i32, &fast));
    let capture = folder.update(Z, FLOW, key).unwrap();
    assert!(known(&capture, 2, 20).acceleration[0] > 4.0);
    // The key counts, whatever the numbers look like; without a step nothing is said.
    let keyed = folder.update(Z, "{ kind = \"flow\", file = \"f.flo\", step = 0 }", "").unwrap();
    assert_eq!(keyed.census.motion_step_px, None);
    let fine = scene(w, h, |x, y| smooth(x, y).map(|v| v as f32), |_, _| 2.0).update(Z, FLOW, "").unwrap();
    assert_eq!((fine.census.motion_step_px, fine.census.notes.len()), (None, 0));
    let keyed = scene(w, h, |x, y| smooth(x, y).map(|v| v as f32), |_, _| 2.0)
        .update(Z, "{ kind = \"flow\", file = \"f.flo\", step = 0.5 }", "")
        .unwrap();
    assert_eq!(keyed.census.motion_step_px, Some(0.5));
}

#[test]
fn motion_buffers_are_displacements_since_the_last_frame() {
    // NDC: 2 is the width, y up. Stored as (ndc - offset) / scale.
    let ndc = |x: usize, y: usize| [2.0 * uv(x, y)[0] / W as f64, -2.0 * uv(x, y)[1] / H as f64];
    let stored = |i: usize| cells(|x, y| ((ndc(x, y)[i] - 0.25) / 0.5) as f32);
    let value = |z: f64| 1.0 - 0.1 / z;
    let before = z(1, 1) + 0.5;
    let list = [
        ("R", stored(0)),
        ("G", stored(1)),
        (
            "B",
            cells(|x, y| {
                // The point of cell (1, 1) came nearer by half a unit.
                let moved = if (x, y) == (1, 1) { value(z(1, 1)) - value(before) } else { 0.0 };
                ((moved - 0.25) / 0.5) as f32
            }),
        ),
        ("A", vec![0.0; 12]),
    ];
    let folder = Folder::new()
        .with("m.exr", encode::exr(W, H, Precision::Float, &list))
        .with("z.npy", encode::npy_f4("(3, 4)", &cells(|x, y| value(z(x, y)) as f32)));
    let depth = "{ kind = \"buffer\", file = \"z.npy\", planes = [0.1, inf], intrinsics = [4, 4, 1.5, 1] }";
    let keys = "kind = \"space-warp\", file = \"m.exr\", scale = 0.5, offset = [0.25, 0.25, 0.25, 0.25], frames = 2";
    let capture = folder.update(depth, &format!("{{ {keys} }}"), "").unwrap();
    for (x, y) in SIZE.positions() {
        near(&known(&capture, x, y).velocity[..2], &uv(x, y).map(|v| v / 2.0), 1e-5);
    }
    // d' = near z' / z², near being half of the nearest distance, 1.
    near(&[known(&capture, 1, 1).velocity[2]], &[-0.25 / z(1, 1).powi(2)], 1e-3);
    let flat = folder.update(depth, &format!("{{ {keys}, flat = true }}"), "").unwrap();
    near(&[known(&flat, 1, 1).velocity[2]], &[0.0], 0.0);
    let skipped = folder.update(depth, &format!("{{ {keys}, skip = true }}"), "").unwrap();
    assert!(skipped.update.samples.iter().all(|s| s.known == Known::Motion && s.velocity == [0.0; 3]));
    says(&skipped.census.notes, "stands still");
    // The application's space has moved by 0.5 to the right: what stands in it has moved so, f / z pixels each.
    let keys = format!("{{ {keys}, pose_delta = [0.5, 0, 0, 0, 0, 0, 1] }}");
    let capture = folder.update(depth, &keys, "").unwrap();
    for (x, y) in SIZE.positions() {
        let wanted = [(uv(x, y)[0] + 4.0 * 0.5 / z(x, y)) / 2.0, uv(x, y)[1] / 2.0];
        near(&known(&capture, x, y).velocity[..2], &wanted, 1e-4);
    }
    folder.refused(
        &manifest(SPEED, "{ kind = \"flow\", file = \"f.flo\", skip = true }", ""),
        "capture.toml",
        "space-warp",
    );
}

#[test]
fn the_example_of_motion_buffers_is_right() {
    let script = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/space_warp.py");
    let folder = tempfile::tempdir().unwrap();
    match std::process::Command::new("python3").arg(&script).arg(folder.path()).status() {
        Ok(status) => assert!(status.success()),
        Err(_) => return eprintln!("skipped: there is no python3"),
    }
    let capture = super::super::load(folder.path(), &super::super::ImportOptions::default()).unwrap();
    assert_eq!(capture.census.notes, Vec::<String>::new());
    for truth in &capture.truths {
        assert_eq!(super::super::plausible::moved_db(&capture.update, truth), Some(100.0));
    }
}
