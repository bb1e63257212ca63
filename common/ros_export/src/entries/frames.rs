//! The tree of frames: how the map, the odometry, the robot and its lasers lie to
//! each other.
//!
//! ```text
//! map ──► odom ──► base_link ──► laser      with odometry and a known mount
//! map ──► base_link ──► laser               without odometry
//! map ──► laser                             without a known mount
//! ```
//!
//! Transforms that are made of others are made of them as they are recorded, so
//! that they come out the same when the recording is played and recorded again.
//! A frame has one parent, so the robot hangs below the odometry as soon as
//! there is one. The map's transform is given only where the verdict is Unique.

use std::collections::VecDeque;

use geometry::Pose;
use messages::{HypothesesHeader, Hypothesis, Odometry, PoseHeader, ScanHeader, Verdict};
use ros::{Header, TfMessage, Time, TransformStamped, planar, poses};

use super::transforms;

/// Odometry that is kept until the hypotheses of its scan come.
const KEPT: usize = 256;

#[derive(Debug)]
pub(super) struct Frames {
    map: String,
    base: String,
    /// The laser whose scan came last, and how it sits.
    laser: Option<Laser>,
    mounts: Vec<TransformStamped>,
    odometry: VecDeque<Odometry>,
}

/// A laser, and how it sits.
#[derive(Debug, Clone, PartialEq)]
struct Laser {
    frame: String,
    /// On the base, if that is known.
    mount: Option<Pose>,
    is_upside_down: bool,
}

impl Frames {
    pub(super) fn new(map: &str, base: &str) -> Self {
        Frames {
            map: map.to_owned(),
            base: base.to_owned(),
            laser: None,
            mounts: Vec::new(),
            odometry: VecDeque::with_capacity(KEPT),
        }
    }

    /// Takes a scan's header; gives all mounts where its own is new.
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

    /// Takes odometry; gives the robot's place in its frame.
    pub(super) fn on_odometry(&mut self, odometry: &Odometry, stamp: Time) -> TfMessage {
        if self.odometry.len() == KEPT {
            self.odometry.pop_front();
        }
        self.odometry.push_back(*odometry);
        let (child, odom_from_robot) = self.robot_in(odometry);
        let parent = odometry.frame.as_str();
        transforms(vec![stamped(stamp, parent, &child, odom_from_robot)])
    }

    /// Where the map's frame lies, by the best hypothesis of a scan.
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
            // Its frame is the laser's, or the mount relates the two.
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

    /// Where the map's frame lies, by the tracker: as long as it believes a place.
    pub(super) fn tracked(&self, header: &PoseHeader, stamp: Time) -> Option<TfMessage> {
        if !header.is_believed() {
            return None;
        }
        let transform = match (header.odom_known, header.mount_known) {
            // The odometry says where its frame has the robot, which has one parent.
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

    /// The robot's frame and its place in the odometry's: where the odometry is
    /// of a laser whose mount is known, that of the base.
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

    /// The newest odometry up to this time, else the first.
    fn odometry_at(&self, measured_ns: i64) -> Option<&Odometry> {
        let by_then = |odometry: &&Odometry| odometry.stamp.measured_ns <= measured_ns;
        let newest = self.odometry.iter().rev().find(by_then);
        newest.or(self.odometry.front())
    }
}

impl Laser {
    /// Where the laser's frame is, seen from above.
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

    const AHEAD: Pose2 = Pose2 {
        x: 0.5,
        y: 0.0,
        yaw: 0.0,
    };

    fn at(x: f64) -> Pose2 {
        Pose2 {
            x,
            y: 0.0,
            yaw: 0.0,
        }
    }

    fn scan(mount_known: bool) -> ScanHeader {
        ScanHeader {
            frame: FrameName::new("laser"),
            base_from_laser: if mount_known { AHEAD } else { at(0.0) },
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

    /// `parent->child x` of the only transform.
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

    /// The laser is at 10, the base half a metre behind.
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
        // The laser of the odometry hangs below the base already.
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
