//! A pyramid worked out on demand, over cells of its own making: what [`super::push_pull::sparse`] does for a picture.

use super::mean::tie;
use super::push_pull::{Rule, Value, above, pulled, pushed, sampled};
use super::pyramid::{Known, Pyramid, State};
use super::validity::FULL;

/// Values of which four that weigh the same have a mean without a product: most of what is pulled.
pub trait Even: Value {
    /// As [`Value::mean`] by equal weights.
    fn mean_of_known(values: [&Self; 4], tie: u32) -> Self;
}

/// What lies under a pyramid.
pub trait Base<V> {
    /// Pulls a cell of level 1, and any others that come with it.
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

impl<V: Even, B: Base<V>> Demand<'_, '_, V, B> {
    /// Pulls a cell of a level from 1 on, and before it what that needs.
    #[inline]
    pub fn want_pulled(&mut self, level: u32, x: u32, y: u32) {
        if self.pyramid.state(self.pyramid.index(level, x, y)) == State::Untouched {
            self.pull(level, x, y);
        }
    }

    fn pull(&mut self, level: u32, x: u32, y: u32) {
        if level == 1 {
            return self.base.pull(self.pyramid, self.rule, x, y);
        }
        let (left, top) = (x << 1, y << 1);
        let places = [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)];
        for (x, y) in places {
            self.want_pulled(level - 1, x, y);
        }
        let [a, b, c, d] = places;
        let at = |(x, y): (u32, u32)| self.pyramid.index(level - 1, x, y);
        let places = [at(a), at(b), at(c), at(d)];
        let known = match self.even(places, tie(x, y, level)) {
            Some(known) => known,
            None => {
                let [a, b, c, d] = places;
                let child = |at: usize| self.pyramid.known(at);
                pulled(&[child(a), child(b), child(c), child(d)], self.rule, tie(x, y, level))
            }
        };
        let index = self.pyramid.index(level, x, y);
        self.pyramid.set(index, State::Pulled, known);
    }

    /// What [`pulled`] makes of four cells that are known and of one surface.
    #[inline(always)]
    fn even(&self, [a, b, c, d]: [usize; 4], tie: u32) -> Option<Known<V>> {
        let (a, b, c, d) =
            (self.pyramid.parts(a)?, self.pyramid.parts(b)?, self.pyramid.parts(c)?, self.pyramid.parts(d)?);
        let nearest = a.1.min(b.1).min(c.1.min(d.1));
        let depth = a.1.max(b.1).max(c.1.max(d.1));
        if a.0 & b.0 & c.0 & d.0 != FULL || depth - nearest > self.rule.threshold {
            return None;
        }
        Some(Known { validity: FULL, depth, value: V::mean_of_known([a.2, b.2, c.2, d.2], tie) })
    }

    /// Completes a cell of a level from 1 on, and before it what that needs.
    pub fn want_completed(&mut self, level: u32, x: u32, y: u32) {
        self.want_pulled(level, x, y);
        let index = self.pyramid.index(level, x, y);
        let own = self.pyramid.known(index);
        if self.pyramid.state(index) == State::Completed || own.validity == FULL {
            return;
        }
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
    let [a, b, c, d] = above(x, y);
    let at = |(x, y): (u32, u32)| {
        let Some((validity, depth, value)) = pyramid.parts(pyramid.index(level + 1, x, y)) else {
            return Known::default();
        };
        Known { validity, depth, value: of(value) }
    };
    let coarse = [at(a), at(b), at(c), at(d)];
    sampled(&coarse, depth, rule, tie(x, y, level))
}
