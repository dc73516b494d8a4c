//! Colour, distance and motion put together: depth becomes normalised, unknown cells become empty ones.

use super::Census;
use super::camera::{Distance, Track};
use super::manifest::Depth;
use crate::picture::Picture;
use crate::update::{DepthKind, Known, Margin, Sample, Update};

/// The nearest distance that can be stored is this part of the nearest that is seen: room to approach.
const ROOM: f64 = 0.5;

/// How the depths of an update are normalised: their kind, and the distance or disparity that the nearest depth stands
/// for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    kind: DepthKind,
    /// The distance of normalised depth 0; of disparities the disparity, without any depth the speed.
    pub nearest: f64,
}

impl Unit {
    /// Returns that of an update.
    pub fn of(depth: &Depth, distances: &Option<Vec<Distance>>, motion: &[Option<Track>]) -> Self {
        let (kind, nearest) = match (depth, distances) {
            (Depth::Z(_), Some(distances)) => (DepthKind::Z, ROOM * extreme(distances, f64::INFINITY, f64::min)),
            (Depth::Disparity(_), Some(distances)) => (DepthKind::Disparity, extreme(distances, 0.0, f64::max) / ROOM),
            _ => (DepthKind::Speed, motion.iter().flatten().map(speed).fold(0.0, f64::max) / ROOM),
        };
        Self { kind, nearest }
    }
}

/// Makes the update. All inputs have the picture's size.
pub(super) fn assemble(
    unit: Unit,
    picture: &Picture,
    distances: &Option<Vec<Distance>>,
    motion: &[Option<Track>],
    census: &mut Census,
) -> Update {
    let Unit { kind: depth_kind, nearest: unit } = unit;
    let distance = |cell: usize| distances.as_ref().map(|distances| distances[cell]);
    let samples = picture.pixels.iter().zip(motion).enumerate().map(|(cell, (&colour, &track))| {
        let distance = distance(cell);
        if distance == Some(Distance::Far) {
            census.far += 1;
        }
        let known = match (distance, track) {
            (Some(Distance::Unknown), _) => {
                census.unknown_depth += 1;
                None
            }
            (_, None) => {
                census.unknown_motion += 1;
                None
            }
            (_, Some(track)) => {
                let sample = sample(colour, depth_kind, distance, unit, &track);
                if is_finite(&sample) {
                    census.known += 1;
                    Some(sample)
                } else {
                    census.unknown_motion += 1;
                    None
                }
            }
        };
        known.unwrap_or(Sample { colour, known: Known::ColourOnly, ..Sample::default() })
    });
    let samples = samples.collect();
    Update {
        width: picture.width,
        height: picture.height,
        margin: Margin::default(),
        samples,
        depth_kind,
        overlay: None,
    }
}

fn extreme(distances: &[Distance], start: f64, pick: fn(f64, f64) -> f64) -> f64 {
    let known = distances.iter().filter_map(|distance| match distance {
        Distance::At(distance) => Some(*distance),
        _ => None,
    });
    known.fold(start, pick)
}

fn speed(track: &Track) -> f64 {
    track.velocity[0].hypot(track.velocity[1])
}

/// At absurd distances the inverse square of one leaves the range of numbers.
fn is_finite(sample: &Sample) -> bool {
    let mut all = sample.velocity.iter().chain(&sample.acceleration).chain([&sample.depth]);
    all.all(|value| value.is_finite())
}

fn sample(colour: [u8; 3], kind: DepthKind, distance: Option<Distance>, unit: f64, track: &Track) -> Sample {
    let [vx, vy, vz] = track.velocity;
    let [ax, ay, az] = track.acceleration;
    let still = |depth: f64| [depth, 0.0, 0.0];
    let [depth, depth_velocity, depth_acceleration] = match (kind, distance) {
        (DepthKind::Z, Some(Distance::At(z))) => {
            // d = 1 - near / z, and its derivatives by the chain rule.
            let [first, second] = [unit / (z * z), -2.0 * unit / (z * z * z)];
            [1.0 - unit / z, first * vz, first * az + second * vz * vz]
        }
        (DepthKind::Disparity, Some(Distance::At(disparity))) => still(1.0 - disparity / unit),
        (DepthKind::Speed, _) if unit > 0.0 => still(1.0 - speed(track) / unit),
        _ => still(1.0),
    };
    Sample {
        colour,
        known: Known::Motion,
        depth,
        velocity: [vx, vy, depth_velocity],
        acceleration: [ax, ay, depth_acceleration],
        luminosity_rate: 0.0,
        tag: 0,
    }
}
