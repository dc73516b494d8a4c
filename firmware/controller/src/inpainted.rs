//! Maps whose frames are inpainted: push-pull over what each of them uncovered.

use galpix_core::inpaint::map::Filling;
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::{Galpixmap, Inpainting, Settings, Tally};

use crate::maps::Maps;

/// Maps, and the pyramid that their holes are filled from.
pub struct Inpainted<'s, M, V> {
    maps: M,
    inpainting: Inpainting<'static>,
    pyramid: Pyramid<'s, V>,
}

impl<'s, M, V> Inpainted<'s, M, V> {
    /// Maps whose every frame is followed by push-pull with this pyramid.
    pub const fn new(maps: M, inpainting: Inpainting<'static>, pyramid: Pyramid<'s, V>) -> Self {
        Self { maps, inpainting, pyramid }
    }
}

impl<'p, M: Maps<'p>, V: Filling> Maps<'p> for Inpainted<'_, M, V> {
    type Format = M::Format;

    fn step(&mut self, settings: &Settings) -> Tally {
        let tally = self.maps.step(settings);
        self.maps.inpaint(settings, &self.inpainting, &mut self.pyramid);
        tally
    }

    fn inpaint<W: Filling>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, W>,
    ) -> u32 {
        self.maps.inpaint(settings, inpainting, pyramid)
    }

    fn shown(&self) -> &Galpixmap<'p, M::Format> {
        self.maps.shown()
    }

    fn shown_mut(&mut self) -> &mut Galpixmap<'p, M::Format> {
        self.maps.shown_mut()
    }

    fn frame(&self) -> u32 {
        self.maps.frame()
    }
}
