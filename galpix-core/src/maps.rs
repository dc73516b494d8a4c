//! What a display controller, a simulator and a queue of objects need of maps, however many there are.

use crate::error::SetupError;
use crate::fast::rolling::Rolling;
use crate::format::Format;
use crate::frame::tally::Tally;
use crate::frame::{Controller, Settings};
use crate::inpaint::{Inpainting, Metamer, PushPull};
use crate::layers::{Layer, Layers};
use crate::map::Galpixmap;

/// Maps over one grid that move together and are shown as one: a [`Controller`], a [`Rolling`] or [`Layers`].
///
/// Layer 0 is the base; all but [`Layers`] have no other.
pub trait Maps<'p> {
    /// How the galpixels are stored.
    type Format: Format;

    /// Makes the next frame and shows it. Of layers the galpixels that moved, were lost, collided or saturated are
    /// counted over all of them, everything else is the base's.
    fn step(&mut self, settings: &Settings) -> Tally;

    /// Inpaints what the last step uncovered, see [`Controller::inpaint`]; returns the number of cells filled.
    fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32;

    /// Inpaints with a texture, see [`Controller::synthesise`]; returns the number of cells filled.
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError>;

    /// Returns the map that is shown.
    fn shown(&self) -> &Galpixmap<'p, Self::Format>;

    /// Returns the galpixels of a layer, to write an update into; `None` if there is no such layer.
    fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, Self::Format>>;

    /// Returns the frame counter.
    fn frame(&self) -> u32;

    /// Returns whether there is such a layer and its galpixels move from cell to cell, so that objects can be grafted
    /// into it. A stationary-source layer is delivered as a whole.
    fn takes(&self, layer: usize) -> bool {
        layer == 0
    }

    /// Returns which layer a cell shows; 0, the base, also where it is empty.
    fn layer_at(&self, cell: u32) -> usize {
        let _ = cell;
        0
    }

    /// Returns the winner map of a layer; empty if none was provided.
    fn winners(&self, layer: usize) -> &[u32];
}

impl<'p, F: Format> Maps<'p> for Controller<'p, F> {
    type Format = F;

    fn step(&mut self, settings: &Settings) -> Tally {
        Self::step(self, settings)
    }

    fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        Self::inpaint(self, settings, inpainting, push_pull)
    }

    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        Self::synthesise(self, settings, inpainting, metamer)
    }

    fn shown(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, F>> {
        if layer == 0 { Some(self.front_mut()) } else { None }
    }

    fn frame(&self) -> u32 {
        Self::frame(self)
    }

    fn winners(&self, layer: usize) -> &[u32] {
        if layer == 0 { Self::winners(self) } else { &[] }
    }
}

impl<'p, F: Format> Maps<'p> for Rolling<'p, F> {
    type Format = F;

    fn step(&mut self, settings: &Settings) -> Tally {
        Self::step(self, settings)
    }

    fn inpaint(&mut self, _: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        Self::inpaint(self, inpainting, push_pull)
    }

    fn synthesise(
        &mut self,
        _: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        Self::synthesise(self, inpainting, metamer)
    }

    fn shown(&self) -> &Galpixmap<'p, F> {
        self.map()
    }

    fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, F>> {
        if layer == 0 { Some(self.map_mut()) } else { None }
    }

    fn frame(&self) -> u32 {
        Self::frame(self)
    }

    /// The winner map covers the window only.
    fn winners(&self, _: usize) -> &[u32] {
        &[]
    }
}

impl<'p, F: Format> Maps<'p> for Layers<'p, '_, F> {
    type Format = F;

    fn step(&mut self, settings: &Settings) -> Tally {
        let base = Self::step(self, settings);
        self.hidden().iter().map(Layer::tally).fold(base, |sum, layer| Tally {
            moved: sum.moved + layer.moved,
            lost: sum.lost + layer.lost,
            collided: sum.collided + layer.collided,
            saturated: sum.saturated + layer.saturated,
            ..sum
        })
    }

    fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        Self::inpaint(self, settings, inpainting, push_pull)
    }

    fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        Self::synthesise(self, settings, inpainting, metamer)
    }

    fn shown(&self) -> &Galpixmap<'p, F> {
        self.front()
    }

    fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, F>> {
        Self::layer_mut(self, layer)
    }

    fn frame(&self) -> u32 {
        Self::frame(self)
    }

    fn takes(&self, layer: usize) -> bool {
        layer <= self.hidden().len() && !self.is_stationary(layer)
    }

    fn layer_at(&self, cell: u32) -> usize {
        Self::layer_at(self, cell)
    }

    fn winners(&self, layer: usize) -> &[u32] {
        Self::winners(self, layer)
    }
}
