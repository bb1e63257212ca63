//! Resampling by weight: systematic, or low variance (Probabilistic Robotics, table 4.4). One
//! random number serves all draws.

/// Number of copies of each weight among `number` draws: within one of its share. `total` is the
/// sum of the weights in their order; `offset` is in `0..1`.
pub(super) fn copies(
    weights: impl Iterator<Item = f64>,
    total: f64,
    number: usize,
    offset: f64,
) -> impl Iterator<Item = usize> {
    let scale = number as f64 / total;
    let (mut sum, mut drawn) = (0.0, 0);
    weights.map(move |weight| {
        sum += weight;
        // Draws at offset, offset + 1, … below the sum.
        let below = (sum * scale - offset).ceil().max(0.0) as usize;
        let copies = below - drawn;
        drawn = below;
        copies
    })
}

/// Kish's effective sample size, (Σ w)² / Σ w²: number of equally weighted particles with the same
/// information (Liu, "Metropolized independent sampling", 1996, for particles).
pub(super) fn effective_number(weights: impl Iterator<Item = f64>) -> f64 {
    let (sum, squares) = weights.fold((0.0, 0.0), |(sum, squares), weight| {
        (sum + weight, squares + weight * weight)
    });
    sum * sum / squares.max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn each_is_drawn_within_one_of_its_share(
            weights in vec(prop_oneof![0.0..1.0f64, Just(0.0)], 1..50),
            number in 1usize..2000, offset in 0.0..1.0f64,
        ) {
            let total: f64 = weights.iter().sum();
            prop_assume!(total > 0.0);
            let drawn: Vec<usize> = copies(weights.iter().copied(), total, number, offset).collect();
            prop_assert_eq!(drawn.iter().sum::<usize>(), number);
            for (&copies, weight) in drawn.iter().zip(&weights) {
                let share = number as f64 * weight / total;
                // The sums round.
                prop_assert!((copies as f64 - share).abs() < 1.0 + 1e-9);
            }
        }
    }

    #[test]
    fn the_effective_number_counts_equal_weights() {
        let effective = |weights: &[f64]| effective_number(weights.iter().copied());
        assert_eq!(effective(&[0.25; 5]), 5.0);
        assert_eq!(effective(&[3.0, 0.0, 0.0]), 1.0);
        assert_eq!(effective(&[2.0, 1.0, 1.0]), 16.0 / 6.0);
        assert_eq!(effective(&[]), 0.0);
    }
}
