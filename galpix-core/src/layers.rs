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
//! seated. **Memory:** two maps and two bits a cell for each layer more; an anchored one three maps and a word a cell.

mod anchored;
mod layer;
mod seat;
mod shown;

pub use anchored::{Displacement, displacement_word};
pub use layer::{Layer, seat_words};

use crate::edge::{self, single::ones};
use crate::error::SetupError;
use crate::frame::{Controller, Inpainting, Settings, Work, fill_holes, move_on};
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::inpaint::map::OfGalpixel;
use crate::inpaint::metamer::{self, Recipe};
use crate::inpaint::pyramid::Pyramid;
use crate::layout::Layout;
use crate::tally::Tally;
use shown::Shown;

/// What a frame of several layers counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LayersTally<const HIDDEN: usize> {
    /// The base; its holes are the cells that no layer reached.
    pub base: Tally,
    /// Each further layer by itself; holes are the bullet holes that were filled in it.
    pub hidden: [Tally; HIDDEN],
    /// How many cells show a galpixel of each of them.
    pub shown: [u32; HIDDEN],
}

/// A base and `HIDDEN` further layers over the same grid and budget. With none of these it is a [`Controller`].
#[derive(Debug)]
pub struct Layers<'p, L, B, const HIDDEN: usize> {
    base: Controller<'p, L, B>,
    hidden: [Layer<'p, L, B>; HIDDEN],
    /// Whether the front maps hold what is shown, rather than each its own galpixels.
    seated: bool,
}

impl<'p, L: Layout, B: Budget<L>, const HIDDEN: usize> Layers<'p, L, B, HIDDEN> {
    /// A base and further layers, each with the maps that it already holds.
    ///
    /// *Errors:* a layer over another grid than the base's.
    pub fn new(base: Controller<'p, L, B>, hidden: [Layer<'p, L, B>; HIDDEN]) -> Result<Self, SetupError> {
        if hidden.iter().any(|layer| layer.front.grid() != base.front.grid()) {
            return Err(SetupError::GridsDiffer);
        }
        let mut layers = Self { base, hidden, seated: false };
        layers.resolve(Work::Skipping);
        Ok(layers)
    }

    /// Makes the next frame of all layers and shows it.
    pub fn step(&mut self, settings: &Settings) -> LayersTally<HIDDEN> {
        self.resolve(settings.work);
        self.take_back(settings.work);
        let Controller { front, back, scratch, frame } = &mut self.base;
        let mut tally = LayersTally { base: Tally::default(), hidden: [Tally::default(); HIDDEN], shown: [0; HIDDEN] };
        tally.base = move_on(front, back, scratch, settings, *frame);
        // Not zipped: that is walked by index, and an index is multiplied by the size of a layer.
        let mut tallies = tally.hidden.iter_mut();
        for layer in &mut self.hidden {
            let moved = layer.move_on(settings, *frame);
            layer.seat_back(back, settings.work);
            if let Some(tally) = tallies.next() {
                *tally = moved;
            }
        }
        let around = Shown { front, hidden: &self.hidden };
        fill_holes(&around, back, scratch, settings, &mut tally.base);
        core::mem::swap(front, back);
        *frame = frame.wrapping_add(1);
        for layer in &mut self.hidden {
            layer.swap();
        }
        self.seated = true;
        tally.shown = self.shown();
        tally
    }

    /// Decides anew what the front maps show; nothing if they show it already. An update that was written into a layer is seen
    /// from then on, and not only after the next step.
    pub fn resolve(&mut self, work: Work) {
        if !self.seated {
            for layer in &mut self.hidden {
                layer.draw(work);
                layer.seat_front(&mut self.base.front, work);
            }
            self.seated = true;
        }
    }

    /// Gives each layer its own galpixels back.
    fn take_back(&mut self, work: Work) {
        if self.seated {
            for layer in self.hidden.iter_mut().rev() {
                layer.take_back(&mut self.base.front, work);
            }
            self.seated = false;
        }
    }

    /// The galpixels of layer `layer` (0: the base), to write an update into; of an anchored layer those in the cells where they
    /// are stored. Nothing if there is no such layer. What is shown is decided anew by [`Self::resolve`], or before the next step.
    pub fn layer_mut(&mut self, layer: usize) -> Option<&mut Galpixmap<'p, L, B>> {
        self.take_back(Work::Skipping);
        match layer.checked_sub(1) {
            None => Some(&mut self.base.front),
            Some(hidden) => self.hidden.get_mut(hidden).map(Layer::stored_mut),
        }
    }

    /// The displacements of an anchored layer, a word for each cell, see [`displacement_word`]; else nothing.
    pub fn displacements_mut(&mut self, layer: usize) -> Option<&mut [u32]> {
        self.take_back(Work::Skipping);
        self.hidden.get_mut(layer.checked_sub(1)?)?.displacements_mut()
    }

    /// How many cells show each layer but the base.
    #[must_use]
    pub fn shown(&self) -> [u32; HIDDEN] {
        let mut counts = [0; HIDDEN];
        for index in 0..edge::words(self.base.front.grid()) {
            let mut taken = 0;
            for (layer, count) in self.hidden.iter().rev().zip(counts.iter_mut().rev()) {
                let seats = layer.seats().get(index).copied().unwrap_or(0);
                *count += ones(seats & !taken);
                taken |= seats;
            }
        }
        counts
    }

    /// Which layer a cell shows; 0, the base, also where it is empty.
    #[must_use]
    pub fn layer_at(&self, cell: u32) -> usize {
        self.hidden.iter().rposition(|layer| seat::bit(layer.seats(), cell) != 0).map_or(0, |hidden| hidden + 1)
    }

    /// Whether a layer is anchored, see [`Layer::anchored`].
    #[must_use]
    pub fn is_anchored(&self, layer: usize) -> bool {
        layer.checked_sub(1).and_then(|hidden| self.hidden.get(hidden)).is_some_and(Layer::is_anchored)
    }

    /// What is shown, if nothing was written into a layer since.
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, L, B> {
        &self.base.front
    }

    /// The base, as it is shown.
    #[must_use]
    pub const fn base(&self) -> &Controller<'p, L, B> {
        &self.base
    }

    /// The winner map of a layer: for each cell, the cell of the map before that the layer's *own* galpixel there came from, be it
    /// shown or not. Empty if none was lent or there is no such layer. Of an anchored layer the cells where galpixels are stored.
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
    pub fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        self.base.inpaint(settings, inpainting, pyramid)
    }

    /// Fills what the last step uncovered, and no layer had, by metamers, see [`Controller::synthesise`].
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    pub fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        recipe: &Recipe,
        scratch: &mut metamer::Scratch<'_>,
    ) -> Result<u32, SetupError> {
        self.base.synthesise(settings, inpainting, recipe, scratch)
    }
}
