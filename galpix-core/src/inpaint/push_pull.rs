//! Push-pull: known cells are pulled up into ever coarser levels, and what is missing is pushed down from them.
//!
//! The arithmetic is in [`super::kernel`]. Only what the holes need is worked out, see [`super::lazy`]; how long that
//! takes by the share of holes is in `docs/notes/inpainting.md`.

use super::kernel::{Known, below, each, pulled, sampled};
use super::lazy::{Base, Lazy};
use super::levels::Levels;
use super::mean::tie;
use super::paint::{Moving, Tint};
use super::picture::Picture;
use super::pyramid::{Pyramid, State, Stored};
use super::settings::Inpainting;
use crate::error::SetupError;

/// Blocks that [`Holed::even_run`] looks at.
pub const RUN: usize = 8;

/// A picture with holes.
pub trait Holed {
    /// What its cells hold.
    type Value: Stored;

    /// Returns columns and rows, each 1 to 32768.
    fn size(&self) -> [u32; 2];

    /// Returns what is known of a cell of the picture, with the validity [`FULL`](super::validity::FULL) or 0. It is
    /// not called for a cell beyond the border.
    fn known(&self, x: u32, y: u32) -> Known<Self::Value>;

    /// Returns what is known of the four cells below a cell of level 1; nothing of those beyond the border.
    #[inline(always)]
    fn block(&self, x: u32, y: u32) -> [Known<Self::Value>; 4] {
        self.cell_by_cell(x, y)
    }

    /// Returns [`Self::block`] for any block, also one that the border cuts.
    #[inline(always)]
    fn cell_by_cell(&self, x: u32, y: u32) -> [Known<Self::Value>; 4] {
        let [width, height] = self.size();
        each(below(x, y), |(x, y)| if x < width && y < height { self.known(x, y) } else { Known::default() })
    }

    /// Returns depths and plain means of [`RUN`] blocks side by side, from that below cell `x` of row `y` of level 1
    /// on, if all of their cells are known and no surface ends among them, and nothing where that is not so.
    #[inline(always)]
    fn even_run(&self, x: u32, y: u32, threshold: u32) -> Option<[(u32, Self::Value); RUN]> {
        let _ = (x, y, threshold);
        None
    }

    /// Calls `value` for each hole that is to be filled, row by row, and puts there what it returns; returns how many
    /// got something. What [`Self::known`] returns for any cell does not change by that.
    fn fill_holes(&mut self, value: impl FnMut(&Self, u32, u32) -> Option<Self::Value>) -> u32;
}

/// A picture under a pyramid. Of the levels up to [`Base::LEVELS`] all that is below a cell is pulled row by row before
/// it, for there most is needed.
struct Rows<'p, P> {
    picture: &'p P,
    inpainting: &'p Inpainting<'p>,
}

impl<P: Holed> Rows<'_, P> {
    /// Pulls a cell whose four cells below are worked out.
    #[inline(always)]
    fn pull_cell(&self, pyramid: &mut Pyramid<'_, P::Value>, level: u32, x: u32, y: u32) {
        let children = match level {
            1 => self.picture.block(x, y),
            _ => pyramid.four(pyramid.indices(level - 1, below(x, y))),
        };
        let known = pulled(&children, self.inpainting, tie(x, y, level));
        pyramid.set(pyramid.index(level, x, y), State::Pulled, known);
    }

    /// Pulls those of `count` cells of a row that are untouched. What they are pulled from is worked out.
    #[inline(always)]
    fn pull_row(&self, pyramid: &mut Pyramid<'_, P::Value>, level: u32, (x, y): (u32, u32), count: u32) {
        let end = (x + count).min(pyramid.levels().level(level).width);
        let row = pyramid.index(level, x, y);
        let (mut at, mut index) = (x, row);
        // Where one run is uneven the next one is sought behind it.
        let mut uneven = x;
        while at < end {
            if level == 1 && at >= uneven && end - at >= RUN as u32 && pyramid.are_untouched(index, RUN as u32) {
                if let Some(run) = self.picture.even_run(at, y, self.inpainting.threshold) {
                    pyramid.set_run(index, &run);
                    at += RUN as u32;
                    index += RUN;
                    continue;
                }
                uneven = at + RUN as u32;
            }
            if pyramid.state(index) == State::Untouched {
                self.pull_cell(pyramid, level, at, y);
            }
            at += 1;
            index += 1;
        }
    }
}

impl<P: Holed> Base<P::Value> for Rows<'_, P> {
    const LEVELS: u32 = 5;

    #[inline(always)]
    fn inpainting(&self) -> &Inpainting<'_> {
        self.inpainting
    }

    fn pull(&mut self, pyramid: &mut Pyramid<'_, P::Value>, level: u32, x: u32, y: u32) {
        // Held in registers while cells are written.
        let rows = Rows { picture: self.picture, inpainting: self.inpainting };
        for below in 1..level {
            let up = level - below;
            let height = pyramid.levels().level(below).height;
            for y in y << up..((y + 1) << up).min(height) {
                rows.pull_row(pyramid, below, (x << up, y), 1 << up);
            }
        }
        rows.pull_cell(pyramid, level, x, y);
    }
}

/// Fills the holes of a picture from an untouched pyramid, and works out only what they need; returns how many were
/// filled. Where the pyramid is of another size, only what lies within both is filled.
pub fn fill<P: Holed>(picture: &mut P, pyramid: &mut Pyramid<'_, P::Value>, inpainting: &Inpainting<'_>) -> u32 {
    picture.fill_holes(|picture, x, y| {
        let mut lazy = Lazy { pyramid: &mut *pyramid, base: Rows { picture, inpainting } };
        let coarse = lazy.ensure_above(0, x, y);
        sampled(&pyramid.four(coarse), picture.known(x, y).depth, inpainting, tie(x, y, 0))
    })
}

/// What push-pull does to the motion of a hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Motion {
    /// It stays the one that the fill mode gave.
    Kept,
    /// It is inpainted with the colour, and with it the position in the cell and the tag: those of a galpixel of the
    /// same surface.
    Inpainted,
}

/// Push-pull for maps or pictures of one size, over a caller-provided buffer.
#[derive(Debug)]
pub struct PushPull<'s> {
    levels: Levels,
    motion: Motion,
    memory: &'s mut [u32],
}

impl<'s> PushPull<'s> {
    /// Returns the words of memory for maps or pictures of `width` x `height` cells, each 1 to 32768: about 2/3 of a
    /// word for each of them, with motion a word.
    #[must_use]
    pub const fn words(width: u32, height: u32, motion: Motion) -> usize {
        let cells = Levels::new(width, height).cells();
        match motion {
            Motion::Kept => Pyramid::<Tint>::words(cells),
            Motion::Inpainted => Pyramid::<Moving>::words(cells),
        }
    }

    /// Lays push-pull for maps or pictures of `width` x `height` cells over `memory`, whose surplus stays untouched.
    /// What is in the memory does not matter.
    ///
    /// *Errors:* a side of 0 or over 32768, memory shorter than [`Self::words`].
    pub fn new(width: u32, height: u32, motion: Motion, memory: &'s mut [u32]) -> Result<Self, SetupError> {
        let levels = Levels::checked(width, height)?;
        let (need, have) = (Self::words(width, height, motion), memory.len());
        let memory = memory.get_mut(..need).ok_or(SetupError::TooShort { plane: "pyramid", need, have })?;
        Ok(Self { levels, motion, memory })
    }

    /// Returns what it does to the motion of a hole.
    #[must_use]
    pub const fn motion(&self) -> Motion {
        self.motion
    }

    /// Fills the holes of a picture: how many were filled. A picture has no motion, so it is filled alike with and
    /// without. Of `inpainting` gamma, threshold and mask count. Of a picture of another size, only what lies within
    /// both is filled.
    pub fn fill_picture(&mut self, picture: &mut Picture<'_>, inpainting: &Inpainting<'_>) -> u32 {
        #[cfg(feature = "check")]
        let expected = picture.on_copy(|copy| {
            super::reference::push_pull(&mut copy.holes::<Tint>(inpainting.mask, &[]), &self.levels, inpainting)
        });
        let filled = self.fill(&mut picture.holes::<Tint>(inpainting.mask, &[]), inpainting);
        #[cfg(feature = "check")]
        assert!((&*picture.colours, filled) == (&*expected.0, expected.1), "push-pull of a picture: {inpainting:?}");
        filled
    }

    /// Fills the holes of anything that has some: how many were filled.
    pub(super) fn fill<P: Holed>(&mut self, picture: &mut P, inpainting: &Inpainting<'_>) -> u32 {
        match Pyramid::over(self.levels, self.memory) {
            Some(mut pyramid) => fill(picture, &mut pyramid, inpainting),
            None => 0,
        }
    }

    /// Returns the levels of its pyramid.
    #[cfg(feature = "check")]
    pub(super) const fn levels(&self) -> &Levels {
        &self.levels
    }
}
