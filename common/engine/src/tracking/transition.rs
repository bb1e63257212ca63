//! Transitions through which a robot may change maps: a lift, stairs, a door between buildings.

use geometry::Pose;
use messages::Transition;
use nalgebra::{Matrix3, Vector3};

/// Standard deviations between the two sides of a transition, in metres and radians; its regions
/// are drawn by people.
const ERROR_M: f64 = 0.2;
const ERROR: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// Maps a pose and its covariance to the other side of a transition; `None` if the pose is not in
/// the transition's region.
pub(super) fn other_side(
    transition: &Transition,
    (map, pose): (u32, Pose),
    covariance: Matrix3<f64>,
) -> Option<(u32, (Pose, Matrix3<f64>))> {
    let sides = [0, 1].map(|side| {
        let map = transition.maps[side];
        (map, Pose::from(transition.map_from_region[side]))
    });
    let (here, there) = match map {
        _ if map == sides[0].0 => (sides[0].1, sides[1]),
        _ if map == sides[1].0 => (sides[1].1, sides[0]),
        _ => return None,
    };
    let in_region = here.inverse().then(pose);
    let [along_x, along_y] = transition.size_m;
    if in_region.x.abs() > along_x / 2.0 || in_region.y.abs() > along_y / 2.0 {
        return None;
    }
    let (map, map_from_region) = there;
    let turn = nalgebra::Rotation2::new(map_from_region.yaw - here.yaw).to_homogeneous();
    let error = Vector3::new(ERROR_M, ERROR_M, ERROR).map(|d| d * d);
    let covariance = turn * covariance * turn.transpose() + Matrix3::from_diagonal(&error);
    Some((map, (map_from_region.then(in_region), covariance)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn what_is_in_the_region_of_a_transition_is_on_its_other_side_too() {
        let lift = Transition {
            maps: [2, 5],
            map_from_region: [
                Pose::new(10.0, 5.0, 0.0).into(),
                Pose::new(-3.0, 1.0, FRAC_PI_2).into(),
            ],
            size_m: [2.0, 1.0],
        };
        let covariance = Matrix3::from_diagonal(&Vector3::new(0.01, 0.04, 0.001));
        let at = |map, x, y| other_side(&lift, (map, Pose::new(x, y, 0.1)), covariance);
        assert_eq!(at(2, 11.1, 5.0), None);
        assert_eq!(at(2, 10.0, 5.6), None);
        assert_eq!(at(3, 10.0, 5.0), None);
        let (map, (pose, spread)) = at(2, 10.9, 5.4).unwrap();
        assert_eq!(map, 5);
        assert!(
            pose.is_within(Pose::new(-3.4, 1.9, FRAC_PI_2 + 0.1), 1e-12, 1e-12),
            "{pose:?}"
        );
        // The covariance is turned by a quarter, and the error of the regions is added.
        assert!((spread[(0, 0)] - 0.08).abs() < 1e-12 && (spread[(1, 1)] - 0.05).abs() < 1e-12);
        let back = other_side(&lift, (map, pose), covariance).unwrap();
        assert_eq!(back.0, 2);
        assert!(back.1.0.is_within(Pose::new(10.9, 5.4, 0.1), 1e-12, 1e-12));
    }
}
