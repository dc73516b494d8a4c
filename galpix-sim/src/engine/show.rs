//! One map or several layers: what shows frames.

use galpix_core::error::SetupError;
use galpix_core::frame::{Controller, Inpainting, Settings};
use galpix_core::galpixel::Budget;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::inpaint::map::OfGalpixel;
use galpix_core::inpaint::metamer::{self, Recipe};
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::layers::Layers;
use galpix_core::layout::Layout;
use galpix_core::tally::Tally;

/// A [`Controller`], or several [`Layers`].
pub trait Show<'p, L: Layout, B: Budget<L>> {
    /// Makes the next frame. What is moved, lost, collided and saturated is counted over all layers, all else is the base's.
    fn step(&mut self, settings: &Settings) -> Tally;
    /// What is shown.
    fn front(&self) -> &Galpixmap<'p, L, B>;
    /// Where the galpixels of a layer's own map came from; layer 0 is the base.
    fn winners(&self, layer: usize) -> &[u32];
    /// Which layer a cell shows.
    fn layer_at(&self, cell: u32) -> usize;
    /// See [`Controller::inpaint`].
    fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32;
    /// See [`Controller::synthesise`].
    ///
    /// *Errors:* memory that is too short for the map.
    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        recipe: &Recipe,
        scratch: &mut metamer::Scratch<'_>,
    ) -> Result<u32, SetupError>;
}

impl<'p, L: Layout, B: Budget<L>> Show<'p, L, B> for Controller<'p, L, B> {
    fn step(&mut self, settings: &Settings) -> Tally {
        self.step(settings)
    }

    fn front(&self) -> &Galpixmap<'p, L, B> {
        self.front()
    }

    fn winners(&self, _layer: usize) -> &[u32] {
        self.winners()
    }

    fn layer_at(&self, _cell: u32) -> usize {
        0
    }

    fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        self.inpaint(settings, inpainting, pyramid)
    }

    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        recipe: &Recipe,
        scratch: &mut metamer::Scratch<'_>,
    ) -> Result<u32, SetupError> {
        self.synthesise(settings, inpainting, recipe, scratch)
    }
}

impl<'p, L: Layout, B: Budget<L>, const HIDDEN: usize> Show<'p, L, B> for Layers<'p, L, B, HIDDEN> {
    fn step(&mut self, settings: &Settings) -> Tally {
        let tally = self.step(settings);
        tally.hidden.iter().fold(tally.base, |sum, layer| Tally {
            moved: sum.moved + layer.moved,
            lost: sum.lost + layer.lost,
            collided: sum.collided + layer.collided,
            saturated: sum.saturated + layer.saturated,
            ..sum
        })
    }

    fn front(&self) -> &Galpixmap<'p, L, B> {
        self.front()
    }

    fn winners(&self, layer: usize) -> &[u32] {
        self.winners(layer)
    }

    fn layer_at(&self, cell: u32) -> usize {
        self.layer_at(cell)
    }

    fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        self.inpaint(settings, inpainting, pyramid)
    }

    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        recipe: &Recipe,
        scratch: &mut metamer::Scratch<'_>,
    ) -> Result<u32, SetupError> {
        self.synthesise(settings, inpainting, recipe, scratch)
    }
}
