//! Metamers: holes get a texture of the statistics of what surrounds them.
//!
//! ```text
//! r = mu_l + sum over levels i < l and bands j of (mu_ij + xi_ij sigma_ij)         (section 3.4 of the paper)
//! ```
//!
//! Push-pull makes `mu_l`, and from the responses of the bands and their squares, known by a mask of their own, `mu`
//! and `sigma`. Sums go down level by level, as in push-pull: a cell takes its own tone by its validity, and the rest
//! from the linear sample of the level above with the detail of its own level added. So what is known is left as it is
//! at every level and not only in the picture, and with no detail this is push-pull.
//!
//! `xi` is white noise through the same bands, see [`noise`]. It is taken where the surface was when the map was
//! updated: a cell less the distance that it has moved since (section 3.4.1). So the noise of an area moves with it,
//! and what opens next to it in the next frame fits.
//!
//! Between places, mean and deviation are interpolated as such: the last linear sample takes them, and the moments go
//! as far as the level above.

mod active;
mod block;
mod map;
pub mod noise;
mod picture;
#[cfg(any(test, feature = "check"))]
pub mod reference;
mod responses;
mod scene;
mod statistics;
mod steerable;
mod surroundings;
mod synthesis;
pub mod tone;
mod tones;
mod ycbcr;

use super::levels::{Level, Levels};
use super::picture::Picture;
use super::pyramid::Pyramid;
use super::settings::Inpainting;
use crate::error::SetupError;
use noise::Scale;
use responses::Workspace;
use scene::Scene;
use statistics::Moments;
use synthesis::{Rule, Synthesis};
use tone::Tone;

/// What a texture is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Recipe {
    /// Levels that have bands, 1 to [`Metamer::MOST_LEVELS`]; no more than the map has.
    pub levels: u32,
    /// To what the noise is scaled.
    pub noise: Scale,
    /// Whether colours get noise of their own besides that of the luma. The chroma of a texture mostly goes with its
    /// luma; noise that does not looks like coloured snow.
    pub coloured: bool,
    /// Which noise.
    pub seed: u32,
}

/// Four levels, as the paper's; noise of full deviation, in the luma.
impl Default for Recipe {
    fn default() -> Self {
        Self { levels: 4, noise: Scale::Deviation, coloured: false, seed: 0 }
    }
}

/// Where the tiles of a [`Metamer`] are worked out, 27 KiB. What is in it does not matter.
#[derive(Debug)]
pub struct MetamerWorkspace {
    responses: Workspace,
    noise: noise::Tiles,
}

impl MetamerWorkspace {
    /// Makes a workspace.
    #[must_use]
    pub const fn new() -> Self {
        Self { responses: Workspace::new(), noise: noise::Tiles::new() }
    }
}

impl Default for MetamerWorkspace {
    fn default() -> Self {
        Self::new()
    }
}

/// Metamers for maps or pictures of one size or smaller ones, over caller-provided buffers.
#[derive(Debug)]
pub struct Metamer<'s> {
    recipe: Recipe,
    memory: &'s mut [u32],
    workspace: &'s mut MetamerWorkspace,
}

/// Limits levels to those that may have bands.
const fn limited(levels: u32) -> u32 {
    if levels == 0 {
        1
    } else if levels > Metamer::MOST_LEVELS {
        Metamer::MOST_LEVELS
    } else {
        levels
    }
}

impl<'s> Metamer<'s> {
    /// The most levels that have bands.
    pub const MOST_LEVELS: u32 = 8;

    /// Returns the words of memory for maps or pictures of `width` x `height` cells, each 1 to 32768, and a recipe of
    /// `levels` levels.
    #[must_use]
    pub const fn words(width: u32, height: u32, levels: u32) -> usize {
        let (of_picture, last) = (Levels::new(width, height), limited(levels));
        let last = if last < of_picture.top() { last } else { of_picture.top() };
        let cells = of_picture.cells();
        let pyramids = Pyramid::<Tone>::words(cells).saturating_add(Pyramid::<Moments>::words(cells));
        pyramids.saturating_add(active::words(width, height, last))
    }

    /// Returns the bytes of both buffers: for four levels 179 KiB for 128 x 64 cells, 1453 KiB for 320 x 240 and 19483
    /// KiB for 1024 x 1024 (`memory_is_as_stated` in the tests of this module).
    #[must_use]
    pub const fn bytes(width: u32, height: u32, levels: u32) -> usize {
        Self::words(width, height, levels)
            .saturating_mul(size_of::<u32>())
            .saturating_add(size_of::<MetamerWorkspace>())
    }

    /// Lays metamers for maps or pictures of `width` x `height` cells over `memory`. What is in the memory and in the
    /// workspace does not matter.
    ///
    /// *Errors:* a side of 0 or over 32768, memory shorter than [`Self::words`].
    pub fn new(
        width: u32,
        height: u32,
        recipe: Recipe,
        memory: &'s mut [u32],
        workspace: &'s mut MetamerWorkspace,
    ) -> Result<Self, SetupError> {
        let levels = Levels::checked(width, height)?;
        Self::synthesis(&recipe, levels, memory)?;
        Ok(Self { recipe, memory, workspace })
    }

    /// Returns what the texture is made with.
    #[must_use]
    pub const fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// Lays out the memory for a picture.
    ///
    /// *Errors:* memory that is too short.
    fn synthesis<'m>(recipe: &Recipe, levels: Levels, memory: &'m mut [u32]) -> Result<Synthesis<'m>, SetupError> {
        let Level { width, height, .. } = levels.level(0);
        let (need, have) = (Self::words(width, height, recipe.levels), memory.len());
        Synthesis::over(levels, limited(recipe.levels), memory).ok_or(SetupError::TooShort {
            plane: "metamer",
            need,
            have,
        })
    }

    /// Fills the holes of a picture: how many were filled. Of `inpainting` gamma, threshold and mask count.
    ///
    /// `moved` has for each cell, row by row, the word of how far what it shows has moved since the update, in whole
    /// cells, see [`displacement_word`](crate::layers::displacement_word); empty, nothing has moved. A hole takes the
    /// noise of its place less the displacement of the known cell that has the largest part in its smooth colour, so
    /// that the texture moves with that surface. What `moved` has for holes does not matter.
    ///
    /// *Errors:* memory that is too short for the picture, displacements of some cells only; then nothing is filled.
    ///
    /// *Cost:* that of metamers in a galpixmap, see `docs/notes/inpainting.md`.
    pub fn fill_picture(
        &mut self,
        picture: &mut Picture<'_>,
        inpainting: &Inpainting<'_>,
        moved: &[u32],
    ) -> Result<u32, SetupError> {
        picture.check_moved(moved)?;
        #[cfg(feature = "check")]
        let expected = picture.on_copy(|copy| {
            reference::metamers(&mut copy.holes::<Tone>(inpainting.mask, moved), inpainting, &self.recipe, 0)
        });
        let filled = self.fill(&mut picture.holes::<Tone>(inpainting.mask, moved), inpainting, 0)?;
        #[cfg(feature = "check")]
        assert!((&*picture.colours, filled) == (&*expected.0, expected.1), "metamers in a picture: {inpainting:?}");
        Ok(filled)
    }

    /// Fills the holes of a scene, `age` frames after it was updated: how many were filled.
    ///
    /// *Errors:* memory that is too short for the scene; then nothing is filled.
    pub(super) fn fill<S: Scene>(
        &mut self,
        scene: &mut S,
        inpainting: &Inpainting<'_>,
        age: u32,
    ) -> Result<u32, SetupError> {
        let [width, height] = scene.size();
        let Self { recipe, memory, workspace } = self;
        let mut synthesis = Self::synthesis(recipe, Levels::checked(width, height)?, memory)?;
        Ok(synthesis.fill(scene, Rule { inpainting, recipe, age }, workspace))
    }
}

#[cfg(test)]
mod tests;
