//! Probability that the robot is at a place, by its weight and that of the others and "nowhere".

use geometry::Covariance;
use nalgebra::Matrix3;

use super::place::Place;
use super::places::Places;

/// Factor on the evidence of all scans together: they repeat each other's errors, since the errors
/// of the map are the same in each.
const SHARE_OF_LOOKS: f64 = 0.5;

/// Log odds, without evidence, that the leading place is the right one.
const LEADING: f64 = 0.7;

/// Probability that the leading place is right although "nowhere" is: half of the faults that make
/// every place unlikely are those of odometry or of a laser, not of the place.
const RIGHT_AND_NOWHERE: f64 = 0.5;

pub(super) fn is_elsewhere(place: &Place, best: &Place) -> bool {
    place.is_apart_from((best.map, best.pose))
}

/// Probability that the robot is at the best place, 0..=1: the weight of all places there against
/// that of all others, times the probability that "nowhere" does not exclude it, by the same weight
/// against that of "nowhere". Calibrated on drives with faults of each kind (docs/tracking.md).
pub(super) fn probability(places: &Places) -> f64 {
    let Some(best) = places.all().first() else {
        return 0.0;
    };
    let weight = |place: &Place| (place.log_weight - best.log_weight).exp();
    let (mut here, mut others) = (0.0, 0.0);
    for place in places.all() {
        match is_elsewhere(place, best) {
            true => others += weight(place),
            false => here += weight(place),
        }
    }
    let here = f64::ln(here);
    let nowhere = 1.0 - calibrated(best.log_weight + here - places.nowhere());
    calibrated(here - f64::ln(others)) * (1.0 - (1.0 - RIGHT_AND_NOWHERE) * nowhere)
}

/// Probability of a place whose weight gives these log odds.
fn calibrated(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-SHARE_OF_LOOKS * log_odds - LEADING).exp())
}

/// The best place, and the places elsewhere each of which alone keeps its probability below `sure`.
pub(super) fn rivals(places: &[Place], sure: f64) -> impl Iterator<Item = &Place> {
    let best = places.first();
    places.iter().filter(move |place| {
        best.is_some_and(|best| {
            let is_near = calibrated(best.log_weight - place.log_weight) < sure;
            place.id == best.id || (is_near && is_elsewhere(place, best))
        })
    })
}

/// Covariance, about one of several places on its map, of a robot that may be at any of them.
pub(super) fn spread(places: &[Place], about: &Place) -> Matrix3<f64> {
    let on_map = || places.iter().filter(|place| place.map == about.map);
    let top = on_map().next().map_or(0.0, |best| best.log_weight);
    let weight = |place: &Place| (place.log_weight - top).exp();
    let all: f64 = on_map().map(weight).sum();
    let parts = on_map().map(|place| {
        let covariance = Covariance::from(place.covariance);
        Matrix3::from(covariance.about(place.pose, about.pose)) * (weight(place) / all)
    });
    parts.sum()
}
