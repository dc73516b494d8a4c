//! The motion of a still scene in a moving camera.
//!
//! A pixel is lifted with its depth, `P = z ((x - cx) / fx, (y - cy) / fy, 1)`, and projected with the other poses.
//! Through its places at the update and at steps `s1`, `s2` runs the parabola `x + v s + a s²/2`; with the poses before
//! and after (`s = -1, 1`) that is `v = (p⁺ - p⁻) / 2`, `a = p⁺ - 2 p⁰ + p⁻`. The depth moves by the same rule.

use super::poses::{Path3, Pose};
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
        self.velocity.iter().chain(&self.acceleration).all(|v| v.abs() <= 1e9)
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

/// Returns the motion of each sample, `None` where the depth is unknown or the point is behind one of the cameras.
///
/// `frames`: display frames between two poses. Far points are directions: they turn with the camera and do not
/// approach.
pub(super) fn tracks(path: &Path3, frames: u32, size: Size, distances: &[Distance]) -> Vec<Option<Track>> {
    let views: Vec<View> = path.others.iter().map(|(steps, pose)| View::new(&path.now, *steps, pose)).collect();
    let [fx, fy, cx, cy] = path.intrinsics;
    let track = |((x, y), distance): ((usize, usize), &Distance)| {
        let (x, y) = (x as f64, y as f64);
        let ray = [(x - cx) / fx, (y - cy) / fy, 1.0];
        let (point, weight) = match *distance {
            Distance::Unknown => return None,
            Distance::Far => (ray, 0.0),
            Distance::At(z) => (ray.map(|v| v * z), 1.0),
        };
        let moved = |view: &View| {
            let [px, py, pz] = view.apply(point, weight);
            (pz > 0.0).then(|| [cx + fx * px / pz - x, cy + fy * py / pz - y, weight * (pz - point[2])])
        };
        let first = views.first()?;
        let second = views.get(1);
        let (d1, d2) = (moved(first)?, second.map(moved));
        let mut track = Track::default();
        for (c, d1) in d1.into_iter().enumerate() {
            let slope = d1 / first.steps;
            let bend = match (d2, second) {
                (Some(d2), Some(second)) => 2.0 * (slope - d2?[c] / second.steps) / (first.steps - second.steps),
                _ => 0.0,
            };
            track.velocity[c] = (slope - bend * first.steps / 2.0) / f64::from(frames);
            track.acceleration[c] = bend / f64::from(frames).powi(2);
        }
        Some(track)
    };
    size.positions().zip(distances).map(track).collect()
}
