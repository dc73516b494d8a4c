//! A frame: its stages in their order, and the swap of the two maps.

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

/// The parameters of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// How positions are rounded.
    pub rounding: Rounding,
    /// How holes are filled.
    pub fill_mode: FillMode,
    /// The largest absolute Laplacian inside a surface, in units of the depth's last bit; beyond it a cell is on an
    /// edge.
    pub edge_threshold: u32,
    /// Rounds of bullet filling, clamped to 1 to 16.
    pub reach: u32,
}

impl Settings {
    /// Returns low-discrepancy rounding, the richest fill mode, one round of bullet filling, and an edge threshold for
    /// depths of `depth_bits` bits that are linear in inverse distance.
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

/// Caller-provided buffers that a frame needs in addition to its maps. Each is empty or has all the words that it
/// needs.
///
/// Fill modes that do not use edges ([`FillMode::uses_edges`]) need neither. With other fill modes, no hole is a bullet
/// hole unless both are provided, and without an edge map edges are neither marked nor counted.
#[derive(Debug, Default)]
pub struct Scratch<'s> {
    /// The winner map, a word for each cell: the cell of the map before from which the cell's galpixel came.
    pub winners: &'s mut [u32],
    /// The edge map, [`edge::words`] words.
    pub edges: &'s mut [u32],
}

impl Scratch<'_> {
    /// Checks that each buffer is empty or has at least so many words.
    ///
    /// *Errors:* a buffer that is neither.
    pub(crate) fn check(&self, winners: u32, edges: usize) -> Result<(), SetupError> {
        let enough = |plane, have: usize, need: usize| {
            if have == 0 || have >= need { Ok(()) } else { Err(SetupError::TooShort { plane, need, have }) }
        };
        enough("winner map", self.winners.len(), winners as usize)?;
        enough("edge map", self.edges.len(), edges)
    }
}

/// Makes frames with two maps that it swaps: the front map is shown while the back map is made from it.
#[derive(Debug)]
pub struct Controller<'p, F> {
    pub(crate) front: Galpixmap<'p, F>,
    pub(crate) back: Galpixmap<'p, F>,
    pub(crate) scratch: Scratch<'p>,
    pub(crate) frame: u32,
}

impl<'p, F: Format> Controller<'p, F> {
    /// Makes a controller of two maps over equal grids, with the scratch buffers that the fill modes in use need.
    ///
    /// *Errors:* different grids, or a scratch buffer that is neither empty nor long enough.
    pub fn new(front: Galpixmap<'p, F>, back: Galpixmap<'p, F>, scratch: Scratch<'p>) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        Ok(Self { front, back, scratch, frame: 0 })
    }

    /// Makes the next frame and swaps the maps. Which instructions are executed depends on the picture.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        let tally = F::step(&self.front, &mut self.back, &mut self.scratch, settings, self.frame);
        self.swap();
        tally
    }

    /// Makes the next frame and swaps the maps, by instructions that do not depend on the picture. The result is that
    /// of [`Self::step`], bit by bit.
    pub fn step_constant_time(&mut self, settings: &Settings) -> Tally {
        let tally = F::step_constant_time(&self.front, &mut self.back, &mut self.scratch, settings, self.frame);
        self.swap();
        tally
    }

    /// Swaps the maps and advances the frame counter.
    fn swap(&mut self) {
        core::mem::swap(&mut self.front, &mut self.back);
        self.frame = self.frame.wrapping_add(1);
    }

    /// Inpaints the cells that the last step unobscured, by push-pull; returns how many. `settings` must be those of
    /// the last step, with [`FillMode::Extend`]; with other fill modes there may be no cells to inpaint.
    ///
    /// If the sizes of push-pull and map differ, only the cells within both are inpainted.
    pub fn inpaint(&mut self, settings: &Settings, inpainting: &Inpainting<'_>, push_pull: &mut PushPull<'_>) -> u32 {
        self.lay_background(settings, inpainting);
        F::push_pull(&mut self.front, inpainting, push_pull)
    }

    /// Inpaints the cells that the last step unobscured by metamers: as [`Self::inpaint`], with a texture. How long the
    /// picture has moved is the frame counter, which should be set to 0 with each update, see [`Self::set_frame`].
    ///
    /// *Errors:* a scratch buffer that is too short for the map; then no cell is changed.
    pub fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
    ) -> Result<u32, SetupError> {
        self.lay_background(settings, inpainting);
        F::metamers(&mut self.front, inpainting, metamer, self.frame)
    }

    /// Gives the holes of the last step the depth of the background, if `inpainting` says so.
    fn lay_background(&mut self, settings: &Settings, inpainting: &Inpainting<'_>) {
        if inpainting.quads {
            let frame = self.frame.wrapping_sub(1);
            F::lay_background(&self.back, &mut self.front, self.scratch.edges, settings.rounding, frame);
        }
    }

    /// Returns the map that is shown.
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, F> {
        &self.front
    }

    /// Returns the map that is shown, for writing an update into it.
    pub const fn front_mut(&mut self) -> &mut Galpixmap<'p, F> {
        &mut self.front
    }

    /// Returns the frame counter, which counts the frames since it was set and wraps.
    #[must_use]
    pub const fn frame(&self) -> u32 {
        self.frame
    }

    /// Sets the frame counter, which selects the thresholds of the rounding. If an update replaces the whole map, 0
    /// aligns a searched table with it; the other roundings have the same error bounds from any frame on.
    pub const fn set_frame(&mut self, frame: u32) {
        self.frame = frame;
    }

    /// Returns the winner map of the shown map: for each cell, the cell of the map before from which its galpixel came;
    /// see [`crate::stages::NO_WINNER`] and [`crate::stages::FILLED`]. Empty if no winner map was provided.
    #[must_use]
    pub const fn winners(&self) -> &[u32] {
        self.scratch.winners
    }

    /// Returns the edge map of the map before, see [`crate::stages::on_edge`]. Empty if none was provided.
    #[must_use]
    pub const fn edges(&self) -> &[u32] {
        self.scratch.edges
    }
}

/// Makes `back` the frame after `front`, whose frame counter is `frame`. With `CONSTANT_TIME` the instructions do not
/// depend on the picture.
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

/// Marks the edges of `front`, propagates it into `back` and resolves collisions; leaves the holes of `back` empty.
#[inline(always)]
pub(crate) fn move_on<F: Format, const CONSTANT_TIME: bool>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    let wants_edges = settings.fill_mode.uses_edges() && !scratch.edges.is_empty();
    let edges = match CONSTANT_TIME {
        _ if !wants_edges => 0,
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

/// Fills the holes that [`move_on`] left.
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
