//! Whether what was loaded can be meant: cheap checks after reading, each a note that names the likely mistake.
//!
//! The first truth decides most: the update is warped to it as it was read, and as it would be under other conventions.
//! Where one of these is clearly better, the note names it.

use super::camera::{self, Distance, Track};
use super::manifest::{Axes, Camera, Depth, Motion, Quaternion, Transform};
use super::{Census, Opened, motion, poses};
use crate::metric;
use crate::picture::Picture;
use crate::update::{Known, Sample, Truth, Update};

/// A displacement below this, in pixels, shows nothing.
const NOTHING: f64 = 0.1;

/// The part of the cells that may be clamped before it is noted.
const CLAMPED: f64 = 0.05;

/// How much better, in dB, another convention must be to be named.
const BETTER: f64 = 3.0;

/// Checks an update, and adds what is noteworthy to the census.
///
/// *Errors:* (what, hint) where no cell is known.
pub(super) fn check(
    opened: Opened<'_>,
    update: &Update,
    truths: &[Truth],
    census: &mut Census,
) -> Result<(), (String, String)> {
    if census.known == 0 {
        let what = format!(
            "gives no cell with both depth and motion: {} cells are without depth, {} without motion",
            census.unknown_depth, census.unknown_motion
        );
        return Err((
            what,
            "correct the keys invalid, far, mask, scale and background, or export the maps again".into(),
        ));
    }
    census.notes.extend(speeds(opened, update, census.known));
    for truth in truths {
        if truth.mask.as_ref().is_some_and(|mask| !mask.contains(&true)) {
            census.notes.push(format!("the mask of the truth at frame {} leaves nothing to compare", truth.frame));
        }
    }
    let mut compared = truths.iter().filter(|truth| truth.mask.as_ref().is_none_or(|mask| mask.contains(&true)));
    let soon = compared.next().and_then(|truth| against(opened, update, truth, true));
    // What is off by little shows late.
    let late = || compared.next_back().and_then(|truth| against(opened, update, truth, false));
    census.notes.extend(soon.or_else(late));
    Ok(())
}

/// Returns remarks on motion that is too small or too large to be meant.
fn speeds(Opened { manifest, size, .. }: Opened<'_>, update: &Update, known: usize) -> Vec<String> {
    let mut notes = Vec::new();
    let moving = || update.samples.iter().filter(|sample| sample.known == Known::Motion);
    let frames = f64::from(manifest.update.motion.frames());
    let largest = moving().flat_map(|s| [s.velocity[0].abs(), s.velocity[1].abs()]).fold(0.0, f64::max) * frames;
    let skipped = matches!(&manifest.update.motion, Motion::SpaceWarp(buffer) if buffer.skip == Some(true));
    if largest < NOTHING && !skipped {
        let hint = match &manifest.update.motion {
            Motion::Camera(_) => "are the poses in the unit of the depth, and is pose the update's?",
            _ => {
                "is the file in parts of the picture or in NDC? Then add units = \"picture\" or units = \"ndc\" to the \
                 motion"
            }
        };
        notes.push(format!("no cell moves by a tenth of a pixel (at most {largest:.4} px in {frames} frames): {hint}"));
    }
    let fastest = motion::fastest(size);
    let beyond = |sample: &&Sample| {
        let over = |of: &[f64; 3], most: f64| of[..2].iter().any(|value| value.abs() > most);
        over(&sample.velocity, fastest) || over(&sample.acceleration, fastest / 4.0)
    };
    let clamped = moving().filter(beyond).count();
    if clamped as f64 > CLAMPED * known as f64 {
        notes.push(format!(
            "{clamped} of {known} cells move faster than a budget can hold ({fastest} px a frame, or {} px a frame²) and \
             are clamped: are units, scale, frames and poses right, and is every unknown cell marked as invalid?",
            fastest / 4.0
        ));
    } else {
        let whole = 2.0 * fastest;
        let gone = moving().filter(|s| s.velocity[..2].iter().any(|v| v.abs() > whole)).count();
        if gone > 0 {
            notes.push(format!(
                "{gone} cells move by more than the whole picture in a frame: if a number marks unknown motion, give it \
                 with the key invalid"
            ));
        }
    }
    notes
}

/// A way in which an update may have been meant.
struct Alternative {
    /// What to write into the manifest, or what is to be changed.
    key: &'static str,
    /// x and y of a velocity as meant, from those as read and the picture's size.
    meant: fn([f64; 2], [f64; 2]) -> [f64; 2],
    /// Whether a cell has the motion and depth of the row as far from the other end.
    flipped: bool,
    /// Whether the farther of two covers the nearer.
    reversed: bool,
}

impl Alternative {
    const fn moving(key: &'static str, meant: fn([f64; 2], [f64; 2]) -> [f64; 2]) -> Self {
        Self { key, meant, flipped: false, reversed: false }
    }
}

const AS_READ: Alternative = Alternative::moving("", |v, _| v);

const ALTERNATIVES: [Alternative; 9] = [
    Alternative::moving("sign = -1", |[x, y], _| [-x, -y]),
    Alternative::moving("y = \"up\"", |[x, y], _| [x, -y]),
    Alternative::moving("sign = -1 and y = \"up\"", |[x, y], _| [-x, y]),
    Alternative::moving("x and y exchanged", |[x, y], _| [y, x]),
    Alternative::moving("units = \"picture\"", |[x, y], [w, h]| [x * w, y * h]),
    Alternative::moving("units = \"ndc\"", |[x, y], [w, h]| [x * w / 2.0, y * h / 2.0]),
    Alternative::moving("units = \"ndc\" and y = \"up\"", |[x, y], [w, h]| [x * w / 2.0, -y * h / 2.0]),
    Alternative { key: "the rows of its maps in the other order (key rows)", flipped: true, ..AS_READ },
    Alternative { key: "near and far exchanged (sign, kind or planes of the depth)", reversed: true, ..AS_READ },
];

/// Compares the update, warped to a truth, with the same under other conventions and with the update shown unchanged.
/// Long after the update, when not `soon`, any motion may have become wrong: only a convention that is much better
/// counts then.
fn against(opened: Opened<'_>, update: &Update, truth: &Truth, soon: bool) -> Option<String> {
    let read = warped(update, &AS_READ, truth)?;
    let stands = stands_still(update, truth)?;
    let mut others: Vec<(String, f64)> = match &opened.manifest.update.motion {
        Motion::Camera(camera) => of_camera(opened, camera, update, truth),
        _ => Vec::new(),
    };
    let moving = ALTERNATIVES.iter().filter_map(|other| Some((other.key.to_owned(), warped(update, other, truth)?)));
    others.extend(moving);
    // Of equally good ones the first: what can be written into the manifest as it is named.
    let (key, other) = others.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    let is_worse = soon && read < stands - 0.1;
    let better = if soon { BETTER } else { 2.0 * BETTER };
    let names_one = other > read + better && other > stands + better;
    if !is_worse && !names_one {
        return None;
    }
    let named = if names_one {
        format!("with {key} it would be {other:.1} dB")
    } else {
        "the motion may not belong to these pictures".to_owned()
    };
    Some(format!(
        "at frame {} the moved cells are at {read:.1} dB, the update shown unchanged at {stands:.1} dB: {named}",
        truth.frame
    ))
}

/// Returns what a truth says of the update under other conventions of its camera and of its distances: key and dB.
fn of_camera(
    Opened { manifest, folder, size, distances }: Opened<'_>,
    camera: &Camera,
    update: &Update,
    truth: &Truth,
) -> Vec<(String, f64)> {
    let Some(distances) = distances else { return Vec::new() };
    let with = |transform: Option<Transform>, quaternion: Option<Quaternion>, axes: Option<Axes>| Camera {
        transform: transform.or(camera.transform),
        quaternion: quaternion.or(camera.quaternion),
        axes: axes.or(camera.axes),
        ..camera.clone()
    };
    let cameras = [
        ("transform = \"world-to-camera\"", with(Some(Transform::WorldToCamera), None, None)),
        ("transform = \"camera-to-world\"", with(Some(Transform::CameraToWorld), None, None)),
        ("quaternion = \"wxyz\"", with(None, Some(Quaternion::Wxyz), None)),
        ("quaternion = \"xyzw\"", with(None, Some(Quaternion::Xyzw), None)),
        ("axes = \"opengl\"", with(None, None, Some(Axes::Opengl))),
        ("axes = \"opencv\"", with(None, None, Some(Axes::Opencv))),
        ("axes = \"ned\"", with(None, None, Some(Axes::Ned))),
    ];
    let mut found = Vec::new();
    let mut judge = |key: &str, camera: &Camera, along: bool| {
        let Ok(path) = poses::read(camera, folder, size) else { return };
        let [fx, fy, cx, cy] = path.intrinsics;
        let planar = |((x, y), distance): ((usize, usize), &Distance)| match distance {
            Distance::At(r) if along => {
                let ray = [(x as f64 - cx) / fx, (y as f64 - cy) / fy];
                Distance::At(r / (ray[0] * ray[0] + ray[1] * ray[1] + 1.0).sqrt())
            }
            other => *other,
        };
        let distances: Vec<Distance> = size.positions().zip(distances).map(planar).collect();
        let mut meant = update.clone();
        for (sample, track) in meant.samples.iter_mut().zip(camera::tracks(&path, path.frames, size, &distances)) {
            match track {
                Some(Track { velocity, acceleration }) => {
                    (sample.velocity, sample.acceleration) = (velocity, acceleration);
                }
                None => sample.known = Known::ColourOnly,
            }
        }
        found.extend(warped(&meant, &AS_READ, truth).map(|db| (key.to_owned(), db)));
    };
    if matches!(manifest.update.depth, Depth::Z(_)) {
        judge("kind = \"ray\" of the depth", camera, true);
    }
    cameras.iter().for_each(|(key, camera)| judge(key, camera, false));
    found
}

/// Returns the PSNR of the whole picture at a truth: the update, forward warped if `moved`, and unchanged elsewhere.
pub(super) fn shown_db(update: &Update, truth: &Truth, moved: bool) -> Option<f64> {
    let still = update.samples.iter().map(|sample| Some(sample.colour));
    if !moved {
        return Some(psnr(update, still, truth)?.0);
    }
    let front = front(update, &AS_READ, truth).into_iter();
    Some(psnr(update, front.zip(still).map(|(seen, still)| seen.or(still)), truth)?.0)
}

/// Returns the PSNR of the update at a truth, over the cells that a forward warp reaches; nothing if there are few.
#[cfg(test)]
pub(super) fn moved_db(update: &Update, truth: &Truth) -> Option<f64> {
    warped(update, &AS_READ, truth)
}

/// Returns the PSNR over the cells that a forward warp of the update reaches; nothing if there are few.
fn warped(update: &Update, alternative: &Alternative, truth: &Truth) -> Option<f64> {
    /// At least this part of the picture must be reached.
    const LEAST: f64 = 0.02;
    let (db, count) = psnr(update, front(update, alternative, truth).into_iter(), truth)?;
    (count as f64 >= LEAST * (update.width * update.height) as f64).then_some(db)
}

/// Returns the colours that a forward warp of the update brings to a truth's cells; the nearest wins.
fn front(update: &Update, alternative: &Alternative, truth: &Truth) -> Vec<Option<[u8; 3]>> {
    let (width, height) = (update.width, update.height);
    let size = [width as f64, height as f64];
    let t = f64::from(truth.frame);
    let mut front: Vec<Option<(f64, [u8; 3])>> = vec![None; width * height];
    for y in 0..height {
        for x in 0..width {
            let row = if alternative.flipped { height - 1 - y } else { y };
            let sample = &update.samples[row * width + x];
            if sample.known != Known::Motion {
                continue;
            }
            let velocity = (alternative.meant)([sample.velocity[0], sample.velocity[1]], size);
            let bent = (alternative.meant)([sample.acceleration[0], sample.acceleration[1]], size);
            let place = [0, 1].map(|i| velocity[i] * t + bent[i] * t * t / 2.0);
            let (to_x, to_y) = ((x as f64 + place[0]).round(), (y as f64 + place[1]).round());
            if !(0.0..width as f64).contains(&to_x) || !(0.0..height as f64).contains(&to_y) {
                continue;
            }
            let cell = &mut front[to_y as usize * width + to_x as usize];
            let depth = if alternative.reversed { -sample.depth } else { sample.depth };
            if cell.is_none_or(|(nearest, _)| depth < nearest) {
                *cell = Some((depth, update.samples[y * width + x].colour));
            }
        }
    }
    front.into_iter().map(|cell| cell.map(|(_, colour)| colour)).collect()
}

fn stands_still(update: &Update, truth: &Truth) -> Option<f64> {
    let moving = |sample: &Sample| (sample.known == Known::Motion).then_some(sample.colour);
    Some(psnr(update, update.samples.iter().map(moving), truth)?.0)
}

/// Returns the PSNR of what is seen against a truth, where it counts and nothing is pinned, and how many pixels that
/// are.
fn psnr(update: &Update, seen: impl Iterator<Item = Option<[u8; 3]>>, truth: &Truth) -> Option<(f64, usize)> {
    let seen: Vec<Option<[u8; 3]>> = seen.collect();
    let is_free = |cell: usize| update.overlay.as_ref().is_none_or(|overlay| overlay.pixels[cell].is_none());
    let counts = |cell: usize| truth.mask.as_ref().is_none_or(|mask| mask[cell]) && is_free(cell);
    let counted: Vec<bool> = seen.iter().enumerate().map(|(cell, seen)| seen.is_some() && counts(cell)).collect();
    let pixels = seen.into_iter().map(Option::unwrap_or_default).collect();
    let shown = Picture { pixels, ..truth.picture };
    let count = counted.iter().filter(|&&counted| counted).count();
    Some((metric::psnr_db(&shown, &truth.picture, Some(&counted))?, count))
}
