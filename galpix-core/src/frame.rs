//! One frame: the stages in their order, and the swap.

use crate::constant;
use crate::edge;
use crate::error::SetupError;
use crate::fill::{Around, Rung, fill_around};
use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::inpaint::map::{OfGalpixel, Uncovered};
use crate::inpaint::metamer::{self, Recipe};
use crate::inpaint::push_pull::{self, Rule};
use crate::inpaint::pyramid::{DEPTH_BITS, Pyramid};
use crate::inpaint::quads::lay_background;
use crate::inpaint::tone::Tone;
use crate::inpaint::validity::Gamma;
use crate::layout::Layout;
use crate::rounding::Rounding;
use crate::sweep::sweep;
use crate::tally::Tally;

/// How much work a frame does. The mode changes no bit of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Work {
    /// What a picture does not need is skipped.
    #[default]
    Skipping,
    /// The same instructions for every picture: a running time that is independent of the image, see [`crate::constant`].
    Constant,
}

impl Work {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::Skipping, Self::Constant];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Skipping => "skipping",
            Self::Constant => "constant",
        }
    }
}

/// What a frame is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Settings {
    /// How positions are rounded.
    pub rounding: Rounding,
    /// What is put into holes.
    pub rung: Rung,
    /// The Laplacian beyond which a cell is on an edge, in units of the depth's last bit.
    pub edge_threshold: u32,
    /// Rounds of bullet filling, 1 to 16.
    pub reach: u32,
    /// Whether work may depend on the picture.
    pub work: Work,
}

impl Settings {
    /// Low-discrepancy rounding, the richest rung, one round of bullet filling, an edge threshold for depths of `depth_bits`
    /// bits that are linear in inverse distance, and skipping what a picture does not need.
    #[must_use]
    pub const fn for_depth(depth_bits: u32) -> Self {
        Self {
            rounding: Rounding::LowDiscrepancy,
            rung: Rung::Extend,
            edge_threshold: edge::threshold_for_depth(depth_bits),
            reach: 1,
            work: Work::Skipping,
        }
    }
}

/// How what was just uncovered is filled after a frame, see [`crate::inpaint`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inpainting<'m> {
    /// How far coarser levels are needed, and what foreground is.
    pub rule: Rule,
    /// Whether holes get the depth of the background from stretched quads first.
    pub quads: bool,
    /// Where it is worth it, a bit for each cell; empty for everywhere.
    pub mask: &'m [u32],
}

impl Inpainting<'_> {
    /// Push-pull that tells foreground from background by depths of `depth_bits` bits, everywhere.
    #[must_use]
    pub const fn for_depth(depth_bits: u32, gamma: Gamma) -> Self {
        let threshold = edge::threshold_for_depth(depth_bits) >> depth_bits.saturating_sub(DEPTH_BITS);
        Self { rule: Rule { gamma, threshold }, quads: true, mask: &[] }
    }

    /// The classic push-pull, which knows no depth.
    #[must_use]
    pub const fn classic() -> Self {
        Self { rule: Rule { gamma: Gamma::Zero, threshold: u32::MAX }, quads: false, mask: &[] }
    }

    /// Push-pull in a map, whose holes have the depth that they are to be filled at.
    pub(crate) fn fill<L: Layout, B: Budget<L>, V: OfGalpixel<L>>(
        &self,
        map: &mut Galpixmap<'_, L, B>,
        work: Work,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        let mut picture = Uncovered::<L, B, V>::new(map, self.mask);
        match work {
            Work::Skipping => push_pull::sparse(&mut picture, pyramid, &self.rule),
            Work::Constant => push_pull::dense(&mut picture, pyramid, &self.rule),
        }
    }
}

/// Memory that a frame needs beside its two maps. Rungs that do not tell surfaces apart need none: lend empty slices. Lent to
/// another rung, they leave out what it is for: without both no hole is a bullet hole, and without an edge map no edge is
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
pub struct Controller<'p, L, B> {
    pub(crate) front: Galpixmap<'p, L, B>,
    pub(crate) back: Galpixmap<'p, L, B>,
    pub(crate) scratch: Scratch<'p>,
    pub(crate) frame: u32,
}

impl<'p, L: Layout, B: Budget<L>> Controller<'p, L, B> {
    /// Two maps over the same grid, and scratch memory for the rungs that will be used.
    ///
    /// *Errors:* grids that differ, or scratch memory that is neither empty nor long enough.
    pub fn new(
        front: Galpixmap<'p, L, B>,
        back: Galpixmap<'p, L, B>,
        scratch: Scratch<'p>,
    ) -> Result<Self, SetupError> {
        if front.grid() != back.grid() {
            return Err(SetupError::GridsDiffer);
        }
        scratch.check(front.grid().cells(), edge::words(front.grid()))?;
        Ok(Self { front, back, scratch, frame: 0 })
    }

    /// Makes the next frame and shows it.
    pub fn step(&mut self, settings: &Settings) -> Tally {
        let tally = step(&self.front, &mut self.back, &mut self.scratch, settings, self.frame);
        core::mem::swap(&mut self.front, &mut self.back);
        self.frame = self.frame.wrapping_add(1);
        tally
    }

    /// Fills what the last step uncovered, by push-pull: how many cells. The step must have been made with `settings`, whose rung is
    /// [`Rung::Extend`]; with any other one there may be nothing to fill.
    ///
    /// Of a pyramid of another size than the map's, only what lies within both is filled.
    pub fn inpaint<V: OfGalpixel<L>>(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        pyramid: &mut Pyramid<'_, V>,
    ) -> u32 {
        self.lay_background(settings, inpainting);
        inpainting.fill(&mut self.front, settings.work, pyramid)
    }

    /// Fills what the last step uncovered by metamers: as [`Self::inpaint`], with a texture. Of `recipe` the rule and the age are
    /// not asked: those of `inpainting` count, and the frame counter, which [`Self::set_frame`] sets to 0 with an update.
    ///
    /// *Errors:* memory that is too short for the map; then nothing is filled.
    pub fn synthesise(
        &mut self,
        settings: &Settings,
        inpainting: &Inpainting<'_>,
        recipe: &Recipe,
        scratch: &mut metamer::Scratch<'_>,
    ) -> Result<u32, SetupError> {
        self.lay_background(settings, inpainting);
        let recipe = Recipe { rule: inpainting.rule, age: self.frame, ..*recipe };
        let mut scene = Uncovered::<L, B, Tone>::new(&mut self.front, inpainting.mask);
        match settings.work {
            Work::Skipping => metamer::sparse(&mut scene, scratch, &recipe),
            Work::Constant => metamer::dense(&mut scene, scratch, &recipe),
        }
    }

    fn lay_background(&mut self, settings: &Settings, inpainting: &Inpainting<'_>) {
        if inpainting.quads {
            let frame = self.frame.wrapping_sub(1);
            lay_background(&self.back, &mut self.front, self.scratch.edges, settings.rounding, frame);
        }
    }

    /// The map that is shown.
    #[must_use]
    pub const fn front(&self) -> &Galpixmap<'p, L, B> {
        &self.front
    }

    /// The map that is shown, to write an update into.
    pub const fn front_mut(&mut self) -> &mut Galpixmap<'p, L, B> {
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

    /// For each cell of the shown map, the cell of the map before that it came from; see [`crate::resolve::NOBODY`] and
    /// [`crate::fill::FILLED`]. Empty if no winner map was lent, stale for rungs that do not need one.
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

/// Makes `back` the frame after `front`, whose frame counter is `frame`.
pub fn step<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    back: &mut Galpixmap<'_, L, B>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    let mut tally = move_on(front, back, scratch, settings, frame);
    fill_holes(front, back, scratch, settings, &mut tally);
    tally
}

/// The edge map of `front`, propagation and resolution: `back` is left with its holes.
#[inline(always)]
pub(crate) fn move_on<L: Layout, B: Budget<L>>(
    front: &Galpixmap<'_, L, B>,
    back: &mut Galpixmap<'_, L, B>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    let surfaces = settings.rung.tells_surfaces() && !scratch.edges.is_empty();
    let edges = match settings.work {
        _ if !surfaces => 0,
        Work::Skipping => edge::mark(front, settings.edge_threshold, scratch.edges),
        Work::Constant => edge::mark_all(front, settings.edge_threshold, scratch.edges),
    };
    let (winners, rounding) = (&mut *scratch.winners, settings.rounding);
    let mut tally = match settings.work {
        Work::Skipping => sweep(front, back, winners, rounding, frame),
        Work::Constant => constant::sweep(front, back, winners, rounding, frame),
    };
    tally.edges = edges;
    tally
}

/// The fill ladder.
#[inline(always)]
pub(crate) fn fill_holes<L: Layout, B: Budget<L>>(
    around: &impl Around,
    back: &mut Galpixmap<'_, L, B>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    let (winners, rung, reach) = (&mut *scratch.winners, settings.rung, settings.reach);
    match settings.work {
        Work::Skipping => fill_around(around, back, winners, scratch.edges, rung, reach, tally),
        Work::Constant => constant::fill_around(around, back, winners, scratch.edges, rung, reach, tally),
    }
}
