//! One layer beside the base: its maps, and which cells of the base it has a seat in.

use crate::error::SetupError;
use crate::fast;
use crate::format::Format;
use crate::frame::edge;
use crate::frame::tally::Tally;
use crate::frame::{Scratch, Settings, move_on, reference};
use crate::layers::seat;
use crate::layers::stationary::Stationary;
use crate::map::Galpixmap;
use crate::map::grid::Grid;

/// Words of memory for the seats of a layer: two bits a cell.
#[must_use]
pub const fn composite_words(grid: &Grid<'_>) -> usize {
    2 * edge::words(grid)
}

/// A layer beside the base.
#[derive(Debug)]
pub struct Layer<'p, F> {
    pub(super) front: Galpixmap<'p, F>,
    back: Galpixmap<'p, F>,
    scratch: Scratch<'p>,
    /// A bit for each cell of the base's front map: whether this layer has its seat there.
    seats: &'p mut [u32],
    /// The same for the map before.
    seats_before: &'p mut [u32],
    stationary: Option<Stationary<'p, F>>,
    pub(super) tally: Tally,
    pub(super) shown: u32,
}

impl<'p, F: Format> Layer<'p, F> {
    /// A layer that moves like the base: two maps over the same grid, and [`composite_words`] for its seats.
    ///
    /// With a winner map it tells where its galpixels come from; with an edge map too it fills its own bullet holes, where the fill_mode
    /// tells surfaces apart.
    ///
    /// *Errors:* grids that differ, scratch memory that is neither empty nor long enough, too few words for the seats.
    pub fn new(
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        scratch: Scratch<'p>,
        seats: &'p mut [u32],
    ) -> Result<Self, SetupError> {
        Self::with(front, back, scratch, seats, None)
    }

    /// A layer whose galpixels stay in the cells where they are stored, know their displacement from there, and are drawn anew in each
    /// frame, so that none is ever lost: `stored` holds them, `displacements` a word for each cell ([`super::displacement_word`]), `front` and `back` what
    /// is drawn. Bullet holes are not filled.
    ///
    /// *Errors:* as [`Self::new`], and too few words for the displacements.
    pub fn stationary(
        stored: Galpixmap<'p, F>,
        displacements: &'p mut [u32],
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        winners: &'p mut [u32],
        seats: &'p mut [u32],
    ) -> Result<Self, SetupError> {
        let (need, have) = (stored.grid().cells() as usize, displacements.len());
        if stored.grid() != front.grid() {
            return Err(SetupError::GridsDiffer);
        }
        if have < need {
            return Err(SetupError::TooShort { plane: "plane of displacements", need, have });
        }
        let stationary = Some(Stationary { stored, displacements });
        Self::with(front, back, Scratch { winners, edges: &mut [] }, seats, stationary)
    }

    fn with(
        front: Galpixmap<'p, F>,
        back: Galpixmap<'p, F>,
        scratch: Scratch<'p>,
        seats: &'p mut [u32],
        stationary: Option<Stationary<'p, F>>,
    ) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        let (need, have) = (composite_words(front.grid()), seats.len());
        let halves = seats.get_mut(..need).and_then(|seats| {
            seats.fill(0);
            seats.split_at_mut_checked(need / 2)
        });
        let (seats, seats_before) = halves.ok_or(SetupError::TooShort { plane: "plane of seats", need, have })?;
        Ok(Self { front, back, scratch, seats, seats_before, stationary, tally: Tally::default(), shown: 0 })
    }

    /// Makes the back map from the front map, or draws it from what is stored. From then on the seats are those of the frame
    /// before.
    pub(super) fn move_on<const CONSTANT_TIME: bool>(&mut self, settings: &Settings, frame: u32) -> Tally {
        core::mem::swap(&mut self.seats, &mut self.seats_before);
        let Self { front, back, scratch, stationary, .. } = self;
        if let Some(stationary) = stationary {
            let thresholds = Some((settings.rounding, frame));
            return stationary.draw::<CONSTANT_TIME>(back, scratch.winners, thresholds);
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

    /// Takes seats in the base's back map.
    pub(super) fn seat_back<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        seat::take::<F, CONSTANT_TIME>(base, &mut self.back, self.seats);
    }

    /// Takes seats in the base's front map.
    pub(super) fn seat_front<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        seat::take::<F, CONSTANT_TIME>(base, &mut self.front, self.seats);
    }

    /// Leaves its seats in the base's front map; which these were stays known.
    pub(super) fn take_back<const CONSTANT_TIME: bool>(&mut self, base: &mut Galpixmap<'p, F>) {
        seat::leave::<F, CONSTANT_TIME>(base, &mut self.front, self.seats);
    }

    /// Draws the front map from what is stored, if anything is.
    pub(super) fn draw<const CONSTANT_TIME: bool>(&mut self) {
        if let Some(stationary) = &mut self.stationary {
            stationary.draw::<CONSTANT_TIME>(&mut self.front, self.scratch.winners, None);
        }
    }

    /// Returns what the last step counted in this layer by itself; holes are the bullet holes that were filled in it.
    #[must_use]
    pub const fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Returns how many cells show a galpixel of this layer since the last step.
    #[must_use]
    pub const fn shown(&self) -> u32 {
        self.shown
    }

    /// Shows what was made.
    pub(super) fn swap(&mut self) {
        core::mem::swap(&mut self.front, &mut self.back);
    }

    /// Where the layer's galpixels are stored.
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

    pub(super) fn seats(&self) -> &[u32] {
        self.seats
    }

    pub(super) fn seats_before(&self) -> &[u32] {
        self.seats_before
    }
}
