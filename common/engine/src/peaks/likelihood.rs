//! Probabilities that the robot is at each place, or at none of them.
//!
//! The best place may be wrong in two ways. Places on the map may explain the scan as well: they
//! share the probability by a softmax of their leads. Or the robot is where the map shows nothing
//! like it, on another map or at a place that is missing: then the best place fits badly, sees
//! through walls, or stands out no more than wrong places do. The log odds of the best place are
//! its lead over the nearest other place, less what its score lacks. The settings were fitted by
//! maximum likelihood to real scans on right, drawn and wrong maps and at places that were erased,
//! each kind with the same weight (docs/accuracy.md).

use super::{PeakConfig, Place};

/// Number of pieces that a scan sees for which the sure score is defined.
const SURE_PIECES: f64 = 6.0;

/// Gap of a score behind the best, relative to the best's gap from a perfect score: where the scan
/// fits well, small differences matter.
pub(crate) fn lead(best: f64, other: f64) -> f64 {
    (best - other) / (1.1 - best).sqrt()
}

/// Returns the gap of the best place's score below the sure score, given the share of beams that
/// pass through obstacles or end behind unknown space, and the number of pieces that the scan sees.
pub(super) fn doubt(score: f64, unmatched: f64, pieces: f64, config: &PeakConfig) -> f64 {
    let trusted = score - config.through_doubt * unmatched
        + config.piece_doubt * (pieces.max(1.0) / SURE_PIECES).ln();
    (config.sure_score - trusted).max(0.0)
}

/// Returns the weight of leads for a scan of this many beams: scores are means over the beams.
pub(super) fn weight_of_leads(beams: f64, config: &PeakConfig) -> f64 {
    (beams.max(1.0) / f64::from(config.sure_beams))
        .min(1.0)
        .sqrt()
}

/// Returns the weighted lead over another place at which the best place is unique.
pub(super) fn needed_lead(doubt: f64, config: &PeakConfig) -> f64 {
    doubt + config.doubt_scale * (config.unique_from / (1.0 - config.unique_from)).ln()
}

/// Returns the part of a lead that does not count because the map leaves things out: a place that leads by
/// this much, `left_out`, is unique.
pub(super) fn discount(left_out: f64, weight: f64, config: &PeakConfig) -> f64 {
    (left_out - needed_lead(0.0, config) / weight).max(0.0)
}

/// Fills in the probabilities of the places, best first, from their weighted leads. The rest to 1 is the
/// probability that the robot is at none of them.
pub(super) fn assign(places: &mut [Place], leads: &[f64], doubt: f64, config: &PeakConfig) {
    let Some(best) = places.first() else { return };
    // A place that was not found scores nothing, or more.
    let nearest = leads[1..]
        .iter()
        .copied()
        .fold(lead(best.score, 0.0), f64::min);
    let right = 1.0 / (1.0 + ((doubt - nearest) / config.doubt_scale).exp());
    let weight = |lead: &f64| (-lead / config.lead_scale).exp();
    let share = 1.0 / leads.iter().map(weight).sum::<f64>();
    for (place, lead) in places.iter_mut().zip(leads) {
        place.probability = right.min(share) * weight(lead);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::place;

    fn assigned(scores: &[f64], leads: &[f64], doubt: f64) -> Vec<f64> {
        let mut places: Vec<Place> = scores.iter().map(|&score| place(0, score, 1)).collect();
        assign(&mut places, leads, doubt, &PeakConfig::default());
        places.iter().map(|place| place.probability).collect()
    }

    #[test]
    fn equal_places_share_all_probability() {
        assert_eq!(assigned(&[0.95; 2], &[0.0; 2], 0.0), [0.5; 2]);
        assert_eq!(assigned(&[0.95; 4], &[0.0; 4], 0.0), [0.25; 4]);
    }

    #[test]
    fn a_lead_as_large_as_the_doubt_is_even() {
        let at = assigned(&[0.9, 0.7], &[0.0, 0.4], 0.4);
        assert!((at[0] - 0.5).abs() < 1e-12 && at[1] < 1e-6, "{at:?}");
        let at = assigned(&[0.9, 0.7], &[0.0, 0.4 + 0.09], 0.4);
        assert!((at[0] / (1.0 - at[0]) - std::f64::consts::E).abs() < 1e-9);
    }

    #[test]
    fn a_single_place_that_fits_badly_is_doubted() {
        let alone = |score, doubt| assigned(&[score], &[0.0], doubt)[0];
        assert!(alone(0.9, 0.0) > 0.999);
        assert!(alone(0.3, 0.5) < 0.2, "{}", alone(0.3, 0.5));
    }

    #[test]
    fn the_lead_that_is_needed_makes_the_place_unique() {
        let config = PeakConfig::default();
        for doubt in [0.0, 0.3] {
            let needed = needed_lead(doubt, &config);
            let at = assigned(&[0.9, 0.7], &[0.0, needed + 0.2], doubt);
            assert!(at[0] > config.unique_from);
            let at = assigned(&[0.9, 0.7], &[0.0, needed], doubt)[0];
            assert!((at - config.unique_from).abs() < 0.02, "{at}");
        }
    }

    #[test]
    fn leads_of_few_beams_count_for_less() {
        let weight = |beams| weight_of_leads(beams, &PeakConfig::default());
        assert_eq!([25.0, 100.0, 180.0].map(weight), [0.5, 1.0, 1.0]);
    }

    #[test]
    fn bad_scores_unmatched_beams_and_few_pieces_are_doubted() {
        let config = PeakConfig::default();
        let check = |score, unmatched, pieces, expected: f64| {
            let doubt = doubt(score, unmatched, pieces, &config);
            assert!(
                (doubt - expected).abs() < 1e-12,
                "{score} {unmatched} {pieces}: {doubt}"
            );
        };
        check(0.95, 0.0, 6.0, 0.0);
        check(0.63, 0.0, 6.0, 0.1);
        // A good score offsets a share of 0.1 of unmatched beams.
        check(0.80, 0.1, 6.0, 0.0);
        check(0.73, 0.5, 6.0, 0.35);
        // A scan of one piece is weaker evidence, one of many pieces is stronger.
        check(0.73, 0.0, 1.0, 0.14 * 6f64.ln());
        check(0.63, 0.0, 9.0, 0.1 - 0.14 * 1.5f64.ln());
        check(0.63, 0.0, 60.0, 0.0);
    }
}
