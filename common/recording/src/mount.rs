//! Where the laser sits on the robot.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use ros::{ConversionError, Mend, Transform, TransformStamped};

/// The names of a robot's base, the one that is preferred first.
const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];

/// How far a laser may be from level, or from upside down: at 10 degrees a wall
/// seems 1.5 percent farther than it is.
pub const MAX_TILT_DEGREES: f64 = 10.0;

/// A laser's place on the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Mount {
    /// The base frame's name.
    pub base_frame: String,
    /// The laser in that frame, seen from above: its heading is that of the laser's
    /// x axis.
    pub base_from_laser: Pose,
    /// Whether the laser's z axis points down, so that its beams, seen from above,
    /// turn clockwise.
    pub upside_down: bool,
    /// How high the laser sits above the base frame, metres.
    pub height_m: f64,
    /// Angle between the z axes of laser and base, degrees; of a laser upside down,
    /// the angle to the opposite of the base's axis.
    pub tilt_degrees: f64,
}

impl From<&Mount> for geometry::Mount {
    /// What matters in the plane.
    fn from(mount: &Mount) -> Self {
        geometry::Mount {
            base_from_laser: mount.base_from_laser,
            is_upside_down: mount.upside_down,
        }
    }
}

/// Frames and what is known between them.
#[derive(Debug, Default)]
pub struct TransformTree {
    /// By child: its parent, and `parent_from_child`.
    parents: BTreeMap<String, (String, Isometry3<f64>)>,
    /// By child: the parent of a transform that is invalid, and why.
    broken: BTreeMap<String, (String, ConversionError)>,
    /// By child: what was wrong with the transform that it has.
    mended: BTreeMap<String, Mend>,
}

impl TransformTree {
    /// Adds a transform, or replaces the one that its child had. An invalid one
    /// is kept in mind only as far as [`TransformTree::broken_below`] asks.
    ///
    /// # Errors
    /// If it is no transform.
    pub fn add(&mut self, stamped: &TransformStamped) -> Result<(), ConversionError> {
        let parent = plain(&stamped.header.frame_id).to_owned();
        let child = plain(&stamped.child_frame_id).to_owned();
        let (parent_from_child, mend) = isometry(&stamped.transform)?;
        match mend {
            Some(mend) => self.mended.insert(child.clone(), mend),
            None => self.mended.remove(&child),
        };
        self.broken.remove(&child);
        self.parents.insert(child, (parent, parent_from_child));
        Ok(())
    }

    /// As [`TransformTree::add`], but an invalid one is noted, and ends nothing.
    pub fn take(&mut self, stamped: &TransformStamped) {
        if let Err(error) = self.add(stamped) {
            let parent = plain(&stamped.header.frame_id).to_owned();
            let child = plain(&stamped.child_frame_id).to_owned();
            self.broken.insert(child, (parent, error));
        }
    }

    /// What is wrong with transforms, the frames named: those that are none, and
    /// those that had to be mended.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        let broken = self.broken.iter().map(|(child, (parent, error))| {
            format!("the transform from {parent} to {child} is ignored: {error}")
        });
        let mended = self.mended.iter().map(|(child, mend)| {
            let parent = self.parents.get(child).map_or("", |(parent, _)| parent);
            format!("the transform from {parent} to {child}: {mend}")
        });
        broken.chain(mended)
    }

    /// A transform that is invalid, if only that keeps the laser from a base: its
    /// parent and child, and what is wrong.
    #[must_use]
    pub fn broken_below(&self, laser: &str) -> Option<(&str, &str, &ConversionError)> {
        let mut bridged = self.sound();
        if bridged.base_from(laser).is_some() {
            return None;
        }
        for (child, (parent, error)) in &self.broken {
            let link = (parent.clone(), Isometry3::identity());
            bridged.parents.entry(child.clone()).or_insert(link);
            if bridged.base_from(laser).is_some() {
                return Some((parent, child, error));
            }
        }
        None
    }

    /// A copy without the notes.
    pub(crate) fn sound(&self) -> TransformTree {
        TransformTree {
            parents: self.parents.clone(),
            ..TransformTree::default()
        }
    }

    /// Whether the frame has a parent.
    pub(crate) fn knows(&self, child: &str) -> bool {
        self.parents.contains_key(plain(child))
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
            upside_down: up.z < 0.0,
            height_m: place.z,
            tilt_degrees: up.xy().norm().atan2(up.z.abs()).to_degrees(),
        })
    }

    /// Where another frame lies in the laser's, seen from above, if they are
    /// connected.
    #[must_use]
    pub fn laser_from(&self, laser: &str, frame: &str) -> Option<Pose> {
        let connected = self.connected_to(plain(laser));
        // From above the frame, for the laser may look at it from below.
        let frame_from_laser = connected.get(plain(frame))?.inverse();
        let forward = frame_from_laser.rotation * Vector3::x();
        let place = frame_from_laser.translation;
        let seen = Pose::new(place.x, place.y, forward.y.atan2(forward.x));
        Some(seen.inverse())
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
pub(crate) fn plain(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

/// A transform in space, and what had to be mended.
///
/// # Errors
/// It is none.
pub(crate) fn isometry(
    transform: &Transform,
) -> Result<(Isometry3<f64>, Option<Mend>), ConversionError> {
    let place = transform.translation;
    let (turn, mend) = transform.rotation.mended()?;
    if !(place.x.is_finite() && place.y.is_finite() && place.z.is_finite()) {
        return Err(ConversionError::Position {
            x: place.x,
            y: place.y,
        });
    }
    let isometry = Isometry3::from_parts(
        Translation3::new(place.x, place.y, place.z),
        UnitQuaternion::from_quaternion(Quaternion::new(turn.w, turn.x, turn.y, turn.z)),
    );
    Ok((isometry, mend))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

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

    /// A turn by angles about x, then y, then z, radians.
    fn turned(roll: f64, pitch: f64, yaw: f64) -> ros::Quaternion {
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        ros::Quaternion {
            x: turn.i,
            y: turn.j,
            z: turn.k,
            w: turn.w,
        }
    }

    fn with_rotation(mut of: TransformStamped, turn: ros::Quaternion) -> TransformStamped {
        of.transform.rotation = turn;
        of
    }

    #[test]
    fn a_laser_upside_down_keeps_the_heading_of_its_x_axis() {
        let degree = PI / 180.0;
        for (turn, yaw, upside_down, tilt) in [
            ((0.0, 0.0, 0.5), 0.5, false, 0.0),
            ((PI, 0.0, 0.0), 0.0, true, 0.0),
            ((-PI, 0.0, 0.5), 0.5, true, 0.0),
            ((0.0, PI, 0.0), PI, true, 0.0),
            ((PI - 3.0 * degree, 0.0, -0.5), -0.5, true, 3.0),
            ((3.0 * degree, 0.0, 0.0), 0.0, false, 3.0),
            ((0.0, FRAC_PI_2, 0.0), 0.0, false, 90.0),
        ] {
            let (roll, pitch, about_z) = turn;
            let laser = transform("tower", "laser", (0.2, 0.0, 0.0), 0.0);
            let tree = tree(&[
                transform("base_link", "tower", (0.5, 0.0, 1.0), FRAC_PI_2),
                with_rotation(laser, turned(roll, pitch, about_z)),
            ]);
            let mount = tree.base_from("laser").unwrap();
            // 1e-9 is far above what a few rotations round, and far below a degree.
            assert!((mount.tilt_degrees - tilt).abs() < 1e-9, "{mount:?}");
            if tilt < MAX_TILT_DEGREES {
                assert_eq!(mount.upside_down, upside_down, "{mount:?}");
                let expected = Pose::new(0.5, 0.2, FRAC_PI_2 + yaw);
                assert!(
                    mount.base_from_laser.is_within(expected, 1e-9, 1e-9),
                    "{mount:?}"
                );
                let inverse = tree.laser_from("laser", "base_link").unwrap();
                assert!(
                    inverse.is_within(expected.inverse(), 1e-9, 1e-9),
                    "{inverse:?}"
                );
            }
        }
    }

    #[test]
    fn two_half_turns_make_a_level_laser() {
        let over = |parent, child| {
            let still = transform(parent, child, (0.0, 0.0, 0.0), 0.0);
            with_rotation(still, turned(PI, 0.0, 0.0))
        };
        let mount = tree(&[over("base_link", "plate"), over("plate", "laser")]);
        let mount = mount.base_from("laser").unwrap();
        assert!(!mount.upside_down && mount.tilt_degrees < 1e-9, "{mount:?}");
    }

    #[test]
    fn what_is_no_transform_counts_only_where_it_is_needed() {
        let nan = (f64::NAN, 0.0, 0.0);
        let mut tree = tree(&[
            transform("base_link", "plate", (1.0, 0.0, 0.0), 0.0),
            transform("plate", "laser", (1.0, 0.0, 0.0), 0.0),
        ]);
        tree.take(&transform("laser", "camera", nan, 0.0));
        tree.take(&transform("plate", "laser", nan, 0.0));
        assert_eq!(tree.base_from("laser").unwrap().base_from_laser.x, 2.0);
        assert!(tree.broken_below("laser").is_none());
        let notes: Vec<String> = tree.notes().collect();
        assert_eq!(
            notes[0],
            "the transform from laser to camera is ignored: the position (NaN, 0) is not finite"
        );
        tree.take(&transform("base_link", "rear", nan, 0.0));
        let (parent, child, _) = tree.broken_below("rear").unwrap();
        assert_eq!((parent, child), ("base_link", "rear"));
    }

    #[test]
    fn quaternions_are_mended_where_it_is_clear_what_is_meant() {
        let laser = || transform("base_link", "laser", (1.0, 0.0, 0.0), 0.0);
        let quaternion = |z: f64, w: f64| ros::Quaternion {
            x: 0.0,
            y: 0.0,
            z,
            w,
        };
        for (turn, expected) in [
            (
                quaternion(0.0, 0.0),
                "the transform from base_link to laser: the quaternion is all zeros: taken for no \
                 turn",
            ),
            (
                quaternion(0.0, 1.04),
                "the transform from base_link to laser: the quaternion has a length of 1.040: taken \
                 as if it were 1",
            ),
        ] {
            let mut tree = tree(&[with_rotation(laser(), turn)]);
            let mount = tree.base_from("laser").unwrap();
            assert_near(mount.base_from_laser, Pose::new(1.0, 0.0, 0.0));
            assert_eq!(tree.notes().collect::<Vec<_>>(), [expected]);
            tree.take(&laser());
            assert_eq!(tree.notes().count(), 0, "the latest counts");
        }
        for turn in [
            quaternion(0.0, 1.06),
            quaternion(0.5, 0.5),
            quaternion(f64::NAN, 1.0),
            quaternion(0.0, f64::INFINITY),
        ] {
            let mut tree = TransformTree::default();
            assert!(tree.add(&with_rotation(laser(), turn)).is_err(), "{turn:?}");
        }
    }
}
