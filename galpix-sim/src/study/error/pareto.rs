//! The Pareto front of two costs: the points that no other beats in both.

/// Returns the indices of the points that no other point dominates, by rising first cost. A point dominates another if
/// it is at most as large in both costs and smaller in one; of equal points the first stays. Points without two finite
/// costs are not on the front.
#[must_use]
pub fn front(costs: &[(Option<f64>, Option<f64>)]) -> Vec<usize> {
    let finite = |cost: Option<f64>| cost.filter(|cost| cost.is_finite());
    let mut points: Vec<(usize, f64, f64)> = costs
        .iter()
        .enumerate()
        .filter_map(|(index, &(first, second))| Some((index, finite(first)?, finite(second)?)))
        .collect();
    points.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)).then(a.0.cmp(&b.0)));
    let mut best = f64::INFINITY;
    points.retain(|&(_, _, second)| {
        let better = second < best;
        best = best.min(second);
        better
    });
    points.into_iter().map(|(index, _, _)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definition.
    fn dominated(costs: &[(Option<f64>, Option<f64>)], index: usize) -> bool {
        let (Some(x), Some(y)) = costs[index] else { return true };
        costs.iter().enumerate().any(|(other, &cost)| {
            let (Some(ox), Some(oy)) = cost else { return false };
            let no_worse = ox <= x && oy <= y;
            no_worse && (ox < x || oy < y || other < index)
        })
    }

    #[test]
    fn the_front_is_what_the_definition_says() {
        // Small numbers, so that ties of both kinds are many.
        let mut state = 1u32;
        let mut draw = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % below
        };
        for case in 0..2000 {
            let count = draw(12) as usize;
            let spread = 1 + draw(8);
            let costs: Vec<_> = (0..count)
                .map(|_| {
                    let mut cost = || (draw(20) != 0).then(|| f64::from(draw(spread)));
                    (cost(), cost())
                })
                .collect();
            let front = front(&costs);
            for index in 0..count {
                assert_eq!(front.contains(&index), !dominated(&costs, index), "case {case}, {index} of {costs:?}");
            }
            for pair in front.windows(2) {
                let (a, b) = (costs[pair[0]], costs[pair[1]]);
                assert!(a.0 < b.0 && a.1 > b.1, "case {case}: {costs:?}");
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_not_on_the_front() {
        assert_eq!(front(&[(Some(1.0), Some(f64::NAN)), (None, Some(0.0)), (Some(2.0), Some(2.0))]), [2]);
        assert_eq!(front(&[]), [0usize; 0]);
    }
}
