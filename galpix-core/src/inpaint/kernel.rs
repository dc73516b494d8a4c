//! The kernel of push-pull: four cells are pulled into one, and one is pushed from four.
//!
//! Algorithm 1 of the paper, in integers, with these readings:
//!
//! - Smaller depths are nearer here; the paper's are larger there. So PULL looks for the *farthest* of four depths, and
//!   what is nearer than that by more than a threshold is foreground, and ignored. A hole takes part with the depth
//!   that [`super::quads`] gave it.
//! - `mean(colours x validity)` is meant as the normalised mean of the text: divided by the sum of the validities.
//! - The validity is raised to gamma where it is pulled, "after each normalised convolution", so that it counts at all
//!   higher levels as well.
//! - `mix(hicolour, locolour, hiValidity)` takes the finer colour by its validity and the rest from the coarser level.
//!
//! The paper does not say how the coarser level is sampled. Here linearly, by 9, 3, 3, 1 sixteenths, and of its cells
//! those that are nearer than the cell itself by more than the threshold are left out too: foreground does not come in
//! from above either.
//!
//! Every mean is one with small positive weights, see [`super::mean`], so a filled value lies within the range of the
//! known ones, exactly.

use super::settings::Inpainting;
use super::validity::FULL;

/// What is known of a cell, of the picture or of a level above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Known<V> {
    /// How much of it is known, 0 to [`FULL`].
    pub validity: u32,
    /// Its depth, below 2^[`DEPTH_BITS`](super::pyramid::DEPTH_BITS), smaller is nearer. Of a coarse cell the farthest
    /// below it; 0 where there is none.
    pub depth: u32,
    /// The mean of what is known; unspecified where nothing is.
    pub value: V,
}

impl<V> Known<V> {
    /// Returns the same of what `of` makes of the value.
    #[inline(always)]
    #[must_use]
    pub fn map<W>(self, of: impl Fn(V) -> W) -> Known<W> {
        Known { validity: self.validity, depth: self.depth, value: of(self.value) }
    }
}

/// What cells hold, and a mean can be taken of.
pub trait Value: Copy + Default {
    /// Returns the mean by weights whose sum is 1 to 64; a half goes up if `tie` is 1.
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self;

    /// Returns [`Self::mean`] by equal weights.
    #[inline(always)]
    fn plain_mean(values: &[Self; 4], tie: u32) -> Self {
        Self::mean(values, &[FULL; 4], tie)
    }

    /// Returns [`Self::mean`] by the weights [`LINEAR`].
    #[inline(always)]
    fn linear(values: &[Self; 4], tie: u32) -> Self {
        Self::mean(values, &LINEAR, tie)
    }
}

/// Sixteenths by which a cell takes of the four coarse cells around it: its own, that beside, that above or below, that
/// across.
pub const LINEAR: [u32; 4] = [9, 3, 3, 1];

/// Maps each of four. The `map` of arrays is not always inlined for small processors, and then goes through memory.
#[inline(always)]
pub fn each<T: Copy, U>(four: [T; 4], mut of: impl FnMut(T) -> U) -> [U; 4] {
    let [a, b, c, d] = four;
    [of(a), of(b), of(c), of(d)]
}

/// Pulls four cells into one: PULL of Algorithm 1. `tie` is that of the cell's place.
#[inline(always)]
#[must_use]
pub fn pulled<V: Value>(children: &[Known<V>; 4], inpainting: &Inpainting<'_>, tie: u32) -> Known<V> {
    let depth = children.iter().fold(0, |farthest, child| farthest.max(child.depth));
    let nearest = children.iter().fold(u32::MAX, |nearest, child| nearest.min(child.depth));
    let threshold = inpainting.threshold;
    if children.iter().all(|child| child.validity == FULL) && depth - nearest <= threshold {
        return Known { validity: FULL, depth, value: V::plain_mean(&each(*children, |child| child.value), tie) };
    }
    let weights = each(*children, |child| if depth - child.depth > threshold { 0 } else { child.validity });
    let sum = weights.iter().sum();
    let value = if sum == 0 { V::default() } else { V::mean(&each(*children, |child| child.value), &weights, tie) };
    Known { validity: inpainting.gamma.raised(sum), depth, value }
}

/// Samples a coarser level for a cell of depth `depth`, linearly: from its own coarse cell, then that beside, that
/// above or below, and the one across. Returns nothing if none of them counts.
#[inline(always)]
#[must_use]
pub fn sampled<V: Value>(coarse: &[Known<V>; 4], depth: u32, inpainting: &Inpainting<'_>, tie: u32) -> Option<V> {
    let counts = each(*coarse, |cell| cell.validity != 0 && depth.saturating_sub(cell.depth) <= inpainting.threshold);
    let values = each(*coarse, |cell| cell.value);
    // Comparisons of arrays would be calls.
    let [own, beside, above, across] = counts;
    if own & beside & above & across {
        return Some(V::linear(&values, tie));
    }
    let mut weights = LINEAR;
    for (weight, counts) in weights.iter_mut().zip(counts) {
        *weight *= u32::from(counts);
    }
    if own | beside | above | across { Some(V::mean(&values, &weights, tie)) } else { None }
}

/// Pushes a cell: PUSH of Algorithm 1. It takes its own value by its validity, and the rest from the coarser level.
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

/// Returns the places of the four cells that a coarse cell is pulled from.
#[inline(always)]
pub const fn below(x: u32, y: u32) -> [(u32, u32); 4] {
    let (left, top) = (x << 1, y << 1);
    [(left, top), (left + 1, top), (left, top + 1), (left + 1, top + 1)]
}

/// Returns the places of the four cells of the level above that a cell is sampled from, in the order of [`sampled`]. A
/// place left of or above the first one wraps to where there is none.
#[inline(always)]
pub const fn above(x: u32, y: u32) -> [(u32, u32); 4] {
    let (own, row) = (x >> 1, y >> 1);
    let (beside, across) = ((x + (x & 1)).wrapping_sub(1 - (x & 1)) >> 1, (y + (y & 1)).wrapping_sub(1 - (y & 1)) >> 1);
    [(own, row), (beside, row), (own, across), (beside, across)]
}
