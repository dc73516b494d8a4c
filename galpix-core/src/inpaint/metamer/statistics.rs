//! Mean and deviation of a band around a place: the first two moments, which any convex mean carries along.
//!
//! A mean by positive weights takes the responses `X` and their squares `X^2` likewise; the variance by the same
//! weights is `E[X^2] - E[X]^2` (section 3.3.1 of the paper, where the sign is the other way round). Push-pull is such
//! a mean. All means here are rounded to the nearest, so the difference can become negative by a trifle: then it counts
//! as 0.

use super::steerable::LARGEST_RESPONSE;
use super::tone::{halves, packed};
use crate::inpaint::kernel::Value;
use crate::inpaint::mean::{divided, signed};
use crate::inpaint::pyramid::Stored;
use crate::inpaint::root::nearest_of;

/// Bands of a level: two for each of three channels.
pub const BANDS: usize = 6;

/// Sums of squares by weights of up to 64 stay below 2^31.
const _: () = assert!((LARGEST_RESPONSE as u64).pow(2) * 64 < (1 << 31) - 64);

/// The first two moments of each band.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Moments {
    /// `E[X]`, with the fraction bits of a response.
    pub means: [i16; BANDS],
    /// `E[X^2]`, with twice as many; below 2^25.
    pub squares: [u32; BANDS],
}

/// Mean and deviation of each band, both with the fraction bits of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Statistics {
    /// The means.
    pub means: [i16; BANDS],
    /// The deviations; 0 to 5104.
    pub deviations: [i16; BANDS],
}

impl Moments {
    /// Returns the moments of a single response of each band.
    #[inline(always)]
    #[must_use]
    pub fn of(responses: [i16; BANDS]) -> Self {
        Self { means: responses, squares: responses.map(|response| (i32::from(response) * i32::from(response)) as u32) }
    }

    /// Returns mean and deviation.
    #[inline(always)]
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        // Two more, so that all registers are full.
        let mut variances = [0; BANDS + 2];
        for ((to, &mean), &square) in variances.iter_mut().zip(&self.means).zip(&self.squares) {
            *to = variance(mean, square);
        }
        let mut deviations = [0; BANDS];
        for (deviation, root) in deviations.iter_mut().zip(nearest_of(variances)) {
            *deviation = root as i16;
        }
        Statistics { means: self.means, deviations }
    }

    /// Puts statistics in the place of moments, from where [`Self::finished`] takes them.
    #[inline(always)]
    #[must_use]
    pub fn finish(statistics: Statistics) -> Self {
        Self { means: statistics.means, squares: statistics.deviations.map(|deviation| deviation as u32) }
    }

    /// Returns what [`Self::finish`] put here.
    #[inline(always)]
    #[must_use]
    pub fn finished(self) -> Statistics {
        Statistics { means: self.means, deviations: self.squares.map(|deviation| deviation as i16) }
    }
}

/// Returns `E[X^2] - E[X]^2`, or 0 where rounding has made it negative; with the fraction bits of a square.
#[inline(always)]
#[must_use]
pub fn variance(mean: i16, square: u32) -> u32 {
    square.saturating_sub((i32::from(mean) * i32::from(mean)) as u32)
}

impl Stored for Moments {
    type Cell = [u32; 10];

    const WORDS: usize = 10;

    #[inline(always)]
    fn cells(memory: &mut [u32]) -> &mut [Self::Cell] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn encode(self, meta: u32) -> Self::Cell {
        let ([a, b, c, d, e, f], [g, h, i, j, k, l]) = (self.means, self.squares);
        [meta, packed(a, b), packed(c, d), packed(e, f), g, h, i, j, k, l]
    }

    #[inline(always)]
    fn decode(&[meta, first, second, third, g, h, i, j, k, l]: &Self::Cell) -> (u32, Self) {
        let ([a, b], [c, d], [e, f]) = (halves(first), halves(second), halves(third));
        (meta, Self { means: [a, b, c, d, e, f], squares: [g, h, i, j, k, l] })
    }
}

impl Value for Moments {
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        let mut mean = Self::default();
        let sum = weights.iter().sum();
        for band in 0..BANDS {
            mean.means[band] = signed(values.map(|value| i32::from(value.means[band])), weights, tie) as i16;
            let squares = values.iter().zip(weights).fold(0, |sum, (value, weight)| sum + value.squares[band] * weight);
            mean.squares[band] = divided(squares, sum, tie);
        }
        mean
    }

    #[inline(always)]
    fn plain_mean([a, b, c, d]: &[Self; 4], tie: u32) -> Self {
        let mut mean = Self::default();
        for band in 0..BANDS {
            // Four responses fit 16 bits.
            let sum = a.means[band] + b.means[band] + c.means[band] + d.means[band];
            mean.means[band] = (sum + 1 + tie as i16) >> 2;
            mean.squares[band] = (a.squares[band] + b.squares[band] + c.squares[band] + d.squares[band] + 1 + tie) >> 2;
        }
        mean
    }

    #[inline(always)]
    fn linear([a, b, c, d]: &[Self; 4], tie: u32) -> Self {
        let mut mean = Self::default();
        for band in 0..BANDS {
            mean.means[band] = linear([a.means[band], b.means[band], c.means[band], d.means[band]], tie);
            let sum = 9 * a.squares[band] + 3 * (b.squares[band] + c.squares[band]) + d.squares[band];
            mean.squares[band] = (sum + 7 + tie) >> 4;
        }
        mean
    }
}

/// Returns the mean by nine, three, three and one sixteenths, to the nearest.
#[inline(always)]
const fn linear([a, b, c, d]: [i16; 4], tie: u32) -> i16 {
    ((9 * a as i32 + 3 * (b as i32 + c as i32) + d as i32 + 7 + tie as i32) >> 4) as i16
}

impl Value for Statistics {
    /// Interpolates mean and deviation as they are: both are smooth where they are known.
    #[inline(always)]
    fn mean(values: &[Self; 4], weights: &[u32; 4], tie: u32) -> Self {
        let mut mean = Self::default();
        for band in 0..BANDS {
            mean.means[band] = signed(values.map(|value| i32::from(value.means[band])), weights, tie) as i16;
            mean.deviations[band] = signed(values.map(|value| i32::from(value.deviations[band])), weights, tie) as i16;
        }
        mean
    }

    #[inline(always)]
    fn linear([a, b, c, d]: &[Self; 4], tie: u32) -> Self {
        let mut mean = Self::default();
        for band in 0..BANDS {
            mean.means[band] = linear([a.means[band], b.means[band], c.means[band], d.means[band]], tie);
            mean.deviations[band] =
                linear([a.deviations[band], b.deviations[band], c.deviations[band], d.deviations[band]], tie);
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_come_back_from_their_cell() {
        let moments = Moments { means: [-5104, 5104, 0, 1, -1, 77], squares: [0, 1, 5104 * 5104, 4, 5, 6] };
        assert_eq!(Moments::decode(&moments.encode(9)), (9, moments));
    }

    #[test]
    fn equal_weights_need_no_product() {
        let value = |k: i16| Moments::of([k, -k, 5100, -5100, 3 * k, 7]);
        for k in -60..60 {
            for tie in 0..2 {
                let values = [value(k), value(-3 * k), value(5), value(k + 1)];
                for band in 0..BANDS {
                    let mean = Moments::plain_mean(&values, tie);
                    assert_eq!(
                        i32::from(mean.means[band]),
                        signed(values.map(|value| value.means[band].into()), &[16; 4], tie)
                    );
                    let sum = values.iter().map(|value| value.squares[band] * 16).sum();
                    assert_eq!(mean.squares[band], divided(sum, 64, tie));
                }
            }
        }
    }

    #[test]
    fn linear_samples_need_no_product() {
        let value = |k: i16| Statistics { means: [k, -k, 5100, -5100, 3 * k, 7], deviations: [k.abs(); BANDS] };
        for k in -60..60 {
            for tie in 0..2 {
                let values = [value(k), value(-3 * k), value(5), value(k + 1)];
                let mean = Statistics::linear(&values, tie);
                let moments = values.map(|value| Moments::of(value.means));
                let sampled = Moments::linear(&moments, tie);
                for band in 0..BANDS {
                    let sum =
                        moments.iter().zip([9, 3, 3, 1]).map(|(value, weight)| value.squares[band] * weight).sum();
                    assert_eq!(sampled.squares[band], divided(sum, 16, tie));
                    assert_eq!(sampled.means, mean.means);
                    let means = values.map(|value| i32::from(value.means[band]));
                    assert_eq!(i32::from(mean.means[band]), signed(means, &[9, 3, 3, 1], tie));
                    let deviations = values.map(|value| i32::from(value.deviations[band]));
                    assert_eq!(i32::from(mean.deviations[band]), signed(deviations, &[9, 3, 3, 1], tie));
                }
            }
        }
    }

    #[test]
    fn moments_give_the_deviation() {
        // Half -a, half a: the deviation is a. All the same: none.
        for a in [0, 1, 16, 777, LARGEST_RESPONSE] {
            let (low, high) = (Moments::of([-a; BANDS]), Moments::of([a; BANDS]));
            let mean = Moments::mean(&[low, high, high, low], &[16; 4], 0);
            assert_eq!(mean.statistics(), Statistics { means: [0; BANDS], deviations: [a; BANDS] });
            let mean = Moments::mean(&[high; 4], &[1, 16, 5, 0], 1);
            assert_eq!(mean.statistics(), Statistics { means: [a; BANDS], deviations: [0; BANDS] });
        }
        assert_eq!(variance(100, 9_999), 0);
        assert_eq!(variance(-5100, 5100 * 5100 + 4), 4);
    }
}
