//! Layers: galpixmaps that move apart and are shown together, so that what is covered now can reappear.
//!
//! Within a map a collision is final: the galpixel that loses is gone. A layer is a map of its own; between layers it is decided
//! anew in each frame who is shown, by (class, depth, layer), the smallest first. A second surface behind the first, an object
//! that passes behind another one, samples that a renderer sends along because they are about to be uncovered: each waits in its
//! layer until it is seen.
//!
//! Layer 0, the *base*, is a [`Controller`]. Its map is what is shown: where a galpixel of another layer is nearer, the two
//! change places (the other one is *seated*), a flag remembers it, and before the layers move on they change back. So the edge
//! map, the fill ladder, inpainting and scan-out work on the shown picture as they do without layers, and where nothing is
//! seated nothing is done. What was made up to fill a hole belongs to the base; being debris, it loses against any galpixel.
//!
//! ```text
//!            ┌ front 0 ─▶ edge, sweep ─▶ back 0 ─┐
//!  take      │                                   ├─ seat ─▶ fill ─▶ inpaint, scan-out
//!  back ─▶ ──┤ front 1 ─▶ sweep, bullets ─▶ back 1 ┤
//!            └ front 2 ─▶ …                      ┘
//! ```
//!
//! In a layer other than the base holes are transparent. If it has scratch memory, bullet holes are filled within it, so that
//! nothing shines through the cracks of an object that comes nearer.
//!
//! **Cost:** a sweep for each layer, and for each layer but the base a comparison a cell, and twice an exchange of what is
//! seated. **Memory:** two maps and two bits a cell for each layer more; an stationary one three maps and a word a cell.

mod layer;
mod seat;
mod shown;
mod stationary;

pub use layer::{Layer, composite_words};
pub use stationary::{Displacement, displacement_word};

use crate::error::SetupError;
use crate::format::Format;
use crate::frame::edge;
use crate::frame::tally::Tally;
use crate::frame::{Controller, Settings, fill_holes, move_on};
use crate::inpaint::{Inpainting, Metamer, PushPull};
use crate::map::Galpixmap;
use shown::Shown;

/// A base and further layers over the same grid and format. With none of these it is a [`Controller`].
#[derive(Debug)]
pub struct Layers<'p, 'l, F> {
    base: Controller<'p, F>,
    hidden: &'l mut [Layer<'p, F>],
    /// Whether the front maps hold what is shown, rather than each its own galpixels.
    seated: bool,
}

/// Makes the next frame of all layers. The entry point of the mode `CONSTANT_TIME`.
pub(crate) fn make<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>, settings: &Settings) -> Tally {
    composite::<F, CONSTANT_TIME>(layers);
    restore::<F, CONSTANT_TIME>(layers);
    let Controller { front, back, scratch, frame } = &mut layers.base;
    let mut tally = move_on::<F, CONSTANT_TIME>(front, back, scratch, settings, *frame);
    for layer in layers.hidden.iter_mut() {
        layer.tally = layer.move_on::<CONSTANT_TIME>(settings, *frame);
        layer.seat_back::<CONSTANT_TIME>(back);
    }
    let around = Shown { front, hidden: layers.hidden };
    fill_holes::<F, CONSTANT_TIME>(&around, back, scratch, settings, &mut tally);
    core::mem::swap(front, back);
    *frame = frame.wrapping_add(1);
    for layer in layers.hidden.iter_mut() {
        layer.swap();
    }
    layers.seated = true;
    layers.count_shown();
    tally
}

/// Decides anew what the front maps show; nothing if they show it already.
pub(crate) fn composite<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>) {
    if !layers.seated {
        for layer in layers.hidden.iter_mut() {
            layer.draw::<CONSTANT_TIME>();
            layer.seat_front::<CONSTANT_TIME>(&mut layers.base.front);
        }
        layers.seated = true;
    }
}

/// Gives each layer its own galpixels back.
pub(crate) fn restore<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>) {
    if layers.seated {
        for layer in layers.hidden.iter_mut().rev() {
            layer.take_back::<CONSTANT_TIME>(&mut layers.base.front);
        }
        layers.seated = false;
    }
}

impl<'p, 'l, F: Format> Layers<'p, 'l, F> {
    /// A base and further layers, each with the maps that it already holds.
    ///
    /// *Errors:* a layer over another grid than the base's.
    pub fn new(base: Controller<'p, F>, hidden: &'l mut [Layer<'p, F>]) -> Result<Self, SetupError> {
        if hidden.iter().any(|layer| layer.front.grid() != base.front.grid()) {
            return Err(SetupError::GridsDiffer);
        }
        let mut layers = Self { base, hidden, seated: false };
        layers.composite();
        Ok(layers)
    }

    /// Makes the next frame of all layers and shows it; the counts are the base's, whose holes are the cells that no layer
    /// reached. Each further layer keeps its own, see [`Layer::tally`]. Work depends on the picture.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        F::layers_step(self, settings)
    }

    /// Makes the next frame of all layers by instructions that do not depend on the picture. Same arguments, same bits as
    /// [`Self::step`].
    pub fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        F::layers_step_constant_time(self, settings)
    }

    /// Decides anew what the front maps show; nothing if they show it already. An update that was written into a layer is seen
    /// from then on, and not only after the next step.
    pub fn composite(&mut self) {
        F::layers_composite(self);
        self.count_shown();
    }

    /// Returns the layers but the base, the one after it first.
    #[must_use]
    pub fn hidden(&self) -> &[Layer<'p, F>] {
        self.hidden
    }

    /// The galpixels of layer `layer` (0: the base), to write an update into; of an stationary layer those in the cells where they
    /// are stored. Nothing if there is no such layer. What is shown is decided anew by [`Self::composite`], or before the next step.
    pub fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, F>> {
        F::layers_restore(self);
        match layer.checked_sub(1) {
            None => Some(&mut self.base.front),
            Some(hidden) => self.hidden.get_mut(hidden).map(Layer::stored_mut),
        }
    }

    /// The displacements of an stationary layer, a word for each cell, see [`displacement_word`]; else nothing.
    pub fn displacements_mut(&mut self, layer: usize) -> Option<&mut [u32]> {
        F::layers_restore(self);
        self.hidden.get_mut(layer.checked_sub(1)?)?.displacements_mut()
    }

    /// Counts the cells that show each layer but the base.
    fn count_shown(&mut self) {
        for layer in self.hidden.iter_mut() {
            layer.shown = 0;
        }
        for index in 0..edge::words(self.base.front.grid()) {
            let mut taken = 0;
            for layer in self.hidden.iter_mut().rev() {
                let seats = layer.seats().get(index).copied().unwrap_or(0);
                layer.shown += (seats & !taken).count_ones();
                taken |= seats;
            }
        }
    }

    /// Which layer a cell shows; 0, the base, also where it is empty.
    #[must_use]
    pub fn layer_at(&self, cell: u32) -> usize {
        self.hidden.iter().rposition(|layer| seat::bit(layer.seats(), cell) != 0).map_or(0, |hidden| hidden + 1)
    }

    /// Whether a layer is stationary, see [`Layer::stationary`].
    #[must_use]
    pub fn is_stationary(&self, layer: usize) -> bool {
        layer.checked_sub(1).and_then(|hidden| self.hidden.get(hidden)).is_some_and(Layer::is_stationary)
    }

    /// What is shown, if nothing was written into a layer since.
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, F> {
        &self.base.front
    }

    /// The base, as it is shown.
    #[must_use]
    pub const fn base(&self) -> &Controller<'p, F> {
        &self.base
    }

    /// The winner map of a layer: for each cell, the cell of the map before that the layer's *own* galpixel there came from, be it
    /// shown or not. Empty if none was lent or there is no such layer. Of an stationary layer the cells where galpixels are stored.
    #[must_use]
    pub fn winners(&self, layer: usize) -> &[u32] {
        match layer.checked_sub(1) {
            None => self.base.winners(),
            Some(hidden) => self.hidden.get(hidden).map(Layer::winners).unwrap_or_default(),
        }
    }

    /// The frame counter, see [`Controller::frame`].
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.base.frame
    }

    /// Sets the frame counter, see [`Controller::set_frame`].
    pub const fn set_frame(&mut self, frame: u32) {
        self.base.frame = frame;
    }

    /// Fills what the last step uncovered, and no layer had, by push-pull, see [`Controller::inpaint`].
    pub fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        self.base.inpaint(settings, inpainting, push_pull)
    }

    /// Fills what the last step uncovered, and no layer had, by metamers, see [`Controller::synthesise`].
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    pub fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        self.base.synthesise(settings, inpainting, metamer)
    }
}
