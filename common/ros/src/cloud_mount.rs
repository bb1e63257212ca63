//! Mount of a lidar over the floor, with its height and tilt.

use std::fmt;
use std::str::FromStr;

use geometry::{Mount, Pose};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// Pose of a lidar on the robot, with its height over the floor.
///
/// As text it is `X,Y,Z,YAW_DEG[,PITCH_DEG,ROLL_DEG]` in metres and degrees, in the order and with
/// the signs of tf2's `static_transform_publisher`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudMount {
    /// `base_from_sensor`; its height is over the floor.
    base_from_sensor: Isometry3<f64>,
    /// Heading of the sensor's x axis seen from above, in radians.
    yaw: f64,
    /// `level_from_sensor`: to axes that are level and have the heading of the sensor's x axis.
    level_from_sensor: UnitQuaternion<f64>,
}

impl CloudMount {
    /// Mount of a sensor at this pose in a frame of the robot whose z axis points up from the floor.
    pub fn new(base_from_sensor: Isometry3<f64>) -> Self {
        let ahead = base_from_sensor.rotation * Vector3::x();
        let yaw = ahead.y.atan2(ahead.x);
        let level_from_base = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -yaw);
        CloudMount {
            base_from_sensor,
            yaw,
            level_from_sensor: level_from_base * base_from_sensor.rotation,
        }
    }

    /// Mount of the level laser that stands for the lidar: at its place, with its heading.
    pub fn planar(&self) -> Mount {
        let place = self.base_from_sensor.translation;
        Mount {
            base_from_laser: Pose::new(place.x, place.y, self.yaw),
            is_upside_down: false,
        }
    }

    /// Height of the lidar over the floor, in metres.
    pub fn height_m(&self) -> f64 {
        self.base_from_sensor.translation.z
    }

    /// Place of a point in the frame of the level laser, with its height over the floor.
    pub(crate) fn level(&self, [x, y, z]: [f64; 3]) -> Point3<f64> {
        let mut place = self.level_from_sensor * Point3::new(x, y, z);
        place.z += self.height_m();
        place
    }
}

impl fmt::Display for CloudMount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.base_from_sensor.translation.vector.into();
        let (roll, pitch, yaw) = self.base_from_sensor.rotation.euler_angles();
        // Zero has no sign.
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(|angle| angle.to_degrees() + 0.0);
        write!(f, "{x},{y},{z},{yaw},{pitch},{roll}")
    }
}

impl FromStr for CloudMount {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |word: &str| word.trim().parse().ok().filter(|n: &f64| n.is_finite());
        let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
        let (place, [yaw, pitch, roll]) = match numbers.as_deref() {
            Some(&[x, y, z, yaw]) => ([x, y, z], [yaw, 0.0, 0.0]),
            Some(&[x, y, z, yaw, pitch, roll]) => ([x, y, z], [yaw, pitch, roll]),
            _ => return Err(wrong()),
        };
        if place.iter().any(|metres| metres.abs() > MAX_DISTANCE_M) {
            return Err(wrong());
        }
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(f64::to_radians);
        Ok(CloudMount::new(Isometry3::from_parts(
            Translation3::from(place),
            UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        )))
    }
}

/// Largest distance of a lidar from the base of its robot, in metres and along each axis.
const MAX_DISTANCE_M: f64 = 10.0;

fn wrong() -> String {
    format!(
        "expected are X,Y,Z,YAW_DEG or X,Y,Z,YAW_DEG,PITCH_DEG,ROLL_DEG, finite numbers within \
         {MAX_DISTANCE_M} metres (not millimetres) of the base"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tilts_are_taken_out_and_the_heading_is_kept() {
        let check = |text: &str, place: [f64; 3], expected: [f64; 3]| {
            let mount: CloudMount = text.parse().unwrap();
            let level = mount.level(place);
            let error = (level - Point3::from(expected)).norm();
            assert!(error < 1e-12, "{text}: {level}");
        };
        check("0,0,1.5,30", [2.0, 0.0, -1.0], [2.0, 0.0, 0.5]);
        // Nose down: what is ahead of the lidar lies below.
        let (sin, cos) = 0.5f64.to_radians().sin_cos();
        check("0,0,1.5,30,0.5,0", [1.0, 2.0, 0.0], [cos, 2.0, 1.5 - sin]);
        check("0,0,1.5,30,0,180", [2.0, 1.0, 0.5], [2.0, -1.0, 1.0]);
        let mount: CloudMount = "1,2,3,90,0,180".parse().unwrap();
        let planar = mount.planar();
        assert!((planar.base_from_laser.yaw - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!(!planar.is_upside_down && mount.height_m() == 3.0);
        let again: CloudMount = mount.to_string().parse().unwrap();
        let moved = again.level([1.0, 2.0, 3.0]) - mount.level([1.0, 2.0, 3.0]);
        assert!(moved.norm() < 1e-12, "{mount}");
    }

    #[test]
    fn other_texts_are_refused() {
        for wrong in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "1,2,inf,0",
            "780,0,0,0",
            "1,2,3,x",
        ] {
            let error = wrong.parse::<CloudMount>().unwrap_err();
            assert!(error.contains("X,Y,Z,YAW_DEG"), "{error}");
        }
    }
}
