//! The motion of a still scene in a moving camera.
//!
//! A pixel is lifted with its depth, `P = z ((x - cx) / fx, (y - cy) / fy, 1)`, and projected with the other poses.
//! Through its places at the update and at steps `s1`, `s2` runs the parabola `x + v s + a s²/2`; with the poses before
//! and after (`s = -1, 1`) that is `v = (p⁺ - p⁻) / 2`, `a = p⁺ - 2 p⁰ + p⁻`. The depth moves by the same rule.

use super::poses::{Other, Path3, Pose};
use super::source::Size;

/// Motion of one sample: x and y in pixels, z in the unit of the depth, per display frame (and frame²).
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Track {
    pub velocity: [f64; 3],
    pub acceleration: [f64; 3],
}

impl Track {
    /// Returns whether all six numbers are finite and of a size that a displacement can have (formats mark unknown by
    /// 1e9 and up).
    pub fn is_usable(&self) -> bool {
        self.velocity.iter().chain(&self.acceleration).all(|v| v.abs() < 1e9)
    }
}

/// What a point's distance is to a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Distance {
    /// Unknown, NaN, or out of range.
    Unknown,
    /// Infinitely far.
    Far,
    /// Planar depth or disparity, in the manifest's unit, finite.
    At(f64),
}

/// The view from the update's camera into another one: `p' = R p + t` in camera coordinates.
pub(super) struct View {
    steps: f64,
    rotation: [[f64; 3]; 3],
    shift: [f64; 3],
}

impl View {
    pub fn new(now: &Pose, steps: f64, other: &Pose) -> Self {
        // R' = R_otherᵀ R_now, t = R_otherᵀ (c_now - c_other).
        let transposed =
            |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| (0..3).map(|k| other.rotation[k][i] * v[k]).sum()) };
        let columns: [[f64; 3]; 3] = std::array::from_fn(|j| transposed(std::array::from_fn(|k| now.rotation[k][j])));
        let rotation = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
        let shift = transposed(std::array::from_fn(|k| now.centre[k] - other.centre[k]));
        Self { steps, rotation, shift }
    }

    /// `R p + weight t`.
    pub fn apply(&self, p: [f64; 3], weight: f64) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| self.rotation[i][k] * p[k]).sum::<f64>() + weight * self.shift[i])
    }
}

/// Returns the point that a pixel shows, in camera axes, and its weight: 1, or 0 for a direction, which is all that is
/// known of a far one. `None` where the depth is unknown.
fn point([x, y]: [f64; 2], distance: &Distance, [fx, fy, cx, cy]: [f64; 4]) -> Option<([f64; 3], f64)> {
    let ray = [(x - cx) / fx, (y - cy) / fy, 1.0];
    match *distance {
        Distance::Unknown => None,
        Distance::Far => Some((ray, 0.0)),
        Distance::At(z) => Some((ray.map(|v| v * z), 1.0)),
    }
}

/// Returns the motion of each sample, `None` where the depth is unknown or the point is behind one of the cameras.
///
/// `frames`: display frames between two poses. Far points are directions: they turn with the camera and do not
/// approach.
pub(super) fn tracks(path: &Path3, frames: f64, size: Size, distances: &[Distance]) -> Vec<Option<Track>> {
    let views: Vec<(View, [f64; 4])> = path.others.iter().map(|other| other.seen_from(&path.now)).collect();
    let track = |((x, y), distance): ((usize, usize), &Distance)| {
        let (x, y) = (x as f64, y as f64);
        let (point, weight) = point([x, y], distance, path.intrinsics)?;
        let moved = |(view, [fx, fy, cx, cy]): &(View, [f64; 4])| {
            let [px, py, pz] = view.apply(point, weight);
            (pz > 0.0).then(|| [cx + fx * px / pz - x, cy + fy * py / pz - y, weight * (pz - point[2])])
        };
        let first = views.first()?;
        let second = views.get(1);
        let (d1, d2) = (moved(first)?, second.map(moved));
        let mut track = Track::default();
        for (c, d1) in d1.into_iter().enumerate() {
            let slope = d1 / first.0.steps;
            let bend = match (d2, second) {
                (Some(d2), Some((second, _))) => 2.0 * (slope - d2?[c] / second.steps) / (first.0.steps - second.steps),
                _ => 0.0,
            };
            track.velocity[c] = (slope - bend * first.0.steps / 2.0) / frames;
            track.acceleration[c] = bend / frames.powi(2);
        }
        Some(track)
    };
    size.positions().zip(distances).map(track).collect()
}

impl Other {
    /// Returns the view into this camera from the update's, and its intrinsics.
    fn seen_from(&self, now: &Pose) -> (View, [f64; 4]) {
        (View::new(now, self.steps, &self.pose), self.intrinsics)
    }
}

/// Cells that are looked at for a cut, at most.
const LOOKED_AT: usize = 4096;

/// Leaves out a pose from which the picture would lie elsewhere while it hardly moves on the other side: a cut, or lost
/// tracking. Returns a remark if there was one.
pub(super) fn leave_out_a_cut(path: &mut Path3, size: Size, distances: &[Distance]) -> Option<String> {
    /// In a smaller picture any step may be half of it.
    const LEAST: usize = 32;
    if size.width.max(size.height) < LEAST {
        return None;
    }
    let side = size.width.max(size.height) as f64;
    let speeds = [0, 1].map(|at| path.sides[at].first().and_then(|other| speed(path, other, size, distances)));
    let (from, name, other) = match speeds {
        [Some(after), Some(before)] if before > side / 2.0 && after < side / 8.0 => (0, "before", "after"),
        [Some(after), Some(before)] if after > side / 2.0 && before < side / 8.0 => (1, "after", "before"),
        _ => return None,
    };
    let uses_both = path.others.len() == 2 && path.others[0].steps * path.others[1].steps < 0.0;
    let far = speed(path, path.sides[1 - from].first()?, size, distances)?;
    let rest = path.sides[from].iter().copied().filter(|other| other.steps.abs() <= 4.0);
    let rest: Vec<Other> =
        rest.filter(|other| speed(path, other, size, distances).is_some_and(|v| v < side / 4.0)).collect();
    if !uses_both || rest.is_empty() {
        return None;
    }
    path.others = rest;
    let count = if path.others.len() == 2 { "two poses" } else { "pose" };
    let away = if far.is_finite() { format!("{far:.0} px away") } else { "out of sight".to_owned() };
    Some(format!(
        "the pose {name} the update is elsewhere, most of the picture {away} a step, as after a cut or lost tracking: \
         motion from the {count} {other} it"
    ))
}

/// Returns the median of how far points move in a step from the update to another pose, in pixels; infinite where most
/// are behind the camera.
fn speed(path: &Path3, other: &Other, size: Size, distances: &[Distance]) -> Option<f64> {
    let every = distances.len().div_ceil(LOOKED_AT).max(1);
    let lone = Path3::between(path.now, other.steps, other.pose, path.intrinsics);
    let (view, [fx, fy, cx, cy]) = lone.others.first()?.seen_from(&path.now);
    let mut moved: Vec<f64> = size
        .positions()
        .zip(distances)
        .step_by(every)
        .filter_map(|((x, y), distance)| {
            let (x, y) = (x as f64, y as f64);
            let (point, weight) = point([x, y], distance, path.intrinsics)?;
            let [px, py, pz] = view.apply(point, weight);
            let off = (cx + fx * px / pz - x).hypot(cy + fy * py / pz - y) / other.steps.abs();
            Some(if pz > 0.0 { off } else { f64::INFINITY })
        })
        .collect();
    moved.sort_by(f64::total_cmp);
    moved.get(moved.len() / 2).copied()
}
