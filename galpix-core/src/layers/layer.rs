//! One hidden layer: its maps, and a mask of the cells in which it is composited with the base.

use crate::error::SetupError;
use crate::fast;
use crate::format::Format;
use crate::frame::edge;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings, move_on, reference};
use crate::layers::composite;
use crate::layers::stationary::Stationary;
use crate::map::Galpixmap;
use crate::map::grid::Grid;

/// Returns the words of a layer's composite masks: one bit per cell for the current frame and one for the frame before.
#[must_use]
pub const fn composite_words(grid: &Grid<'_>) -> usize {
    2 * edge::words(grid)
}

/// A hidden layer: any layer but the base.
#[derive(Debug)]
pub struct Layer<'p, F> {
    pub(super) front: Galpixmap<'p, F>,
    back: Galpixmap<'p, F>,
    scratch: Scratch<'p>,
    /// One bit per cell: whether the galpixels of this layer and of the base have changed places.
    composited: &'p mut [u32],
    /// The same for the frame before.
    composited_before: &'p mut [u32],
    stationary: Option<Stationary<'p, F>>,
    pub(super) tally: Tally,
    pub(super) shown: u32,
}

impl<'p, F: Format> Layer<'p, F> {
    /// Creates a layer that moves like the base from two maps over the same grid and [`composite_words`] words for its
    /// composite masks, whatever these hold.
    ///
    /// With a winner map it reports where its galpixels come from. With an edge map too it fills its own bullet holes,
    /// in the fill modes that separate surfaces.
    ///
    /// *Errors:* grids that differ, scratch memory that is neither empty nor long enough, too few words in
    /// `composited`.
    pub fn new(
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        scratch: Scratch<'p>,
        composited: &'p mut [u32],
    ) -> Result<Self, SetupError> {
        Self::with(front, back, scratch, composited, None)
    }

    /// Creates a stationary-source layer: its galpixels stay in the cells where they are stored, and each frame draws
    /// them anew into `front` and `back`, at their displacements. So no galpixel is ever lost. Bullet holes are not
    /// filled.
    ///
    /// `winners` is a winner map or empty; `composited` as in [`Self::new`].
    ///
    /// *Errors:* as [`Self::new`], and too few words for the displacements.
    pub fn stationary(
        stationary: Stationary<'p, F>,
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        winners: &'p mut [u32],
        composited: &'p mut [u32],
    ) -> Result<Self, SetupError> {
        let (need, have) = (stationary.stored.grid().cells() as usize, stationary.displacements.len());
        if stationary.stored.grid() != front.grid() {
            return Err(SetupError::GridsDiffer);
        }
        if have < need {
            return Err(SetupError::TooShort { plane: "plane of displacements", need, have });
        }
        Self::with(front, back, Scratch { winners, edges: &mut [] }, composited, Some(stationary))
    }

    fn with(
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        scratch: Scratch<'p>,
        composited: &'p mut [u32],
        stationary: Option<Stationary<'p, F>>,
    ) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        let (need, have) = (composite_words(front.grid()), composited.len());
        let halves = composited.get_mut(..need).and_then(|composited| {
            composited.fill(0);
            composited.split_at_mut_checked(need / 2)
        });
        let (composited, composited_before) =
            halves.ok_or(SetupError::TooShort { plane: "plane of composite masks", need, have })?;
        Ok(Self { front, back, scratch, composited, composited_before, stationary, tally: Tally::default(), shown: 0 })
    }

    /// Makes the back map from the front map, or draws it from the stored galpixels. The composite mask becomes that of
    /// the frame before.
    pub(super) fn move_on<const CONSTANT_TIME: bool>(&mut self, settings: &Settings, frame: u32) -> Tally {
        core::mem::swap(&mut self.composited, &mut self.composited_before);
        let Self { front, back, scratch, stationary, .. } = self;
        if let Some(stationary) = stationary {
            let step = Some((settings.rounding, frame));
            return stationary.draw::<CONSTANT_TIME>(back, scratch.winners, step);
        }
        let mut tally = move_on::<F, CONSTANT_TIME>(front, back, scratch, settings, frame);
        if settings.fill_mode.uses_edges() && !scratch.edges.is_empty() && !scratch.winners.is_empty() {
            if CONSTANT_TIME {
                reference::fill_bullets(back, scratch, settings.reach, &mut tally);
            } else {
                fast::fill_bullets(back, scratch, settings.reach, &mut tally);
            }
        }
        tally
    }

    /// Composites the back map with the base's.
    pub(super) fn composite_back<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        self.shown = 0;
        composite::composite::<F, CONSTANT_TIME>(base, &mut self.back, self.composited);
    }

    /// Composites the front map with the base's.
    pub(super) fn composite_front<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        self.shown = 0;
        composite::composite::<F, CONSTANT_TIME>(base, &mut self.front, self.composited);
    }

    /// Undoes the compositing of the front map; the mask of the cells stays.
    pub(super) fn restore<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        composite::restore::<F, CONSTANT_TIME>(base, &mut self.front, self.composited);
    }

    /// Draws the front map from the stored galpixels, if the layer has any.
    pub(super) fn draw<const CONSTANT_TIME: bool>(&mut self) {
        if let Some(stationary) = &mut self.stationary {
            stationary.draw::<CONSTANT_TIME>(&mut self.front, self.scratch.winners, None);
        }
    }

    /// Returns what the last step counted in this layer by itself; `holes` are the bullet holes that were filled in it.
    #[must_use]
    pub const fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Returns the number of cells in which this layer is seen, since the last step or
    /// [`Layers::composite`](super::Layers::composite).
    #[must_use]
    pub const fn shown(&self) -> u32 {
        self.shown
    }

    /// Exchanges the front and the back map.
    pub(super) fn swap(&mut self) {
        core::mem::swap(&mut self.front, &mut self.back);
    }

    /// Returns the map in which the layer's galpixels are stored.
    pub(super) fn stored_mut(&mut self) -> &mut Galpixmap<'p, F> {
        match &mut self.stationary {
            Some(stationary) => &mut stationary.stored,
            None => &mut self.front,
        }
    }

    pub(super) fn displacements_mut(&mut self) -> Option<&mut [u32]> {
        self.stationary.as_mut().map(|Stationary { displacements, .. }| &mut **displacements)
    }

    pub(super) const fn is_stationary(&self) -> bool {
        self.stationary.is_some()
    }

    pub(super) fn winners(&self) -> &[u32] {
        self.scratch.winners
    }

    pub(super) fn composited(&self) -> &[u32] {
        self.composited
    }

    pub(super) fn composited_before(&self) -> &[u32] {
        self.composited_before
    }
}
