//! Messages about a pose.

use bytemuck::Zeroable;
use engine::joined::ByOdometry;
use engine::peaks::Target;
use engine::tracking::Report;
use geometry::Pose;
use messages::{FrameName, MapName, PoseHeader, Stamp, TrackReason, TrackState};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tracked {
    pub(crate) stamp: Stamp,
    pub(crate) map_id: u64,
    pub(crate) map_name: MapName,
    pub(crate) report: Report,
    pub(crate) target: Target,
    pub(crate) mount_known: bool,
    /// Odometry of the target frame, and the name of the odometry frame.
    pub(crate) by_odometry: Option<(ByOdometry, FrameName)>,
    pub(crate) tracking_ns: u64,
}

impl Tracked {
    pub(crate) fn map_from_odom(&self) -> Option<Pose> {
        let (at, _) = self.by_odometry?;
        Some(self.report.pose?.then(at.odom_from_target.inverse()))
    }

    pub(crate) fn header(&self) -> PoseHeader {
        self.header_at(self.stamp, true)
    }

    /// Extrapolates the result to the newest odometry; `None` if odometry was reset since.
    pub(crate) fn carried(&self, newest: ByOdometry, odometry_error: f64) -> Option<Self> {
        let (at, frame) = self.by_odometry?;
        let moved = newest.moved_since(&at)?;
        Some(Tracked {
            report: self.report.carried(moved, odometry_error),
            by_odometry: Some((newest, frame)),
            ..*self
        })
    }

    /// Returns the message with this stamp, of a scan or between scans.
    pub(crate) fn header_at(&self, stamp: Stamp, from_scan: bool) -> PoseHeader {
        let report = &self.report;
        let map_from_target = report.pose.unwrap_or_default();
        let laser = self.target.laser(map_from_target);
        let base = self.target.base(map_from_target);
        let covariance = |of: Pose| {
            let carried = report.covariance.carried(map_from_target, of);
            carried.to_rows()
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
