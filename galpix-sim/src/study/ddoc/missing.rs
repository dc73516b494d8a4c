//! What a frame lacks: samples of the truth that are not in it, over views around the reference eye (section 6).

use super::reference;
use super::view::{Place, View};
use super::warp::{Joint, warp};
use super::world::World;
use crate::source::ddoc::raster::Raster;
use crate::study::ddoc::reference::Reference;
use rayon::prelude::*;

/// Two samples are the same if their inverse distances differ by no more than this share.
const SAME: f32 = 0.03;

/// How far from its own pixel a sample of the truth may be in a frame, pixels: what is lost there is not the sample
/// but a part of an outline, which no image of samples has more exactly.
pub const TOLERANCE: usize = 1;

/// What the frames of one view lack.
#[derive(Clone, Debug)]
pub struct Missing {
    /// The view's eye.
    pub eye: Place,
    /// Samples of the truth.
    pub truth: u32,
    /// For each reference image, samples of the truth that are not in its frame within [`TOLERANCE`].
    pub missing: Vec<u32>,
    /// The same without a tolerance.
    pub strict: Vec<u32>,
}

/// Returns where in a frame samples of the truth are missing: those for which no pixel within `near` of theirs holds
/// the same depth.
#[must_use]
pub fn mask<const N: usize>(truth: &Raster<N>, frame: &Raster<3>, near: usize) -> Vec<bool> {
    let (width, height) = (truth.width, truth.height);
    let missing = |index: usize| {
        let own = truth.nearness[index];
        let (x, y) = (index % width, index / width);
        own > 0.0
            && !(y.saturating_sub(near)..height.min(y + near + 1)).any(|y| {
                (x.saturating_sub(near)..width.min(x + near + 1))
                    .any(|x| (frame.nearness[y * width + x] - own).abs() <= SAME * own)
            })
    };
    (0..width * height).map(missing).collect()
}

/// Returns the faces', edges' and corners' middles of a cube around the reference eye: 26 places.
#[must_use]
pub fn cube(half_side: f64) -> Vec<Place> {
    let coordinates = [-half_side, 0.0, half_side];
    let places =
        coordinates.iter().flat_map(|&x| coordinates.iter().flat_map(move |&y| coordinates.map(|z| [x, y, z])));
    places.filter(|place| *place != [0.0; 3]).collect()
}

/// Returns the view from a place: 45 degrees wide, along z, with pixels about as large as the reference image's.
#[must_use]
pub fn desired(eye: Place, size: usize) -> View {
    // tan 22.5 degrees; three quarters as high.
    let width = (0.414 * size as f64).round() as usize;
    View::new(eye, width, width * 3 / 4, 45.0)
}

/// Returns what frames lack that are made from each of `references`, view by view.
#[must_use]
pub fn count(world: &World, size: usize, references: &[(&Reference, Joint)]) -> Vec<Missing> {
    cube(world.half_side)
        .into_par_iter()
        .map(|eye| {
            let view = desired(eye, size);
            let truth = reference::plain(world, &view).raster;
            let mut found = Missing { eye, truth: 0, missing: Vec::new(), strict: Vec::new() };
            found.truth = truth.nearness.iter().filter(|&&nearness| nearness > 0.0).count() as u32;
            for (reference, joint) in references {
                let frame = warp(reference, &view, joint);
                let lacks = |near| mask(&truth, &frame, near).iter().filter(|&&missing| missing).count() as u32;
                found.missing.push(lacks(TOLERANCE));
                found.strict.push(lacks(0));
            }
            found
        })
        .collect()
}
