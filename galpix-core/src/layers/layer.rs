//! One layer beside the base: its maps, and which cells of the base it has a seat in.

use crate::constant;
use crate::edge;
use crate::error::SetupError;
use crate::fill::fill_bullets;
use crate::frame::{Scratch, Settings, Work, move_on};
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::grid::Grid;
use crate::layers::anchored::Anchored;
use crate::layers::seat;
use crate::layout::Layout;
use crate::tally::Tally;

/// Words of memory for the seats of a layer: two bits a cell.
#[must_use]
pub const fn seat_words(grid: &Grid<'_>) -> usize {
    2 * edge::words(grid)
}

/// A layer beside the base.
#[derive(Debug)]
pub struct Layer<'p, L, B> {
    pub(super) front: Galpixmap<'p, L, B>,
    back: Galpixmap<'p, L, B>,
    scratch: Scratch<'p>,
    /// A bit for each cell of the base's front map: whether this layer has its seat there.
    seats: &'p mut [u32],
    /// The same for the map before.
    seats_before: &'p mut [u32],
    anchored: Option<Anchored<'p, L, B>>,
}

impl<'p, L: Layout, B: Budget<L>> Layer<'p, L, B> {
    /// A layer that moves like the base: two maps over the same grid, and [`seat_words`] for its seats.
    ///
    /// With a winner map it tells where its galpixels come from; with an edge map too it fills its own bullet holes, where the rung
    /// tells surfaces apart.
    ///
    /// *Errors:* grids that differ, scratch memory that is neither empty nor long enough, too few words for the seats.
    pub fn new(
        front: Galpixmap<'p, L, B>,
        back: Galpixmap<'p, L, B>,
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
    pub fn anchored(
        stored: Galpixmap<'p, L, B>,
        displacements: &'p mut [u32],
        front: Galpixmap<'p, L, B>,
        back: Galpixmap<'p, L, B>,
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
        let anchored = Some(Anchored { stored, displacements });
        Self::with(front, back, Scratch { winners, edges: &mut [] }, seats, anchored)
    }

    fn with(
        front: Galpixmap<'p, L, B>,
        back: Galpixmap<'p, L, B>,
        scratch: Scratch<'p>,
        seats: &'p mut [u32],
        anchored: Option<Anchored<'p, L, B>>,
    ) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        let (need, have) = (seat_words(front.grid()), seats.len());
        let halves = seats.get_mut(..need).and_then(|seats| {
            seats.fill(0);
            seats.split_at_mut_checked(need / 2)
        });
        let (seats, seats_before) = halves.ok_or(SetupError::TooShort { plane: "plane of seats", need, have })?;
        Ok(Self { front, back, scratch, seats, seats_before, anchored })
    }

    /// Makes the back map from the front map, or draws it from what is stored. From then on the seats are those of the frame
    /// before.
    pub(super) fn move_on(&mut self, settings: &Settings, frame: u32) -> Tally {
        core::mem::swap(&mut self.seats, &mut self.seats_before);
        let Self { front, back, scratch, anchored, .. } = self;
        if let Some(anchored) = anchored {
            let thresholds = Some((settings.rounding, frame));
            return anchored.draw(back, scratch.winners, thresholds, settings.work);
        }
        let mut tally = move_on(front, back, scratch, settings, frame);
        if settings.rung.tells_surfaces() && !scratch.edges.is_empty() && !scratch.winners.is_empty() {
            let (winners, reach) = (&mut *scratch.winners, settings.reach);
            match settings.work {
                Work::Skipping => fill_bullets(back, winners, scratch.edges, reach, &mut tally),
                Work::Constant => constant::fill_bullets(back, winners, scratch.edges, reach, &mut tally),
            }
        }
        tally
    }

    /// Takes seats in the base's back map.
    pub(super) fn seat_back(&mut self, base: &mut Galpixmap<'p, L, B>, work: Work) {
        seat::take(base, &mut self.back, self.seats, work);
    }

    /// Takes seats in the base's front map.
    pub(super) fn seat_front(&mut self, base: &mut Galpixmap<'p, L, B>, work: Work) {
        seat::take(base, &mut self.front, self.seats, work);
    }

    /// Leaves its seats in the base's front map; which these were stays known.
    pub(super) fn take_back(&mut self, base: &mut Galpixmap<'p, L, B>, work: Work) {
        seat::leave(base, &mut self.front, self.seats, work);
    }

    /// Draws the front map from what is stored, if anything is.
    pub(super) fn draw(&mut self, work: Work) {
        if let Some(anchored) = &mut self.anchored {
            anchored.draw(&mut self.front, self.scratch.winners, None, work);
        }
    }

    /// Shows what was made.
    pub(super) fn swap(&mut self) {
        core::mem::swap(&mut self.front, &mut self.back);
    }

    /// Where the layer's galpixels are stored.
    pub(super) fn stored_mut(&mut self) -> &mut Galpixmap<'p, L, B> {
        match &mut self.anchored {
            Some(anchored) => &mut anchored.stored,
            None => &mut self.front,
        }
    }

    pub(super) fn displacements_mut(&mut self) -> Option<&mut [u32]> {
        self.anchored.as_mut().map(|Anchored { displacements, .. }| &mut **displacements)
    }

    pub(super) const fn is_anchored(&self) -> bool {
        self.anchored.is_some()
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
