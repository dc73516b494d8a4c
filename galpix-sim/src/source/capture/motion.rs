//! The motion of an update as the manifest describes it.

use std::path::Path;

use super::camera::{self, Distance, Track};
use super::error::CaptureError;
use super::exr_planes::{Planes, under};
use super::manifest::{Background, Camera, Depth, DisparityMotion, Flow, Motion, Passes};
use super::source::{Size, Source};
use super::{Census, Opened, mixed, poses, raster};

/// The motion of each cell, per display frame; `None` where it is unknown or the cell starts empty.
pub(super) fn read(
    Opened { manifest, folder, size, distances }: Opened<'_>,
    census: &mut Census,
) -> Result<Vec<Option<Track>>, CaptureError> {
    let update = &manifest.update;
    let mut tracks = match &update.motion {
        Motion::Disparity(motion) => disparity(motion, folder, size)?,
        Motion::Flow(flow) => displacements(flow, folder, size)?,
        Motion::Planes(passes) => planes(passes, folder, size, depth_scale(&update.depth))?,
        Motion::BlenderVector(passes) => {
            let mut tracks = blender_vector(passes, folder, size)?;
            let replaced = distances.as_ref().map_or(0, |distances| mixed::unmix(&mut tracks, distances, size));
            if replaced > 0 {
                census.notes.push(format!("{replaced} vectors at the borders of surfaces were mixed and are replaced"));
            }
            tracks
        }
        Motion::Camera(camera) => from_camera(camera, folder, size, distances, census)?,
    };
    let background = match update.background {
        Background::Given => None,
        Background::Empty => Some(vec![None; size.cells()]),
        Background::Still => Some(vec![Some(Track::default()); size.cells()]),
        Background::Camera => match (&update.motion, &update.camera) {
            (_, Some(camera)) | (Motion::Camera(camera), None) => {
                Some(from_camera(camera, folder, size, distances, census)?)
            }
            // The manifest was refused.
            _ => None,
        },
    };
    if let (Some(background), Some(distances)) = (background, distances) {
        for ((track, far), distance) in tracks.iter_mut().zip(background).zip(distances) {
            if *distance == Distance::Far {
                *track = far;
            }
        }
    }
    for track in &mut tracks {
        *track = track.filter(Track::is_usable);
    }
    Ok(tracks)
}

/// Returns the unit in which velocities of the depth are given: the raw unit of the depth.
fn depth_scale(depth: &Depth) -> f64 {
    match depth {
        Depth::Z(map) | Depth::Disparity(map) => map.scale,
        Depth::Speed(_) => 0.0,
    }
}

fn steady(velocity: [f64; 2]) -> Track {
    Track { velocity: [velocity[0], velocity[1], 0.0], ..Track::default() }
}

fn disparity(motion: &DisparityMotion, folder: &Path, size: Size) -> Result<Vec<Option<Track>>, CaptureError> {
    let source = Source::open(&folder.join(&motion.file))?;
    let numbers = raster::numbers(&source, motion.channel.as_deref(), motion.format, size)?;
    let along = motion.sign * motion.scale / f64::from(motion.frames);
    let track = |raw: f64| (!motion.invalid.holds(raw)).then(|| steady([raw * along, 0.0]));
    Ok(numbers.into_iter().map(track).collect())
}

fn displacements(flow: &Flow, folder: &Path, size: Size) -> Result<Vec<Option<Track>>, CaptureError> {
    let flows = raster::flow(&Source::open(&folder.join(&flow.file))?, size)?;
    let frames = f64::from(flow.frames);
    Ok(flows.into_iter().map(|flow| Some(steady(flow?.map(|component| component / frames)))).collect())
}

/// Returns `VX VY` and, where present, `VZ AX AY AZ`, each per step of `frames` display frames.
fn planes(passes: &Passes, folder: &Path, size: Size, depth_scale: f64) -> Result<Vec<Option<Track>>, CaptureError> {
    let source = Source::open(&folder.join(&passes.file))?;
    let planes = Planes::read(&source)?;
    let prefix = passes.channel.as_deref().unwrap_or("");
    let band = |name: &str, wanted: bool| {
        let name = under(prefix, name);
        if wanted || planes.has(&name) { planes.band(&name, size) } else { Ok(vec![0.0; size.cells()]) }
    };
    let velocity = [band("VX", true)?, band("VY", true)?, band("VZ", false)?];
    let acceleration = [band("AX", false)?, band("AY", false)?, band("AZ", false)?];
    let frames = f64::from(passes.frames);
    let unit = [1.0, 1.0, depth_scale];
    let track = |cell: usize| {
        let mut track = Track::default();
        for component in 0..3 {
            track.velocity[component] = velocity[component][cell] * unit[component] / frames;
            track.acceleration[component] = acceleration[component][cell] * unit[component] / (frames * frames);
        }
        Some(track)
    };
    Ok((0..size.cells()).map(track).collect())
}

/// Blender's vector pass: `X`, `Y` to the previous frame and `Z`, `W` to the next, y up; both give the acceleration.
///
/// With y down the displacement to the next frame is `(-Z, W)` and that from the previous one `(-X, Y)`.
fn blender_vector(passes: &Passes, folder: &Path, size: Size) -> Result<Vec<Option<Track>>, CaptureError> {
    let source = Source::open(&folder.join(&passes.file))?;
    let planes = Planes::read(&source)?;
    let prefix = passes.channel.as_deref().unwrap_or("Vector");
    let band = |name: &str| planes.band(&under(prefix, name), size);
    let (x, y, z, w) = (band("X")?, band("Y")?, band("Z")?, band("W")?);
    let frames = f64::from(passes.frames);
    let track = |cell: usize| {
        let (x, y, z, w) = (x[cell], y[cell], z[cell], w[cell]);
        let velocity = [(-z - x) / 2.0, (w + y) / 2.0, 0.0].map(|v| v / frames);
        let acceleration = [x - z, w - y, 0.0].map(|a| a / (frames * frames));
        Some(Track { velocity, acceleration })
    };
    Ok((0..size.cells()).map(track).collect())
}

fn from_camera(
    camera: &Camera,
    folder: &Path,
    size: Size,
    distances: &Option<Vec<Distance>>,
    census: &mut Census,
) -> Result<Vec<Option<Track>>, CaptureError> {
    let path = poses::read(camera, folder)?;
    // The background may come from the same path.
    census.notes.extend(path.note.clone().filter(|note| !census.notes.contains(note)));
    let Some(distances) = distances else {
        let hint = "give a depth map of kind \"z\", or another motion";
        return Err(CaptureError::new(&folder.join(&camera.poses), "moves a camera past cells of unknown depth", hint));
    };
    Ok(camera::tracks(&path, camera.frames, size, distances))
}
