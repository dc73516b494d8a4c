//! Maps whose frames are inpainted: push-pull over what each of them uncovered, with the feature `push-pull`.

use galpix_core::inpaint::{Inpainting, Metamer, PushPull};
use galpix_core::{Galpixmap, Maps, Settings, SetupError, Tally};
use galpix_link::panel::Panel;

/// Words of memory that [`of_panel`] takes; none without the feature.
#[must_use]
pub const fn words<P: Panel>() -> usize {
    if cfg!(feature = "push-pull") { P::PUSH_PULL_WORDS } else { 0 }
}

/// The maps of a panel, inpainted as it says.
///
/// *Errors:* memory shorter than [`words`].
#[cfg(feature = "push-pull")]
pub fn of_panel<P: Panel, M>(maps: M, memory: &mut [u32]) -> Result<Inpainted<'_, M>, SetupError> {
    let push_pull = PushPull::new(u32::from(P::WIDTH), u32::from(P::HEIGHT), P::MOTION, memory)?;
    Ok(Inpainted::new(maps, P::INPAINTING, push_pull))
}

/// The maps of a panel, as they are.
///
/// *Errors:* none.
#[cfg(not(feature = "push-pull"))]
pub const fn of_panel<P: Panel, M>(maps: M, _: &mut [u32]) -> Result<M, SetupError> {
    Ok(maps)
}

/// Maps, and the push-pull that fills their holes.
pub struct Inpainted<'s, M> {
    maps: M,
    inpainting: Inpainting<'static>,
    push_pull: PushPull<'s>,
}

impl<'s, M> Inpainted<'s, M> {
    /// Maps whose every frame is followed by this push-pull.
    pub const fn new(maps: M, inpainting: Inpainting<'static>, push_pull: PushPull<'s>) -> Self {
        Self { maps, inpainting, push_pull }
    }
}

impl<'p, M: Maps<'p>> Maps<'p> for Inpainted<'_, M> {
    type Format = M::Format;

    fn step(&mut self, settings: &Settings) -> Tally {
        let tally = self.maps.step(settings);
        self.maps.inpaint(settings, &self.inpainting, &mut self.push_pull);
        tally
    }

    fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        self.maps.inpaint(settings, inpainting, push_pull)
    }

    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        self.maps.synthesise(settings, inpainting, metamer)
    }

    fn shown(&self) -> &Galpixmap<'p, M::Format> {
        self.maps.shown()
    }

    fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, M::Format>> {
        self.maps.layer_mut(layer)
    }

    fn frame(&self) -> u32 {
        self.maps.frame()
    }

    fn takes(&self, layer: usize) -> bool {
        self.maps.takes(layer)
    }

    fn layer_at(&self, cell: u32) -> usize {
        self.maps.layer_at(cell)
    }

    fn winners(&self, layer: usize) -> &[u32] {
        self.maps.winners(layer)
    }
}
