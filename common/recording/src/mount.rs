//! Mount of the laser on the robot, from a tree of transforms.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use ros::{CloudMount, ConversionError, Mend, Transform, TransformStamped};

/// Usual names of a robot's base frame, in order of preference.
const BASES: [&str; 3] = ["base_link", "base_footprint", "base"];

const FLOOR: &str = BASES[1];

/// Largest tilt of a laser from level, or from upside down, in degrees: at 10 degrees a wall seems
/// 1.5 percent farther than it is.
pub const MAX_TILT_DEGREES: f64 = 10.0;

#[derive(Debug, Clone, PartialEq)]
pub struct Mount {
    pub base_frame: String,
    /// Pose of the laser in that frame, seen from above: its heading is that of the laser's x axis.
    pub base_from_laser: Pose,
    /// True if the laser's z axis points down, so that its beams turn clockwise seen from above.
    pub upside_down: bool,
    /// Height of the laser above the base frame, in metres.
    pub height_m: f64,
    /// Angle between the z axes of laser and base, in degrees; for a laser upside down, the angle
    /// to the opposite of the base's axis.
    pub tilt_degrees: f64,
}

impl From<&Mount> for geometry::Mount {
    fn from(mount: &Mount) -> Self {
        geometry::Mount {
            base_from_laser: mount.base_from_laser,
            is_upside_down: mount.upside_down,
        }
    }
}

#[derive(Debug, Default)]
pub struct TransformTree {
    /// Parent and `parent_from_child`, by child.
    parents: BTreeMap<String, (String, Isometry3<f64>)>,
    /// Parent and error of invalid transforms, by child.
    broken: BTreeMap<String, (String, ConversionError)>,
    /// Corrections that were applied to valid transforms, by child.
    mended: BTreeMap<String, Mend>,
    moved: Option<String>,
}

impl TransformTree {
    /// Adds a transform, or replaces the previous one of its child.
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

    /// Same as [`TransformTree::add`], but an invalid transform is only recorded, for
    /// [`TransformTree::notes`] and [`TransformTree::broken_below`].
    pub fn take(&mut self, stamped: &TransformStamped) {
        if let Err(error) = self.add(stamped) {
            let parent = plain(&stamped.header.frame_id).to_owned();
            let child = plain(&stamped.child_frame_id).to_owned();
            self.broken.insert(child, (parent, error));
        }
    }

    /// Describes invalid and corrected transforms, with their frames.
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

    /// Returns an invalid transform if it alone separates the laser from a base: parent, child and
    /// error.
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

    /// Sets the base frame to the child frame of odometry; returns true if it has changed.
    pub fn on_odometry(&mut self, child: &str) -> bool {
        let child = plain(child);
        let is_new = !child.is_empty() && self.moved.as_deref() != Some(child);
        if is_new {
            self.moved = Some(child.to_owned());
        }
        is_new
    }

    /// Returns a copy without the invalid transforms and the corrections.
    pub(crate) fn sound(&self) -> TransformTree {
        TransformTree {
            parents: self.parents.clone(),
            moved: self.moved.clone(),
            ..TransformTree::default()
        }
    }

    pub(crate) fn knows(&self, child: &str) -> bool {
        self.parents.contains_key(plain(child))
    }

    pub fn children(&self) -> usize {
        self.parents.len()
    }

    /// Mount of the laser in the child frame of odometry, if the laser is below it in the tree;
    /// otherwise in a frame with a usual name of a base, otherwise in the child frame of odometry
    /// if it is connected at all.
    pub fn base_from(&self, laser: &str) -> Option<Mount> {
        let connected = self.connected_to(plain(laser));
        let base = self.base_of(laser, &connected)?;
        Some(mount(base, connected.get(base)?))
    }

    /// Mount of a lidar in the frame `base`, or in that of [`TransformTree::base_from`], with its
    /// height over `base_footprint` if that is connected. Also returns the name of the base frame.
    pub fn cloud_mount(&self, base: Option<&str>, lidar: &str) -> Option<(String, CloudMount)> {
        let connected = self.connected_to(plain(lidar));
        let base = match base.map(plain).filter(|base| connected.contains_key(*base)) {
            Some(named) => named,
            None => self.base_of(lidar, &connected)?,
        };
        let mut base_from_lidar = connected.get(base)?.inverse();
        let mut frames = connected.iter();
        if let Some((_, lidar_from_floor)) = frames.find(|(frame, _)| is_called(frame, FLOOR)) {
            base_from_lidar.translation.z = lidar_from_floor.inverse().translation.z;
        }
        Some((base.to_owned(), CloudMount::new(base_from_lidar)))
    }

    /// Name of the base frame of a laser, among the frames that are connected to it.
    fn base_of<'a>(
        &'a self,
        laser: &str,
        connected: &'a BTreeMap<String, Isometry3<f64>>,
    ) -> Option<&'a String> {
        let laser = plain(laser);
        let of_usual_name = || {
            BASES.iter().find_map(|base| {
                let mut frames = connected.keys();
                frames.find(|frame| is_called(frame, base))
            })
        };
        let moved = self.moved.as_ref().filter(|frame| *frame != laser);
        let bearing = moved.filter(|frame| self.bears(frame, laser));
        bearing.or_else(of_usual_name).or(moved)
    }

    /// True if `frame` is an ancestor of `child`.
    fn bears(&self, frame: &str, child: &str) -> bool {
        let parent = |child: &str| self.parents.get(child).map(|(parent, _)| parent.as_str());
        // Transforms may form a cycle.
        std::iter::successors(parent(child), |&above| parent(above))
            .take(self.parents.len())
            .any(|above| above == frame)
    }

    /// Same as [`TransformTree::base_from`], for the base frame with this name.
    pub fn base_named(&self, base: &str, laser: &str) -> Option<Mount> {
        let base = plain(base);
        Some(mount(base, self.connected_to(plain(laser)).get(base)?))
    }

    /// Pose of another frame in the laser's frame, seen from above, if they are connected.
    pub fn laser_from(&self, laser: &str, frame: &str) -> Option<Pose> {
        let connected = self.connected_to(plain(laser));
        // Seen from above `frame`, because a laser upside down would see it from below.
        let frame_from_laser = connected.get(plain(frame))?.inverse();
        let forward = frame_from_laser.rotation * Vector3::x();
        let place = frame_from_laser.translation;
        let seen = Pose::new(place.x, place.y, forward.y.atan2(forward.x));
        Some(seen.inverse())
    }

    /// Every frame that is connected to the laser, with `laser_from_frame`.
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

fn mount(base: &str, laser_from_base: &Isometry3<f64>) -> Mount {
    let base_from_laser = laser_from_base.inverse();
    let forward = base_from_laser.rotation * Vector3::x();
    let up = base_from_laser.rotation * Vector3::z();
    let place = base_from_laser.translation;
    Mount {
        base_frame: base.to_owned(),
        base_from_laser: Pose::new(place.x, place.y, forward.y.atan2(forward.x)),
        upside_down: up.z < 0.0,
        height_m: place.z,
        tilt_degrees: up.xy().norm().atan2(up.z.abs()).to_degrees(),
    }
}

/// True if the frame has this name, with any prefix that ends in a slash.
fn is_called(frame: &str, name: &str) -> bool {
    frame.rsplit('/').next() == Some(name)
}

/// Strips the leading slash that some writers put before a frame's name, as ROS 1 once did.
pub(crate) fn plain(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

/// Converts a transform; also returns the correction that was applied, if any.
pub(crate) fn isometry(
    transform: &Transform,
) -> Result<(Isometry3<f64>, Option<Mend>), ConversionError> {
    let place = transform.translation;
    let (turn, mend) = transform.rotation.mended()?;
    if !(place.x.is_finite() && place.y.is_finite() && place.z.is_finite()) {
        return Err(ConversionError(format!(
            "the position ({}, {}) is not finite",
            place.x, place.y
        )));
    }
    let isometry = Isometry3::from_parts(
        Translation3::new(place.x, place.y, place.z),
        UnitQuaternion::from_quaternion(Quaternion::new(turn.w, turn.x, turn.y, turn.z)),
    );
    Ok((isometry, mend))
}

#[cfg(test)]
mod tests;
