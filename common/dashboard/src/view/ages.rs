//! Ages of the newest scan and pose: show whether data still arrives.

use messages::{HypothesesHeader, PoseHeader};
use serde::Serialize;

/// Arrival times of the newest data, by the host's monotonic clock.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Times {
    /// Entry into the graph of the newest scan with a result.
    scan_ns: Option<i64>,
    /// Time at which the tracker sent its newest pose.
    pose_ns: Option<i64>,
}

/// Ages in seconds; `None` before the first one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Ages {
    /// Since the newest scan with a result entered the graph.
    pub(crate) scan_s: Option<f64>,
    /// Since the tracker sent its newest pose.
    pub(crate) pose_s: Option<f64>,
}

impl Times {
    pub(crate) fn on_answer(&mut self, header: &HypothesesHeader) {
        self.scan_ns = self.scan_ns.max(Some(header.stamp.entered_ns));
    }

    /// Takes the tracker's pose, from a scan or from odometry between scans.
    pub(crate) fn on_pose(&mut self, header: &PoseHeader) {
        if header.from_scan == 1 {
            self.scan_ns = self.scan_ns.max(Some(header.stamp.entered_ns));
        }
        self.pose_ns = self.pose_ns.max(Some(header.sent_ns));
    }

    /// Time of the newest scan or, with a tracker, of its newest pose: the earlier of the two.
    pub(crate) fn newest_ns(self) -> Option<i64> {
        let scan_ns = self.scan_ns.or(self.pose_ns)?;
        Some(self.pose_ns.map_or(scan_ns, |pose_ns| scan_ns.min(pose_ns)))
    }

    pub(crate) fn ages(self, now_ns: i64) -> Ages {
        let seconds = |ns: i64| now_ns.saturating_sub(ns).max(0) as f64 / 1e9;
        Ages {
            scan_s: self.scan_ns.map(seconds),
            pose_s: self.pose_ns.map(seconds),
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    #[test]
    fn a_pose_between_scans_is_no_scan() {
        let mut times = Times::default();
        let none = Ages {
            scan_s: None,
            pose_s: None,
        };
        assert_eq!(times.ages(5 * SECOND), none);
        let mut header = HypothesesHeader::zeroed();
        header.stamp.entered_ns = SECOND;
        assert_eq!(times.newest_ns(), None);
        times.on_answer(&header);
        assert_eq!(times.newest_ns(), Some(SECOND));
        assert_eq!(times.ages(5 * SECOND).scan_s, Some(4.0));
        let mut pose = PoseHeader::zeroed();
        (pose.stamp.entered_ns, pose.sent_ns) = (2 * SECOND, 3 * SECOND);
        times.on_pose(&pose);
        let ages = times.ages(5 * SECOND);
        assert_eq!((ages.scan_s, ages.pose_s), (Some(4.0), Some(2.0)));
        assert_eq!(times.newest_ns(), Some(SECOND), "odometry alone is no scan");
        pose.from_scan = 1;
        times.on_pose(&pose);
        assert_eq!(times.ages(5 * SECOND).scan_s, Some(3.0));
        assert_eq!(times.ages(0).scan_s, Some(0.0), "another machine's clock");
    }
}
