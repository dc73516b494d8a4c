//! Camera paths: Redwood `.log`, TUM, `transforms.json`, TartanAir, and one matrix per file.
//!
//! Every layout gives camera-to-world transforms; here the camera's axes become x right, y down, z forward.

use std::path::Path;

use serde_json::Value;

use super::error::CaptureError;
use super::manifest::{Axes, Camera, PoseFormat};
use super::source::Source;

/// How far a matrix may be from a rotation, in the largest element of `R Rᵀ - 1`.
const ROTATION_TOLERANCE: f64 = 0.02;

/// A camera in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// From the camera's axes (x right, y down, z forward) to the world's.
    pub rotation: [[f64; 3]; 3],
    /// The camera's place in the world.
    pub centre: [f64; 3],
}

/// The camera around the update.
#[derive(Clone, Debug)]
pub(super) struct Path3 {
    /// At the update.
    pub now: Pose,
    /// One or two other poses: (steps after the update, pose).
    pub others: Vec<(f64, Pose)>,
    /// `fx fy cx cy` in pixels, sample (i, j) at the integer point (i, j).
    pub intrinsics: [f64; 4],
    /// A note for the user, if a pose was missing.
    pub note: Option<String>,
}

/// Reads the poses around the update.
///
/// Wanted are the poses before and after. Where one of them is missing, the next two on the other side give the same
/// parabola one-sidedly; where there is only one other pose, the velocity is constant. Errors: no other pose at all.
pub(super) fn read(camera: &Camera, folder: &Path) -> Result<Path3, CaptureError> {
    let axes = camera.axes.unwrap_or(match camera.format {
        PoseFormat::Transforms => Axes::Opengl,
        PoseFormat::Tartanair => Axes::Ned,
        PoseFormat::Log | PoseFormat::Tum | PoseFormat::MatrixFiles => Axes::Opencv,
    });
    let mut own_intrinsics = None;
    let file = folder.join(&camera.poses);
    let mut nearby: Vec<(f64, Pose)> = Vec::new();
    let about;
    if camera.format == PoseFormat::MatrixFiles {
        about = format!("no file for pose {}", camera.pose);
        for offset in -2..=2_i64 {
            let Ok(number) = u32::try_from(i64::from(camera.pose) + offset) else { continue };
            let name = numbered(&camera.poses, number).ok_or_else(|| {
                CaptureError::new(&file, "has no {:06} for the frame's number", "write it into poses")
            })?;
            let path = folder.join(name);
            // Only the update's own pose must be there.
            if offset == 0 || path.exists() {
                let source = Source::open(&path)?;
                nearby.push((offset as f64, matrix_file(&source)?));
            }
        }
    } else {
        let source = Source::open(&file)?;
        let all = match camera.format {
            PoseFormat::Log => log(&source)?,
            PoseFormat::Tum => lines(&source, 1)?,
            PoseFormat::Tartanair => lines(&source, 0)?,
            PoseFormat::Transforms | PoseFormat::MatrixFiles => {
                let (poses, intrinsics) = transforms(&source)?;
                own_intrinsics = intrinsics;
                poses
            }
        };
        about = format!("holds {} poses, pose {} is not among them (the first is 0)", all.len(), camera.pose);
        for offset in -2..=2_i64 {
            let index = usize::try_from(i64::from(camera.pose) + offset).ok();
            if let Some(pose) = index.and_then(|index| all.get(index)) {
                nearby.push((offset as f64, *pose));
            }
        }
    }
    let native = |pose: &Pose| Pose { rotation: multiply(&pose.rotation, &basis(axes)), centre: pose.centre };
    let find = |offset: f64| nearby.iter().find(|(o, _)| *o == offset).map(|(o, pose)| (*o, native(pose)));
    let Some((_, now)) = find(0.0) else {
        return Err(CaptureError::new(&file, about, "correct the key pose"));
    };
    let (others, note) = choose(find);
    if others.is_empty() {
        let what = format!("has no pose next to pose {}, so nothing is known of the motion", camera.pose);
        return Err(CaptureError::new(&file, what, "add the pose before or after the update"));
    }
    let intrinsics = intrinsics(camera, own_intrinsics)
        .ok_or_else(|| CaptureError::new(&file, "holds no intrinsics", "add intrinsics = [fx, fy, cx, cy]"))?;
    Ok(Path3 { now, others, intrinsics, note: note.map(str::to_owned) })
}

/// Returns the poses that the motion is taken from, and a remark if they are not the two neighbours.
fn choose(find: impl Fn(f64) -> Option<(f64, Pose)>) -> (Vec<(f64, Pose)>, Option<&'static str>) {
    let two = |a: f64, b: f64| Some(vec![find(a)?, find(b)?]);
    if let Some(both) = two(1.0, -1.0) {
        return (both, None);
    }
    if let Some(after) = two(1.0, 2.0) {
        return (after, Some("the pose before the update is missing: motion from the two poses after it"));
    }
    if let Some(before) = two(-1.0, -2.0) {
        return (before, Some("the pose after the update is missing: motion from the two poses before it"));
    }
    let only = find(1.0).or_else(|| find(-1.0));
    (only.into_iter().collect(), Some("only one pose besides the update's is there: constant velocity"))
}

/// The intrinsics for samples at integer points: the manifest's, else the file's own.
///
/// `transforms.json` has pixel centres at +0.5. A manifest that gives that file's centre less one half has already
/// moved it.
fn intrinsics(camera: &Camera, own: Option<[f64; 4]>) -> Option<[f64; 4]> {
    let [fx, fy, cx, cy] = camera.intrinsics.or(own)?;
    let usual = if camera.format == PoseFormat::Transforms { 0.5 } else { 0.0 };
    let moved = own.is_some_and(|[_, _, ox, oy]| cx == ox - 0.5 && cy == oy - 0.5);
    let centre = camera.pixel_centre.unwrap_or(if moved { 0.0 } else { usual });
    Some([fx, fy, cx - centre, cy - centre])
}

/// Returns the camera's native axes in terms of x right, y down, z forward (columns are the images of those).
const fn basis(axes: Axes) -> [[f64; 3]; 3] {
    match axes {
        Axes::Opencv => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        Axes::Opengl => [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]],
        Axes::Ned => [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    }
}

/// The matrix product `a b`.
fn multiply(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Returns a pose from a 4x4 (or 3x4) camera-to-world matrix, row by row; errors describe what is wrong.
fn from_matrix(m: &[f64]) -> Result<Pose, String> {
    if m.len() != 12 && m.len() != 16 {
        return Err(format!("has {} numbers in a matrix, not 16", m.len()));
    }
    if m.iter().any(|v| !v.is_finite()) {
        return Err("has a pose that is not finite (lost tracking)".into());
    }
    if m.len() == 16 && (m[12..15] != [0.0; 3] || m[15] != 1.0) {
        return Err("has a matrix whose last row is not 0 0 0 1".into());
    }
    let rotation = std::array::from_fn(|i| std::array::from_fn(|j| m[4 * i + j]));
    check_rotation(&rotation)?;
    Ok(Pose { rotation, centre: [m[3], m[7], m[11]] })
}

/// Refuses a matrix that stretches, shears or mirrors.
fn check_rotation(r: &[[f64; 3]; 3]) -> Result<(), String> {
    let transposed = std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]));
    let product = multiply(r, &transposed);
    let off = |i: usize, j: usize| (product[i][j] - if i == j { 1.0 } else { 0.0 }).abs();
    let worst = (0..9).map(|n| off(n / 3, n % 3)).fold(0.0, f64::max);
    let determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1])
        - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
        + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    if worst <= ROTATION_TOLERANCE && determinant > 0.0 {
        Ok(())
    } else {
        Err("has a matrix that is not a rotation".into())
    }
}

/// A pose from a place and a quaternion (x y z w) of any length above zero.
fn from_quaternion(n: &[f64; 7]) -> Result<Pose, String> {
    let [tx, ty, tz, x, y, z, w] = *n;
    let length = (x * x + y * y + z * z + w * w).sqrt();
    if n.iter().any(|v| !v.is_finite()) || !length.is_finite() {
        return Err("has a pose that is not finite (lost tracking)".into());
    }
    if length < 1e-9 {
        return Err("has a quaternion of length zero".into());
    }
    let [x, y, z, w] = [x, y, z, w].map(|v| v / length);
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    Ok(Pose { rotation, centre: [tx, ty, tz] })
}

/// Returns the numbers of a line, or the word that is none.
fn numbers(line: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| word.parse().map_err(|_| format!("has \"{word}\" where a number belongs"));
    line.split_whitespace().map(number).collect()
}

/// Returns the lines that carry something, with their numbers counted from 1.
fn meaningful(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// Returns an error in a line of a file of poses.
fn in_line(source: &Source, line: usize, what: &str) -> CaptureError {
    source.fault(format!("line {line} {what}"), "correct or remove that pose")
}

/// TUM (`skipped` = 1, the time stamp) and TartanAir (0): `tx ty tz qx qy qz qw` in each line.
fn lines(source: &Source, skipped: usize) -> Result<Vec<Pose>, CaptureError> {
    let pose = |(number, line): (usize, &str)| {
        let read = || {
            let values = numbers(line)?;
            let place = values.get(skipped..).and_then(|rest| <&[f64; 7]>::try_from(rest).ok());
            from_quaternion(place.ok_or_else(|| format!("has {} numbers, not {}", values.len(), 7 + skipped))?)
        };
        read().map_err(|what: String| in_line(source, number, &what))
    };
    meaningful(source.text()?).map(pose).collect()
}

/// Redwood: blocks of a header of three integers and the four rows of a matrix.
fn log(source: &Source) -> Result<Vec<Pose>, CaptureError> {
    let all: Vec<(usize, &str)> = meaningful(source.text()?).collect();
    let pose = |block: &[(usize, &str)]| {
        let first = block.first().map_or(0, |(number, _)| *number);
        let read = || {
            if block.len() != 5 {
                return Err("begins a pose that is incomplete".to_owned());
            }
            if numbers(block[0].1)?.len() != 3 {
                return Err("is not a header of three integers".to_owned());
            }
            let mut matrix = Vec::with_capacity(16);
            for (_, line) in &block[1..] {
                matrix.extend(numbers(line)?);
            }
            from_matrix(&matrix)
        };
        read().map_err(|what| in_line(source, first, &what))
    };
    all.chunks(5).map(pose).collect()
}

/// Returns one matrix: 16 (or 12) numbers.
fn matrix_file(source: &Source) -> Result<Pose, CaptureError> {
    numbers(source.text()?)
        .and_then(|matrix| from_matrix(&matrix))
        .map_err(|what| source.fault(what, "give a 4x4 camera-to-world matrix, or choose another pose"))
}

/// Returns the poses of a `transforms.json` in the order of its list, and its intrinsics if it has all four.
fn transforms(source: &Source) -> Result<(Vec<Pose>, Option<[f64; 4]>), CaptureError> {
    let document: Value = serde_json::from_slice(&source.bytes).map_err(|e| source.damaged(e))?;
    let frames = document.get("frames").and_then(Value::as_array);
    let frames =
        frames.ok_or_else(|| source.fault("has no list \"frames\"", "give a transforms.json of nerfstudio"))?;
    let pose = |(index, frame): (usize, &Value)| {
        let rows = frame.get("transform_matrix").and_then(Value::as_array);
        let values = rows.map(|rows| {
            let cells = rows.iter().flat_map(|row| row.as_array().into_iter().flatten());
            cells.map(|v| v.as_f64().unwrap_or(f64::NAN)).collect::<Vec<f64>>()
        });
        values
            .ok_or_else(|| "has no transform_matrix".to_owned())
            .and_then(|matrix| from_matrix(&matrix))
            .map_err(|what| source.fault(format!("frame {index} {what}"), "correct or remove that frame"))
    };
    let poses = frames.iter().enumerate().map(pose).collect::<Result<_, _>>()?;
    let number = |key: &str| document.get(key).and_then(Value::as_f64).filter(|v| v.is_finite());
    let focal = |key: &str| number(key).filter(|&v| v > 0.0);
    let own = || Some([focal("fl_x")?, focal("fl_y").or_else(|| focal("fl_x"))?, number("cx")?, number("cy")?]);
    Ok((poses, own()))
}

/// Returns `pattern` with its one `{}` or `{:06}` replaced by `number`; `None` without such a place.
fn numbered(pattern: &str, number: u32) -> Option<String> {
    let (before, rest) = pattern.split_once('{')?;
    let (format, after) = rest.split_once('}')?;
    let digits = match format.strip_prefix(':') {
        Some(width) if width.len() <= 2 => width.trim_end_matches('d').parse().ok()?,
        None if format.is_empty() => 1_usize,
        _ => return None,
    };
    Some(format!("{before}{number:0digits$}{after}"))
}
