//! A pyramid worked out on demand, over cells of its own making: what [`super::push_pull::sparse`] does for a picture.

use super::mean::tie;
use super::push_pull::{Rule, Value, above, below, pulled, pushed, sampled};
use super::pyramid::{Known, Pyramid, State};
use super::validity::FULL;

/// What lies under a pyramid.
pub trait Base<V> {
    /// The levels that come together, from 1 on.
    const LEVELS: u32;

    /// Pulls those cells of these levels that come with a cell of level 1.
    fn pull(&mut self, pyramid: &mut Pyramid<'_, V>, rule: &Rule, x: u32, y: u32);
}

/// A pyramid, and what lies under it.
#[derive(Debug)]
pub struct Demand<'f, 's, V, B> {
    /// The levels from 1 on.
    pub pyramid: &'f mut Pyramid<'s, V>,
    /// How they are pulled and pushed.
    pub rule: &'f Rule,
    /// Level 0.
    pub base: B,
}

impl<V: Value, B: Base<V>> Demand<'_, '_, V, B> {
    /// Pulls a cell of a level from 1 on, and before it what that needs.
    #[inline]
    pub fn want_pulled(&mut self, level: u32, x: u32, y: u32) {
        if self.pyramid.state(self.pyramid.index(level, x, y)) == State::Untouched {
            self.pull(level, x, y);
        }
    }

    fn pull(&mut self, level: u32, x: u32, y: u32) {
        if level <= B::LEVELS {
            return self.base.pull(self.pyramid, self.rule, x << (level - 1), y << (level - 1));
        }
        for (x, y) in below(x, y) {
            self.want_pulled(level - 1, x, y);
        }
        let children = self.pyramid.indices(level - 1, below(x, y)).map(|index| self.pyramid.known(index));
        let known = pulled(&children, self.rule, tie(x, y, level));
        let index = self.pyramid.index(level, x, y);
        self.pyramid.set(index, State::Pulled, known);
    }

    /// Completes a cell of a level from 1 on, and before it what that needs.
    pub fn want_completed(&mut self, level: u32, x: u32, y: u32) {
        self.want_pulled(level, x, y);
        let index = self.pyramid.index(level, x, y);
        if self.pyramid.state(index) == State::Completed || self.pyramid.validity(index) == FULL {
            return;
        }
        let own = self.pyramid.known(index);
        if level < self.pyramid.levels().top() {
            for (x, y) in above(x, y) {
                self.want_completed(level + 1, x, y);
            }
        }
        let from_above = sample(self.pyramid, level, x, y, own.depth, self.rule, |value| *value);
        self.pyramid.set(index, State::Completed, pushed(own, from_above, tie(x, y, level)));
    }
}

/// What a cell of any level gets from the completed level above, of which `of` is taken.
#[inline(always)]
pub fn sample<V: Value, W: Value>(
    pyramid: &Pyramid<'_, V>,
    level: u32,
    x: u32,
    y: u32,
    depth: u32,
    rule: &Rule,
    of: impl Fn(&V) -> W,
) -> Option<W> {
    if level >= pyramid.levels().top() {
        return None;
    }
    let [a, b, c, d] = pyramid.indices(level + 1, above(x, y));
    let at = |index: usize| match pyramid.parts(index) {
        Some((validity, depth, value)) => Known { validity, depth, value: of(value) },
        None => Known::default(),
    };
    let coarse = [at(a), at(b), at(c), at(d)];
    sampled(&coarse, depth, rule, tie(x, y, level))
}
