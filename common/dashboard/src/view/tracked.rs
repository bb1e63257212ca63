//! Pose of the tracker.

use engine::tracking::Report;
use messages::{PoseHeader, TrackState};
use serde::Serialize;

use super::{Ellipse, PoseJson, ms};

/// The tracker's pose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Tracked {
    /// Number of the scan or, between scans, of the odometry.
    pub(crate) counter: u64,
    /// Time of that measurement, in seconds since 1970.
    pub(crate) stamp_s: f64,
    /// Map of the pose, in hexadecimal.
    pub(crate) map_id: String,
    /// True if the pose is from a scan; false if odometry predicted it.
    pub(crate) from_scan: bool,
    /// The state; `?` if this version does not know its code.
    pub(crate) state: &'static str,
    /// Reason for the state, and advice.
    pub(crate) says: String,
    /// The reason alone.
    pub(crate) why: String,
    /// The advice alone; empty if there is none.
    pub(crate) advice: String,
    /// Pose of the laser in the map; `None` if it is not known.
    pub(crate) laser: Option<PoseJson>,
    /// Pose of the robot's base; `None` if that or the laser's mount is not known.
    pub(crate) base: Option<PoseJson>,
    /// One-sigma ellipse of the laser's pose.
    pub(crate) ellipse: Option<Ellipse>,
    /// One-sigma ellipse of the base's pose.
    pub(crate) base_ellipse: Option<Ellipse>,
    pub(crate) probability: f64,
    /// Log odds of this place over the next one.
    pub(crate) lead: f64,
    /// Fit of the last scan at this pose.
    pub(crate) score: f64,
    /// Number of places kept as possible.
    pub(crate) places: u32,
    /// Start of the state, in seconds since 1970.
    pub(crate) since_s: f64,
    /// Distance travelled since then, in metres.
    pub(crate) since_m: f64,
    /// From the measurement's entry into the graph to the pose.
    pub(crate) latency_ms: f64,
    /// Duration of the tracking, part of the latency.
    pub(crate) tracking_ms: f64,
    /// From the measurement's entry into the graph to this message.
    pub(crate) age_ms: f64,
    /// From the sending of the pose to this message.
    pub(crate) sent_age_ms: f64,
}

impl Tracked {
    /// Converts a message of `pose`. `now_ns`: monotonic clock of the host.
    pub(crate) fn new(header: &PoseHeader, words: &[u8], now_ns: i64) -> Self {
        let state = TrackState::from_code(header.state);
        let since_entry = |ns: i64| ms(ns.saturating_sub(header.stamp.entered_ns));
        let (laser, base) = (header.laser(), header.base());
        let words = words.get(..PoseHeader::WORDS_CAPACITY).unwrap_or(words);
        let says = String::from_utf8_lossy(words).into_owned();
        let (why, advice) = Report::split(&says);
        Tracked {
            counter: header.stamp.counter,
            stamp_s: header.stamp.measured_ns as f64 / 1e9,
            map_id: format!("{:016x}", header.map_id),
            from_scan: header.from_scan == 1,
            state: state.map_or("?", TrackState::as_str),
            why: why.to_owned(),
            advice: advice.to_owned(),
            says,
            laser: laser.map(Into::into),
            base: base.map(Into::into),
            ellipse: Ellipse::new(header.laser_covariance).filter(|_| laser.is_some()),
            base_ellipse: Ellipse::new(header.base_covariance).filter(|_| base.is_some()),
            probability: header.probability,
            lead: header.lead,
            score: header.score,
            places: header.places,
            since_s: header.since_ns as f64 / 1e9,
            since_m: header.since_m,
            latency_ms: since_entry(header.sent_ns),
            tracking_ms: header.tracking_ns as f64 / 1e6,
            age_ms: since_entry(now_ns),
            sent_age_ms: ms(now_ns.saturating_sub(header.sent_ns)),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, Stamp};

    use super::*;

    pub(crate) fn header(state: TrackState, x: f64) -> PoseHeader {
        PoseHeader {
            stamp: Stamp {
                measured_ns: 1_500_000_000,
                entered_ns: 1_000_000,
                counter: 7,
            },
            sent_ns: 23_000_000,
            map_from_laser: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            laser_covariance: [0.04, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0009],
            state: state as u32,
            from_scan: 1,
            pose_known: 1,
            ..PoseHeader::zeroed()
        }
    }

    #[test]
    fn a_pose_is_reported_in_numbers_and_words() {
        let words = b"2 places fit, 25 m apart: drive on";
        let tracked = Tracked::new(&header(TrackState::Doubtful, 1.5), words, 33_000_000);
        assert_eq!((tracked.counter, tracked.state), (7, "Doubtful"));
        assert_eq!(tracked.says, "2 places fit, 25 m apart: drive on");
        let parts = (&*tracked.why, &*tracked.advice);
        assert_eq!(parts, ("2 places fit, 25 m apart", "drive on"));
        assert_eq!((tracked.latency_ms, tracked.age_ms), (22.0, 32.0));
        assert_eq!(tracked.sent_age_ms, 10.0);
        assert_eq!(tracked.laser.map(|pose| pose.x), Some(1.5));
        assert_eq!(tracked.base, None, "no mount is known");
        assert!((tracked.ellipse.unwrap().major_m - 0.2).abs() < 1e-12);
        assert_eq!(tracked.base_ellipse, None);
        let mounted = PoseHeader {
            mount_known: 1,
            base_covariance: [0.09, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0009],
            ..header(TrackState::Unique, 1.5)
        };
        let tracked = Tracked::new(&mounted, b"", 0);
        assert!((tracked.base_ellipse.unwrap().major_m - 0.3).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_known_is_not_reported() {
        let mut searching = header(TrackState::Searching, 1.5);
        searching.pose_known = 0;
        let tracked = Tracked::new(&searching, b"", 0);
        assert_eq!((tracked.laser, tracked.ellipse), (None, None));
        let tracked = Tracked::new(&header(TrackState::Unique, f64::NAN), &[0xff; 999], 0);
        assert_eq!(tracked.laser, None);
        assert_eq!(tracked.says.chars().count(), PoseHeader::WORDS_CAPACITY);
        let mut unknown = header(TrackState::Unique, 1.0);
        unknown.state = 99;
        assert_eq!(Tracked::new(&unknown, b"", i64::MIN).state, "?");
    }
}
