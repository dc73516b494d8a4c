//! The captures of the test data, of real cameras and renderers.

use std::path::{Path, PathBuf};

use super::super::camera::Track;
use super::super::exr_planes::Planes;
use super::super::raster::Canvas;
use super::super::source::{Size, Source};
use super::super::{Capture, ImportOptions, load};
use super::folder::near;
use crate::update::Known;

/// Returns the folder of the test data, if it is there.
pub fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: ../shared/data is absent");
    None
}

fn read(folder: &Path) -> Capture {
    load(folder, &ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Loads a manifest that stands in a temporary folder and names files by their full paths.
fn read_text(text: &str) -> Capture {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("capture.toml"), text).unwrap();
    read(folder.path())
}

/// Returns the capture in `folder` without its truths, its manifest changed from the first text of each pair to the
/// second.
fn changed(folder: &Path, changes: &[(&str, &str)]) -> Capture {
    let mut text = std::fs::read_to_string(folder.join("capture.toml")).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from} is not in the manifest");
        text = text.replace(from, to);
    }
    // Only the update is of interest.
    let (update, _) = text.split_once("[[truth]]").unwrap();
    let absolute =
        |key: &str, text: &str| text.replace(&format!("{key} = \""), &format!("{key} = \"{}/", folder.display()));
    read_text(&absolute("color", &absolute("poses", &absolute("file", update))))
}

#[test]
fn all_twelve_captures_load() {
    let Some(data) = data() else { return };
    // Folder, size, truths, share of cells that are known in percent (from the description of the data where it says
    // so).
    let captures = [
        ("blender/ball", [256, 256], 32, 100.0),
        ("blender/pan", [256, 256], 32, 100.0),
        ("blender/pan_aa", [256, 256], 6, 100.0),
        ("icl_livingroom1", [640, 480], 6, 100.0),
        ("kitti_flow", [1242, 375], 1, 16.2),
        ("middlebury_flow/RubberWhale", [584, 388], 2, 98.4),
        ("middlebury_stereo/teddy", [450, 375], 1, 98.0),
        ("middlebury_stereo/tsukuba", [384, 288], 1, 79.3),
        ("middlebury_stereo/venus", [434, 383], 1, 100.0),
        ("sevenscenes", [640, 480], 3, 92.1),
        ("sintel_alley_1", [480, 270], 3, 100.0),
        ("tartanair_a", [640, 480], 5, 100.0),
    ];
    for (name, size, truths, percent) in captures {
        let capture = read(&data.join(name));
        assert_eq!(([capture.update.width, capture.update.height], capture.truths.len()), (size, truths), "{name}");
        let cells = size[0] * size[1];
        let census = &capture.census;
        assert_eq!(census.known + census.unknown_depth + census.unknown_motion, cells, "{name}: {census:?}");
        let known = capture.update.samples.iter().filter(|s| s.known == Known::Motion).count();
        assert_eq!(known, census.known, "{name}");
        let share = 100.0 * known as f64 / cells as f64;
        eprintln!("{name}: {share:.2} % known, {census:?}");
        assert!((share - percent).abs() <= 0.06, "{name}: {share} % are known, not {percent}");
        for truth in &capture.truths {
            assert_eq!([truth.picture.width, truth.picture.height], size);
        }
    }
}

#[test]
fn the_capture_of_this_repository_loads() {
    let capture = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/marbles"));
    assert_eq!((capture.name.as_str(), capture.frames, capture.truths.len()), ("marbles", 16, 8));
    assert_eq!(capture.census.known, capture.update.samples.len());
}

/// Returns the motion of Blender's pass as it stands in the file, before mixed vectors are replaced.
fn pass(file: &Path, size: Size) -> Vec<Track> {
    let source = Source::open(file).unwrap();
    let planes = Planes::read(&source).unwrap();
    let [x, y, z, w] = ["X", "Y", "Z", "W"].map(|n| {
        let canvas = &mut Canvas { size, notes: &mut Vec::new() };
        planes.bands(&[format!("ViewLayer.Vector.{n}")], canvas).unwrap().bands.swap_remove(0)
    });
    let track = |i: usize| Track {
        velocity: [(-z[i] - x[i]) / 2.0, (w[i] + y[i]) / 2.0, 0.0],
        acceleration: [x[i] - z[i], w[i] - y[i], 0.0],
    };
    (0..size.cells()).map(track).collect()
}

#[test]
fn blenders_vectors_agree_with_the_closed_form() {
    let Some(data) = data() else { return };
    for name in ["ball", "pan"] {
        let folder = data.join("blender").join(name);
        let truth = changed(&folder, &[]);
        let blender = changed(
            &folder,
            &[
                (
                    "kind = \"planes\", file = \"k0000_planes.exr\"",
                    "kind = \"blender-vector\", file = \"k0000_blender.exr\"",
                ),
                (
                    "file = \"k0000_planes.exr\", kind = \"z\", channel = \"Z\"",
                    "file = \"k0000_blender.exr\", kind = \"z\", channel = \"ViewLayer.Depth.Z\"",
                ),
            ],
        );
        let raw = pass(&folder.join("k0000_blender.exr"), Size { width: 256, height: 256 });
        let (mut worst, mut replaced, mut moved) = ([0.0_f64; 2], 0, 0.0_f64);
        for ((found, wanted), raw) in blender.update.samples.iter().zip(&truth.update.samples).zip(&raw) {
            assert!((found.depth - wanted.depth).abs() < 1e-5);
            let far = wanted.depth == 1.0;
            if !far && found.velocity[..2] != raw.velocity[..2] {
                replaced += 1;
                moved = (0..2).map(|i| (found.velocity[i] - wanted.velocity[i]).abs()).fold(moved, f64::max);
                continue;
            }
            for i in 0..2 {
                worst[0] = worst[0].max((found.velocity[i] - wanted.velocity[i]).abs());
                worst[1] = worst[1].max((found.acceleration[i] - wanted.acceleration[i]).abs());
            }
        }
        eprintln!(
            "{name}: at most {worst:?} px/frame(²) off, {replaced} replaced by at most {moved} px/frame, {:?}",
            blender.census.notes
        );
        assert!(worst[0] <= 0.01 && worst[1] <= 0.03, "{name}: {worst:?}");
        // Point sampled: hardly any vector may be taken for a mixed one.
        assert!(replaced * 100 <= 256 * 256, "{name}: {replaced} vectors are replaced");
    }
}

#[test]
fn the_same_path_in_three_layouts_moves_alike() {
    let Some(data) = data() else { return };
    let folder = data.join("icl_livingroom1");
    let log = changed(&folder, &[]);
    let poses = "poses = \"trajectory_refined.log\", format = \"log\", axes = \"opencv\"";
    let intrinsics = "intrinsics = [525.0, 525.0, 319.5, 239.5], ";
    let others = [
        changed(&folder, &[(poses, "poses = \"groundtruth.txt\", format = \"tum\"")]),
        changed(&folder, &[(poses, "poses = \"transforms.json\", format = \"transforms\"")]),
        changed(&folder, &[(poses, "poses = \"transforms.json\", format = \"transforms\""), (intrinsics, "")]),
    ];
    // The speeds that the description of the data gives.
    let mut speeds: Vec<f64> = log.update.samples.iter().map(|s| s.velocity[0].hypot(s.velocity[1])).collect();
    speeds.sort_by(f64::total_cmp);
    near(&[speeds[speeds.len() / 2], speeds[speeds.len() * 95 / 100]], &[5.0, 7.0], 0.06);
    for other in &others {
        for (a, b) in log.update.samples.iter().zip(&other.update.samples) {
            assert_eq!(a.known, b.known);
            near(&a.velocity[..2], &b.velocity[..2], 1e-3);
        }
    }
}

#[test]
fn blenders_ways_to_name_channels_are_understood() {
    let Some(data) = data() else { return };
    for name in ["naming_4.2.0", "naming_5.0.1", "naming_5.0.1_interleaved"] {
        let file = data.join(format!("blender/naming/{name}.exr"));
        let file = file.display();
        let capture = read_text(&format!(
            "frames = 1\n[update]\ncolor = {{ file = \"{file}\", channel = \"ViewLayer.Combined\" }}\n\
             depth = {{ kind = \"z\", file = \"{file}\", channel = \"ViewLayer.Depth.Z\", far = 1e9 }}\n\
             motion = {{ kind = \"blender-vector\", file = \"{file}\", channel = \"ViewLayer.Vector\" }}\n"
        ));
        eprintln!("{name}: {}x{}, {:?}", capture.update.width, capture.update.height, capture.census);
        assert_eq!(capture.census.known, capture.update.samples.len(), "{name}");
        // By the ends of the names as well, which leaves the view layer open.
        read_text(&format!(
            "frames = 1\n[update]\ncolor = \"{file}\"\n\
             depth = {{ kind = \"z\", file = \"{file}\", channel = \"Depth.Z\", far = 1e9 }}\n\
             motion = {{ kind = \"blender-vector\", file = \"{file}\" }}\n"
        ));
    }
}
