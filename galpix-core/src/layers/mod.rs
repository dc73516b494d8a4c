//! Layers: galpixmaps that move independently and are shown together, so that what is covered now can reappear.
//!
//! Within a map a collision is final: the galpixel that loses is gone. A layer is a map of its own. Between layers each
//! frame resolves anew which galpixel a cell shows: the smallest by (class, depth, layer). So a second surface behind
//! the first, an object that passes behind another one, or samples that a renderer sends because they are about to be
//! uncovered wait in their layer until they are seen.
//!
//! Layer 0, the *base*, is a [`Controller`]; the others are *hidden layers*, whether they are seen or not. The base's
//! map is the picture. Where a galpixel of a hidden layer is nearer, the two change places: the layer is *composited*
//! with the base there, and a bit records it. Before the layers move, they are *restored*: the galpixels change back.
//! So the edge map, the fill modes, inpainting and scan-out work on the picture as they do without layers, and cells in
//! which nothing is composited cost no exchange. What fills a hole belongs to the base. Between layers the depth alone
//! decides: what is covered stays in its layer.
//!
//! ```text
//!             ┌ front 0 ─▶ edge, sweep ───▶ back 0 ─┐
//! restore ──▶ ┤ front 1 ─▶ sweep, bullets ▶ back 1 ─┼─ composite ─▶ fill ─▶ inpaint, scan-out
//!             └ front 2 ─▶ …                        ┘
//! ```
//!
//! Holes are transparent in hidden layers. A hidden layer with scratch memory fills its own bullet holes, so that
//! nothing shows through the cracks of an object that comes nearer.
//!
//! *Cost* per frame: a sweep per layer; per hidden layer also a comparison per cell and two exchanges per composited
//! cell.
//!
//! *Memory* per hidden layer: two maps and two bits per cell; a stationary-source layer three maps, two bits and one
//! word a cell.

mod composite;
mod layer;
mod shown;
mod stationary;

pub use layer::{Layer, composite_words};
pub(crate) use stationary::displacement;
pub use stationary::{Displacement, Stationary, displacement_word};

use crate::error::SetupError;
use crate::format::Format;
use crate::frame::edge;
use crate::frame::tally::Tally;
use crate::frame::{Controller, Settings, fill_holes, move_on};
use crate::inpaint::{Inpainting, Metamer, PushPull};
use crate::map::Galpixmap;
use shown::Shown;

/// A base and hidden layers over the same grid and format. Without hidden layers it acts as a [`Controller`].
#[derive(Debug)]
pub struct Layers<'p, 'l, F> {
    base: Controller<'p, F>,
    hidden: &'l mut [Layer<'p, F>],
    /// Whether the front maps are composited; otherwise each holds its own galpixels.
    composited: bool,
}

/// Makes the next frame of all layers, in constant time or data-dependent.
pub(crate) fn make<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>, settings: &Settings) -> Tally {
    composite::<F, CONSTANT_TIME>(layers);
    restore::<F, CONSTANT_TIME>(layers);
    let Controller { front, back, scratch, frame } = &mut layers.base;
    let mut tally = move_on::<F, CONSTANT_TIME>(front, back, scratch, settings, *frame);
    for layer in layers.hidden.iter_mut() {
        layer.tally = layer.move_on::<CONSTANT_TIME>(settings, *frame);
        layer.composite_back::<CONSTANT_TIME>(back);
    }
    let around = Shown { front, hidden: layers.hidden };
    fill_holes::<F, CONSTANT_TIME>(&around, back, scratch, settings, &mut tally);
    core::mem::swap(front, back);
    *frame = frame.wrapping_add(1);
    for layer in layers.hidden.iter_mut() {
        layer.swap();
    }
    layers.composited = true;
    layers.count_shown();
    tally
}

/// Composites the front maps, unless they are composited.
pub(crate) fn composite<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>) {
    if !layers.composited {
        for layer in layers.hidden.iter_mut() {
            layer.draw::<CONSTANT_TIME>();
            layer.composite_front::<CONSTANT_TIME>(&mut layers.base.front);
        }
        layers.composited = true;
    }
}

/// Restores the front maps, if they are composited: each then holds its own galpixels.
pub(crate) fn restore<F: Format, const CONSTANT_TIME: bool>(layers: &mut Layers<'_, '_, F>) {
    if layers.composited {
        for layer in layers.hidden.iter_mut().rev() {
            layer.restore::<CONSTANT_TIME>(&mut layers.base.front);
        }
        layers.composited = false;
    }
}

impl<'p, 'l, F: Format> Layers<'p, 'l, F> {
    /// Creates layers from a base and hidden layers, each with the galpixels that its maps hold, and composites them.
    ///
    /// *Errors:* a layer over another grid than the base's.
    pub fn new(base: Controller<'p, F>, hidden: &'l mut [Layer<'p, F>]) -> Result<Self, SetupError> {
        if hidden.iter().any(|layer| layer.front.grid() != base.front.grid()) {
            return Err(SetupError::GridsDiffer);
        }
        let mut layers = Self { base, hidden, composited: false };
        layers.composite();
        Ok(layers)
    }

    /// Makes the next frame of all layers and shows it. Data-dependent: the work depends on the picture.
    ///
    /// Returns the counts of the base, whose holes are the cells that no layer reached; [`Layer::tally`] has those of
    /// each hidden layer.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        F::layers_step(self, settings)
    }

    /// Makes the next frame of all layers and shows it, in constant time: the instructions do not depend on the
    /// picture. The result equals that of [`Self::step`] bit by bit.
    pub fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        F::layers_step_constant_time(self, settings)
    }

    /// Composites the front maps anew after an update was written into a layer, so that the update is seen before the
    /// next step. Does nothing if no layer was written to.
    pub fn composite(&mut self) {
        if !self.composited {
            F::layers_composite(self);
            self.count_shown();
        }
    }

    /// Returns the hidden layers; layer 1 comes first.
    #[must_use]
    pub fn hidden(&self) -> &[Layer<'p, F>] {
        self.hidden
    }

    /// Returns the galpixels of layer `layer` (0: the base), to write an update into; those of a stationary-source
    /// layer in the cells where they are stored. Returns `None` if there is no such layer.
    ///
    /// Restores the layers: the picture is complete again after [`Self::composite`] or the next step.
    pub fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, F>> {
        F::layers_restore(self);
        match layer.checked_sub(1) {
            None => Some(&mut self.base.front),
            Some(hidden) => self.hidden.get_mut(hidden).map(Layer::stored_mut),
        }
    }

    /// Returns the displacements of a stationary-source layer, a word for each cell (see [`displacement_word`]); `None`
    /// for any other layer. Restores the layers, as [`Self::layer_mut`].
    pub fn displacements_mut(&mut self, layer: usize) -> Option<&mut [u32]> {
        F::layers_restore(self);
        self.hidden.get_mut(layer.checked_sub(1)?)?.displacements_mut()
    }

    /// Counts the cells in which each hidden layer is seen. Compositing has set the counts to 0.
    fn count_shown(&mut self) {
        for index in 0..edge::words(self.base.front.grid()) {
            let mut taken = 0;
            // A loop over `iter_mut().rev()` is unrolled by rustc 1.95 for thumbv6m-none-eabi, which finds the number
            // of its rounds as the distance of two pointers by the size of a layer: `__aeabi_uidiv`. A slice has its
            // length.
            let mut rest = &mut *self.hidden;
            while let Some((layer, before)) = rest.split_last_mut() {
                let composited = layer.composited().get(index).copied().unwrap_or(0);
                layer.shown += (composited & !taken).count_ones();
                taken |= composited;
                rest = before;
            }
        }
    }

    /// Returns the layer that a cell shows; 0, the base, also where the cell is empty or outside of the map.
    #[must_use]
    pub fn layer_at(&self, cell: u32) -> usize {
        self.hidden.iter().rposition(|layer| composite::is_set(layer.composited(), cell)).map_or(0, |hidden| hidden + 1)
    }

    /// Returns whether a layer is a stationary-source layer, see [`Layer::stationary`].
    pub(crate) fn is_stationary(&self, layer: usize) -> bool {
        layer.checked_sub(1).and_then(|hidden| self.hidden.get(hidden)).is_some_and(Layer::is_stationary)
    }

    /// Returns the picture, unless a layer was written to since the last step or [`Self::composite`].
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, F> {
        &self.base.front
    }

    /// Returns the base, whose front map is the picture.
    #[must_use]
    pub const fn base(&self) -> &Controller<'p, F> {
        &self.base
    }

    /// Returns the winner map of a layer: for each cell the cell of the frame before that the layer's *own* galpixel
    /// there came from, seen or not; in a stationary-source layer the cell where it is stored.
    ///
    /// Empty if no winner map was provided or there is no such layer.
    #[must_use]
    pub fn winners(&self, layer: usize) -> &[u32] {
        match layer.checked_sub(1) {
            None => self.base.winners(),
            Some(hidden) => self.hidden.get(hidden).map(Layer::winners).unwrap_or_default(),
        }
    }

    /// Returns the frame counter, see [`Controller::frame`].
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.base.frame
    }

    /// Sets the frame counter, see [`Controller::set_frame`].
    pub const fn set_frame(&mut self, frame: u32) {
        self.base.frame = frame;
    }

    /// Fills by push-pull what the last step uncovered and no layer holds, see [`Controller::inpaint`]. Returns the
    /// number of cells filled.
    pub fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        self.base.inpaint(settings, inpainting, push_pull)
    }

    /// Fills by metamers what the last step uncovered and no layer holds, see [`Controller::synthesise`]. Returns the
    /// number of cells filled.
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
