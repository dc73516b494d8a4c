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

    /// [`Self::mean`] by equal weights.
    #[inline(always)]
    fn plain_mean(values: &[Self; 4], tie: u32) -> Self {
        Self::mean(values, &[FULL; 4], tie)
    }

    /// [`Self::mean`] by the weights [`LINEAR`].
    #[inline(always)]
    fn linear(values: &[Self; 4], tie: u32) -> Self {
        Self::mean(values, &LINEAR, tie)
    }
}

/// Sixteenths by which a cell takes of the four coarse cells around it: its own, that beside, that above or below, that across.
pub const LINEAR: [u32; 4] = [9, 3, 3, 1];

/// Blocks that [`Picture::even_run`] looks at.
pub const RUN: usize = 8;

/// A picture with holes.
pub trait Picture {
    /// What its cells hold.
    type Value: Value;

    /// Columns and rows, each 1 to 32768.
    fn size(&self) -> [u32; 2];

    /// What is known of a cell of the picture: validity [`FULL`] or 0. A cell beyond its border is never asked for.
    fn known(&self, x: u32, y: u32) -> Known<Self::Value>;

    /// What is known of the four cells below a cell of level 1; nothing of those beyond the border.
    #[inline(always)]
    fn block(&self, x: u32, y: u32) -> [Known<Self::Value>; 4] {
        self.cell_by_cell(x, y)
    }

    /// [`Self::block`] for any block, also one that the border cuts.
    #[inline(always)]
    fn cell_by_cell(&self, x: u32, y: u32) -> [Known<Self::Value>; 4] {
        let [width, height] = self.size();
        each(below(x, y), |(x, y)| if x < width && y < height { self.known(x, y) } else { Known::default() })
    }

    /// The plain means of [`RUN`] blocks side by side, from that below cell `x` of row `y` of level 1 on, if all of their
    /// cells are known and no surface ends among them: depth, value, and nothing where that is not so.
    #[inline(always)]
    fn even_run(&self, x: u32, y: u32, threshold: u32) -> Option<[(u32, Self::Value); RUN]> {
        let _ = (x, y, threshold);
        None
    }

    /// Asks `value` for each hole that is to be filled, row by row, and puts there what it answers; how many got something. What
    /// [`Self::known`] says of any cell does not change by that.
    fn fill_holes(&mut self, value: impl FnMut(&Self, u32, u32) -> Option<Self::Value>) -> u32;
}

/// What comes of each of four. The `map` of arrays is not always inlined for small processors, and then goes through memory.
#[inline(always)]
pub(super) fn each<T: Copy, U>(four: [T; 4], mut of: impl FnMut(T) -> U) -> [U; 4] {
    let [a, b, c, d] = four;
    [of(a), of(b), of(c), of(d)]
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
    let nearest = children.iter().fold(u32::MAX, |nearest, child| nearest.min(child.depth));
    if children.iter().all(|child| child.validity == FULL) && depth - nearest <= rule.threshold {
        return Known { validity: FULL, depth, value: V::plain_mean(&each(*children, |child| child.value), tie) };
    }
    let weights = each(*children, |child| if depth - child.depth > rule.threshold { 0 } else { child.validity });
    let sum = weights.iter().sum();
    let value = if sum == 0 { V::default() } else { V::mean(&each(*children, |child| child.value), &weights, tie) };
    Known { validity: rule.gamma.raised(sum), depth, value }
}

/// The linear sample of a coarser level for a cell of depth `depth`: its own coarse cell first, then that beside, that above or below, and
/// the one across. Nothing if none of them is of use.
#[inline(always)]
#[must_use]
pub fn sampled<V: Value>(coarse: &[Known<V>; 4], depth: u32, rule: &Rule, tie: u32) -> Option<V> {
    let of_use = each(*coarse, |cell| cell.validity != 0 && depth.saturating_sub(cell.depth) <= rule.threshold);
    let values = each(*coarse, |cell| cell.value);
    // Comparisons of arrays would be calls.
    let [own, beside, above, across] = of_use;
    if own & beside & above & across {
        return Some(V::linear(&values, tie));
    }
    let mut weights = LINEAR;
    for (weight, of_use) in weights.iter_mut().zip(of_use) {
        *weight *= u32::from(of_use);
    }
    if own | beside | above | across { Some(V::mean(&values, &weights, tie)) } else { None }
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

/// The four cells that a coarse cell is pulled from.
#[inline(always)]
pub(super) const fn below(x: u32, y: u32) -> [(u32, u32); 4] {
    let (left, top) = (x << 1, y << 1);
    [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)]
}

/// The four cells of the level above that a cell is sampled from, as [`sampled`] takes them. A place left of or above the first
/// one wraps to where there is none.
#[inline(always)]
pub(super) const fn above(x: u32, y: u32) -> [(u32, u32); 4] {
    let (own, row) = (x >> 1, y >> 1);
    let (beside, across) = ((x + (x & 1)).wrapping_sub(1 - (x & 1)) >> 1, (y + (y & 1)).wrapping_sub(1 - (y & 1)) >> 1);
    [(own, row), (beside, row), (own, across), (beside, across)]
}

/// The highest level below which all is pulled row by row where it is needed.
const ROW_BY_ROW: u32 = 5;

/// A pyramid being worked out.
struct Filling<'f, 's, V> {
    pyramid: &'f mut Pyramid<'s, V>,
    rule: &'f Rule,
}

impl<V: Value> Filling<'_, '_, V> {
    /// Pulls a cell whose four cells below are worked out.
    #[inline(always)]
    fn pull(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        let children = match level {
            1 => picture.block(x, y),
            _ => each(self.pyramid.indices(level - 1, below(x, y)), |index| self.pyramid.known(index)),
        };
        let known = pulled(&children, self.rule, tie(x, y, level));
        let index = self.pyramid.index(level, x, y);
        self.pyramid.set(index, State::Pulled, known);
    }

    /// The linear sample at a place of `level`, from the cells above it, which are completed.
    #[inline(always)]
    fn sample(&self, level: u32, x: u32, y: u32, depth: u32, above: [usize; 4]) -> Option<V> {
        sampled(&each(above, |index| self.pyramid.known(index)), depth, self.rule, tie(x, y, level))
    }

    /// Where in the pyramid the cells lie that a cell is sampled from.
    #[inline(always)]
    fn above(&self, level: u32, x: u32, y: u32) -> [usize; 4] {
        self.pyramid.indices(level + 1, above(x, y))
    }

    /// Completes a pulled cell; all that it is sampled from is completed.
    #[inline(always)]
    fn push(&mut self, level: u32, x: u32, y: u32, index: usize) {
        let own = self.pyramid.known(index);
        let from_above =
            if own.validity < FULL { self.sample(level, x, y, own.depth, self.above(level, x, y)) } else { None };
        self.pyramid.set(index, State::Completed, pushed(own, from_above, tie(x, y, level)));
    }

    /// Pulls those of `count` cells of a row that are untouched. What they are pulled from is worked out.
    #[inline(always)]
    fn pull_row(&mut self, picture: &impl Picture<Value = V>, level: u32, (x, y): (u32, u32), count: u32) {
        let end = (x + count).min(self.pyramid.levels().level(level).width);
        let row = self.pyramid.index(level, x, y);
        let (mut at, mut index) = (x, row);
        // Where one run is uneven the next one is sought behind it.
        let mut uneven = x;
        while at < end {
            if level == 1 && at >= uneven && end - at >= RUN as u32 && self.pyramid.are_untouched(index, RUN as u32) {
                if let Some(run) = picture.even_run(at, y, self.rule.threshold) {
                    self.pyramid.set_run(index, &run);
                    at += RUN as u32;
                    index += RUN;
                    continue;
                }
                uneven = at + RUN as u32;
            }
            if self.pyramid.state(index) == State::Untouched {
                self.pull(picture, level, at, y);
            }
            at += 1;
            index += 1;
        }
    }

    /// Pulls a cell, and before it what that needs: of the lower levels row by row, for there most is needed.
    fn want_pulled(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) {
        if level <= ROW_BY_ROW {
            for below in 1..level {
                let up = level - below;
                let height = self.pyramid.levels().level(below).height;
                for y in y << up..((y + 1) << up).min(height) {
                    self.pull_row(picture, below, (x << up, y), 1 << up);
                }
            }
        } else {
            let places = below(x, y);
            for ((x, y), index) in places.into_iter().zip(self.pyramid.indices(level - 1, places)) {
                if self.pyramid.state(index) == State::Untouched {
                    self.want_pulled(picture, level - 1, x, y);
                }
            }
        }
        self.pull(picture, level, x, y);
    }

    /// Completes a cell, and before it what that needs. A cell is overwritten only after its own coarse cell has been pulled
    /// from it: so whatever is pulled later sees what it would have seen before.
    fn want_completed(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32, index: usize) {
        if self.pyramid.state(index) == State::Untouched {
            self.want_pulled(picture, level, x, y);
        }
        if self.pyramid.known(index).validity < FULL {
            self.want_above(picture, level, x, y);
            self.push(level, x, y, index);
        } else {
            self.pyramid.complete(index);
        }
    }

    /// Completes what a cell is sampled from: where that lies.
    #[inline(always)]
    fn want_above(&mut self, picture: &impl Picture<Value = V>, level: u32, x: u32, y: u32) -> [usize; 4] {
        let places = above(x, y);
        let indices = self.pyramid.indices(level + 1, places);
        for ((x, y), index) in places.into_iter().zip(indices) {
            if self.pyramid.state(index) < State::Completed {
                self.want_completed(picture, level + 1, x, y, index);
            }
        }
        indices
    }
}

/// Fills the holes of a picture, and works out only what they need: how many were filled. The pyramid must be of the picture's
/// size. Calls itself as deep as there are levels, up and down.
pub fn sparse<P: Picture>(picture: &mut P, pyramid: &mut Pyramid<'_, P::Value>, rule: &Rule) -> u32 {
    pyramid.forget();
    let mut filling = Filling { pyramid, rule };
    picture.fill_holes(|picture, x, y| {
        let above = filling.want_above(picture, 0, x, y);
        filling.sample(0, x, y, picture.known(x, y).depth, above)
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
            filling.pull_row(picture, number, (0, y), level.width);
        }
    }
    for number in (1..=levels.top()).rev() {
        let level = levels.level(number);
        for y in 0..level.height {
            for x in 0..level.width {
                filling.push(number, x, y, filling.pyramid.index(number, x, y));
            }
        }
    }
    picture.fill_holes(|picture, x, y| filling.sample(0, x, y, picture.known(x, y).depth, filling.above(0, x, y)))
}
