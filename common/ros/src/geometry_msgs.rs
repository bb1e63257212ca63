//! Types of `geometry_msgs` that other messages use.

use serde::{Deserialize, Serialize};

use super::ConversionError;
use super::definition::Rows6;

/// Tolerance of a quaternion's squared length around 1, as in tf2.
const ROTATION_TOLERANCE: f64 = 0.01;

/// Tolerance of a quaternion's length around 1, for rounded values.
const ROUNDING: f64 = 0.05;

/// Correction of an inexact quaternion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mend {
    /// All four numbers are zero; replaced by the identity.
    Zero,
    /// The length is near 1, but not 1; normalized.
    Length(f64),
}

impl std::fmt::Display for Mend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Mend::Zero => f.write_str("the quaternion is all zeros: taken for no turn"),
            Mend::Length(length) => {
                write!(
                    f,
                    "the quaternion has a length of {length:.3}: taken as if it were 1"
                )
            }
        }
    }
}

/// Indices of x, y and yaw among x, y, z and the rotations about them.
const PLANAR_AXES: [usize; 3] = [0, 1, 5];

/// `geometry_msgs/msg/Quaternion`; `w` is the real part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

part!(
    Quaternion = "geometry_msgs/Quaternion",
    "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"
);

declare! {
    /// `geometry_msgs/msg/Point`, in metres.
    #[derive(Copy)]
    part Point = "geometry_msgs/Point" [] {
        x: f64,
        y: f64,
        z: f64,
    }

    /// `geometry_msgs/msg/Vector3`: metres, metres per second or radians per second along or about
    /// the frame's axes.
    #[derive(Copy)]
    part Vector3 = "geometry_msgs/Vector3" [] {
        x: f64,
        y: f64,
        z: f64,
    }

    #[derive(Copy)]
    part Pose = "geometry_msgs/Pose" [Point, Quaternion] {
        position: Point,
        orientation: Quaternion,
    }

    #[derive(Copy)]
    part PoseWithCovariance = "geometry_msgs/PoseWithCovariance" [Pose] {
        pose: Pose,
        /// Row by row over x, y, z and the rotations about them.
        covariance: Rows6,
    }

    #[derive(Copy)]
    part Twist = "geometry_msgs/Twist" [Vector3] {
        /// Metres per second.
        linear: Vector3,
        /// Radians per second.
        angular: Vector3,
    }

    #[derive(Copy)]
    part TwistWithCovariance = "geometry_msgs/TwistWithCovariance" [Twist] {
        twist: Twist,
        /// Row by row over x, y, z and the rotations about them.
        covariance: Rows6,
    }

    /// `geometry_msgs/msg/Transform`: pose of the child frame in the parent frame.
    #[derive(Copy)]
    part Transform = "geometry_msgs/Transform" [Vector3, Quaternion] {
        /// Position of the child frame's origin, in metres.
        translation: Vector3,
        rotation: Quaternion,
    }
}

impl Default for Quaternion {
    /// The identity.
    fn default() -> Self {
        Quaternion {
            x: 0.0,
            y: 0.0,
            z: 0.0,
            w: 1.0,
        }
    }
}

impl Quaternion {
    /// Rotation about the z axis, in radians.
    pub fn from_yaw(yaw: f64) -> Self {
        let (sin, cos) = (0.5 * yaw).sin_cos();
        Quaternion {
            x: 0.0,
            y: 0.0,
            z: sin,
            w: cos,
        }
    }

    /// Heading of the rotated x axis, radians in `[-π, π]`, after the correction by
    /// [`Quaternion::mended`].
    pub fn yaw(self) -> Result<f64, ConversionError> {
        let (Quaternion { x, y, z, w }, _) = self.mended()?;
        // Both arguments scale with the squared length, so it does not need to be 1.
        Ok((2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z))
    }

    /// Corrects the quaternion: all zeros, as in a field that was never set, become the identity,
    /// and a rounded one gets the length 1. Also returns the correction that was applied.
    pub fn mended(self) -> Result<(Self, Option<Mend>), ConversionError> {
        let Quaternion { x, y, z, w } = self;
        let squared = x * x + y * y + z * z + w * w;
        if (squared - 1.0).abs() < ROTATION_TOLERANCE {
            return Ok((self, None));
        }
        if squared == 0.0 {
            return Ok((Quaternion::default(), Some(Mend::Zero)));
        }
        let length = squared.sqrt();
        if (length - 1.0).abs() > ROUNDING {
            return Err(self.no_rotation());
        }
        let [x, y, z, w] = [x, y, z, w].map(|part| part / length);
        match squared.is_finite() {
            true => Ok((Quaternion { x, y, z, w }, Some(Mend::Length(length)))),
            false => Err(self.no_rotation()),
        }
    }

    fn no_rotation(self) -> ConversionError {
        let Quaternion { x, y, z, w } = self;
        ConversionError(format!(
            "the quaternion ({x}, {y}, {z}, {w}) is not a rotation; allowed: a length of 1"
        ))
    }
}

impl Pose {
    /// Pose in the plane, at height 0.
    pub fn from_planar(pose: geometry::Pose) -> Self {
        Pose {
            position: Point {
                x: pose.x,
                y: pose.y,
                z: 0.0,
            },
            orientation: Quaternion::from_yaw(pose.yaw),
        }
    }

    /// Projects the pose to the plane.
    pub fn planar(&self) -> Result<geometry::Pose, ConversionError> {
        let Point { x, y, .. } = self.position;
        if !(x.is_finite() && y.is_finite()) {
            return Err(ConversionError(format!(
                "the position ({x}, {y}) is not finite"
            )));
        }
        Ok(geometry::Pose::new(x, y, self.orientation.yaw()?))
    }
}

impl Transform {
    /// Transform in the plane, at height 0.
    pub fn from_planar(pose: geometry::Pose) -> Self {
        Transform {
            translation: Vector3 {
                x: pose.x,
                y: pose.y,
                z: 0.0,
            },
            rotation: Quaternion::from_yaw(pose.yaw),
        }
    }
}

impl PoseWithCovariance {
    /// Estimate in the plane, with its covariance row by row over x, y and yaw: m², m·rad, rad².
    pub fn from_planar(pose: geometry::Pose, covariance: [f64; 9]) -> Self {
        let mut with = PoseWithCovariance {
            pose: Pose::from_planar(pose),
            ..PoseWithCovariance::default()
        };
        for (i, value) in covariance.into_iter().enumerate() {
            with.covariance[PLANAR_AXES[i / 3]][PLANAR_AXES[i % 3]] = value;
        }
        with
    }

    /// Covariance row by row over x, y and yaw: m², m·rad, rad².
    pub fn planar_covariance(&self) -> [f64; 9] {
        std::array::from_fn(|i| self.covariance[PLANAR_AXES[i / 3]][PLANAR_AXES[i % 3]])
    }
}

impl Twist {
    /// Motion in the plane: m/s, m/s and rad/s.
    pub fn from_planar(motion: geometry::Pose) -> Self {
        Twist {
            linear: Vector3 {
                x: motion.x,
                y: motion.y,
                z: 0.0,
            },
            angular: Vector3 {
                x: 0.0,
                y: 0.0,
                z: motion.yaw,
            },
        }
    }

    /// Projects the motion to the plane: m/s, m/s and rad/s.
    pub fn planar(&self) -> geometry::Pose {
        geometry::Pose::new(self.linear.x, self.linear.y, self.angular.z)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    #[test]
    fn yaw_comes_back_also_with_tilt() {
        for yaw in [0.0, 0.1, -3.0, FRAC_PI_2] {
            // Half angles and one arc tangent cost a few units in the last place.
            assert!((Quaternion::from_yaw(yaw).yaw().unwrap() - yaw).abs() < 1e-15);
        }
        // Upside down and turned by 0.4: the x axis still has that heading.
        let (sin, cos) = 0.2f64.sin_cos();
        let flipped = Quaternion {
            x: cos,
            y: sin,
            z: 0.0,
            w: 0.0,
        };
        assert!((flipped.yaw().unwrap() - 0.4).abs() < 1e-15);
        // Slightly too long, like values of writers that round.
        let long = Quaternion {
            w: 1.004,
            ..Quaternion::default()
        };
        assert_eq!(long.yaw().unwrap(), 0.0);
    }

    #[test]
    fn what_is_no_pose_is_refused() {
        let of_length = |w| Quaternion {
            w,
            ..Quaternion::default()
        };
        assert_eq!(of_length(0.0).yaw().unwrap(), 0.0, "it was never set");
        assert_eq!(of_length(0.96).yaw().unwrap(), 0.0, "it was rounded");
        let message = of_length(0.9).yaw().unwrap_err().to_string();
        assert_eq!(
            message,
            "the quaternion (0, 0, 0, 0.9) is not a rotation; allowed: a length of 1"
        );
        let nan = Quaternion {
            x: f64::NAN,
            ..Quaternion::default()
        };
        assert!(nan.yaw().is_err());
        let mut pose = Pose::from_planar(geometry::Pose::new(1.0, 2.0, PI));
        assert_eq!(pose.planar().unwrap(), geometry::Pose::new(1.0, 2.0, PI));
        pose.position.x = f64::INFINITY;
        let error = pose.planar().unwrap_err().to_string();
        assert_eq!(error, "the position (inf, 2) is not finite");
    }

    #[test]
    fn the_planar_covariance_is_of_x_y_and_yaw() {
        let mut with = PoseWithCovariance::default();
        for (row, values) in with.covariance.iter_mut().enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = (10 * row + column) as f64;
            }
        }
        assert_eq!(
            with.planar_covariance(),
            [0.0, 1.0, 5.0, 10.0, 11.0, 15.0, 50.0, 51.0, 55.0]
        );
        let planar = with.planar_covariance();
        let back = PoseWithCovariance::from_planar(geometry::Pose::IDENTITY, planar);
        assert_eq!(back.planar_covariance(), planar);
        assert_eq!(back.covariance[0][2], 0.0);
        let motion = geometry::Pose::new(1.0, 2.0, 0.5);
        assert_eq!(Twist::from_planar(motion).planar(), motion);
    }
}
