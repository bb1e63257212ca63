//! How places lie to each other, and by how much one leads.

use geometry::Covariance;
use nalgebra::Matrix3;

use crate::tracking::limits::FARTHEST_BEHIND;
use crate::tracking::place::Place;
use crate::tracking::places::Places;

/// Places so near each other are not distinguished by the verdict.
const DISTINCT_M: f64 = 1.0;
const DISTINCT_RADIANS: f64 = 15.0 * std::f64::consts::PI / 180.0;

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

/// How likely the place is that leads by this much: a logistic regression over 2191 key
/// scans of seven drives, which docs/tracking.md has as a table. The lead by itself
/// is overconfident, for scans of one place err together.
pub(super) fn probability(lead: f64) -> f64 {
    1.0 / (1.0 + (-(0.2 + 0.4 * lead)).exp())
}

pub(super) fn is_elsewhere(place: &Place, best: &Place) -> bool {
    !place.is_within((best.map, best.pose), DISTINCT_M, DISTINCT_RADIANS)
}

/// By how much the best place leads over the next that lies elsewhere. A new one is not the
/// next, unless the best is new itself, or all are of the first key scan.
pub(super) fn lead(places: &Places) -> f64 {
    let Some(best) = places.all().first() else {
        return 0.0;
    };
    let are_first = best.age <= 1 || places.key_scans() <= 1;
    let counts = |place: &&Place| are_first || place.age > 1;
    let mut others = places.all().iter().filter(counts);
    let next = others.find(|place| is_elsewhere(place, best));
    next.map_or(FARTHEST_BEHIND, |next| {
        (best.log_weight - next.log_weight).min(FARTHEST_BEHIND)
    })
}
