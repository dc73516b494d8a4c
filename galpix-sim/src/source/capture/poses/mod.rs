//! Camera paths: Redwood `.log`, TUM, KITTI, EuRoC, COLMAP, `transforms.json`, TartanAir, and one matrix per file.
//!
//! Whatever a layout gives, here are camera-to-world transforms, the camera's axes x right, y down, z forward, in the
//! order of time where the file says it: by time stamps, by the numbers of frames, by the names of pictures.

mod colmap;
pub(super) mod text;
mod transforms;

use std::path::Path;

use super::error::CaptureError;
use super::folder::Folder;
use super::manifest::{Axes, Camera, PoseFormat, Quaternion, Transform};
use super::source::{Size, Source};

/// How far a matrix may be from a rotation, in the largest element of `R Rᵀ - 1`.
const ROTATION_TOLERANCE: f64 = 0.02;

/// A neighbour farther away in steps leaves a gap over which no parabola is believed.
const GAP: f64 = 2.5;

/// Steps that are whole but for so much are whole: time stamps are rounded.
const JITTER: f64 = 0.02;

/// A camera in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// From the camera's axes (x right, y down, z forward) to the world's.
    pub rotation: [[f64; 3]; 3],
    /// The camera's place in the world.
    pub centre: [f64; 3],
}

/// Another pose than the update's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Other {
    /// After the update.
    pub steps: f64,
    pub pose: Pose,
    /// As of [`Path3`].
    pub intrinsics: [f64; 4],
}

/// The camera around the update.
#[derive(Clone, Debug)]
pub(super) struct Path3 {
    /// At the update.
    pub now: Pose,
    /// One or two other poses, from which the motion is taken.
    pub others: Vec<Other>,
    /// The next poses after the update, and those before it, nearest first: at most two each.
    pub sides: [Vec<Other>; 2],
    /// `fx fy cx cy` in pixels, sample (i, j) at the integer point (i, j).
    pub intrinsics: [f64; 4],
    /// Display frames in a step.
    pub frames: f64,
    /// Notes for the user, about what was missing or was not used.
    pub notes: Vec<String>,
}

/// The poses of a file.
#[derive(Clone, Debug, Default)]
struct List {
    poses: Vec<Pose>,
    /// In any unit; as many as poses, or none.
    stamps: Vec<f64>,
    /// Of all poses, or none; for samples at the pixels' corners or centres as the format has them.
    intrinsics: Vec<[f64; 4]>,
    notes: Vec<String>,
}

impl Pose {
    /// The world's own axes.
    pub const HERE: Self = Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], centre: [0.0; 3] };

    /// Returns a movement that is given in axes x right, y up, z backward in those of this module.
    pub fn in_opengl_axes(self) -> Self {
        let turned = |pose: &Self| multiply(&multiply(&basis(Axes::Opengl), &pose.rotation), &basis(Axes::Opengl));
        let [x, y, z] = self.centre;
        Self { rotation: turned(&self), centre: [x, -y, -z] }
    }

    /// Returns the inverse: a world-to-camera transform as a pose, or the reverse.
    fn inverse(self) -> Self {
        let rotation: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| self.rotation[j][i]));
        let centre = std::array::from_fn(|i| -(0..3).map(|k| rotation[i][k] * self.centre[k]).sum::<f64>());
        Self { rotation, centre }
    }

    /// Returns this pose of a body, and then what is mounted on it.
    fn with(self, mounted: &Self) -> Self {
        let place = |i: usize| (0..3).map(|k| self.rotation[i][k] * mounted.centre[k]).sum::<f64>();
        Self {
            rotation: multiply(&self.rotation, &mounted.rotation),
            centre: std::array::from_fn(|i| self.centre[i] + place(i)),
        }
    }
}

impl Path3 {
    /// Returns the way between two poses.
    pub fn between(now: Pose, steps: f64, pose: Pose, intrinsics: [f64; 4]) -> Self {
        let others = vec![Other { steps, pose, intrinsics }];
        Self { now, others, sides: [Vec::new(), Vec::new()], intrinsics, frames: 1.0, notes: Vec::new() }
    }
}

/// Reads the poses around the update of a picture of `size`.
///
/// Wanted are the poses before and after. Where one of them is missing, the next two on the other side give the same
/// parabola one-sidedly; where there is only one other pose, the velocity is constant. Errors: no other pose at all.
pub(super) fn read(camera: &Camera, folder: Folder<'_>, size: Size) -> Result<Path3, CaptureError> {
    let file = folder.path(&camera.poses);
    let (list, at, steps) = if camera.format == PoseFormat::MatrixFiles {
        numbered_files(camera, folder)?
    } else {
        let mut list = one_file(camera, folder, size)?;
        in_order(&mut list, &file);
        let at = of_update(camera, &list, &file)?;
        let steps = steps(camera, &list, at, &file)?;
        (list, at, steps)
    };
    let axes = camera.axes.unwrap_or(match camera.format {
        PoseFormat::Transforms => Axes::Opengl,
        PoseFormat::Tartanair => Axes::Ned,
        _ => Axes::Opencv,
    });
    let inverted = camera.transform.unwrap_or(match camera.format {
        PoseFormat::Colmap => Transform::WorldToCamera,
        _ => Transform::CameraToWorld,
    });
    let mount = match &camera.mount {
        Some(matrix) => {
            let hint = "write a camera-to-body matrix, 16 numbers row by row";
            Some(from_matrix(matrix).map_err(|what| CaptureError::new(&file, format!("key mount: {what}"), hint))?)
        }
        None => None,
    };
    let native = |pose: &Pose| {
        let pose = if inverted == Transform::WorldToCamera { pose.inverse() } else { *pose };
        let pose = mount.as_ref().map_or(pose, |mount| pose.with(mount));
        Pose { rotation: multiply(&pose.rotation, &basis(axes)), ..pose }
    };
    let intrinsics = |index: usize| {
        intrinsics(camera, list.intrinsics.get(index).copied())
            .ok_or_else(|| CaptureError::new(&file, "holds no intrinsics", "add intrinsics = [fx, fy, cx, cy]"))
    };
    let mut sides = [Vec::new(), Vec::new()];
    for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
        for (index, steps) in neighbours(&steps, sign) {
            side.push(Other { steps, pose: native(&list.poses[index]), intrinsics: intrinsics(index)? });
        }
    }
    let mut notes = list.notes.clone();
    let (others, note) = choose(&sides);
    notes.extend(note);
    if others.is_empty() {
        let what = format!("has no pose next to pose {at}, so nothing is known of the motion");
        return Err(CaptureError::new(&file, what, "add the pose before or after the update"));
    }
    let frames = if camera.rate.is_some() { 1.0 } else { f64::from(camera.frames) };
    Ok(Path3 { now: native(&list.poses[at]), others, sides, intrinsics: intrinsics(at)?, frames, notes })
}

/// Reads the poses around the update from files with one matrix each.
fn numbered_files(camera: &Camera, folder: Folder<'_>) -> Result<(List, usize, Vec<f64>), CaptureError> {
    let file = folder.path(&camera.poses);
    let hint = "write the number of the update's file into the key pose";
    let pose = camera.pose.ok_or_else(|| CaptureError::new(&file, "are files without times", hint))?;
    let (mut list, mut steps, mut at) = (List::default(), Vec::new(), 0);
    for offset in -2..=2_i64 {
        let Ok(number) = u32::try_from(i64::from(pose) + offset) else { continue };
        let name = numbered(&camera.poses, number)
            .ok_or_else(|| CaptureError::new(&file, "has no {:06} for the frame's number", "write it into poses"))?;
        // Only the update's own pose must be there.
        if offset == 0 || folder.holds(&name) {
            at = if offset == 0 { list.poses.len() } else { at };
            list.poses.push(text::matrix_file(&folder.open(&name)?)?);
            steps.push(offset as f64);
        }
    }
    Ok((list, at, steps))
}

fn one_file(camera: &Camera, folder: Folder<'_>, size: Size) -> Result<List, CaptureError> {
    let source = folder.open(&camera.poses)?;
    let order = |usual: Quaternion| camera.quaternion.unwrap_or(usual);
    let mut list = match camera.format {
        PoseFormat::Log => text::log(&source)?,
        PoseFormat::Tum => text::lines(&source, 1, order(Quaternion::Xyzw))?,
        PoseFormat::Tartanair => text::lines(&source, 0, order(Quaternion::Xyzw))?,
        PoseFormat::Kitti => text::kitti(&source)?,
        PoseFormat::Euroc => text::euroc(&source, camera.mount.is_some(), order(Quaternion::Wxyz))?,
        PoseFormat::Colmap => colmap::read(&source, camera, folder, size)?,
        PoseFormat::Transforms | PoseFormat::MatrixFiles => {
            transforms::read(&source, size, camera.intrinsics.is_some())?
        }
    };
    if let Some(times) = &camera.times {
        let source = folder.open(times)?;
        let stamps = text::times(&source)?;
        if stamps.len() != list.poses.len() {
            let what = format!("holds {} times for {} poses", stamps.len(), list.poses.len());
            return Err(source.fault(what, "give one time a line for each pose"));
        }
        list.stamps = stamps;
    }
    Ok(list)
}

/// Sorts poses by their stamps; of several with one stamp the first is kept.
fn in_order(list: &mut List, file: &Path) {
    if list.stamps.len() != list.poses.len() || list.stamps.windows(2).all(|pair| pair[0] < pair[1]) {
        return;
    }
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let mut order: Vec<usize> = (0..list.poses.len()).collect();
    order.sort_by(|&a, &b| list.stamps[a].total_cmp(&list.stamps[b]));
    let count = order.len();
    let different = 1 + order.windows(2).filter(|pair| list.stamps[pair[0]] != list.stamps[pair[1]]).count();
    if 2 * different <= count {
        list.notes
            .push(format!("{name} has times that do not tell its poses apart: they are taken as they stand there"));
        list.stamps.clear();
        return;
    }
    if order.windows(2).any(|pair| pair[0] > pair[1]) {
        list.notes.push(format!("{name} is not in the order of its times or names: its poses are sorted by them"));
    }
    order.dedup_by(|later, kept| list.stamps[*later] == list.stamps[*kept]);
    if order.len() < count {
        let dropped = count - order.len();
        list.notes.push(format!("{name} has {dropped} poses at the time of another one, which are left out"));
    }
    list.poses = order.iter().map(|&at| list.poses[at]).collect();
    list.stamps = order.iter().map(|&at| list.stamps[at]).collect();
    if list.intrinsics.len() == count {
        list.intrinsics = order.iter().map(|&at| list.intrinsics[at]).collect();
    }
}

/// Returns the update's place among the poses.
fn of_update(camera: &Camera, list: &List, file: &Path) -> Result<usize, CaptureError> {
    let count = list.poses.len();
    if let Some(time) = camera.time {
        let off = |at: &usize| (list.stamps[*at] - time).abs();
        let nearest = (0..list.stamps.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
        let Some(nearest) = nearest else {
            return Err(CaptureError::new(file, "has no time stamps", "give pose instead of time, or the key times"));
        };
        let most = usual_gap(&list.stamps).unwrap_or(f64::INFINITY);
        if off(&nearest) > most {
            let what = format!("has no pose at the time {time}; the nearest is at {}", list.stamps[nearest]);
            return Err(CaptureError::new(file, what, "correct the key time"));
        }
        return Ok(nearest);
    }
    let pose = camera.pose.unwrap_or(0);
    match usize::try_from(pose) {
        Ok(pose) if pose < count => Ok(pose),
        _ => {
            let what = format!("holds {count} poses, pose {pose} is not among them (the first is 0)");
            Err(CaptureError::new(file, what, "correct the key pose"))
        }
    }
}

/// Returns how many steps after the update each pose is.
fn steps(camera: &Camera, list: &List, at: usize, file: &Path) -> Result<Vec<f64>, CaptureError> {
    if list.stamps.len() != list.poses.len() {
        if camera.rate.is_some() {
            let hint = "give the number of frames between two poses with the key frames, or the key times";
            return Err(CaptureError::new(file, "has no time stamps for the key rate", hint));
        }
        return Ok((0..list.poses.len()).map(|index| index as f64 - at as f64).collect());
    }
    let step = camera.rate.map(f64::recip).or_else(|| usual_gap(&list.stamps)).unwrap_or(1.0);
    let steps = |stamp: f64| {
        let steps = (stamp - list.stamps[at]) / step;
        if (steps - steps.round()).abs() <= JITTER { steps.round() } else { steps }
    };
    Ok(list.stamps.iter().map(|&stamp| steps(stamp)).collect())
}

/// Returns the median time between two neighbouring poses.
fn usual_gap(stamps: &[f64]) -> Option<f64> {
    let mut gaps: Vec<f64> = stamps.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 0.0).collect();
    gaps.sort_by(f64::total_cmp);
    // Of two in the middle the smaller one: a gap is more likely too large.
    gaps.get(gaps.len().saturating_sub(1) / 2).copied()
}

/// Returns the poses that are nearest to one and to two steps on one side: place and steps.
fn neighbours(steps: &[f64], side: f64) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> = Vec::new();
    for wanted in [1.0, 2.0] {
        let least = found.last().map_or(0.5, |(_, steps)| steps * side + 0.5);
        let off = |steps: f64| (steps * side - wanted).abs();
        let candidates = steps.iter().enumerate().filter(|(_, steps)| **steps * side >= least);
        if let Some((index, &steps)) = candidates.min_by(|a, b| off(*a.1).total_cmp(&off(*b.1))) {
            found.push((index, steps));
        }
    }
    found
}

/// Returns the poses that the motion is taken from, and a remark if they are not the two neighbours.
fn choose([after, before]: &[Vec<Other>; 2]) -> (Vec<Other>, Option<String>) {
    let gap = |side: &[Other]| side.first().map_or(f64::INFINITY, |other| other.steps.abs());
    let pair = |side: &[Other]| side.len() == 2 && side[1].steps.abs() <= 2.0 * GAP && gap(side) <= GAP;
    let away = |side: &str, other: &Other| {
        format!("the pose {side} the update is {:.3} steps away: poses are missing", other.steps.abs())
    };
    match (&after[..], &before[..]) {
        ([next, ..], [last, ..]) if gap(after) <= GAP && gap(before) <= GAP => {
            let far = |other: &Other| other.steps.abs() > 1.5;
            let note = if far(next) {
                Some(away("after", next))
            } else if far(last) {
                Some(away("before", last))
            } else {
                None
            };
            (vec![*next, *last], note)
        }
        (_, []) if after.len() == 2 => {
            let note = "the pose before the update is missing: motion from the two poses after it";
            (after.clone(), Some(note.to_owned()))
        }
        ([], _) if before.len() == 2 => {
            let note = "the pose after the update is missing: motion from the two poses before it";
            (before.clone(), Some(note.to_owned()))
        }
        (_, [last, ..]) if pair(after) => {
            (after.clone(), Some(format!("{}, motion from the two poses after it", away("before", last))))
        }
        ([next, ..], _) if pair(before) => {
            (before.clone(), Some(format!("{}, motion from the two poses before it", away("after", next))))
        }
        ([next, ..], [last, ..]) => {
            let note = format!("{}, {}", away("after", next), away("before", last));
            (vec![*next, *last], Some(note))
        }
        ([only], []) | ([], [only]) => {
            let note = "only one pose besides the update's is there: constant velocity";
            (vec![*only], Some(note.to_owned()))
        }
        _ => (Vec::new(), None),
    }
}

/// The intrinsics for samples at integer points: the manifest's, else the file's own.
///
/// `transforms.json` and COLMAP have pixel centres at +0.5. A manifest that gives that file's centre less one half has
/// already moved it.
fn intrinsics(camera: &Camera, own: Option<[f64; 4]>) -> Option<[f64; 4]> {
    let [fx, fy, cx, cy] = camera.intrinsics.or(own)?;
    let by_corner = matches!(camera.format, PoseFormat::Transforms | PoseFormat::Colmap);
    let moved = own.is_some_and(|[_, _, ox, oy]| cx == ox - 0.5 && cy == oy - 0.5);
    let usual = if by_corner && !moved { 0.5 } else { 0.0 };
    let centre = camera.pixel_centre.unwrap_or(usual);
    Some([fx, fy, cx - centre, cy - centre])
}

/// Returns intrinsics that a file gives for pictures of one size for those of another, and a remark if they differ.
///
/// *Errors:* another shape.
fn scaled(
    source: &Source,
    [fx, fy, cx, cy]: [f64; 4],
    own: Option<[f64; 2]>,
    size: Size,
) -> Result<([f64; 4], Option<String>), CaptureError> {
    let [width, height] = [size.width as f64, size.height as f64];
    let Some([w, h]) = own.filter(|own| *own != [width, height]) else { return Ok(([fx, fy, cx, cy], None)) };
    if !(w > 0.0 && h > 0.0) || (w * height - h * width).abs() > 2.0 * width.max(height) {
        let what = format!("gives its intrinsics for {w}x{h}, but the update's colour is {width}x{height}");
        let hint = "add intrinsics = [fx, fy, cx, cy] for the colour's pixels";
        return Err(source.fault(what, hint));
    }
    let name = source.path.file_name().unwrap_or(source.path.as_os_str()).to_string_lossy();
    let note = format!("{name} gives its intrinsics for {w}x{h}: they are scaled to {width}x{height}");
    let [across, down] = [width / w, height / h];
    Ok(([fx * across, fy * down, cx * across, cy * down], Some(note)))
}

/// Returns names' places in the order that a person would give them: numbers in them by their size.
fn natural(name: &str) -> Vec<(String, u64)> {
    let mut parts = Vec::new();
    let mut rest = name;
    while !rest.is_empty() {
        let digits = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
        let (text, from) = rest.split_at(digits);
        let end = from.find(|c: char| !c.is_ascii_digit()).unwrap_or(from.len());
        let (number, after) = from.split_at(end);
        parts.push((text.to_owned(), number.parse().unwrap_or(0)));
        rest = after;
    }
    parts
}

/// Returns stamps for poses with names: the one number in which they differ, else their places in order.
fn stamps_of(names: &[String]) -> Vec<f64> {
    let parts: Vec<Vec<(String, u64)>> = names.iter().map(|name| natural(name)).collect();
    let Some(first) = parts.first() else { return Vec::new() };
    let alike =
        |a: &[(String, u64)], b: &[(String, u64)]| a.len() == b.len() && a.iter().zip(b).all(|((a, _), (b, _))| a == b);
    if parts.iter().all(|other| alike(first, other)) {
        let differing: Vec<usize> =
            (0..first.len()).filter(|&at| parts.iter().any(|other| other[at].1 != first[at].1)).collect();
        if let [only] = differing[..] {
            return parts.iter().map(|parts| parts[only].1 as f64).collect();
        }
    }
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by(|&a, &b| parts[a].cmp(&parts[b]));
    let mut stamps = vec![0.0; parts.len()];
    for (place, at) in order.into_iter().enumerate() {
        stamps[at] = place as f64;
    }
    stamps
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

/// Returns a pose from a place and a quaternion (x y z w) of any length above zero.
pub(super) fn from_quaternion(n: &[f64; 7]) -> Result<Pose, String> {
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
