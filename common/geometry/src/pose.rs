//! A pose in the plane.

use nalgebra::{Isometry2, Point2, Vector2};
use serde::{Deserialize, Serialize};

use crate::{angle_between, wrap_angle};

/// A pose or rigid transform: the frame's origin at `(x, y)` metres, rotated by `yaw` radians
/// counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Pose {
    /// Position along the target frame's x axis, in metres.
    pub x: f64,
    /// Position along the target frame's y axis, in metres.
    pub y: f64,
    /// Heading in radians, counter-clockwise from the target frame's x axis.
    pub yaw: f64,
}

impl Pose {
    /// Identity transform.
    pub const IDENTITY: Pose = Pose::new(0.0, 0.0, 0.0);

    /// Creates a pose from metres and radians; the yaw is kept as given.
    #[must_use]
    pub const fn new(x: f64, y: f64, yaw: f64) -> Self {
        Pose { x, y, yaw }
    }

    /// Composes transforms: `a_from_b.then(b_from_c)` is `a_from_c`. The yaw is in `(-π, π]`.
    #[must_use]
    pub fn then(self, inner: Pose) -> Pose {
        (Isometry2::from(self) * Isometry2::from(inner)).into()
    }

    /// Returns the inverse transform: `a_from_b.inverse()` is `b_from_a`.
    #[must_use]
    pub fn inverse(self) -> Pose {
        Isometry2::from(self).inverse().into()
    }

    /// Interpolates from this pose to another with constant twist; `share` 0 is this pose, 1 the
    /// other, and values outside extrapolate.
    ///
    /// By the exponential map of SE(2): the path is an arc with a constant angle between heading
    /// and tangent.
    #[must_use]
    pub fn towards(self, other: Pose, share: f64) -> Pose {
        let step = self.inverse().then(other);
        // With (x, y) = V(yaw) v, the twist is (v, yaw); see for instance Solà et al., A micro Lie
        // theory for state estimation in robotics, eq. 158.
        let (a, b) = arc(step.yaw);
        let norm = a * a + b * b;
        let forward = (a * step.x + b * step.y) / norm;
        let aside = (a * step.y - b * step.x) / norm;
        let (a, b) = arc(share * step.yaw);
        self.then(Pose::new(
            share * (a * forward - b * aside),
            share * (b * forward + a * aside),
            share * step.yaw,
        ))
    }

    /// Transforms a point of the inner frame to the outer one.
    #[must_use]
    pub fn transform(self, x: f64, y: f64) -> (f64, f64) {
        let point = Isometry2::from(self) * Point2::new(x, y);
        (point.x, point.y)
    }

    /// Returns the distance between the two origins, in metres.
    #[must_use]
    pub fn distance_to(self, other: Pose) -> f64 {
        (self.x - other.x).hypot(self.y - other.y)
    }

    /// Returns the unsigned difference of the two headings, in `[0, π]` radians.
    #[must_use]
    pub fn angle_to(self, other: Pose) -> f64 {
        angle_between(self.yaw, other.yaw)
    }

    /// True if the poses differ by at most `metres` and at most `radians`.
    #[must_use]
    pub fn is_within(self, other: Pose, metres: f64, radians: f64) -> bool {
        self.distance_to(other) <= metres && self.angle_to(other) <= radians
    }

    /// True if all three numbers are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.yaw.is_finite()
    }
}

/// Returns sin θ / θ and (1 - cos θ) / θ.
fn arc(angle: f64) -> (f64, f64) {
    // For smaller angles, the next terms of the series are below rounding.
    if angle.abs() < 1e-6 {
        return (1.0 - angle * angle / 6.0, angle / 2.0);
    }
    (angle.sin() / angle, (1.0 - angle.cos()) / angle)
}

impl From<Pose> for Isometry2<f64> {
    fn from(pose: Pose) -> Self {
        Isometry2::new(Vector2::new(pose.x, pose.y), pose.yaw)
    }
}

impl From<Isometry2<f64>> for Pose {
    fn from(isometry: Isometry2<f64>) -> Self {
        Pose::new(
            isometry.translation.x,
            isometry.translation.y,
            wrap_angle(isometry.rotation.angle()),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn a_mount_ahead_of_the_base_turns_with_it() {
        let map_from_base = Pose::new(1.0, 2.0, FRAC_PI_2);
        let base_from_laser = Pose::new(0.78, 0.0, 0.0);
        let map_from_laser = map_from_base.then(base_from_laser);
        // The tolerance covers one rotation and one sum.
        assert!(map_from_laser.distance_to(Pose::new(1.0, 2.78, 0.0)) < 1e-12);
        assert!(map_from_laser.angle_to(map_from_base) < 1e-12);
    }

    #[test]
    fn within_asks_for_both_distance_and_angle() {
        let pose = Pose::new(0.0, 0.0, PI);
        assert!(pose.is_within(Pose::new(0.5, 0.0, -PI), 0.5, 0.0));
        assert!(!pose.is_within(Pose::new(0.6, 0.0, PI), 0.5, 1.0));
        assert!(!pose.is_within(Pose::new(0.0, 0.0, 0.0), 0.5, 1.0));
    }

    proptest::proptest! {
        #[test]
        fn two_halves_of_a_way_are_the_way(
            x in -5.0..5.0f64, y in -5.0..5.0f64, yaw in -3.0..3.0f64,
            to_x in -5.0..5.0f64, turn in -2.0..2.0f64,
        ) {
            let start = Pose::new(x, y, yaw);
            let end = start.then(Pose::new(to_x, 0.3, turn));
            let half = start.towards(end, 0.5);
            // The tolerance covers a few roundings of numbers below ten, divided by a cosine above
            // 0.5.
            proptest::prop_assert!(half.then(start.inverse().then(half)).is_within(end, 1e-9, 1e-9));
            proptest::prop_assert!(start.towards(end, 1.0).is_within(end, 1e-9, 1e-9));
            proptest::prop_assert!(start.towards(end, 0.0).is_within(start, 1e-9, 1e-9));
        }

        #[test]
        fn a_transform_and_its_inverse_cancel(
            x in -1e3..1e3f64, y in -1e3..1e3f64, yaw in -10.0..10.0f64,
            px in -1e2..1e2f64, py in -1e2..1e2f64,
        ) {
            let pose = Pose::new(x, y, yaw);
            let (tx, ty) = pose.transform(px, py);
            let (bx, by) = pose.inverse().transform(tx, ty);
            // Coordinates up to 1e3 have rounding errors of about 1e-13; 1e-9 is a nanometre.
            proptest::prop_assert!((bx - px).hypot(by - py) < 1e-9);
            proptest::prop_assert!(pose.then(pose.inverse()).is_within(Pose::IDENTITY, 1e-9, 1e-9));
        }
    }
}
