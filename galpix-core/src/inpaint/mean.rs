//! Means with small weights, exact and without a division.
//!
//! `floor((n + bias) / s)` for a sum of weights `s` from 1 to 64 is a product with a reciprocal rounded upwards: with
//! `R = ceil(2^k / s)` and `R s = 2^k + e`, `e < s`, the product is too large by less than `n e / (s 2^k)`, which
//! cannot carry it over the next whole number while `n e < 2^k`.
//!
//! A mean that lies halfway between two numbers goes up or down by the parity of its place, so that a picture becomes
//! neither brighter nor darker from level to level.

/// The largest sum of weights.
const MOST: u32 = 64;

/// Sums that [`divided`] takes are below 2^31, and those with a short reciprocal below 2^16 + 32.
const SHIFT: u32 = 37;
const SHORT_SHIFT: u32 = 22;

const RECIPROCALS: [u64; MOST as usize + 1] = {
    let mut table = [0; MOST as usize + 1];
    let mut s = 1;
    while s < table.len() {
        table[s] = (1u64 << SHIFT).div_ceil(s as u64);
        s += 1;
    }
    table
};

/// A sum below `1024 s` times one of these stays below 2^32: a processor without a long product does not need one.
const SHORT_RECIPROCALS: [u32; MOST as usize + 1] = {
    let mut table = [0; MOST as usize + 1];
    let mut s = 1;
    while s < table.len() {
        table[s] = (1u32 << SHORT_SHIFT).div_ceil(s as u32);
        s += 1;
    }
    table
};

/// Returns `sum / weight` to the nearest; halves go up if `tie` is 1 and down if it is 0. `weight` 1 to 64, `sum` below
/// 2^31 - 64.
#[inline(always)]
#[must_use]
pub fn divided(sum: u32, weight: u32, tie: u32) -> u32 {
    let reciprocal = RECIPROCALS.get(weight as usize).copied().unwrap_or_default();
    ((u64::from(sum + bias(weight, tie)) * reciprocal) >> SHIFT) as u32
}

/// Returns the same for a sum of at most 64 times 1023: three channels of ten bits with one look at the table.
#[inline(always)]
#[must_use]
pub fn divided3(sums: [u32; 3], weight: u32, tie: u32) -> [u32; 3] {
    let reciprocal = SHORT_RECIPROCALS.get(weight as usize).copied().unwrap_or_default();
    let bias = bias(weight, tie);
    let quotient = |sum: u32| (sum + bias).wrapping_mul(reciprocal) >> SHORT_SHIFT;
    let [first, second, third] = sums;
    [quotient(first), quotient(second), quotient(third)]
}

/// Returns what is added before the fraction is dropped.
#[inline(always)]
const fn bias(weight: u32, tie: u32) -> u32 {
    (weight.wrapping_sub(1).wrapping_add(tie)) >> 1
}

/// Whether a half goes up at a place of a level: in every other cell, as on a chessboard.
#[inline(always)]
#[must_use]
pub const fn tie(x: u32, y: u32, level: u32) -> u32 {
    (x ^ y ^ level) & 1
}

/// Returns the mean of four signed numbers between -2^23 and 2^23, by weights whose sum is 1 to 64: to the nearest,
/// ties as in [`divided`]. Never outside of the range of those with a weight.
#[inline(always)]
#[must_use]
pub fn signed(values: [i32; 4], weights: &[u32; 4], tie: u32) -> i32 {
    const OFFSET: i32 = 1 << 23;
    let mut sum = 0;
    for (value, &weight) in values.into_iter().zip(weights) {
        sum += weight * value.wrapping_add(OFFSET) as u32;
    }
    divided(sum, weights.iter().sum(), tie) as i32 - OFFSET
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(sum: u64, weight: u64, tie: u64) -> u64 {
        let (whole, rest) = (sum / weight, sum % weight);
        whole + u64::from(2 * rest > weight || 2 * rest == weight && tie == 1)
    }

    #[test]
    fn short_quotients_are_the_nearest_for_all_sums() {
        for weight in 1..=64 {
            for tie in 0..2 {
                for sum in 0..=weight * 1023 {
                    let expected = nearest(sum.into(), weight.into(), tie.into()) as u32;
                    assert_eq!(divided3([sum; 3], weight, tie), [expected; 3]);
                }
            }
        }
    }

    #[test]
    fn long_quotients_are_the_nearest_around_every_border() {
        for weight in 1..=64u32 {
            let most = weight * ((1 << 24) - 1);
            let step = (most / 4000).max(1);
            let near = |sum: u32| sum.saturating_sub(2)..=(sum + 2).min(most);
            let multiples = (0..=most).step_by(step as usize).map(|sum| sum / weight * weight);
            for sum in multiples.chain([0, most]).flat_map(near) {
                for tie in 0..2 {
                    assert_eq!(u64::from(divided(sum, weight, tie)), nearest(sum.into(), weight.into(), tie.into()));
                }
            }
        }
    }

    #[test]
    fn a_mean_stays_within_what_has_weight() {
        let values = [-8_388_608, -3, 5, 8_388_607];
        for code in 0..16u32.pow(4) {
            let weights = [code & 15, code >> 4 & 15, code >> 8 & 15, code >> 12];
            if weights == [0; 4] {
                continue;
            }
            let with_weight =
                || values.iter().zip(&weights).filter(|(_, weight)| **weight > 0).map(|(value, _)| *value);
            for tie in 0..2 {
                let mean = signed(values, &weights, tie);
                assert!(with_weight().min() <= Some(mean) && Some(mean) <= with_weight().max());
            }
        }
    }
}
