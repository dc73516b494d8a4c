//! Vectors of each pixel under the manifest's conventions: flows, EXR channels, Blender's pass, motion buffers.

use super::camera::{self, Distance, Track};
use super::coarse::{Field, Steps};
use super::error::CaptureError;
use super::exr_planes::{Planes, under};
use super::folder::Folder;
use super::manifest::{Depth, Map, OneOrEach, Units, Upward, Vectors};
use super::poses::{Path3, Pose};
use super::raster::{self, Canvas, Fitted, Flow, Layout};
use super::{Opened, poses};

/// The motion of each cell, and the steps in which its displacements come, in pixels per display frame.
pub(super) struct Moved {
    pub tracks: Vec<Option<Track>>,
    pub steps: Steps,
}

/// How raw numbers become pixels, per step of the manifest's frames.
pub(super) struct Convention {
    /// Of x and y, and of the depth.
    scale: [f64; 3],
    offset: [f64; 3],
    /// Signs of x and y, and of the depth, from where the vectors point to and where y grows.
    sign: [f64; 3],
    frames: f64,
}

impl Convention {
    /// Returns that of vectors which were stretched to a picture; `units` and `y` are those meant without the keys.
    pub fn new(vectors: &Vectors, units: Units, y: Upward, canvas: &Canvas<'_>, stretch: [f64; 2]) -> Self {
        let [width, height] = [canvas.size.width as f64, canvas.size.height as f64];
        let unit = match vectors.units.unwrap_or(units) {
            Units::Pixels => stretch,
            Units::ColorPixels => [1.0; 2],
            Units::Picture => [width, height],
            Units::Ndc => [width / 2.0, height / 2.0],
        };
        let unit = [unit[0], unit[1], 1.0];
        let along = vectors.sign.unwrap_or(1.0);
        let down = if vectors.y.unwrap_or(y) == Upward::Up { -1.0 } else { 1.0 };
        let given = |value: &Option<OneOrEach>, usual: f64| -> [f64; 3] {
            std::array::from_fn(|i| value.as_ref().map_or(usual, |v| v.of(i, usual)))
        };
        let (scale, offset) = (given(&vectors.scale, 1.0), given(&vectors.offset, 0.0));
        Self {
            scale: std::array::from_fn(|i| scale[i] * unit[i]),
            offset: std::array::from_fn(|i| if i < 2 { offset[i] * unit[i] } else { 0.0 }),
            sign: [along, along * down, along],
            frames: f64::from(vectors.frames),
        }
    }

    /// Returns a velocity, per display frame.
    pub fn velocity(&self, component: usize, raw: f64) -> f64 {
        (raw * self.scale[component] + self.offset[component]) * self.sign[component] / self.frames
    }

    /// Returns an acceleration, per display frame². It does not turn with the direction in time.
    fn acceleration(&self, component: usize, raw: f64) -> f64 {
        let down = if component == 1 { self.sign[1] * self.sign[0] } else { 1.0 };
        raw * self.scale[component] * down / (self.frames * self.frames)
    }

    /// Returns steps of raw numbers in pixels per display frame.
    fn steps(&self, raw: Steps) -> Steps {
        Steps(std::array::from_fn(|i| raw.0[i] * self.scale[i].abs() / self.frames))
    }
}

/// Reads a displacement for each pixel from a file of two numbers.
pub(super) fn flow(vectors: &Vectors, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Moved, CaptureError> {
    let source = folder.open(&vectors.file)?;
    let Flow { vectors: raw, stretch } = raster::flow(&source, &layout(vectors), canvas)?;
    let mask = mask(vectors, folder, canvas)?;
    let convention = Convention::new(vectors, Units::Pixels, Upward::Down, canvas, stretch);
    let invalid = |raw: [f64; 2]| raw.iter().any(|&value| vectors.invalid.holds(value));
    let known = |(cell, raw): (usize, Option<[f64; 2]>)| {
        raw.filter(|&raw| !invalid(raw) && mask.as_ref().is_none_or(|mask| mask[cell]))
    };
    let raw: Vec<Option<[f64; 2]>> = raw.into_iter().enumerate().map(known).collect();
    let field = |i: usize| raw.iter().map(|raw| raw.map_or(f64::NAN, |raw| raw[i])).collect();
    let steps = steps(vectors, canvas, stretch, [0, 1].map(field));
    let track = |raw: Option<[f64; 2]>| {
        let raw = raw?;
        let velocity = [convention.velocity(0, raw[0]), convention.velocity(1, raw[1]), 0.0];
        Some(Track { velocity, ..Track::default() })
    };
    Ok(Moved { tracks: raw.into_iter().map(track).collect(), steps: convention.steps(steps) })
}

/// Returns `VX VY` and, where present, `VZ AX AY AZ`, or the channels that the manifest names, each per step of
/// `frames` display frames.
pub(super) fn planes(vectors: &Vectors, opened: Opened<'_>, canvas: &mut Canvas<'_>) -> Result<Moved, CaptureError> {
    let source = opened.folder.open(&vectors.file)?;
    let planes = Planes::read(&source)?;
    planes.note_losses(canvas);
    let prefix = vectors.channel.as_deref().unwrap_or("");
    let named = |name: &str| under(prefix, name);
    let names: Vec<String> = match &vectors.channels {
        Some(names) => names.iter().map(|name| named(name)).collect(),
        None if planes.has(&named("VX")) => {
            let further = ["VZ", "AX", "AY", "AZ"].map(named);
            let wanted = ["VX", "VY"].map(named).into_iter();
            wanted.chain(further.into_iter().map(|n| if planes.has(&n) { n } else { String::new() })).collect()
        }
        None => {
            let pair = raster::pair(&source, &planes, &layout(vectors))?;
            canvas.note(&source, &format!("moves by its channels {} and {}", pair[0], pair[1]));
            pair
        }
    };
    let given: Vec<String> = names.iter().filter(|name| !name.is_empty()).cloned().collect();
    let file = planes.bands(&given, canvas)?;
    let Fitted { bands, stretch } = raster::fitted(&source, file, &layout(vectors), canvas)?;
    let mut bands = bands.into_iter();
    let mut next = |at: usize| names.get(at).filter(|name| !name.is_empty()).and_then(|_| bands.next());
    let bands: [Option<Vec<f64>>; 6] = std::array::from_fn(&mut next);
    let mask = mask(vectors, opened.folder, canvas)?;
    let mut convention = Convention::new(vectors, Units::Pixels, Upward::Down, canvas, stretch);
    // The depth's own unit, in which its velocity is given.
    convention.scale[2] *= depth_scale(&opened.manifest.update.depth);
    let raw = |band: usize, cell: usize| bands[band].as_ref().map(|band| band[cell]);
    let is_known = |cell: usize| {
        let all = (0..2).filter_map(|band| raw(band, cell));
        mask.as_ref().is_none_or(|mask| mask[cell]) && all.into_iter().all(|raw| !vectors.invalid.holds(raw))
    };
    let track = |cell: usize| {
        let mut track = Track::default();
        for component in 0..3 {
            track.velocity[component] = raw(component, cell).map_or(0.0, |raw| convention.velocity(component, raw));
            track.acceleration[component] =
                raw(component + 3, cell).map_or(0.0, |raw| convention.acceleration(component, raw));
        }
        is_known(cell).then_some(track)
    };
    let steps = steps(vectors, canvas, stretch, [0, 1].map(|band| bands[band].clone().unwrap_or_default()));
    Ok(Moved { tracks: (0..canvas.size.cells()).map(track).collect(), steps: convention.steps(steps) })
}

/// Blender's vector pass: `X`, `Y` to the previous frame and `Z`, `W` to the next, y up; both give the acceleration.
///
/// With y down the displacement to the next frame is `(-Z, W)` and that from the previous one `(-X, Y)`. At the first
/// frame of an animation, and at the last, one of the pairs is zero everywhere: then the other is the velocity.
pub(super) fn blender(vectors: &Vectors, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Moved, CaptureError> {
    let source = folder.open(&vectors.file)?;
    let planes = Planes::read(&source)?;
    planes.note_losses(canvas);
    let prefix = vectors.channel.as_deref().unwrap_or("Vector");
    let names = ["X", "Y", "Z", "W"].map(|name| under(prefix, name));
    let file = planes.bands(&names, canvas)?;
    let Fitted { bands, stretch } = raster::fitted(&source, file, &layout(vectors), canvas)?;
    let [x, y, z, w] = &bands[..] else { return Err(source.damaged("a channel of its vectors is missing")) };
    let mask = mask(vectors, folder, canvas)?;
    let convention = Convention::new(vectors, Units::Pixels, Upward::Down, canvas, stretch);
    let is_zero = |a: &[f64], b: &[f64]| a.iter().chain(b).all(|&value| value == 0.0);
    let (before, after) = (!is_zero(x, y), !is_zero(z, w));
    match (before, after) {
        (false, true) => {
            let what = "holds no vector to the previous frame, as at the first one of an animation: constant velocity, \
                        from the vectors to the next frame";
            canvas.note(&source, what);
        }
        (true, false) => {
            let what = "holds no vector to the next frame, as at the last one of an animation: constant velocity, from \
                        the vectors to the previous frame";
            canvas.note(&source, what);
        }
        _ => {}
    }
    let track = |cell: usize| {
        let (last, next) = ([-x[cell], y[cell]], [-z[cell], w[cell]]);
        let mut track = Track::default();
        for i in 0..2 {
            let (velocity, acceleration) = match (before, after) {
                (false, _) => (next[i], 0.0),
                (true, false) => (last[i], 0.0),
                (true, true) => ((next[i] + last[i]) / 2.0, next[i] - last[i]),
            };
            track.velocity[i] = convention.velocity(i, velocity);
            track.acceleration[i] = convention.acceleration(i, acceleration);
        }
        let is_known = [x, y, z, w].iter().all(|band| !vectors.invalid.holds(band[cell]));
        (is_known && mask.as_ref().is_none_or(|mask| mask[cell])).then_some(track)
    };
    let [across, down] = if after { [z, w] } else { [x, y] };
    let steps = steps(vectors, canvas, stretch, [across.clone(), down.clone()]);
    Ok(Moved { tracks: (0..canvas.size.cells()).map(track).collect(), steps: convention.steps(steps) })
}

/// The motion buffer of `XR_FB_space_warp` and `XR_EXT_frame_synthesis`: in each pixel of a half-float picture the
/// movement of a surface point since the last frame of the application, in normalised device coordinates, `scale * raw
/// + offset`, y up; the third channel is that of the depth buffer's value. The next frame is taken to move on alike.
pub(super) fn space_warp(
    vectors: &Vectors,
    opened: Opened<'_>,
    canvas: &mut Canvas<'_>,
) -> Result<Moved, CaptureError> {
    let Opened { manifest, folder, distances, .. } = opened;
    let source = folder.open(&vectors.file)?;
    let cells = canvas.size.cells();
    if vectors.skip == Some(true) {
        canvas.note(&source, "is to be skipped: nothing is synthesised, the update stands still");
        return Ok(Moved { tracks: vec![Some(Track::default()); cells], steps: Steps::default() });
    }
    let planes = Planes::read(&source)?;
    planes.note_losses(canvas);
    let prefix = vectors.channel.as_deref().unwrap_or("");
    let names: Vec<String> = match &vectors.channels {
        Some(names) => names.iter().map(|name| under(prefix, name)).collect(),
        None => {
            let usual = ["R", "G", "B"].map(|name| under(prefix, name)).into_iter();
            usual.filter(|name| !name.ends_with('B') || planes.has(name)).collect()
        }
    };
    let file = planes.bands(&names, canvas)?;
    let Fitted { bands, stretch } = raster::fitted(&source, file, &layout(vectors), canvas)?;
    let mask = mask(vectors, folder, canvas)?;
    let convention = Convention::new(vectors, Units::Ndc, Upward::Up, canvas, stretch);
    let buffer = match &manifest.update.depth {
        Depth::Buffer(map) if vectors.flat != Some(true) => map.planes,
        _ => None,
    };
    let third = vectors.offset.as_ref().map_or(0.0, |offset| offset.of(2, 0.0));
    let depth = |cell: usize| {
        let ([at_0, at_1], Some(Distance::At(z))) = (buffer?, distances.as_ref().map(|d| d[cell])) else {
            return None;
        };
        // Back to the buffer's value, to that of the last frame, and to its distance.
        let value = (1.0 / z - 1.0 / at_0) / (1.0 / at_1 - 1.0 / at_0);
        let before = value - (bands.get(2)?[cell] * convention.scale[2] + third) * convention.sign[2];
        let inverse = (1.0 - before) / at_0 + before / at_1;
        (inverse > 0.0).then(|| (z - 1.0 / inverse) / convention.frames)
    };
    let known = |cell: usize| {
        let raw = [bands[0][cell], bands[1][cell]];
        let is = raw.iter().all(|&raw| raw.is_finite() && !vectors.invalid.holds(raw));
        is && mask.as_ref().is_none_or(|mask| mask[cell])
    };
    let track = |cell: usize| {
        let velocity = [
            convention.velocity(0, bands[0][cell]),
            convention.velocity(1, bands[1][cell]),
            depth(cell).unwrap_or(0.0),
        ];
        known(cell).then_some(Track { velocity, ..Track::default() })
    };
    let mut tracks: Vec<Option<Track>> = (0..cells).map(track).collect();
    if let Some(delta) = vectors.pose_delta {
        let moved = by_space(delta, vectors, opened, canvas)?;
        for (track, moved) in tracks.iter_mut().zip(moved) {
            if let (Some(track), Some(moved)) = (track, moved) {
                track.velocity = std::array::from_fn(|i| track.velocity[i] + moved.velocity[i]);
            }
        }
    }
    let steps = steps(vectors, canvas, stretch, [0, 1].map(|band| bands[band].clone()));
    Ok(Moved { tracks, steps: convention.steps(steps) })
}

/// Returns the motion of what stands still in an application's space that itself has moved since the last frame.
fn by_space(
    [x, y, z, qx, qy, qz, qw]: [f64; 7],
    vectors: &Vectors,
    Opened { manifest, folder, distances, .. }: Opened<'_>,
    canvas: &Canvas<'_>,
) -> Result<Vec<Option<Track>>, CaptureError> {
    let update = &manifest.update;
    let fault = |what: &str, hint: &str| CaptureError::new(&folder.path(&vectors.file), what, hint);
    let Some(distances) = distances else {
        return Err(fault("moves a space past cells of unknown depth", "give a depth map of kind \"buffer\""));
    };
    let intrinsics = match (update.depth.map().and_then(|map: &Map| map.intrinsics), update.viewer()) {
        (Some(intrinsics), _) => intrinsics,
        (None, Some(camera)) => poses::read(camera, folder, canvas.size)?.intrinsics,
        (None, None) => {
            let hint = "add intrinsics = [fx, fy, cx, cy] to the depth";
            return Err(fault("moves a space whose camera has no intrinsics", hint));
        }
    };
    let moved = poses::from_quaternion(&[x, y, z, qx, qy, qz, qw])
        .map_err(|what| fault(&what, "write pose_delta as [x, y, z, qx, qy, qz, qw]"))?;
    let path = Path3::between(Pose::HERE, -1.0, moved.in_opengl_axes(), intrinsics);
    Ok(camera::tracks(&path, f64::from(vectors.frames), canvas.size, distances))
}

fn layout(vectors: &Vectors) -> Layout<'_> {
    Layout {
        channel: vectors.channel.as_deref(),
        channels: vectors.channels.as_deref(),
        rows: vectors.rows,
        resize: vectors.resize,
        ..Layout::default()
    }
}

fn mask(vectors: &Vectors, folder: Folder<'_>, canvas: &mut Canvas<'_>) -> Result<Option<Vec<bool>>, CaptureError> {
    let Some(file) = &vectors.mask else { return Ok(None) };
    let layout = Layout { rows: vectors.rows, resize: vectors.resize, ..Layout::default() };
    raster::mask(&folder.open(file)?, &layout, canvas).map(Some)
}

/// Returns the steps of raw numbers: the manifest's, else those that are found.
fn steps(vectors: &Vectors, canvas: &Canvas<'_>, stretch: [f64; 2], raw: [Vec<f64>; 2]) -> Steps {
    let field = |numbers| Field { numbers, width: canvas.size.width, apart: stretch.map(|by| by.ceil() as usize) };
    vectors.step.map_or_else(|| Steps::found(raw.map(field)), |step| Steps([step; 2]))
}

/// Returns the unit in which velocities of the depth are given: the raw unit of the depth.
fn depth_scale(depth: &Depth) -> f64 {
    match depth {
        Depth::Z(map) | Depth::Disparity(map) => map.scale * map.sign,
        Depth::Ray(_) | Depth::Buffer(_) | Depth::Speed(_) => 0.0,
    }
}
