//! One map or two: what shows the same pictures with different memory.

use galpix_core::inpaint::map::Filling;
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::rolling::Rolling;
use galpix_core::{Controller, Format, Galpixmap, Inpainting, Settings, Tally};

/// A galpixmap that is propagated.
pub trait Maps<'p> {
    /// How its galpixels are stored.
    type Format: Format;

    /// Makes the next frame.
    fn step(&mut self, settings: &Settings) -> Tally;
    /// Fills what it uncovered, by push-pull: how many cells.
    fn inpaint<V: Filling>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32;
    /// The map that is shown.
    fn shown(&self) -> &Galpixmap<'p, Self::Format>;
    /// The map that is shown, to write an update into.
    fn shown_mut(&mut self) -> &mut Galpixmap<'p, Self::Format>;
    /// The frame counter.
    fn frame(&self) -> u32;
}

impl<'p, F: Format> Maps<'p> for Controller<'p, F> {
    type Format = F;

    fn step(&mut self, settings: &Settings) -> Tally {
        Controller::step(self, settings)
    }

    fn inpaint<V: Filling>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        Controller::inpaint(self, settings, inpainting, pyramid)
    }

    fn shown(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn shown_mut(&mut self) -> &mut Galpixmap<'p, F> {
        self.front_mut()
    }

    fn frame(&self) -> u32 {
        Controller::frame(self)
    }
}

impl<'p, F: Format> Maps<'p> for Rolling<'p, F> {
    type Format = F;

    fn step(&mut self, settings: &Settings) -> Tally {
        Rolling::step(self, settings)
    }

    fn inpaint<V: Filling>(&mut self, _: &Settings, inpainting: &Inpainting<'_>, pyramid: &mut Pyramid<'_, V>) -> u32 {
        Rolling::inpaint(self, inpainting, pyramid)
    }

    fn shown(&self) -> &Galpixmap<'p, F> {
        self.map()
    }

    fn shown_mut(&mut self) -> &mut Galpixmap<'p, F> {
        self.map_mut()
    }

    fn frame(&self) -> u32 {
        Rolling::frame(self)
    }
}
