//! Push-pull: known cells are pulled up into ever coarser levels, and what is missing is pushed down from them.
//!
//! Algorithm 1 of the paper, in integers, with these readings:
//!
//! - Smaller depths are nearer here; the paper's are larger there. So PULL looks for the *farthest* of four depths, and what is
//!   nearer than that by more than a threshold is foreground, and ignored. A hole takes part with the depth that
//!   [`super::quads`] gave it.
//! - `mean(colours x validity)` is meant as the normalised mean of the text: divided by the sum of the validities.
//! - The validity is raised to gamma where it is pulled, "after each normalised convolution", so that it counts at all higher
//!   levels as well.
//! - `mix(hicolour, locolour, hiValidity)` takes the finer colour by its validity and the rest from the coarser level.
//!
//! The paper does not say how the coarser level is sampled. Here linearly, by 9, 3, 3, 1 sixteenths, and of its cells those that are
//! nearer than the cell itself by more than the threshold are left out too: foreground does not come in from above either.
//!
//! Every mean is one with small positive weights, see [`super::mean`], so a filled value lies within the range of the known
//! ones, exactly.
//!
//! Two arrangements give the same bits: [`dense`] works out all cells of all levels, [`sparse`] only those that the holes ask
//! for.

use super::mean::tie;
use super::pyramid::{Known, Pyramid, State};
use super::validity::{FULL, Gamma};

/// What cells hold, and a mean can be taken of.
pub trait Value: Copy + Default {
    /// The mean by weights whose sum is 1 to 64; a half goes up if `tie` is 1.
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self;
}

/// A picture with holes.
pub trait Picture {
    /// What its cells hold.
    type Value: Value;

    /// Columns and rows, each 1 to 32768.
    fn size(&self) -> [u32; 2];

    /// What is known of a cell of the picture: validity [`FULL`] or 0. A cell beyond its border is never asked for.
    fn known(&self, x: u32, y: u32) -> Known<Self::Value>;

    /// Asks `value` for each hole that is to be filled, row by row, and puts there what it answers; how many got something. What
    /// [`Self::known`] says of any cell does not change by that.
    fn fill_holes(&mut self, value: impl FnMut(&Self, u32, u32) -> Option<Self::Value>) -> u32;
}

/// How a picture is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rule {
    /// The power of the validity.
    pub gamma: Gamma,
    /// How much nearer than the background foreground is at least, in units of the depth's last bit; `u32::MAX` makes no difference
    /// between them.
    pub threshold: u32,
}

/// PULL of Algorithm 1: four cells become one. `tie` is that of the cell's place.
#[inline(always)]
#[must_use]
pub fn pulled<V: Value>(children: &[Known<V>; 4], rule: &Rule, tie: u32) -> Known<V> {
    let depth = children.iter().fold(0, |farthest, child| farthest.max(child.depth));
    let weights = children.map(|child| if depth - child.depth > rule.threshold { 0 } else { child.validity });
    let sum = weights.iter().sum();
    let value = if sum == 0 { V::default() } else { V::mean(&children.map(|child| child.value), &weights, tie) };
    Known { validity: rule.gamma.raised(sum), depth, value }
}

/// The linear sample of a coarser level for a cell of depth `depth`: its own coarse cell first, then that beside, that above or below, and
/// the one across. Nothing if none of them is of use.
#[inline(always)]
#[must_use]
pub fn sampled<V: Value>(coarse: &[Known<V>; 4], depth: u32, rule: &Rule, tie: u32) -> Option<V> {
    let mut weights = [9, 3, 3, 1];
    for (weight, cell) in weights.iter_mut().zip(coarse) {
        if cell.validity == 0 || depth.saturating_sub(cell.depth) > rule.threshold {
            *weight = 0;
        }
    }
    if weights == [0; 4] { None } else { Some(V::mean(&coarse.map(|cell| cell.value), &weights, tie)) }
}

/// PUSH of Algorithm 1: a cell takes its own value by its validity, and the rest from the coarser level.
#[inline(always)]
#[must_use]
pub fn pushed<V: Value>(own: Known<V>, from_above: Option<V>, tie: u32) -> Known<V> {
    let value = match from_above {
        Some(above) if own.validity == 0 => above,
        Some(above) if own.validity < FULL => {
            let values = [own.value, above, V::default(), V::default()];
            V::mean(&values, &[own.validity, FULL - own.validity, 0, 0], tie)
        }
        _ => own.value,
    };
    let validity = if own.validity > 0 || from_above.is_some() { FULL } else { 0 };
    Known { validity, value, ..own }
}

/// The four cells of the level above that a cell is sampled from, as [`sampled`] takes them.
#[inline(always)]
pub(super) const fn above(x: u32, y: u32) -> [(u32, u32); 4] {
    // A place left of or above the first one wraps to where there is none.
    let (own, beside) = (x >> 1, (x >> 1).wrapping_add(x & 1).wrapping_add(x & 1).wrapping_sub(1));
    let (row, across) = (y >> 1, (y >> 1).wrapping_add(y & 1).wrapping_add(y & 1).wrapping_sub(1));
    [(own, row), (beside, row), (own, across), (beside, across)]
}

/// A pyramid being worked out.
struct Filling<'f, 's, V> {
    pyramid: &'f mut Pyramid<'s, V>,
    rule: &'f Rule,
}

impl<V: Value> Filling<'_, '_, V> {
    /// What is known of a cell of any level; nothing of a place that there is not.
    #[inline(always)]
    fn known(&self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) -> Known<V> {
        if level > 0 {
            return self.pyramid.known(self.pyramid.index(level, x, y));
        }
        let size = self.pyramid.levels().level(0);
        if x < size.width && y < size.height { picture.known(x, y) } else { Known::default() }
    }

    /// Pulls a cell whose four cells below are worked out.
    #[inline(always)]
    fn pull(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        let (below, left, top) = (level - 1, x << 1, y << 1);
        let children = [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)]
            .map(|(x, y)| self.known(picture, below, x, y));
        let known = pulled(&children, self.rule, tie(x, y, level));
        let index = self.pyramid.index(level, x, y);
        self.pyramid.set(index, State::Pulled, known);
    }

    /// What a cell of any level gets from above; all that it is sampled from is completed.
    #[inline(always)]
    fn sample(&self, level: u32, x: u32, y: u32, depth: u32) -> Option<V> {
        if level == self.pyramid.levels().top() {
            return None;
        }
        let coarse = above(x, y).map(|(x, y)| self.pyramid.known(self.pyramid.index(level + 1, x, y)));
        sampled(&coarse, depth, self.rule, tie(x, y, level))
    }

    /// Completes a pulled cell; all that it is sampled from is completed.
    #[inline(always)]
    fn push(&mut self, level: u32, x: u32, y: u32) {
        let index = self.pyramid.index(level, x, y);
        let own = self.pyramid.known(index);
        let from_above = if own.validity < FULL { self.sample(level, x, y, own.depth) } else { None };
        self.pyramid.set(index, State::Completed, pushed(own, from_above, tie(x, y, level)));
    }

    /// Pulls a cell, and before it what that needs.
    fn want_pulled(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        if self.pyramid.state(self.pyramid.index(level, x, y)) != State::Untouched {
            return;
        }
        if level > 1 {
            let (left, top) = (x << 1, y << 1);
            for (x, y) in [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)] {
                self.want_pulled(picture, level - 1, x, y);
            }
        }
        self.pull(picture, level, x, y);
    }

    /// Completes a cell, and before it what that needs. A cell is overwritten only after its own coarse cell has been pulled
    /// from it: so whatever is pulled later sees what it would have seen before.
    fn want_completed(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        let index = self.pyramid.index(level, x, y);
        match self.pyramid.state(index) {
            State::Completed => return,
            State::Pulled => {}
            State::Untouched => self.want_pulled(picture, level, x, y),
        }
        if self.pyramid.known(index).validity < FULL {
            self.want_above(picture, level, x, y);
            self.push(level, x, y);
        }
    }

    /// Completes what a cell is sampled from.
    #[inline(always)]
    fn want_above(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        if level < self.pyramid.levels().top() {
            for (x, y) in above(x, y) {
                self.want_completed(picture, level + 1, x, y);
            }
        }
    }
}

/// Fills the holes of a picture, and works out only what they need: how many were filled. The pyramid must be of the picture's
/// size. Calls itself as deep as there are levels, up and down.
pub fn sparse<P: Picture>(picture: &mut P, pyramid: &mut Pyramid<'_, P::Value>, rule: &Rule) -> u32 {
    pyramid.forget();
    let mut filling = Filling { pyramid, rule };
    picture.fill_holes(|picture, x, y| {
        filling.want_above(picture, 0, x, y);
        filling.sample(0, x, y, picture.known(x, y).depth)
    })
}

/// [`sparse`] with all cells of all levels worked out, and without recursion: for comparison, and where there is little stack.
pub fn dense<P: Picture>(picture: &mut P, pyramid: &mut Pyramid<'_, P::Value>, rule: &Rule) -> u32 {
    pyramid.forget();
    let levels = *pyramid.levels();
    let mut filling = Filling { pyramid, rule };
    for number in 1..=levels.top() {
        let level = levels.level(number);
        for y in 0..level.height {
            for x in 0..level.width {
                filling.pull(picture, number, x, y);
            }
        }
    }
    for number in (1..=levels.top()).rev() {
        let level = levels.level(number);
        for y in 0..level.height {
            for x in 0..level.width {
                filling.push(number, x, y);
            }
        }
    }
    picture.fill_holes(|picture, x, y| filling.sample(0, x, y, picture.known(x, y).depth))
}
