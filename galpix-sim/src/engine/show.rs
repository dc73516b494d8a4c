//! One map or several layers: what shows frames.

use galpix_core::inpaint::map::Filling;
use galpix_core::inpaint::metamer::{self, Recipe};
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::layers::Layers;
use galpix_core::{Controller, Format, Galpixmap, Inpainting, Settings, SetupError, Tally};

/// A [`Controller`], or several [`Layers`].
pub trait Show<'p, F> {
    /// Makes the next frame. What is moved, lost, collided and saturated is counted over all layers, all else is the base's.
    fn step(&mut self, settings: &Settings) -> Tally;
    /// The same by instructions that do not depend on the picture.
    fn step_constant_time(&mut self, settings: &Settings) -> Tally;
    /// What is shown.
    fn front(&self) -> &Galpixmap<'p, F>;
    /// Where the galpixels of a layer's own map came from; layer 0 is the base.
    fn winners(&self, layer: usize) -> &[u32];
    /// Which layer a cell shows.
    fn layer_at(&self, cell: u32) -> usize;
    /// See [`Controller::inpaint`].
    fn inpaint<V: Filling>(
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

impl<'p, F: Format> Show<'p, F> for Controller<'p, F> {
    fn step(&mut self, settings: &Settings) -> Tally {
        self.step(settings)
    }

    fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        self.step_constant_time(settings)
    }

    fn front(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn winners(&self, _layer: usize) -> &[u32] {
        self.winners()
    }

    fn layer_at(&self, _cell: u32) -> usize {
        0
    }

    fn inpaint<V: Filling>(
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

impl<'p, F: Format> Show<'p, F> for Layers<'p, '_, F> {
    fn step(&mut self, settings: &Settings) -> Tally {
        let base = self.step(settings);
        over_all_layers(base, self)
    }

    fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        let base = self.step_constant_time(settings);
        over_all_layers(base, self)
    }

    fn front(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn winners(&self, layer: usize) -> &[u32] {
        self.winners(layer)
    }

    fn layer_at(&self, cell: u32) -> usize {
        self.layer_at(cell)
    }

    fn inpaint<V: Filling>(
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

/// Adds what the other layers counted in the last step to what the base did.
fn over_all_layers<F: Format>(base: Tally, layers: &Layers<'_, '_, F>) -> Tally {
    layers.hidden().iter().map(galpix_core::layers::Layer::tally).fold(base, |sum, layer| Tally {
        moved: sum.moved + layer.moved,
        lost: sum.lost + layer.lost,
        collided: sum.collided + layer.collided,
        saturated: sum.saturated + layer.saturated,
        ..sum
    })
}
