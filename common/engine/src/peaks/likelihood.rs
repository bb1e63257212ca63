//! Probabilities that the robot is at each place, or at none of them.
//!
//! A softmax: weights fall exponentially with the lead of the best place and, for "none", with its
//! score. The scales are settings. That of leads was fitted to real scans with known poses by
//! maximum likelihood; those of scores are a little below that optimum, because all those scans
//! were taken on their maps.

use super::{PeakConfig, Place};

/// Fills in the probabilities of the places, best first, from their leads. The rest to 1 is the
/// probability that the robot is at none of them.
pub(super) fn assign(places: &mut [Place], leads: &[f64], config: &PeakConfig) {
    let Some(best) = places.first() else { return };
    let none = ((config.even_score - best.score) / config.score_scale).exp();
    let weight = |lead: &f64| (-lead / config.lead_scale).exp();
    let all = none + leads.iter().map(weight).sum::<f64>();
    for (place, lead) in places.iter_mut().zip(leads) {
        place.probability = weight(lead) / all;
    }
}

#[cfg(test)]
mod tests {
    use geometry::{Covariance, Pose};

    use super::*;

    fn assigned(scores: &[f64], leads: &[f64]) -> Vec<f64> {
        let place = |&score: &f64| Place {
            map: 0,
            map_from_laser: Pose::IDENTITY,
            covariance: Covariance::from_deviations(0.1, 0.1, 0.01),
            score,
            probability: 0.0,
            intensity: 1,
            possible: 1,
            drawn_doubt: 0.0,
            support: 1,
        };
        let mut places: Vec<Place> = scores.iter().map(place).collect();
        assign(&mut places, leads, &PeakConfig::default());
        places.iter().map(|place| place.probability).collect()
    }

    #[test]
    fn equal_places_share_what_none_leaves() {
        let at = assigned(&[0.95, 0.95], &[0.0, 0.0]);
        assert!(at[0] == at[1] && (0.49..0.5).contains(&at[0]), "{at:?}");
        let [even] = assigned(&[0.55], &[0.0])[..] else {
            panic!("one place");
        };
        assert!((even - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_lead_of_one_scale_is_a_factor_of_e() {
        let at = assigned(&[0.9, 0.89], &[0.0, 0.025]);
        assert!((at[0] / at[1] - std::f64::consts::E).abs() < 1e-12);
        assert!(at.iter().sum::<f64>() < 1.0);
    }
}
