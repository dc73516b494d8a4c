//! Means and medians.

/// Returns the mean; `None` of nothing.
pub fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    weighted_mean(values.into_iter().map(|value| (1.0, value)))
}

/// Returns the mean of values by their weights, given as (weight, value); `None` without any weight.
pub fn weighted_mean(pairs: impl IntoIterator<Item = (f64, f64)>) -> Option<f64> {
    let add = |(sum, all): (f64, f64), (weight, value): (f64, f64)| (sum + weight * value, all + weight);
    let (sum, weights) = pairs.into_iter().fold((0.0, 0.0), add);
    (weights > 0.0).then(|| sum / weights)
}

/// Returns the median, of an even number of values the middle between the two in the middle; `None` of nothing.
#[must_use]
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() % 2 {
        1 => values.get(middle).copied(),
        _ => Some(0.5 * (values.get(middle.checked_sub(1)?)? + values.get(middle)?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_has_neither_a_mean_nor_a_median() {
        assert_eq!((mean([]), median(vec![]), weighted_mean([(0.0, 3.0)])), (None, None, None));
    }

    #[test]
    fn means_weigh_and_medians_stand_in_the_middle() {
        assert_eq!((mean([1.0, 2.0, 6.0]), weighted_mean([(3.0, 1.0), (1.0, 5.0)])), (Some(3.0), Some(2.0)));
        assert_eq!((median(vec![9.0, 1.0, 2.0]), median(vec![4.0, 1.0, 2.0, 9.0])), (Some(2.0), Some(3.0)));
    }
}
