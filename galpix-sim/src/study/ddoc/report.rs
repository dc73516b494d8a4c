//! The study's figures, as they are printed and written.

use schemars::JsonSchema;
use serde::Serialize;

use super::Request;
use super::missing::Missing;
use super::reference::Ddoc;
use super::world::World;

/// Seconds for a DDOC image.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Seconds {
    /// The plain z-buffer.
    pub z_buffer: f64,
    /// The distortion map.
    pub map: f64,
    /// Subdivision, projection and rasterisation.
    pub image: f64,
    /// All of it.
    pub total: f64,
}

/// One world.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SourceReport {
    /// Its name.
    pub source: String,
    /// What it shows.
    pub about: String,
    /// Triangles before subdivision.
    pub triangles: usize,
    /// Side of the reference images, pixels.
    pub size: usize,
    /// D, pixels.
    pub radius: u32,
    /// a_f.
    pub asymmetry: f64,
    /// Half the side of the cube of views, in units of the near distance.
    pub half_side: f64,
    /// Views.
    pub views: usize,
    /// Samples of the truth, over all views.
    pub truth: u64,
    /// Of these, samples that the frames of the plain image lack, within a pixel.
    pub missing_plain: u64,
    /// Samples that the frames of the DDOC image lack, within a pixel.
    pub missing_ddoc: u64,
    /// Their ratio.
    pub ratio: Option<f64>,
    /// The same at the very pixel.
    pub strict_plain: u64,
    /// The same at the very pixel.
    pub strict_ddoc: u64,
    /// Their ratio.
    pub strict_ratio: Option<f64>,
    /// Samples of the DDOC image.
    pub samples: usize,
    /// Cells on edges that became splats.
    pub splats: u32,
    /// Splats that a conflict made smaller.
    pub shrunk: u32,
    /// Distortions that were deleted again.
    pub orphans: u32,
    /// Cells of the map that are distorted.
    pub distorted: u32,
    /// What taking the DDOC image took.
    pub seconds: Seconds,
}

impl SourceReport {
    /// Creates the figures of a world. The first reference image of `views` is the plain one.
    #[must_use]
    pub fn new(world: &World, request: &Request, ddoc: &Ddoc, views: &[Missing]) -> Self {
        let sum = |of: &dyn Fn(&Missing) -> u32| views.iter().map(|view| u64::from(of(view))).sum::<u64>();
        let ratio = |of: u64, to: u64| (to > 0).then(|| of as f64 / to as f64);
        let [z_buffer, map, image] = ddoc.seconds;
        let (missing_plain, missing_ddoc) = (sum(&|view| view.missing[0]), sum(&|view| view.missing[1]));
        let (strict_plain, strict_ddoc) = (sum(&|view| view.strict[0]), sum(&|view| view.strict[1]));
        Self {
            source: world.name.clone(),
            about: world.about.clone(),
            triangles: world.triangles.len(),
            size: request.size,
            radius: request.radius,
            asymmetry: request.asymmetry,
            half_side: world.half_side,
            views: views.len(),
            truth: sum(&|view| view.truth),
            missing_plain,
            missing_ddoc,
            ratio: ratio(missing_ddoc, missing_plain),
            strict_plain,
            strict_ddoc,
            strict_ratio: ratio(strict_ddoc, strict_plain),
            samples: ddoc.image.raster.nearness.iter().filter(|&&nearness| nearness > 0.0).count(),
            splats: ddoc.tally.splats,
            shrunk: ddoc.tally.shrunk,
            orphans: ddoc.tally.orphans,
            distorted: ddoc.tally.distorted,
            seconds: Seconds { z_buffer, map, image, total: z_buffer + map + image },
        }
    }
}
