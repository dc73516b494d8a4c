//! One map or two: what shows the same pictures with different memory.

use galpix_core::frame::{Controller, Inpainting, Settings};
use galpix_core::galpixel::Budget;
use galpix_core::galpixmap::Galpixmap;
use galpix_core::inpaint::map::OfGalpixel;
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::layout::Layout;
use galpix_core::rolling::Rolling;
use galpix_core::tally::Tally;

/// A galpixmap that is propagated.
pub trait Maps<'p> {
    /// What its galpixels carry.
    type Layout: Layout;
    /// How they are stored.
    type Budget: Budget<Self::Layout>;

    /// Makes the next frame.
    fn step(&mut self, settings: &Settings) -> Tally;
    /// Fills what it uncovered, by push-pull: how many cells.
    fn inpaint<V: OfGalpixel<Self::Layout>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32;
    /// The map that is shown.
    fn shown(&self) -> &Galpixmap<'p, Self::Layout, Self::Budget>;
    /// The map that is shown, to write an update into.
    fn shown_mut(&mut self) -> &mut Galpixmap<'p, Self::Layout, Self::Budget>;
    /// The frame counter.
    fn frame(&self) -> u32;
}

impl<'p, L: Layout, B: Budget<L>> Maps<'p> for Controller<'p, L, B> {
    type Layout = L;
    type Budget = B;

    fn step(&mut self, settings: &Settings) -> Tally {
        Controller::step(self, settings)
    }

    fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        Controller::inpaint(self, settings, inpainting, pyramid)
    }

    fn shown(&self) -> &Galpixmap<'p, L, B> {
        self.front()
    }

    fn shown_mut(&mut self) -> &mut Galpixmap<'p, L, B> {
        self.front_mut()
    }

    fn frame(&self) -> u32 {
        Controller::frame(self)
    }
}

impl<'p, L: Layout, B: Budget<L>> Maps<'p> for Rolling<'p, L, B> {
    type Layout = L;
    type Budget = B;

    fn step(&mut self, settings: &Settings) -> Tally {
        Rolling::step(self, settings)
    }

    fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        Rolling::inpaint(self, settings, inpainting, pyramid)
    }

    fn shown(&self) -> &Galpixmap<'p, L, B> {
        self.map()
    }

    fn shown_mut(&mut self) -> &mut Galpixmap<'p, L, B> {
        self.map_mut()
    }

    fn frame(&self) -> u32 {
        Rolling::frame(self)
    }
}
