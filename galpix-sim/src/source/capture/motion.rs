//! The motion of an update as the manifest describes it.

use super::camera::{self, Distance, Track};
use super::coarse::{Field, Steps};
use super::error::CaptureError;
use super::folder::Folder;
use super::manifest::{Background, Camera, DisparityMotion, Motion};
use super::raster::{self, Canvas, Layout};
use super::source::Size;
use super::vectors::{self, Moved};
use super::{Census, Opened, mixed, poses};

/// The motion of each cell, per display frame; `None` where it is unknown or the cell starts empty.
pub(super) fn read(opened: Opened<'_>, census: &mut Census) -> Result<Moved, CaptureError> {
    let Opened { manifest, folder, size, distances } = opened;
    let update = &manifest.update;
    let mut canvas = Canvas { size, notes: &mut census.notes };
    let mut moved = match &update.motion {
        Motion::Disparity(motion) => disparity(motion, folder, &mut canvas)?,
        Motion::Flow(flow) => vectors::flow(flow, folder, &mut canvas)?,
        Motion::Planes(planes) => vectors::planes(planes, opened, &mut canvas)?,
        Motion::SpaceWarp(buffer) => vectors::space_warp(buffer, opened, &mut canvas)?,
        Motion::BlenderVector(passes) => {
            let mut moved = vectors::blender(passes, folder, &mut canvas)?;
            let replaced = distances.as_ref().map_or(0, |distances| mixed::unmix(&mut moved.tracks, distances, size));
            if replaced > 0 {
                census.notes.push(format!("{replaced} vectors at the borders of surfaces were mixed and are replaced"));
            }
            moved
        }
        Motion::Camera(camera) => Moved { tracks: from_camera(camera, opened, census)?, steps: Steps::default() },
    };
    let background = match update.background() {
        Background::Given => None,
        Background::Empty => Some(vec![None; size.cells()]),
        Background::Still => Some(vec![Some(Track::default()); size.cells()]),
        Background::Camera => match (&update.motion, &update.camera) {
            // The camera has moved far cells already.
            (Motion::Camera(_), None) => None,
            (_, Some(camera)) => Some(from_camera(camera, opened, census)?),
            // The manifest was refused.
            _ => None,
        },
    };
    if let (Some(background), Some(distances)) = (background, distances) {
        for ((track, far), distance) in moved.tracks.iter_mut().zip(background).zip(distances) {
            if *distance == Distance::Far {
                *track = far;
            }
        }
    }
    for track in &mut moved.tracks {
        *track = track.filter(Track::is_usable);
    }
    Ok(moved)
}

fn disparity(motion: &DisparityMotion, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Moved, CaptureError> {
    let source = folder.open(&motion.file)?;
    let layout = Layout {
        channel: motion.channel.as_deref(),
        format: motion.format,
        rows: motion.rows,
        resize: motion.resize,
        ..Layout::default()
    };
    let raster::Fitted { mut bands, stretch } = raster::numbers(&source, &layout, canvas)?;
    let numbers = bands.swap_remove(0);
    let mask = match &motion.mask {
        Some(file) => {
            let layout = Layout { channel: None, format: Default::default(), ..layout };
            Some(raster::mask(&folder.open(file)?, &layout, canvas)?)
        }
        None => None,
    };
    let along = motion.sign * motion.scale * stretch[0] / f64::from(motion.frames);
    let known = |(cell, &raw): (usize, &f64)| {
        !motion.invalid.holds(raw) && mask.as_ref().is_none_or(|mask: &Vec<bool>| mask[cell])
    };
    let track = |at: (usize, &f64)| {
        let velocity = [at.1 * along, 0.0, 0.0];
        known(at).then_some(Track { velocity, ..Track::default() })
    };
    let raw = numbers.iter().enumerate().map(|at| if known(at) { *at.1 } else { f64::NAN }).collect();
    let apart = stretch.map(|by| by.ceil() as usize);
    let none = Field { numbers: Vec::new(), width: 1, apart };
    let Steps([step, _]) = Steps::found([Field { numbers: raw, width: canvas.size.width, apart }, none]);
    let tracks = numbers.iter().enumerate().map(track).collect();
    Ok(Moved { tracks, steps: Steps([step * along.abs(), 0.0]) })
}

fn from_camera(
    camera: &Camera,
    Opened { folder, size, distances, .. }: Opened<'_>,
    census: &mut Census,
) -> Result<Vec<Option<Track>>, CaptureError> {
    let mut path = poses::read(camera, folder, size)?;
    let Some(distances) = distances else {
        let hint = "give a depth map of kind \"z\", or another motion";
        return Err(CaptureError::new(&folder.path(&camera.poses), "moves a camera past cells of unknown depth", hint));
    };
    if let Some(note) = camera::leave_out_a_cut(&mut path, size, distances) {
        path.notes.push(note);
    }
    // The background may come from the same path.
    for note in &path.notes {
        if !census.notes.contains(note) {
            census.notes.push(note.clone());
        }
    }
    Ok(camera::tracks(&path, path.frames, size, distances))
}

/// Returns the size of the speed beyond which the default budget clamps, in pixels per display frame.
pub(super) fn fastest(size: Size) -> f64 {
    size.width.max(size.height).next_power_of_two() as f64 / 2.0
}
