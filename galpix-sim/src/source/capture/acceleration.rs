//! Accelerations of captures: chained from a second flow, left out, limited, or smoothed.

use super::camera::{Distance, Track};
use super::coarse::Steps;
use super::error::CaptureError;
use super::manifest::{Background, Vectors};
use super::raster::Canvas;
use super::source::Size;
use super::vectors::{self, Moved};
use super::{Census, Opened};

/// What becomes of a capture's accelerations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AccelerationPolicy {
    /// As the capture gives them.
    #[default]
    AsGiven,
    /// Left out: constant velocity.
    Off,
    /// Each component is limited so that over the capture's frames `a t² / 2` never exceeds `|v| t`. Second differences
    /// of noisy poses are then at worst a velocity too many.
    Clamp,
    /// The mean over the known cells around, 5x5, whose distance differs by at most 5 %.
    Smooth,
}

/// Chains a second flow: `p1 = x + f1(x)`, `p2 = p1 + f2(p1)` (bilinear), and the parabola through `x`, `p1`, `p2`.
/// Returns the steps of its displacements.
///
/// The first displacement spans the `n1` display frames of the manifest's motion, the second `n2 = next.frames`. Where
/// the second one is unknown, or `p1` is outside of the picture, the motion stays as it is and is counted. So it does,
/// uncounted, in cells that start empty, and in the background, whose motion does not come from the flow.
pub(super) fn chain(
    motion: &mut [Option<Track>],
    Opened { manifest, folder, size, distances }: Opened<'_>,
    next: &Vectors,
    census: &mut Census,
) -> Result<Steps, CaptureError> {
    let Moved { tracks, steps } = vectors::flow(next, folder, &mut Canvas { size, notes: &mut census.notes })?;
    let (n1, n2) = (f64::from(manifest.update.motion.frames()), f64::from(next.frames));
    let next: Vec<Option<[f64; 2]>> =
        tracks.into_iter().map(|track| track.map(|track| [track.velocity[0] * n2, track.velocity[1] * n2])).collect();
    let from_flow = |cell: usize| match distances.as_ref().map(|distances| distances[cell]) {
        Some(Distance::Unknown) => false,
        Some(Distance::Far) => manifest.update.background() == Background::Given,
        Some(Distance::At(_)) | None => true,
    };
    for (cell, ((x, y), track)) in size.positions().zip(motion).enumerate() {
        let Some(track) = track.as_mut().filter(|_| from_flow(cell)) else { continue };
        let first = [track.velocity[0] * n1, track.velocity[1] * n1];
        let Some(second) = bilinear(&next, size, x as f64 + first[0], y as f64 + first[1]) else {
            census.unknown_acceleration += 1;
            continue;
        };
        for component in 0..2 {
            // f1 = v n1 + a n1² / 2 and f1 + f2 = v (n1 + n2) + a (n1 + n2)² / 2.
            let slope = first[component] / n1;
            let acceleration = 2.0 * (second[component] / n2 - slope) / (n1 + n2);
            track.acceleration[component] = acceleration;
            track.velocity[component] = slope - acceleration * n1 / 2.0;
        }
    }
    Ok(steps)
}

/// Leaves out accelerations that two displacements in steps cannot tell from none; returns how many cells lost theirs.
///
/// Each displacement is off by at most half a step, so that their difference is off by a whole one. An acceleration is
/// kept only where it is at least twice what that can feign: then its error is at most its true value, and using it is
/// never worse than the velocity alone, which is what the cell falls back to. `span`: the display frames of the first
/// displacement, over which the parabola has changed the velocity; 0 where it has not.
pub(super) fn leave_out_feigned(motion: &mut [Option<Track>], feigned: Steps, span: f64) -> usize {
    let mut left_out = 0;
    for track in motion.iter_mut().flatten() {
        let mut lost = false;
        for component in 0..2 {
            let acceleration = track.acceleration[component];
            if acceleration != 0.0 && acceleration.abs() < 2.0 * feigned.0[component] {
                track.velocity[component] += acceleration * span / 2.0;
                track.acceleration[component] = 0.0;
                lost = true;
            }
        }
        left_out += usize::from(lost);
    }
    left_out
}

/// The flow at a place between cells; `None` outside of the picture or next to an unknown cell.
fn bilinear(flow: &[Option<[f64; 2]>], size: Size, x: f64, y: f64) -> Option<[f64; 2]> {
    if !(x >= 0.0 && y >= 0.0 && x <= (size.width - 1) as f64 && y <= (size.height - 1) as f64) {
        return None;
    }
    let (left, top) = (x.floor() as usize, y.floor() as usize);
    // On a row or column exactly, the next one has no weight and need not be known.
    let (right, below) = (x.ceil() as usize, y.ceil() as usize);
    let (part_x, part_y) = (x - x.floor(), y - y.floor());
    let at = |x: usize, y: usize| flow.get(y * size.width + x).copied().flatten();
    let (a, b, c, d) = (at(left, top)?, at(right, top)?, at(left, below)?, at(right, below)?);
    Some([0, 1].map(|i| {
        let (upper, lower) = (a[i] + (b[i] - a[i]) * part_x, c[i] + (d[i] - c[i]) * part_x);
        upper + (lower - upper) * part_y
    }))
}

/// Removes all accelerations, for `acceleration = false`.
pub(super) fn leave_out(motion: &mut [Option<Track>]) {
    for track in motion.iter_mut().flatten() {
        track.acceleration = [0.0; 3];
    }
}

/// Applies the user's policy; `frames`: display frames of the capture.
pub(super) fn apply(
    policy: AccelerationPolicy,
    motion: &mut [Option<Track>],
    distances: &Option<Vec<Distance>>,
    size: Size,
    frames: u32,
) {
    match policy {
        AccelerationPolicy::AsGiven => {}
        AccelerationPolicy::Off => leave_out(motion),
        AccelerationPolicy::Clamp => {
            for track in motion.iter_mut().flatten() {
                for component in 0..3 {
                    let most = 2.0 * track.velocity[component].abs() / f64::from(frames);
                    track.acceleration[component] = track.acceleration[component].clamp(-most, most);
                }
            }
        }
        AccelerationPolicy::Smooth => smooth(motion, distances, size),
    }
}

fn smooth(motion: &mut [Option<Track>], distances: &Option<Vec<Distance>>, size: Size) {
    let given: Vec<Option<[f64; 3]>> = motion.iter().map(|track| track.map(|track| track.acceleration)).collect();
    let distance = |cell: usize| match distances.as_ref().map(|distances| distances[cell]) {
        Some(Distance::At(distance)) => distance,
        _ => 0.0,
    };
    for ((x, y), (cell, track)) in size.positions().zip(motion.iter_mut().enumerate()) {
        let Some(track) = track else { continue };
        let here = distance(cell);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for near_y in y.saturating_sub(2)..(y + 3).min(size.height) {
            for near_x in x.saturating_sub(2)..(x + 3).min(size.width) {
                let near = near_y * size.width + near_x;
                if let Some(acceleration) = given[near]
                    && (distance(near) - here).abs() <= 0.05 * here
                {
                    sum = [0, 1, 2].map(|i| sum[i] + acceleration[i]);
                    count += 1.0;
                }
            }
        }
        // The cell itself always counts.
        track.acceleration = sum.map(|sum| sum / count);
    }
}
