//! The hidden samples of a capture: a second layer over the same pixels, or what pictures from other places show.

use super::camera::{Distance, View as Between};
use super::error::CaptureError;
use super::folder::Folder;
use super::manifest::{Acceleration, Camera, Hidden, Motion, View, Views};
use super::raster::Canvas;
use super::samples::{self, Unit};
use super::source::Size;
use super::{Census, ImportOptions, Opened, acceleration, colour, depth, motion, poses};
use crate::picture::Picture;
use crate::update::{Known, Update};

/// Depths of one surface differ from cell to cell by less than this part.
const SAME_SURFACE: f64 = 0.05;

/// Returns the hidden samples as an update over the same cells, whose depths are normalised as the first layer's are;
/// nothing if there are none in the manifest. What is no farther than the first layer is not hidden, and left out.
pub(super) fn read(
    opened: Opened<'_>,
    unit: Unit,
    options: &ImportOptions,
    census: &mut Census,
) -> Result<Option<Update>, CaptureError> {
    let Opened { manifest, folder, size, distances: first } = opened;
    let Some(hidden) = &manifest.update.hidden else { return Ok(None) };
    let mut own = Census::default();
    let update = &manifest.update;
    // All that is not about the second layer is as it is with the first.
    let mut behind = manifest.clone();
    let (picture, distances) = match hidden {
        Hidden::Layer(layer) => {
            let channel = layer.color.channel.as_deref().or(layer.channel.as_deref());
            let file = folder.open(&layer.color.file)?;
            let picture = colour::read(&file, channel, Some(size), &mut own.notes)?;
            behind.update.depth = layer.depth.clone();
            if let Some(motion) = &layer.motion {
                behind.update.motion = motion.clone();
            }
            let canvas = &mut Canvas { size, notes: &mut own.notes };
            (picture, depth::read(&layer.depth, update, folder, canvas)?)
        }
        Hidden::Views(views) => {
            let (picture, distances) = seen_from_elsewhere(opened, views, unit, &mut own.notes)?;
            (picture, Some(distances))
        }
    };
    let mut tracks = motion::read(Opened { manifest: &behind, distances: &distances, ..opened }, &mut own)?.tracks;
    if matches!(manifest.update.acceleration, Some(Acceleration::No)) {
        acceleration::leave_out(&mut tracks);
    }
    acceleration::apply(options.acceleration, &mut tracks, &distances, size, manifest.frames);
    let mut update = samples::assemble(unit, &picture, &distances, &tracks, &mut own);
    let is_behind = |first: Distance, second: Distance| match (first, second) {
        (Distance::At(first), Distance::At(second)) if behind.update.depth.is_distance() => second >= first,
        (Distance::At(first), Distance::At(second)) => second <= first,
        (Distance::Far, _) => false,
        (Distance::At(_) | Distance::Unknown, _) => true,
    };
    if let (Some(first), Some(second)) = (first, &distances) {
        for (sample, (first, second)) in update.samples.iter_mut().zip(first.iter().zip(second)) {
            if !is_behind(*first, *second) {
                sample.known = Known::ColourOnly;
            }
        }
    }
    census.hidden = Some(update.samples.iter().filter(|sample| sample.known == Known::Motion).count());
    own.notes.retain(|note| !census.notes.contains(note));
    census.notes.extend(own.notes.into_iter().map(|note| format!("behind the first layer: {note}")));
    Ok(Some(update))
}

/// What other pictures of the still scene see behind the first layer: in each cell the nearest surface that lies behind
/// by the separation.
///
/// Each pixel of a view is lifted with its depth and projected into the update's camera, and so are the places half way
/// between pixels of one surface, so that no cracks open where the view is coarser. A sample is put into the middle of
/// the cell that it falls into, at most half a pixel from its place.
fn seen_from_elsewhere(
    Opened { manifest, folder, size, distances: first }: Opened<'_>,
    views: &Views,
    unit: Unit,
    notes: &mut Vec<String>,
) -> Result<(Picture, Vec<Distance>), CaptureError> {
    let mut picture = Picture::filled(size.width, size.height, [0; 3]);
    let mut nearest = vec![Distance::Unknown; size.cells()];
    let mut off = vec![0.0; size.cells()];
    // A manifest with another motion was refused.
    let Motion::Camera(camera) = &manifest.update.motion else { return Ok((picture, nearest)) };
    let path = poses::read(camera, folder, size)?;
    let [fx, fy, cx, cy] = path.intrinsics;
    let normalised = |z: f64| 1.0 - unit.nearest / z;
    for view in &views.views {
        let (colours, distances) = read_view(view, folder, &mut Canvas { size, notes: &mut *notes })?;
        let camera = Camera { pose: Some(view.pose), time: None, ..camera.clone() };
        let other = poses::read(&camera, folder, size)?.now;
        let between = Between::new(&other, 0.0, &path.now);
        for (place, z, colour) in lattice(&colours, &distances, size) {
            let ray = [(place[0] - cx) / fx, (place[1] - cy) / fy, 1.0];
            let [px, py, pz] = between.apply(ray.map(|v| v * z), 1.0);
            let seen = [cx + fx * px / pz, cy + fy * py / pz];
            let [x, y] = seen.map(f64::round);
            let inside = pz > 0.0 && (0.0..size.width as f64).contains(&x) && (0.0..size.height as f64).contains(&y);
            if !inside {
                continue;
            }
            let cell = y as usize * size.width + x as usize;
            let hidden = match first.as_ref().map(|first| first[cell]) {
                Some(Distance::At(front)) => normalised(pz) >= normalised(front) + views.separation,
                Some(Distance::Unknown) => true,
                Some(Distance::Far) | None => false,
            };
            let distance = (seen[0] - x).hypot(seen[1] - y);
            let better = match nearest[cell] {
                // Of one surface what is nearer to the middle of the cell, of two the nearer surface.
                Distance::At(there) if (there - pz).abs() <= SAME_SURFACE * there.min(pz) => distance < off[cell],
                Distance::At(there) => pz < there,
                Distance::Far | Distance::Unknown => true,
            };
            if hidden && better {
                nearest[cell] = Distance::At(pz);
                off[cell] = distance;
                picture.pixels[cell] = colour;
            }
        }
    }
    Ok((picture, nearest))
}

fn read_view(
    view: &View,
    folder: Folder<'_>,
    canvas: &mut Canvas<'_>,
) -> Result<(Picture, Vec<Distance>), CaptureError> {
    let channel = view.color.channel.as_deref().or(view.channel.as_deref());
    let file = folder.open(&view.color.file)?;
    let colours = colour::read(&file, channel, Some(canvas.size), canvas.notes)?;
    Ok((colours, depth::planar(&view.depth, folder, canvas)?))
}

/// Returns the pixels of a view, and the places half way between those of one surface: place, distance, colour.
fn lattice(colours: &Picture, distances: &[Distance], size: Size) -> impl Iterator<Item = ([f64; 2], f64, [u8; 3])> {
    let corner = move |x: usize, y: usize| {
        let cell = y * size.width + x;
        match distances[cell] {
            Distance::At(z) => Some((z, colours.pixels[cell])),
            Distance::Far | Distance::Unknown => None,
        }
    };
    let mean = move |x: usize, y: usize, [right, below]: [usize; 2]| {
        if x + right >= size.width || y + below >= size.height {
            return None;
        }
        let corners = [corner(x, y)?, corner(x + right, y)?, corner(x, y + below)?, corner(x + right, y + below)?];
        let depths = corners.map(|(z, _)| z);
        let (near, far) = (depths.into_iter().fold(f64::INFINITY, f64::min), depths.into_iter().fold(0.0, f64::max));
        let colour = |channel: usize| {
            let sum: u32 = corners.iter().map(|(_, colour)| u32::from(colour[channel])).sum();
            ((sum + 2) / 4) as u8
        };
        let place = [x as f64 + right as f64 / 2.0, y as f64 + below as f64 / 2.0];
        let z = depths.iter().sum::<f64>() / 4.0;
        (far - near <= SAME_SURFACE * near).then(|| (place, z, [0, 1, 2].map(colour)))
    };
    let halves = [[0, 0], [1, 0], [0, 1], [1, 1]];
    size.positions().flat_map(move |(x, y)| halves.into_iter().filter_map(move |half| mean(x, y, half)))
}
