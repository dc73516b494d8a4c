//! The lazy evaluator of pyramids: a cell is pulled or completed when something asks for it, and before it what that
//! needs.
//!
//! It serves push-pull of maps and of plain pictures, and both pyramids of metamers. How the lowest levels are pulled
//! is the business of what lies under the pyramid, its [`Base`]: row by row, or tile by tile. [`super::reference`]
//! makes all cells of all levels instead, with the same bits.
//!
//! A cell is overwritten only after its own coarse cell has been pulled from it, so whatever is pulled later is pulled
//! from the same cells as if all had been pulled before the first was pushed.

use super::kernel::{above, below, pulled, pushed, sampled};
use super::mean::tie;
use super::pyramid::{Pyramid, State, Stored};
use super::settings::Inpainting;
use super::validity::FULL;

/// What lies under a pyramid, and how its lowest levels are pulled.
pub trait Base<V: Stored> {
    /// The highest level that the base pulls.
    const LEVELS: u32;

    /// Returns by what the pyramid is pulled and pushed.
    fn inpainting(&self) -> &Inpainting<'_>;

    /// Pulls an untouched cell of a level from 1 to [`Self::LEVELS`], and what is pulled together with it.
    fn pull(&mut self, pyramid: &mut Pyramid<'_, V>, level: u32, x: u32, y: u32);
}

/// A pyramid that is worked out as far as it is needed, and what lies under it. The methods call themselves as deep as
/// there are levels, up and down.
#[derive(Debug)]
pub struct Lazy<'f, 's, V: Stored, B> {
    /// The levels from 1 on.
    pub pyramid: &'f mut Pyramid<'s, V>,
    /// Level 0.
    pub base: B,
}

impl<V: Stored, B: Base<V>> Lazy<'_, '_, V, B> {
    /// Pulls a cell of a level from 1 on, unless it is.
    #[inline]
    pub fn ensure_pulled(&mut self, level: u32, x: u32, y: u32) {
        if self.pyramid.state(self.pyramid.index(level, x, y)) == State::Untouched {
            self.pull(level, x, y);
        }
    }

    /// Pulls an untouched cell, and before it what that needs.
    fn pull(&mut self, level: u32, x: u32, y: u32) {
        if level <= B::LEVELS {
            return self.base.pull(self.pyramid, level, x, y);
        }
        let places = below(x, y);
        let indices = self.pyramid.indices(level - 1, places);
        for ((x, y), index) in places.into_iter().zip(indices) {
            if self.pyramid.state(index) == State::Untouched {
                self.pull(level - 1, x, y);
            }
        }
        let known = pulled(&self.pyramid.four(indices), self.base.inpainting(), tie(x, y, level));
        self.pyramid.set(self.pyramid.index(level, x, y), State::Pulled, known);
    }

    /// Completes a cell of a level from 1 on, unless it is.
    #[inline]
    pub fn ensure_completed(&mut self, level: u32, x: u32, y: u32) {
        let index = self.pyramid.index(level, x, y);
        if self.pyramid.state(index) < State::Completed {
            self.complete(level, x, y, index);
        }
    }

    /// Completes a cell, and before it what that needs.
    fn complete(&mut self, level: u32, x: u32, y: u32, index: usize) {
        if self.pyramid.state(index) == State::Untouched {
            self.pull(level, x, y);
        }
        if self.pyramid.validity(index) == FULL {
            return self.pyramid.complete(index);
        }
        let coarse = self.ensure_above(level, x, y);
        let (own, tie) = (self.pyramid.known(index), tie(x, y, level));
        let from_above = sampled(&self.pyramid.four(coarse), own.depth, self.base.inpainting(), tie);
        self.pyramid.set(index, State::Completed, pushed(own, from_above, tie));
    }

    /// Completes what a cell of any level is sampled from, and returns the indices of these cells.
    #[inline(always)]
    pub fn ensure_above(&mut self, level: u32, x: u32, y: u32) -> [usize; 4] {
        let places = above(x, y);
        let indices = self.pyramid.indices(level + 1, places);
        for ((x, y), index) in places.into_iter().zip(indices) {
            if self.pyramid.state(index) < State::Completed {
                self.complete(level + 1, x, y, index);
            }
        }
        indices
    }
}
