//! One frame: the stages in their order, and the swap.

pub mod edge;
pub mod fill;
pub mod reference;
pub mod resolve;
pub mod step;
pub mod tally;

use crate::error::SetupError;
use crate::fast;
use crate::format::Format;
use crate::format::rounding::Rounding;
use crate::inpaint::{Inpainting, Metamer, PushPull};
use crate::map::Galpixmap;
use fill::{Around, FillMode};
use tally::Tally;

/// What a frame is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// How positions are rounded.
    pub rounding: Rounding,
    /// What is put into holes.
    pub fill_mode: FillMode,
    /// The Laplacian beyond which a cell is on an edge, in units of the depth's last bit.
    pub edge_threshold: u32,
    /// Rounds of bullet filling, 1 to 16.
    pub reach: u32,
}

impl Settings {
    /// Returns low-discrepancy rounding, the richest fill mode, one round of bullet filling, and an edge threshold for depths
    /// of `depth_bits` bits that are linear in inverse distance.
    #[must_use]
    pub const fn for_depth(depth_bits: u32) -> Self {
        Self {
            rounding: Rounding::LowDiscrepancy,
            fill_mode: FillMode::Extend,
            edge_threshold: edge::threshold_for_depth(depth_bits),
            reach: 1,
        }
    }
}

/// Memory that a frame needs beside its two maps. Rungs that do not tell surfaces apart need none: lend empty slices. Lent to
/// another fill_mode, they leave out what it is for: without both no hole is a bullet hole, and without an edge map no edge is
/// looked for or counted.
#[derive(Debug, Default)]
pub struct Scratch<'s> {
    /// Who won each cell: a word for each cell.
    pub winners: &'s mut [u32],
    /// The edge map: [`edge::words`] words.
    pub edges: &'s mut [u32],
}

impl Scratch<'_> {
    /// Whether each of the two is empty or has the words that are needed.
    pub(crate) fn check(&self, winners: u32, edges: usize) -> Result<(), SetupError> {
        let enough = |plane, have: usize, need: usize| {
            if have == 0 || have >= need { Ok(()) } else { Err(SetupError::TooShort { plane, need, have }) }
        };
        enough("winner map", self.winners.len(), winners as usize)?;
        enough("edge map", self.edges.len(), edges)
    }
}

/// Two maps that take turns: the front one is shown while the back one is made from it.
#[derive(Debug)]
pub struct Controller<'p, F> {
    pub(crate) front: Galpixmap<'p, F>,
    pub(crate) back: Galpixmap<'p, F>,
    pub(crate) scratch: Scratch<'p>,
    pub(crate) frame: u32,
}

impl<'p, F: Format> Controller<'p, F> {
    /// Two maps over the same grid, and scratch memory for the rungs that will be used.
    ///
    /// *Errors:* grids that differ, or scratch memory that is neither empty nor long enough.
    pub fn new(front: Galpixmap<'p, F>, back: Galpixmap<'p, F>, scratch: Scratch<'p>) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        Ok(Self { front, back, scratch, frame: 0 })
    }

    /// Makes the next frame and shows it. Work depends on the picture: what it does not need is skipped.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        let tally = F::step(&self.front, &mut self.back, &mut self.scratch, settings, self.frame);
        self.swap();
        tally
    }

    /// Makes the next frame and shows it, by instructions that do not depend on the picture. Same arguments, same bits as
    /// [`Self::step`].
    pub fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        let tally = F::step_constant_time(&self.front, &mut self.back, &mut self.scratch, settings, self.frame);
        self.swap();
        tally
    }

    fn swap(&mut self) {
        core::mem::swap(&mut self.front, &mut self.back);
        self.frame = self.frame.wrapping_add(1);
    }

    /// Fills what the last step uncovered, by push-pull: how many cells. The step must have been made with `settings`, whose
    /// fill mode is [`FillMode::Extend`]; with any other one there may be nothing to fill.
    ///
    /// Of push-pull for another size than the map's, only what lies within both is filled.
    pub fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        self.lay_background(settings, inpainting);
        F::push_pull(&mut self.front, inpainting, push_pull)
    }

    /// Fills what the last step uncovered by metamers: as [`Self::inpaint`], with a texture. How long the picture has moved is
    /// the frame counter, which [`Self::set_frame`] sets to 0 with an update.
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    pub fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        self.lay_background(settings, inpainting);
        F::metamers(&mut self.front, inpainting, metamer, self.frame)
    }

    /// Gives the holes the depth of the background, where that is asked for.
    fn lay_background(&mut self, settings: &Settings, inpainting: &Inpainting<'_>) {
        if inpainting.quads {
            let frame = self.frame.wrapping_sub(1);
            F::lay_background(&self.back, &mut self.front, self.scratch.edges, settings.rounding, frame);
        }
    }

    /// The map that is shown.
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, F> {
        &self.front
    }

    /// The map that is shown, to write an update into.
    pub const fn front_mut(&mut self) -> &mut Galpixmap<'p, F> {
        &mut self.front
    }

    /// The frame counter: frames made since it was set; wraps.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Sets the frame counter, from which the thresholds of the rounding are taken. Where an update replaces the whole map,
    /// 0 aligns a searched table with it; the other roundings have the same bounds from any frame on.
    pub const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }

    /// For each cell of the shown map, the cell of the map before that it came from; see [`crate::frame::resolve::NO_WINNER`] and
    /// [`crate::frame::fill::FILLED`]. Empty if no winner map was lent, stale for rungs that do not need one.
    #[must_use]
    pub const fn winners(&self) -> &[u32] {
        self.scratch.winners
    }

    /// The edge map of the map before; see [`edge::on_edge`].
    #[must_use]
    pub const fn edges(&self) -> &[u32] {
        self.scratch.edges
    }
}

/// Makes `back` the frame after `front`, whose frame counter is `frame`. The entry point of the mode `CONSTANT_TIME`.
pub(crate) fn make<F: Format, const CONSTANT_TIME: bool>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    let mut tally = move_on::<F, CONSTANT_TIME>(front, back, scratch, settings, frame);
    fill_holes::<F, CONSTANT_TIME>(front, back, scratch, settings, &mut tally);
    tally
}

/// Makes the edge map of `front`, propagates and resolves: `back` is left with its holes.
#[inline(always)]
pub(crate) fn move_on<F: Format, const CONSTANT_TIME: bool>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    let surfaces = settings.fill_mode.uses_edges() && !scratch.edges.is_empty();
    let edges = match CONSTANT_TIME {
        _ if !surfaces => 0,
        false => fast::mark(front, settings.edge_threshold, scratch.edges),
        true => fast::mark_constant_time(front, settings.edge_threshold, scratch.edges),
    };
    let (winners, rounding) = (&mut *scratch.winners, settings.rounding);
    let tally = if CONSTANT_TIME {
        reference::sweep(front, back, winners, rounding, frame)
    } else {
        fast::sweep(front, back, winners, rounding, frame)
    };
    Tally { edges, ..tally }
}

/// Fills what was left empty.
#[inline(always)]
pub(crate) fn fill_holes<F: Format, const CONSTANT_TIME: bool>(
    around: &impl Around,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    if CONSTANT_TIME {
        reference::fill(around, back, scratch, settings, tally);
    } else {
        fast::fill(around, back, scratch, settings, tally);
    }
}
