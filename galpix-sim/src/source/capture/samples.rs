//! Colour, distance and motion put together: depth becomes normalised, unknown cells become empty ones.

use super::Census;
use super::camera::{Distance, Track};
use super::manifest::Depth;
use crate::picture::Picture;
use crate::update::{DepthKind, Known, Margin, Sample, Update};

/// The nearest distance that can be stored is this part of the nearest that is seen: room to approach.
const ROOM: f64 = 0.5;

/// At most this part of the cells can be outliers, which lie this many times nearer than all the others.
const RARE: f64 = 0.005;
const OUTLIER: f64 = 8.0;

/// Of fewer cells none is an outlier.
const FEW: usize = 256;

/// How the depths of an update are normalised: their kind, and the distance or disparity that the nearest depth stands
/// for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit {
    kind: DepthKind,
    /// The distance of normalised depth 0; of disparities the disparity, without any depth the speed.
    pub nearest: f64,
}

impl Unit {
    /// Returns that of an update, whose range the nearest cell decides unless it is an outlier; the note then says how
    /// many are.
    pub fn of(
        depth: &Depth,
        distances: &Option<Vec<Distance>>,
        motion: &[Option<Track>],
        notes: &mut Vec<String>,
    ) -> Self {
        let known = |distances: &[Distance]| -> Vec<f64> {
            let at = |distance: &Distance| if let Distance::At(value) = distance { Some(*value) } else { None };
            distances.iter().filter_map(at).collect()
        };
        let (kind, nearness) = match distances {
            Some(distances) if depth.is_distance() => {
                (DepthKind::Z, known(distances).into_iter().map(f64::recip).collect())
            }
            Some(distances) => (DepthKind::Disparity, known(distances)),
            None => (DepthKind::Speed, motion.iter().flatten().map(speed).collect()),
        };
        let (nearest, beyond) = largest(nearness);
        if beyond > 0 {
            let what = match kind {
                DepthKind::Speed => "faster",
                DepthKind::Z | DepthKind::Disparity => "nearer",
            };
            notes.push(format!(
                "of all cells {beyond} are more than {OUTLIER} times {what} than the others: they count as nearest, and \
                 do not decide the depth range"
            ));
        }
        let nearest = if kind == DepthKind::Z { ROOM / nearest } else { nearest / ROOM };
        Self { kind, nearest }
    }
}

/// Returns the largest of some numbers, which decides a range, without outliers, and how many of these there are.
fn largest(mut numbers: Vec<f64>) -> (f64, usize) {
    let all = numbers.iter().copied().fold(0.0, f64::max);
    if numbers.len() < FEW {
        return (all, 0);
    }
    let place = numbers.len() - 1 - (numbers.len() as f64 * RARE).ceil() as usize;
    let (_, usual, rare) = numbers.select_nth_unstable_by(place, f64::total_cmp);
    let most = *usual * OUTLIER;
    if *usual > 0.0 && all > most {
        let beyond = rare.iter().filter(|&&number| number > most).count();
        let rest = rare.iter().copied().filter(|&number| number <= most).fold(*usual, f64::max);
        return (rest, beyond);
    }
    (all, 0)
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
            if unit > z { still(0.0) } else { [1.0 - unit / z, first * vz, first * az + second * vz * vz] }
        }
        (DepthKind::Disparity, Some(Distance::At(disparity))) => still((1.0 - disparity / unit).max(0.0)),
        (DepthKind::Speed, _) if unit > 0.0 => still((1.0 - speed(track) / unit).max(0.0)),
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
