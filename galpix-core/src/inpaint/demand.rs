//! A pyramid worked out on demand, over cells of its own making: what [`super::push_pull::sparse`] does for a picture.

use super::mean::tie;
use super::push_pull::{Rule, Value, above, pulled, pushed, sampled};
use super::pyramid::{Known, State};
use super::store::Store;
use super::validity::FULL;

/// Values of which four that weigh the same have a mean without a product: most of what is pulled.
pub trait Even: Value {
    /// As [`Value::mean`] by equal weights.
    fn mean_of_known(values: [&Self; 4], tie: u32) -> Self;
}

/// What lies under a pyramid.
pub trait Base<V> {
    /// The levels that come together, from 1 on.
    const LEVELS: u32;

    /// Pulls those cells of these levels that come with a cell of level 1.
    fn pull(&mut self, pyramid: &mut Store<'_, V>, rule: &Rule, x: u32, y: u32);
}

/// A pyramid, and what lies under it.
#[derive(Debug)]
pub struct Demand<'f, 's, V, B> {
    /// The levels from 1 on.
    pub pyramid: &'f mut Store<'s, V>,
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
        if level <= B::LEVELS {
            return self.base.pull(self.pyramid, self.rule, x << (level - 1), y << (level - 1));
        }
        let (left, top) = (x << 1, y << 1);
        let places = [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)];
        for (x, y) in places {
            self.want_pulled(level - 1, x, y);
        }
        let [a, b, c, d] = places;
        let at = |(x, y): (u32, u32)| self.pyramid.index(level - 1, x, y);
        let places = [at(a), at(b), at(c), at(d)];
        let [a, b, c, d] = places;
        let child = |at: usize| self.pyramid.known(at);
        let known = pulled_alike([&child(a), &child(b), &child(c), &child(d)], self.rule, tie(x, y, level));
        let index = self.pyramid.index(level, x, y);
        self.pyramid.set(index, State::Pulled, &known);
    }

    /// Completes a cell of a level from 1 on, and before it what that needs.
    pub fn want_completed(&mut self, level: u32, x: u32, y: u32) {
        self.want_pulled(level, x, y);
        let index = self.pyramid.index(level, x, y);
        if self.pyramid.state(index) == State::Completed || self.pyramid.standing(index).validity() == FULL {
            return;
        }
        let own = self.pyramid.known(index);
        if level < self.pyramid.levels().top() {
            for (x, y) in above(x, y) {
                self.want_completed(level + 1, x, y);
            }
        }
        let from_above = sample(self.pyramid, level, x, y, own.depth, self.rule, |value| *value);
        self.pyramid.set(index, State::Completed, &pushed(own, from_above, tie(x, y, level)));
    }
}

/// [`pulled`], where most cells are known and of one surface.
#[inline(always)]
pub fn pulled_alike<V: Even>([a, b, c, d]: [&Known<V>; 4], rule: &Rule, tie: u32) -> Known<V> {
    let nearest = a.depth.min(b.depth).min(c.depth.min(d.depth));
    let depth = a.depth.max(b.depth).max(c.depth.max(d.depth));
    if a.validity & b.validity & c.validity & d.validity == FULL && depth - nearest <= rule.threshold {
        let value = V::mean_of_known([&a.value, &b.value, &c.value, &d.value], tie);
        return Known { validity: FULL, depth, value };
    }
    pulled(&[*a, *b, *c, *d], rule, tie)
}

/// What a cell of any level gets from the completed level above, of which `of` is taken.
#[inline(always)]
pub fn sample<V: Value, W: Value>(
    pyramid: &Store<'_, V>,
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
    let level_above = pyramid.levels().level(level + 1);
    let at = |(x, y): (u32, u32)| {
        if x >= level_above.width || y >= level_above.height {
            return Known::default();
        }
        let index = (level_above.start + y * level_above.width + x) as usize;
        let Some(value) = pyramid.value(index) else { return Known::default() };
        let standing = pyramid.standing(index);
        Known { validity: standing.validity(), depth: standing.depth(), value: of(value) }
    };
    let coarse = [at(a), at(b), at(c), at(d)];
    sampled(&coarse, depth, rule, tie(x, y, level))
}
