//! What is sent of a pose.

use bytemuck::Zeroable;
use engine::joined::ByOdometry;
use engine::peaks::Target;
use engine::tracking::Report;
use geometry::{Covariance, Pose};
use messages::{FrameName, MapName, PoseHeader, Stamp, TrackReason, TrackState};

/// All that there is to send of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tracked {
    /// Of the scan.
    pub(crate) stamp: Stamp,
    /// The map, and what it is called.
    pub(crate) map_id: u64,
    pub(crate) map_name: MapName,
    /// What the tracker says of the scan.
    pub(crate) report: Report,
    /// Whose pose that is.
    pub(crate) target: Target,
    /// Whether it is known how the laser sits on the base.
    pub(crate) mount_known: bool,
    /// Where the target frame was by the odometry, and the odometry's frame.
    pub(crate) by_odometry: Option<(ByOdometry, FrameName)>,
    /// Nanoseconds of computing.
    pub(crate) tracking_ns: u64,
}

impl Tracked {
    /// Where the odometry's frame lies in the map.
    #[must_use]
    pub(crate) fn map_from_odom(&self) -> Option<Pose> {
        let (at, _) = self.by_odometry?;
        Some(self.report.pose?.then(at.odom_from_target.inverse()))
    }

    /// The message of the scan.
    #[must_use]
    pub(crate) fn header(&self) -> PoseHeader {
        self.header_at(self.stamp, true)
    }

    /// The same where odometry, of which this is the newest, has carried the pose on since the
    /// scan; none where it has begun anew. The frame of odometry keeps its place in the map.
    #[must_use]
    pub(crate) fn carried(&self, newest: ByOdometry, odometry_error: f64) -> Option<Self> {
        let (at, frame) = self.by_odometry?;
        let moved = newest.moved_since(&at)?;
        Some(Tracked {
            report: self.report.carried(moved, odometry_error),
            by_odometry: Some((newest, frame)),
            ..*self
        })
    }

    /// The message at a stamp, of a scan or between scans.
    #[must_use]
    pub(crate) fn header_at(&self, stamp: Stamp, from_scan: bool) -> PoseHeader {
        let report = &self.report;
        let map_from_target = report.pose.unwrap_or_default();
        let laser = self.target.laser(map_from_target);
        let base = self.target.base(map_from_target);
        let covariance = |of: Pose| {
            let target = Covariance(report.covariance);
            target.carried(map_from_target, of).to_rows()
        };
        let frame = self.by_odometry.map(|(_, frame)| frame);
        PoseHeader {
            stamp,
            map_id: self.map_id,
            tracking_ns: self.tracking_ns,
            since_ns: report.since_ns,
            since_m: report.since_m,
            map_from_laser: laser.into(),
            map_from_base: base.into(),
            map_from_odom: self.map_from_odom().unwrap_or_default().into(),
            laser_covariance: covariance(laser),
            base_covariance: covariance(base),
            probability: report.probability,
            lead: report.lead,
            score: report.score,
            state: report.state as u32,
            reason: report.reason as u32,
            places: report.rivals,
            from_scan: from_scan.into(),
            pose_known: report.pose.is_some().into(),
            mount_known: self.mount_known.into(),
            odom_known: self.map_from_odom().is_some().into(),
            odom_frame: frame.unwrap_or_else(|| FrameName::new("")),
            ..PoseHeader::zeroed()
        }
    }
}

/// What is sent of a scan of which nothing can be said.
#[must_use]
pub(crate) fn nothing(stamp: Stamp, map_id: u64, reason: TrackReason) -> PoseHeader {
    PoseHeader {
        stamp,
        map_id,
        state: TrackState::Searching as u32,
        reason: reason as u32,
        from_scan: 1,
        ..PoseHeader::zeroed()
    }
}
