//! Transforms between the robot's frames: the laser on the base, and the base in the odometry's
//! frame. Pure.
//!
//! Rejects lasers that are neither level nor upside down, and more frames than a robot has.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use geometry::{Mount, Pose};
use messages::{HypothesesHeader, Hypothesis, Odometry};
use recording::{MAX_TILT_DEGREES, TransformTree};
use ros::{CloudMount, TfMessage, TransformStamped};

use crate::GatewayError;

/// Number of odometry messages kept until the hypotheses of their scan come.
const KEPT: usize = 256;

/// Largest number of frames: a robot has some dozens.
const MAX_FRAMES: usize = 1000;

/// Longest name of a frame, bytes.
const MAX_NAME: usize = 256;

/// Largest number of mounts kept: a robot has some lasers, each with one frame.
const MAX_MOUNTS: usize = 64;

#[derive(Debug, Default)]
pub(crate) struct Frames {
    fixed: TransformTree,
    /// Child frames whose rotation was repaired; each is logged once.
    mended: BTreeSet<String>,
    /// Frame of the base, if the user names it.
    base: Option<String>,
    /// Mounts that the user gave, one per laser; empty if the transforms provide them.
    given: Vec<Mount>,
    /// Mounts by laser and its frame, found since the transforms last changed.
    mounts: BTreeMap<(usize, String), Option<Mount>>,
    /// Frame of the first laser, to which hypotheses refer.
    first: Option<String>,
    odometry: VecDeque<Odometry>,
}

impl Frames {
    /// Uses these mounts, and the frame `base` as the base if the transforms connect it to the laser.
    pub(crate) fn new(given: Vec<Mount>, base: Option<String>) -> Self {
        Frames {
            base,
            given,
            ..Frames::default()
        }
    }

    /// Takes transforms that never change. An invalid one does not keep the others from being used.
    pub(crate) fn on_static_transforms(&mut self, message: &TfMessage) -> Result<(), GatewayError> {
        let outcomes: Vec<_> = message.transforms.iter().map(|t| self.add(t)).collect();
        outcomes.into_iter().collect()
    }

    fn add(&mut self, transform: &TransformStamped) -> Result<(), GatewayError> {
        let (parent, child) = (&transform.header.frame_id, &transform.child_frame_id);
        if let Some(frame) = [parent, child].into_iter().find(|f| f.len() > MAX_NAME) {
            return Err(GatewayError::Refused(format!(
                "a frame's name has {} bytes: allowed are at most {MAX_NAME}",
                frame.len()
            )));
        }
        if self.fixed.children() >= MAX_FRAMES {
            return Err(GatewayError::Refused(format!(
                "too many frames, {child:?} is ignored: allowed are {MAX_FRAMES}"
            )));
        }
        self.fixed.add(transform).map_err(|error| {
            GatewayError::Refused(format!(
                "the transform from {parent} to {child} is ignored: {error}"
            ))
        })?;
        self.mounts.clear();
        if let Ok((_, Some(mend))) = transform.transform.rotation.mended()
            && self.mended.insert(child.clone())
        {
            tracing::warn!("the transform from {parent} to {child}: {mend}");
        }
        Ok(())
    }

    pub(crate) fn on_odometry(&mut self, odometry: &Odometry) {
        if self.fixed.on_odometry(odometry.child_frame.as_str()) {
            self.mounts.clear();
        }
        if self.odometry.len() == KEPT {
            self.odometry.pop_front();
        }
        self.odometry.push_back(*odometry);
    }

    /// Returns the mount of a laser with this frame on the base, if it is known.
    pub(crate) fn base_from_laser(
        &mut self,
        index: usize,
        laser: &str,
    ) -> Result<Option<Mount>, GatewayError> {
        if index == 0 && self.first.as_deref() != Some(laser) {
            self.first = Some(laser.to_owned());
        }
        let key = (index, laser.to_owned());
        if let Some(mount) = self.mounts.get(&key) {
            return Ok(*mount);
        }
        let fixed = &self.fixed;
        let named = self
            .base
            .as_ref()
            .and_then(|base| fixed.base_named(base, laser));
        let found = named.or_else(|| fixed.base_from(laser));
        let mount = match (self.given.get(index), found) {
            (Some(given), _) => Some(*given),
            (None, Some(mount)) if mount.tilt_degrees > MAX_TILT_DEGREES => {
                return Err(GatewayError::Refused(format!(
                    "the laser {laser} is tilted by {:.1} degrees against {}: allowed are at most \
                     {MAX_TILT_DEGREES}, also upside down",
                    mount.tilt_degrees, mount.base_frame
                )));
            }
            (None, mount) => mount.as_ref().map(Mount::from),
        };
        if let Some(mount) = mount {
            tracing::info!(
                laser,
                x = mount.base_from_laser.x,
                y = mount.base_from_laser.y,
                yaw = mount.base_from_laser.yaw,
                upside_down = mount.is_upside_down,
                "the mount"
            );
        }
        self.keep(key, mount);
        Ok(mount)
    }

    fn keep(&mut self, key: (usize, String), mount: Option<Mount>) {
        if self.mounts.len() >= MAX_MOUNTS {
            self.mounts.clear();
        }
        self.mounts.insert(key, mount);
    }

    /// Returns the mount of a lidar with this frame: the given one, or that of the transforms. Its
    /// planar part is that of the first laser from now on.
    pub(crate) fn cloud_mount(
        &mut self,
        given: Option<CloudMount>,
        lidar: &str,
    ) -> Result<CloudMount, GatewayError> {
        let found = || self.fixed.cloud_mount(self.base.as_deref(), lidar);
        let mount = given.or_else(|| found().map(|(_, mount)| mount));
        let mount = mount.ok_or_else(|| {
            GatewayError::Refused(format!(
                "no transform says where {lidar}, the frame of the point cloud, sits on the robot: \
                 allowed are clouds with a mount, by /tf_static or --cloud-mount"
            ))
        })?;
        self.keep((0, lidar.to_owned()), Some(mount.planar()));
        Ok(mount)
    }

    /// Returns the pose of the odometry's frame in the map, and its name, by the best hypothesis of
    /// a scan; `None` without odometry, or if its child frame is not known to belong to the laser.
    pub(crate) fn map_from_odom(
        &self,
        header: &HypothesesHeader,
        best: &Hypothesis,
    ) -> Option<(Pose, String)> {
        let odometry = self.odometry_at(header.stamp.measured_ns)?;
        let child = odometry.child_frame.as_str();
        let map_from_laser = Pose::from(best.map_from_laser);
        let laser_from_child = match self.first.as_deref() {
            Some(laser) if laser == child => Some(Pose::IDENTITY),
            Some(laser) => self.fixed.laser_from(laser, child),
            None => None,
        };
        let map_from_child = match laser_from_child {
            Some(laser_from_child) => map_from_laser.then(laser_from_child),
            // The child frame of the odometry is the base, by any name.
            None if header.mount_known != 0 => best.map_from_base.into(),
            None => return None,
        };
        let odom_from_child = Pose::from(odometry.odom_from_child);
        let map_from_odom = map_from_child.then(odom_from_child.inverse());
        Some((map_from_odom, odometry.frame.as_str().to_owned()))
    }

    /// Returns the motion of the robot since then by odometry, if that goes back so far.
    pub(crate) fn moved_since(&self, measured_ns: i64) -> Option<Pose> {
        let (first, newest) = (self.odometry.front()?, self.odometry.back()?);
        if first.stamp.measured_ns > measured_ns {
            return None;
        }
        let then = Pose::from(self.odometry_at(measured_ns)?.odom_from_child);
        Some(then.inverse().then(newest.odom_from_child.into()))
    }

    /// Returns the newest odometry up to this time, else the oldest.
    fn odometry_at(&self, measured_ns: i64) -> Option<&Odometry> {
        let by_then = |odometry: &&Odometry| odometry.stamp.measured_ns <= measured_ns;
        let newest = self.odometry.iter().rev().find(by_then);
        newest.or(self.odometry.front())
    }
}

#[cfg(test)]
mod tests;
