//! The tree of frames: transforms between the map, the odometry, the robot and its lasers.
//!
//! ```text
//! map ──► odom ──► base_link ──► laser      with odometry and a known mount
//! map ──► base_link ──► laser               without odometry
//! map ──► laser                             without a known mount
//! ```
//!
//! Transforms that are computed from others use their recorded values, so that they are the same
//! when the recording is replayed and recorded again. A frame has one parent, so the robot is below
//! the odometry once there is odometry. The map's transform is only given if the verdict is Unique.

use std::collections::VecDeque;

use geometry::Pose;
use messages::{HypothesesHeader, Hypothesis, Odometry, PoseHeader, ScanHeader, Verdict};
use ros::{Header, TfMessage, Time, TransformStamped, planar, poses};

use super::transforms;

/// Number of odometry samples that are kept for the hypotheses of a scan.
const KEPT: usize = 256;

#[derive(Debug, Default)]
pub(super) struct Frames {
    map: String,
    base: String,
    laser: Option<Laser>,
    mounts: Vec<TransformStamped>,
    odometry: VecDeque<Odometry>,
}

#[derive(Debug, Clone, PartialEq)]
struct Laser {
    frame: String,
    /// Pose on the base, if known.
    mount: Option<Pose>,
    is_upside_down: bool,
}

impl Frames {
    pub(super) fn new(map: &str, base: &str) -> Self {
        Frames {
            map: map.to_owned(),
            base: base.to_owned(),
            ..Frames::default()
        }
    }

    /// Evaluates the header of a scan; returns all mounts if its own is new.
    pub(super) fn on_scan(&mut self, scan: &ScanHeader, stamp: Time) -> Option<TfMessage> {
        let frame = scan.frame.as_str();
        let mount =
            (scan.mount_known != 0).then(|| planar::as_recorded(scan.base_from_laser.into()));
        let laser = Laser {
            frame: frame.to_owned(),
            mount,
            is_upside_down: scan.upside_down == 1,
        };
        if self.laser.as_ref() == Some(&laser) {
            return None;
        }
        let transform = mount.map(|mount| laser.stamped(stamp, &self.base, mount));
        self.laser = Some(laser);
        let transform = transform?;
        let known = self.mounts.iter_mut().find(|m| m.child_frame_id == frame);
        match known {
            Some(known) if known.transform == transform.transform => return None,
            Some(known) => *known = transform,
            None => self.mounts.push(transform),
        }
        Some(transforms(self.mounts.clone()))
    }

    /// Stores odometry; returns the transform of the robot in its frame.
    pub(super) fn on_odometry(&mut self, odometry: &Odometry, stamp: Time) -> TfMessage {
        if self.odometry.len() == KEPT {
            self.odometry.pop_front();
        }
        self.odometry.push_back(*odometry);
        let (child, odom_from_robot) = self.robot_in(odometry);
        let parent = odometry.frame.as_str();
        transforms(vec![stamped(stamp, parent, &child, odom_from_robot)])
    }

    /// Transform below the map's frame, by the best hypothesis of a scan.
    pub(super) fn localized(
        &self,
        header: &HypothesesHeader,
        best: &Hypothesis,
        stamp: Time,
    ) -> Option<TfMessage> {
        if Verdict::from_code(header.verdict) != Some(Verdict::Unique) {
            return None;
        }
        let laser = self.laser.as_ref()?;
        let mount = laser.mount;
        let map_from_robot = poses::robot(header, best);
        let odometry = self.odometry_at(header.stamp.measured_ns);
        let transform = match odometry {
            // The odometry moves the laser's frame, or the mount relates the two.
            Some(odometry) if mount.is_some() || odometry.child_frame.as_str() == laser.frame => {
                let (_, odom_from_robot) = self.robot_in(odometry);
                let map_from_odom = map_from_robot.then(odom_from_robot.inverse());
                stamped(stamp, &self.map, odometry.frame.as_str(), map_from_odom)
            }
            Some(_) => laser.stamped(stamp, &self.map, map_from_robot),
            None if mount.is_some() => stamped(stamp, &self.map, &self.base, map_from_robot),
            None => laser.stamped(stamp, &self.map, map_from_robot),
        };
        Some(transforms(vec![transform]))
    }

    /// Transform below the map's frame by the tracker, if it believes a place.
    pub(super) fn tracked(&self, header: &PoseHeader, stamp: Time) -> Option<TfMessage> {
        if !header.is_believed() {
            return None;
        }
        let transform = match (header.odom_known, header.mount_known) {
            // The robot is already below the odometry, and a frame has one parent.
            (0, _) if !self.odometry.is_empty() => return None,
            (1, _) => {
                let odom = header.odom_frame.as_str();
                stamped(stamp, &self.map, odom, header.map_from_odom.into())
            }
            (_, 0) => {
                let laser = self.laser.as_ref()?;
                laser.stamped(stamp, &self.map, header.map_from_laser.into())
            }
            _ => stamped(stamp, &self.map, &self.base, header.map_from_base.into()),
        };
        Some(transforms(vec![transform]))
    }

    /// Frame of the robot and its pose in the odometry's frame: that of the base if the odometry
    /// moves a laser with a known mount.
    fn robot_in(&self, odometry: &Odometry) -> (String, Pose) {
        let child = odometry.child_frame.as_str();
        let odom_from_child = planar::as_recorded(odometry.odom_from_child.into());
        match &self.laser {
            Some(Laser {
                frame,
                mount: Some(base_from_laser),
                ..
            }) if frame == child => {
                let odom_from_base = odom_from_child.then(base_from_laser.inverse());
                (self.base.clone(), odom_from_base)
            }
            _ => (child.to_owned(), odom_from_child),
        }
    }

    /// Newest odometry up to this time, otherwise the first.
    fn odometry_at(&self, measured_ns: i64) -> Option<&Odometry> {
        let by_then = |odometry: &&Odometry| odometry.stamp.measured_ns <= measured_ns;
        let newest = self.odometry.iter().rev().find(by_then);
        newest.or(self.odometry.front())
    }
}

impl Laser {
    /// Transform of the laser's frame, by its pose seen from above.
    fn stamped(&self, stamp: Time, parent: &str, parent_from_laser: Pose) -> TransformStamped {
        let mut stamped = stamped(stamp, parent, &self.frame, parent_from_laser);
        if self.is_upside_down {
            stamped.transform = planar::upside_down(stamped.transform);
        }
        stamped
    }
}

fn stamped(stamp: Time, parent: &str, child: &str, parent_from_child: Pose) -> TransformStamped {
    TransformStamped {
        header: Header::new(stamp, parent),
        child_frame_id: child.to_owned(),
        transform: planar::transform(parent_from_child),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{FrameName, Pose2, TrackState};

    use super::*;

    fn at(x: f64) -> Pose2 {
        Pose::new(x, 0.0, 0.0).into()
    }

    fn scan(mount_known: bool) -> ScanHeader {
        ScanHeader {
            frame: FrameName::new("laser"),
            base_from_laser: at(if mount_known { 0.5 } else { 0.0 }),
            mount_known: mount_known.into(),
            ..ScanHeader::zeroed()
        }
    }

    fn odometry(child: &str, x: f64) -> Odometry {
        Odometry {
            odom_from_child: at(x),
            frame: FrameName::new("odom"),
            child_frame: FrameName::new(child),
            ..Odometry::zeroed()
        }
    }

    fn shown(message: Option<TfMessage>) -> String {
        let transforms = message
            .map(|message| message.transforms)
            .unwrap_or_default();
        let show = |t: &TransformStamped| {
            let (parent, x) = (&t.header.frame_id, t.transform.translation.x);
            format!("{parent}->{} {x}", t.child_frame_id)
        };
        transforms.iter().map(show).collect::<Vec<_>>().join(", ")
    }

    /// Transform for a laser at 10 whose base is half a metre behind it.
    fn localized(frames: &Frames, mount_known: bool, verdict: Verdict) -> String {
        let header = HypothesesHeader {
            verdict: verdict as u32,
            mount_known: mount_known.into(),
            ..HypothesesHeader::zeroed()
        };
        let best = Hypothesis {
            map_from_laser: at(10.0),
            map_from_base: at(9.5),
            ..Hypothesis::zeroed()
        };
        shown(frames.localized(&header, &best, Time::default()))
    }

    #[test]
    fn without_odometry_the_map_holds_the_robot() {
        let mut frames = Frames::new("map", "base_link");
        assert_eq!(localized(&frames, false, Verdict::Unique), "");
        assert_eq!(shown(frames.on_scan(&scan(false), Time::default())), "");
        assert_eq!(localized(&frames, false, Verdict::Unique), "map->laser 10");
        let mounts = frames.on_scan(&scan(true), Time::default());
        assert_eq!(shown(mounts), "base_link->laser 0.5");
        assert_eq!(shown(frames.on_scan(&scan(true), Time::default())), "");
        assert_eq!(
            localized(&frames, true, Verdict::Unique),
            "map->base_link 9.5"
        );
        assert_eq!(localized(&frames, true, Verdict::Ambiguous), "");
    }

    #[test]
    fn with_odometry_the_map_holds_its_frame() {
        let mut frames = Frames::new("map", "base_link");
        frames.on_scan(&scan(true), Time::default());
        let base = frames.on_odometry(&odometry("base_link", 2.0), Time::default());
        assert_eq!(shown(Some(base)), "odom->base_link 2");
        assert_eq!(localized(&frames, true, Verdict::Unique), "map->odom 7.5");
        // The laser that the odometry moves is below the base already.
        let laser = frames.on_odometry(&odometry("laser", 2.0), Time::default());
        assert_eq!(shown(Some(laser)), "odom->base_link 1.5");
        assert_eq!(localized(&frames, true, Verdict::Unique), "map->odom 8");
    }

    #[test]
    fn where_nobody_knows_how_laser_and_base_lie_neither_is_moved() {
        let mut frames = Frames::new("map", "base_link");
        frames.on_scan(&scan(false), Time::default());
        frames.on_odometry(&odometry("base_link", 2.0), Time::default());
        assert_eq!(localized(&frames, false, Verdict::Unique), "map->laser 10");
        frames.on_odometry(&odometry("laser", 2.0), Time::default());
        assert_eq!(localized(&frames, false, Verdict::Unique), "map->odom 8");
    }

    #[test]
    fn the_tracker_says_where_the_map_lies_as_long_as_it_believes_a_place() {
        let mut frames = Frames::new("map", "base_link");
        frames.on_scan(&scan(true), Time::default());
        let mut header = PoseHeader {
            map_from_base: at(9.5),
            map_from_odom: at(7.0),
            pose_known: 1,
            mount_known: 1,
            odom_known: 1,
            odom_frame: FrameName::new("odom"),
            state: TrackState::Doubtful as u32,
            ..PoseHeader::zeroed()
        };
        let shown_of = |header: &PoseHeader| shown(frames.tracked(header, Time::default()));
        assert_eq!(shown_of(&header), "map->odom 7");
        header.odom_known = 0;
        assert_eq!(shown_of(&header), "map->base_link 9.5");
        header.state = TrackState::Lost as u32;
        assert_eq!(shown_of(&header), "");
        header.state = TrackState::Unique as u32;
        frames.on_odometry(&odometry("base_link", 2.0), Time::default());
        let shown_of = |header: &PoseHeader| shown(frames.tracked(header, Time::default()));
        assert_eq!(shown_of(&header), "", "the base hangs on the odometry");
    }
}
