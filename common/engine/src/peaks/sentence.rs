//! Verdicts in words, for the operator at the robot.

use std::f64::consts::PI;

use geometry::{Covariance, Pose};
use messages::Verdict;

/// Data of a place for a sentence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaceSummary {
    /// Number of its map; places with different numbers are on different maps.
    pub map: u64,
    /// Pose of the laser in the map.
    pub map_from_laser: Pose,
    /// Covariance of the pose.
    pub covariance: Covariance,
    /// Score of the fit there.
    pub score: f64,
}

/// Ratio of length to width from which an ellipse is along a corridor.
const CORRIDOR: f64 = 5.0;

/// Tolerance for places in a corridor's direction, in radians.
const ALONG_RADIANS: f64 = 0.35;

/// Distance within which poses are on the same spot, in metres.
const SAME_SPOT_M: f64 = 0.5;

/// Explains a verdict. The places are best first; for [`Verdict::Ambiguous`] all of them fit about
/// as well as the first.
#[must_use]
pub fn sentence(verdict: Verdict, places: &[PlaceSummary]) -> String {
    match (verdict, places) {
        (Verdict::NoScan, _) | (_, []) => "no usable beams: is the laser covered?".into(),
        (Verdict::Unique, [best, ..]) => {
            format!("one place, fit {:.2}", fit(best))
        }
        (Verdict::PoorFit, [best, ..]) => format!(
            "the best place has a fit of only {:.2}: is it this map?",
            fit(best)
        ),
        (Verdict::Ambiguous, [_]) => "no place stands out enough to be sure".into(),
        (Verdict::Ambiguous, [best, others @ ..]) => {
            format!("{} places fit: {}", places.len(), apart(best, others))
        }
    }
}

fn fit(place: &PlaceSummary) -> f64 {
    place.score.clamp(0.0, 1.0)
}

/// Describes the positions of the others relative to the best place.
fn apart(best: &PlaceSummary, others: &[PlaceSummary]) -> String {
    let elsewhere = others.iter().filter(|other| other.map != best.map).count();
    match elsewhere {
        0 => {}
        1 => return "one of them on another map".to_owned(),
        _ => return format!("{elsewhere} of them on other maps"),
    }
    let distance = |other: &PlaceSummary| best.map_from_laser.distance_to(other.map_from_laser);
    let distances = others.iter().map(distance);
    let (nearest, farthest) = distances.fold((f64::INFINITY, 0.0_f64), |(near, far), distance| {
        (near.min(distance), far.max(distance))
    });
    if farthest <= SAME_SPOT_M {
        let angle = |other: &PlaceSummary| best.map_from_laser.angle_to(other.map_from_laser);
        let turn = others.iter().map(angle).fold(0.0, f64::max);
        return format!("the same spot, turned by up to {:.0}°", turn.to_degrees());
    }
    let range = match others {
        [_] => format!("{farthest:.1} m apart"),
        _ => format!("{nearest:.1} to {farthest:.1} m from the best"),
    };
    if others.iter().all(|other| is_along_corridor(best, other)) {
        return format!("{range}, along the corridor");
    }
    range
}

/// True if another place is in the direction that the scan does not constrain.
fn is_along_corridor(best: &PlaceSummary, other: &PlaceSummary) -> bool {
    let ellipse = best.covariance.ellipse();
    let (from, to) = (best.map_from_laser, other.map_from_laser);
    let way = (to.y - from.y).atan2(to.x - from.x);
    let off = (way - ellipse.angle).rem_euclid(PI);
    ellipse.major_m > CORRIDOR * ellipse.minor_m && off.min(PI - off) < ALONG_RADIANS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, degrees: f64) -> PlaceSummary {
        PlaceSummary {
            map: 0,
            map_from_laser: Pose::new(x, y, degrees.to_radians()),
            covariance: Covariance::from_deviations(2.0, 0.02, 0.01),
            score: 0.874,
        }
    }

    #[test]
    fn rivals_are_reported_by_how_they_lie_to_the_best() {
        let say = |others: &[PlaceSummary]| {
            let places = [&[at(0.0, 0.0, 0.0)], others].concat();
            sentence(Verdict::Ambiguous, &places)
        };
        assert_eq!(
            say(&[at(-12.0, 1.0, 0.0)]),
            "2 places fit: 12.0 m apart, along the corridor"
        );
        assert_eq!(say(&[at(3.0, 4.0, 90.0)]), "2 places fit: 5.0 m apart");
        assert_eq!(
            say(&[at(6.0, 0.0, 0.0), at(0.0, 9.0, 0.0)]),
            "3 places fit: 6.0 to 9.0 m from the best"
        );
        assert_eq!(
            say(&[at(0.1, 0.0, 180.0)]),
            "2 places fit: the same spot, turned by up to 180°"
        );
    }
}
