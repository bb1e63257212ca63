//! How likely the robot is at a place: its share of all weight.

use geometry::Covariance;
use nalgebra::Matrix3;

use super::place::Place;
use super::places::Places;

pub(super) fn is_elsewhere(place: &Place, best: &Place) -> bool {
    place.is_apart_from((best.map, best.pose))
}

/// Probability that the robot is at the best place, 0..=1: the weight of all that lie there,
/// of that of all places and "nowhere".
pub(super) fn probability(places: &Places) -> f64 {
    let Some(best) = places.all().first() else {
        return 0.0;
    };
    let weight = |place: &Place| (place.log_weight - best.log_weight).exp();
    let nowhere = (places.nowhere() - best.log_weight).exp();
    let (mut here, mut all) = (0.0, nowhere);
    for place in places.all() {
        all += weight(place);
        if !is_elsewhere(place, best) {
            here += weight(place);
        }
    }
    here / all
}

/// The best place, and those elsewhere that are this likely against it or more.
pub(super) fn rivals(places: &[Place], least: f64) -> impl Iterator<Item = &Place> {
    let best = places.first();
    places.iter().filter(move |place| {
        best.is_some_and(|best| {
            let is_near = (place.log_weight - best.log_weight).exp() > least;
            place.id == best.id || (is_near && is_elsewhere(place, best))
        })
    })
}

/// The covariance, about one of several places on its map, of a robot that is at any of them.
pub(super) fn spread(places: &[Place], about: &Place) -> Matrix3<f64> {
    let on_map = || places.iter().filter(|place| place.map == about.map);
    let top = on_map().next().map_or(0.0, |best| best.log_weight);
    let weight = |place: &Place| (place.log_weight - top).exp();
    let all: f64 = on_map().map(weight).sum();
    let parts = on_map().map(|place| {
        let about = Covariance(place.covariance).about(place.pose, about.pose);
        about.0 * (weight(place) / all)
    });
    parts.sum()
}
