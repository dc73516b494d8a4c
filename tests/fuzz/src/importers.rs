//! The importers by the format of the file that is varied, and the captures that name it.

use std::io::Cursor;
use std::path::Path;

use galpix_sim::source::capture::{CaptureError, Files, ImportOptions, load_files};
use galpix_sim::study::ddoc::import::triangles;

use crate::seeds;

/// The name of the file that is varied.
const VARIED: &str = "varied";

/// The names of all importers.
pub const NAMES: [&str; 10] = ["manifest", "png", "jpeg", "exr", "npy", "npz", "pfm", "pieh", "poses", "obj"];

const COLOUR: &str = "\"c.png\"";
const SPEED: &str = "{ kind = \"speed\" }";
const Z: &str = "{ kind = \"z\", file = \"z.npy\" }";
const FLOW: &str = "{ kind = \"flow\", file = \"f.flo\" }";

/// What is varied, and where it is read.
pub struct Importer {
    name: &'static str,
    /// One capture for each place at which the file can stand; empty for objects, which are no captures.
    captures: Vec<Files>,
}

/// A manifest of its colour, depth, motion, and what follows.
fn manifest(colour: &str, depth: &str, motion: &str, more: &str) -> String {
    format!("frames = 4\n[update]\ncolor = {colour}\ndepth = {depth}\nmotion = {motion}\n{more}")
}

/// `{ kind, file = "varied", keys }`.
fn varied(kind: &str, keys: &str) -> String {
    format!("{{ kind = \"{kind}\", file = \"{VARIED}\"{keys} }}")
}

/// A map that is read as depth, as a flow, and as motion by disparity, from another size and from the bottom up too.
fn of_numbers() -> Vec<String> {
    let mut list = vec![
        manifest(COLOUR, &varied("z", ", far = 0.0"), FLOW, ""),
        manifest(COLOUR, &varied("z", ", resize = true, rows = \"bottom-up\", invalid = [0, -1]"), FLOW, ""),
        manifest(COLOUR, &varied("ray", ", intrinsics = [4, 4, 1.5, 1]"), FLOW, ""),
        manifest(COLOUR, &varied("buffer", ", planes = [0.1, 100.0]"), FLOW, ""),
        manifest(COLOUR, &varied("disparity", ", baseline = 0.5, intrinsics = [4, 4, 1.5, 1]"), FLOW, ""),
        manifest(COLOUR, SPEED, &varied("disparity", ", sign = -1"), ""),
        manifest(COLOUR, Z, &varied("flow", ""), ""),
        manifest(COLOUR, Z, &varied("flow", ", resize = true, y = \"up\", units = \"ndc\", frames = 3"), ""),
        manifest(COLOUR, Z, FLOW, &format!("acceleration = {}\n", varied("next-flow", ""))),
    ];
    list.push(manifest(
        COLOUR,
        &format!("{{ kind = \"z\", file = \"z.npy\", mask = \"{VARIED}\" }}"),
        &format!("{{ kind = \"flow\", file = \"f.flo\", mask = \"{VARIED}\" }}"),
        "",
    ));
    list
}

/// A picture: the update's, an overlay, the truth and its mask, and one of a hidden layer.
fn of_colours() -> Vec<String> {
    let file = format!("\"{VARIED}\"");
    let truth = |keys: &str| format!("[[truth]]\nframe = 2\n{keys}\n");
    let hidden = format!("hidden = {{ kind = \"layer\", color = {file}, depth = {Z}, motion = {FLOW} }}\n");
    vec![
        manifest(&file, SPEED, FLOW, ""),
        manifest(COLOUR, SPEED, FLOW, &format!("overlay = {{ file = {file} }}\n")),
        manifest(COLOUR, SPEED, FLOW, &truth(&format!("color = {file}"))),
        manifest(COLOUR, SPEED, FLOW, &truth(&format!("color = {COLOUR}\nmask = {file}"))),
        manifest(COLOUR, Z, FLOW, &hidden),
    ]
}

fn of_packed_numbers() -> Vec<String> {
    ["sintel-disparity", "kitti-disparity", "rgb24", "bgr24"]
        .map(|format| manifest(COLOUR, &varied("z", &format!(", format = \"{format}\"")), FLOW, ""))
        .into()
}

fn of_exr() -> Vec<String> {
    let mut list = vec![
        manifest(COLOUR, &varied("z", ", channel = \"Z\""), &varied("planes", ""), ""),
        manifest(COLOUR, SPEED, &varied("planes", ", channels = [\"X\", \"Y\"], resize = true"), ""),
        manifest(COLOUR, Z, &varied("blender-vector", ", channel = \"\""), "acceleration = true\n"),
        manifest(COLOUR, Z, &varied("space-warp", ""), ""),
        manifest(&format!("{{ file = \"{VARIED}\", channel = \"View.Combined\" }}"), SPEED, FLOW, ""),
    ];
    list.extend(of_numbers());
    list.extend(of_colours());
    list
}

/// A file of poses in each format, and what stands beside it.
fn of_poses() -> Vec<String> {
    let camera = |format: &str, keys: &str| {
        let intrinsics =
            if format == "colmap" || format == "transforms" { "" } else { "intrinsics = [4, 4, 1.5, 1], " };
        let motion =
            format!("{{ kind = \"camera\", poses = \"{VARIED}\", format = \"{format}\", {intrinsics}{keys} }}");
        manifest(COLOUR, Z, &motion, "")
    };
    let formats = ["log", "tum", "transforms", "tartanair", "kitti", "euroc", "colmap"];
    let mut list: Vec<String> = formats.iter().map(|format| camera(format, "pose = 1")).collect();
    list.push(camera("tum", "time = 0.2, rate = 10.0, quaternion = \"wxyz\", transform = \"world-to-camera\""));
    list.push(camera("kitti", "pose = 1, times = \"times.txt\", axes = \"opengl\""));
    list.push(manifest(
        COLOUR,
        Z,
        &format!(
            "{{ kind = \"camera\", poses = \"kitti.txt\", format = \"kitti\", intrinsics = [4, 4, 1.5, 1], pose = 1, \
             times = \"{VARIED}\" }}"
        ),
        "",
    ));
    list.push(camera("matrix-files", "pose = 1").replace(&format!("poses = \"{VARIED}\""), "poses = \"m000001\""));
    list
}

impl Importer {
    /// Returns the importer of this name.
    pub fn named(name: &str) -> Option<Self> {
        let name = *NAMES.iter().find(|known| **known == name)?;
        let mut manifests = match name {
            "png" => [of_colours(), of_numbers(), of_packed_numbers()].concat(),
            "jpeg" => of_colours(),
            "exr" => of_exr(),
            "npy" | "npz" | "pfm" | "pieh" => of_numbers(),
            "poses" => of_poses(),
            "manifest" => vec![String::new()],
            _ => Vec::new(),
        };
        if name == "npz" {
            manifests[0] = manifest(COLOUR, &varied("z", ", channel = \"a\""), FLOW, "");
        }
        let with = |manifest: String| {
            let mut files = seeds::beside();
            files.insert("capture.toml".to_owned(), manifest.into_bytes());
            files
        };
        Some(Self { name, captures: manifests.into_iter().map(with).collect() })
    }

    /// Reads a case. A refusal must be one sentence.
    pub fn read(&self, case: &[u8]) {
        if self.name == "obj" {
            if let Err(error) = triangles(Path::new("varied.obj"), &mut Cursor::new(case)) {
                check(&error.to_string());
            }
            return;
        }
        let Some((&first, file)) = case.split_first() else { return };
        let mut files = self.captures[usize::from(first) % self.captures.len()].clone();
        let varied = match self.name {
            "manifest" => "capture.toml",
            "poses" if files["capture.toml"].windows(7).any(|word| word == b"m000001") => "m000001",
            _ => VARIED,
        };
        files.insert(varied.to_owned(), file.to_vec());
        match load_files(&files, &ImportOptions::default()) {
            Ok(capture) => {
                let cells = capture.update.samples.len();
                assert!(capture.census.known <= cells, "more known than there are cells");
                capture.census.notes.iter().for_each(|note| check(note));
            }
            Err(error) => {
                let CaptureError { what, hint, .. } = &error;
                assert!(!what.is_empty() && !hint.is_empty());
                check(&error.to_string());
            }
        }
    }

    /// Returns cases to begin with: each file that is right, at each place.
    pub fn seeds(&self) -> Vec<Vec<u8>> {
        let files = seeds::of(self.name);
        if self.captures.is_empty() {
            return files;
        }
        let at = |place: usize| files.iter().map(move |file| [&[place as u8], &file[..]].concat());
        (0..self.captures.len()).flat_map(at).collect()
    }
}

/// Checks that a text from the importers is one line.
fn check(text: &str) {
    assert!(!text.contains('\n') && text.chars().count() < 4000, "no sentence: {text:?}");
}
