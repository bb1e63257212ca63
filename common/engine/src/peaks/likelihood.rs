//! How likely the robot is at each place, and at none of them.

use super::Place;

/// By so much lead, in the measure of [`super::PeakConfig::least_lead`], another
/// place becomes less likely by a factor of e.
const LEAD_SCALE: f64 = 0.02;

/// A best place with this score is as likely as that the robot is at none.
const EVEN_SCORE: f64 = 0.55;

/// By so much score, that becomes less likely by a factor of e.
const SCORE_SCALE: f64 = 0.03;

/// Fills in the probabilities, best place first, from the leads over each; what
/// they leave of 1 is that the robot is at none.
pub(super) fn assign(places: &mut [Place], leads: &[f64]) {
    let Some(best) = places.first() else { return };
    let none = ((EVEN_SCORE - best.score) / SCORE_SCALE).exp();
    let weights: Vec<f64> = leads
        .iter()
        .map(|lead| (-lead / LEAD_SCALE).exp())
        .collect();
    let all = none + weights.iter().sum::<f64>();
    for (place, weight) in places.iter_mut().zip(weights) {
        place.probability = weight / all;
    }
}
