//! Where the laser sits on the robot.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::f64::consts::PI;

use geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use crate::ros::{ConversionError, Transform, TransformStamped};

/// The names of a robot's base, the one that is preferred first.
const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];

/// How far a laser may be from level: at 10 degrees a wall seems 1.5 percent
/// farther than it is.
pub const MAX_TILT_DEGREES: f64 = 10.0;

/// A laser's place on the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Mount {
    /// The base frame's name.
    pub base_frame: String,
    /// The laser in that frame, seen from above.
    pub base_from_laser: Pose,
    /// How high the laser sits above the base frame, metres.
    pub height_m: f64,
    /// Angle between the z axes of laser and base, degrees, from level or from upside
    /// down, whichever is nearer.
    pub tilt_degrees: f64,
    /// Whether the laser hangs upside down.
    pub upside_down: bool,
}

/// Frames and what is known between them.
#[derive(Debug, Default)]
pub struct TransformTree {
    /// By child: its parent, and `parent_from_child`.
    parents: BTreeMap<String, (String, Isometry3<f64>)>,
}

impl TransformTree {
    /// Adds a transform, or replaces the one that its child had.
    ///
    /// # Errors
    /// If it is no transform.
    pub fn add(&mut self, stamped: &TransformStamped) -> Result<(), ConversionError> {
        let parent_from_child = isometry(&stamped.transform)?;
        let parent = plain(&stamped.header.frame_id).to_owned();
        let child = plain(&stamped.child_frame_id).to_owned();
        self.parents.insert(child, (parent, parent_from_child));
        Ok(())
    }

    /// How many frames have a parent.
    #[must_use]
    pub fn children(&self) -> usize {
        self.parents.len()
    }

    /// The laser's place in the base frame that is preferred among those that
    /// it is connected to.
    #[must_use]
    pub fn base_from(&self, laser: &str) -> Option<Mount> {
        let connected = self.connected_to(plain(laser));
        let base = BASES.iter().find_map(|base| {
            let is_base = |frame: &&String| frame.rsplit('/').next() == Some(base);
            connected.keys().find(is_base)
        })?;
        let base_from_laser = connected.get(base)?.inverse();
        let forward = base_from_laser.rotation * Vector3::x();
        let up = base_from_laser.rotation * Vector3::z();
        let place = base_from_laser.translation;
        Some(Mount {
            base_frame: base.clone(),
            base_from_laser: Pose::new(place.x, place.y, forward.y.atan2(forward.x)),
            height_m: place.z,
            tilt_degrees: up.z.abs().min(1.0).acos().to_degrees(),
            upside_down: up.z < 0.0,
        })
    }

    /// Where another frame lies in the laser's, seen from above, if they are
    /// connected.
    #[must_use]
    pub fn laser_from(&self, laser: &str, frame: &str) -> Option<Pose> {
        let connected = self.connected_to(plain(laser));
        let laser_from_frame = *connected.get(plain(frame))?;
        let laser_from_frame = match self.base_from(laser) {
            // Seen from above, a laser upside down is mirrored.
            Some(mount) if mount.upside_down => {
                let roll = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
                Isometry3::from_parts(Translation3::identity(), roll) * laser_from_frame
            }
            _ => laser_from_frame,
        };
        let forward = laser_from_frame.rotation * Vector3::x();
        let place = laser_from_frame.translation;
        Some(Pose::new(place.x, place.y, forward.y.atan2(forward.x)))
    }

    /// Every frame that is connected to the laser, as `laser_from_frame`.
    fn connected_to(&self, laser: &str) -> BTreeMap<String, Isometry3<f64>> {
        let mut found = BTreeMap::new();
        let mut queue = VecDeque::from([(laser.to_owned(), Isometry3::identity())]);
        let mut seen = BTreeSet::new();
        while let Some((frame, laser_from_frame)) = queue.pop_front() {
            if !seen.insert(frame.clone()) {
                continue;
            }
            if let Some((parent, parent_from_frame)) = self.parents.get(&frame) {
                let laser_from_parent = laser_from_frame * parent_from_frame.inverse();
                queue.push_back((parent.clone(), laser_from_parent));
            }
            for (child, (parent, frame_from_child)) in &self.parents {
                if *parent == frame {
                    queue.push_back((child.clone(), laser_from_frame * frame_from_child));
                }
            }
            found.insert(frame, laser_from_frame);
        }
        found
    }
}

/// Some writers put a slash before a frame's name, as ROS 1 once did.
fn plain(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

fn isometry(transform: &Transform) -> Result<Isometry3<f64>, ConversionError> {
    let place = transform.translation;
    let turn = transform.rotation;
    turn.check()?;
    if !(place.x.is_finite() && place.y.is_finite() && place.z.is_finite()) {
        return Err(ConversionError::Position {
            x: place.x,
            y: place.y,
        });
    }
    Ok(Isometry3::from_parts(
        Translation3::new(place.x, place.y, place.z),
        UnitQuaternion::from_quaternion(Quaternion::new(turn.w, turn.x, turn.y, turn.z)),
    ))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::ros;

    fn transform(
        parent: &str,
        child: &str,
        (x, y, z): (f64, f64, f64),
        yaw: f64,
    ) -> TransformStamped {
        TransformStamped {
            header: ros::Header {
                frame_id: parent.to_owned(),
                ..ros::Header::default()
            },
            child_frame_id: child.to_owned(),
            transform: Transform {
                translation: ros::Vector3 { x, y, z },
                rotation: ros::Quaternion::from_yaw(yaw),
            },
        }
    }

    fn tree(transforms: &[TransformStamped]) -> TransformTree {
        let mut tree = TransformTree::default();
        for transform in transforms {
            tree.add(transform).unwrap();
        }
        tree
    }

    fn assert_near(found: Pose, expected: Pose) {
        // A few rotations of numbers near 1: a few units in the last place.
        assert!(
            found.is_within(expected, 1e-12, 1e-12),
            "{found:?} {expected:?}"
        );
    }

    #[test]
    fn a_laser_ahead_of_the_base() {
        let tree = tree(&[transform("base_link", "laser", (0.78, 0.0, 0.3), 0.0)]);
        let mount = tree.base_from("/laser").unwrap();
        assert_eq!(mount.base_frame, "base_link");
        assert_near(mount.base_from_laser, Pose::new(0.78, 0.0, 0.0));
        assert_eq!((mount.height_m, mount.tilt_degrees), (0.3, 0.0));
        assert_eq!(tree.base_from("camera"), None);
        let behind = tree.laser_from("laser", "/base_link").unwrap();
        assert_near(behind, Pose::new(-0.78, 0.0, 0.0));
        assert_eq!(tree.laser_from("laser", "camera"), None);
    }

    #[test]
    fn chains_are_followed_and_base_link_is_preferred() {
        let mut transforms = vec![
            transform("base_footprint", "base_link", (1.0, 0.0, 0.1), 0.0),
            transform("base_link", "tower", (0.5, 0.0, 1.0), FRAC_PI_2),
            transform("tower", "laser", (0.2, 0.0, 0.0), FRAC_PI_2),
        ];
        let mount = tree(&transforms).base_from("laser").unwrap();
        assert_eq!(mount.base_frame, "base_link");
        assert_near(
            mount.base_from_laser,
            Pose::new(0.5, 0.2, std::f64::consts::PI),
        );
        transforms.remove(0);
        transforms[0].header.frame_id = "base_footprint".to_owned();
        let mount = tree(&transforms).base_from("laser").unwrap();
        assert_eq!(mount.base_frame, "base_footprint");
    }

    #[test]
    fn a_base_beside_or_below_the_laser_is_found() {
        let beside = tree(&[
            transform("chassis", "r1/base_link", (0.0, 0.0, 0.0), FRAC_PI_2),
            transform("chassis", "r1/laser", (1.0, 0.0, 0.0), 0.0),
        ]);
        let mount = beside.base_from("r1/laser").unwrap();
        assert_eq!(mount.base_frame, "r1/base_link");
        assert_near(mount.base_from_laser, Pose::new(0.0, -1.0, -FRAC_PI_2));
    }

    #[test]
    fn the_latest_transform_counts_and_a_circle_ends() {
        let mut tree = tree(&[
            transform("base_link", "laser", (1.0, 0.0, 0.0), 0.0),
            transform("base_link", "laser", (2.0, 0.0, 0.0), 0.0),
        ]);
        let mount = tree.base_from("laser").unwrap();
        assert_near(mount.base_from_laser, Pose::new(2.0, 0.0, 0.0));
        tree.add(&transform("laser", "base_link", (0.0, 0.0, 0.0), 0.0))
            .unwrap();
        assert!(tree.base_from("laser").is_some());
        let itself = tree.base_from("base_link").unwrap();
        assert_near(itself.base_from_laser, Pose::IDENTITY);
    }

    #[test]
    fn tilt_is_measured_against_the_base() {
        let mut upside_down = transform("base_link", "laser", (0.0, 0.0, 0.0), 0.0);
        upside_down.transform.rotation = ros::Quaternion {
            x: 1.0,
            y: 0.0,
            z: 0.0,
            w: 0.0,
        };
        let mount = tree(&[upside_down.clone()]).base_from("laser").unwrap();
        assert!(mount.upside_down && mount.tilt_degrees < 1e-6);
        upside_down.transform.rotation.x = 0.0;
        assert!(TransformTree::default().add(&upside_down).is_err());
    }
}
