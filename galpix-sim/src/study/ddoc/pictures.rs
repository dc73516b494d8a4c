//! Pictures of a study: both reference images, the distortion map, and a pair of frames with what they lack in white.

use super::missing::{TOLERANCE, mask};
use super::reference::{self, Ddoc, Reference};
use super::view::View;
use super::warp::{Joint, warp};
use super::world::World;
use crate::output::film::magnified;
use crate::picture::Picture;
use crate::source::ddoc::raster::Raster;
use crate::study::ink;

/// Columns and rows of the magnified part of a frame.
const PART: usize = 44;

/// How much it is magnified.
const TIMES: usize = 6;

/// The pictures, with a name and a caption each.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// File name without its ending, caption, picture.
    pub all: Vec<(&'static str, &'static str, Picture)>,
}

impl Pictures {
    /// The pictures of a world; `references` are the plain image and the DDOC image.
    #[must_use]
    pub fn new(world: &World, view: &View, references: &[(&Reference, Joint); 2], ddoc: &Ddoc) -> Self {
        let truth = reference::plain(world, view).raster;
        let frames = references.map(|(reference, joint)| warp(reference, view, &joint));
        let masks = frames.each_ref().map(|frame| mask(&truth, frame, TOLERANCE));
        let [plain_frame, ddoc_frame] = [0, 1].map(|i: usize| whitened(&frames[i], &masks[i]));
        let (left, top) = most_missing(&masks[0], view.width, view.height);
        let part = |picture: &Picture| {
            let (width, height) = (PART.min(picture.width), PART.min(picture.height));
            magnified(&picture.crop(left, top, width, height), TIMES)
        };
        let parts = [&plain_frame, &ddoc_frame, &picture(&truth)].map(part);
        let [plain_part, ddoc_part, truth_part] = parts;
        let all = vec![
            ("plain", "depth image", picture(&references[0].0.raster)),
            ("ddoc", "DDOC image", picture(&references[1].0.raster)),
            ("map", "directions of the distortion", directions(ddoc)),
            ("frame-plain", "frame from the depth image, missing samples white", plain_frame),
            ("frame-ddoc", "frame from the DDOC image", ddoc_frame),
            ("frame-truth", "frame from geometry", picture(&truth)),
            ("part-plain", "depth image, magnified", plain_part),
            ("part-ddoc", "DDOC image, magnified", ddoc_part),
            ("part-truth", "geometry, magnified", truth_part),
        ];
        Self { all }
    }

    /// Returns the picture with this name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&Picture> {
        self.all.iter().find(|(own, _, _)| *own == name).map(|(_, _, picture)| picture)
    }
}

/// Returns the colours of a raster, of which they are the first three numbers.
#[must_use]
pub fn picture<const N: usize>(raster: &Raster<N>) -> Picture {
    let colour = |carried: &[f32; N]| [0, 1, 2].map(|i: usize| carried[i].round() as u8);
    Picture { width: raster.width, height: raster.height, pixels: raster.carried.iter().map(colour).collect() }
}

fn whitened(frame: &Raster<3>, missing: &[bool]) -> Picture {
    let mut picture = picture(frame);
    for (pixel, _) in picture.pixels.iter_mut().zip(missing).filter(|(_, missing)| **missing) {
        *pixel = [255; 3];
    }
    picture
}

/// Returns the direction of the distortion as a hue, as in figure 6; the lighter the smaller, and grey where there is
/// none.
fn directions(ddoc: &Ddoc) -> Picture {
    let Raster { width, height, .. } = ddoc.image.raster;
    let longest = ddoc.map.iter().map(|[x, y]| x.hypot(*y)).fold(1e-9, f64::max);
    let colour = |vector: &[f64; 2]| ink::direction(*vector, longest);
    Picture { width, height, pixels: ddoc.map.iter().map(colour).collect() }
}

/// Returns the corner of the part in which most is missing.
fn most_missing(missing: &[bool], width: usize, height: usize) -> (usize, usize) {
    let places = |size: usize| (0..=size.saturating_sub(PART)).step_by(4);
    let count = |&(left, top): &(usize, usize)| {
        let rows = top..height.min(top + PART);
        rows.map(|y| missing[y * width + left..y * width + width.min(left + PART)].iter().filter(|&&is| is).count())
            .sum()
    };
    let corners = places(height).flat_map(|top| places(width).map(move |left| (left, top)));
    corners.max_by_key(|corner| -> usize { count(corner) }).unwrap_or((0, 0))
}
