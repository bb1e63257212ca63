//! Where the laser sits on the robot.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use ros::{ConversionError, Mend, Transform, TransformStamped};

/// The names of a robot's base where odometry names none, the one that is preferred first.
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
    /// The frame that odometry moves.
    moved: Option<String>,
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

    /// Takes note of the child frame of odometry; whether it is another than before.
    pub fn on_odometry(&mut self, child: &str) -> bool {
        let child = plain(child);
        let is_new = !child.is_empty() && self.moved.as_deref() != Some(child);
        if is_new {
            self.moved = Some(child.to_owned());
        }
        is_new
    }

    /// A copy without the notes.
    pub(crate) fn sound(&self) -> TransformTree {
        TransformTree {
            parents: self.parents.clone(),
            moved: self.moved.clone(),
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

    /// The laser's place in the frame that odometry moves, if that bears the laser; else in
    /// the one with a usual name of a base, or else in the first, if it is connected to it.
    #[must_use]
    pub fn base_from(&self, laser: &str) -> Option<Mount> {
        let laser = plain(laser);
        let connected = self.connected_to(laser);
        let of_usual_name = || {
            BASES.iter().find_map(|base| {
                let is_base = |frame: &&String| frame.rsplit('/').next() == Some(base);
                connected.keys().find(is_base)
            })
        };
        let moved = self.moved.as_ref().filter(|frame| *frame != laser);
        let bearing = moved.filter(|frame| self.bears(frame, laser));
        let base = bearing.or_else(of_usual_name).or(moved)?;
        Some(mount(base, connected.get(base)?))
    }

    /// Whether a frame is above another one.
    fn bears(&self, frame: &str, child: &str) -> bool {
        let parent = |child: &str| self.parents.get(child).map(|(parent, _)| parent.as_str());
        // Transforms may go round.
        std::iter::successors(parent(child), |&above| parent(above))
            .take(self.parents.len())
            .any(|above| above == frame)
    }

    /// As [`TransformTree::base_from`], of the base frame with this name.
    #[must_use]
    pub fn base_named(&self, base: &str, laser: &str) -> Option<Mount> {
        let base = plain(base);
        Some(mount(base, self.connected_to(plain(laser)).get(base)?))
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

/// A laser's place in a base frame.
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
mod tests;
