//! Pose of the tracker.

use answers::TrackedPose;
use engine::tracking::Report;
use messages::PoseHeader;
use serde::Serialize;

use super::ms;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Tracked {
    /// Number of the scan or, between scans, of the odometry.
    pub(crate) counter: u64,
    #[serde(flatten)]
    pub(crate) pose: TrackedPose,
    /// The reason for the state alone.
    pub(crate) why: String,
    /// The advice alone; empty if there is none.
    pub(crate) advice: String,
    /// Log odds of this place over the next one.
    pub(crate) lead: f64,
    /// Start of the state, in seconds since 1970.
    pub(crate) since_s: f64,
    /// Distance travelled since then, in metres.
    pub(crate) since_m: f64,
    /// From the measurement's entry into the graph to this message.
    pub(crate) age_ms: f64,
    /// From the sending of the pose to this message.
    pub(crate) sent_age_ms: f64,
}

impl Tracked {
    /// Converts a message of `pose`. `name_of` returns the name of one of several maps; `now_ns`:
    /// monotonic clock of the host.
    pub(crate) fn new(
        header: &PoseHeader,
        words: &[u8],
        name_of: &dyn Fn(u64) -> Option<String>,
        now_ns: i64,
    ) -> Self {
        let mut pose = TrackedPose::new(header, words);
        pose.place.map = pose.place.laser.and_then(|_| name_of(header.map_id));
        let (why, advice) = Report::split(&pose.says);
        Tracked {
            counter: header.stamp.counter,
            why: why.to_owned(),
            advice: advice.to_owned(),
            lead: header.lead,
            since_s: header.since_ns as f64 / 1e9,
            since_m: header.since_m,
            age_ms: ms(now_ns.saturating_sub(header.stamp.entered_ns)),
            sent_age_ms: ms(now_ns.saturating_sub(header.sent_ns)),
            pose,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, Stamp, TrackState};

    use super::*;

    pub(crate) fn header(state: TrackState, x: f64) -> PoseHeader {
        PoseHeader {
            stamp: Stamp {
                measured_ns: 1_500_000_000,
                entered_ns: 1_000_000,
                counter: 7,
            },
            sent_ns: 23_000_000,
            map_from_laser: Pose2::new(x, 2.0, 0.5),
            state: state as u32,
            from_scan: 1,
            pose_known: 1,
            ..PoseHeader::zeroed()
        }
    }

    pub(crate) fn tracked(header: &PoseHeader, words: &[u8]) -> Tracked {
        Tracked::new(header, words, &|_| None, 33_000_000)
    }

    #[test]
    fn a_pose_is_reported_in_numbers_and_words() {
        let words = b"2 places fit, 25 m apart: drive on";
        let tracked = tracked(&header(TrackState::Doubtful, 1.5), words);
        let parts = (&*tracked.why, &*tracked.advice);
        assert_eq!(parts, ("2 places fit, 25 m apart", "drive on"));
        assert_eq!((tracked.counter, tracked.age_ms), (7, 32.0));
        assert_eq!(tracked.sent_age_ms, 10.0);
        let json = serde_json::to_value(&tracked).unwrap();
        assert_eq!(json["says"], "2 places fit, 25 m apart: drive on");
        let expected = (&"Doubtful".into(), &22.0.into());
        assert_eq!((&json["state"], &json["latency_ms"]), expected);
        let found = (&json["laser"]["x"], &json["base"]);
        assert_eq!(found, (&1.5.into(), &().into()));
    }

    #[test]
    fn what_is_not_known_is_not_reported() {
        let mut searching = header(TrackState::Searching, 1.5);
        searching.pose_known = 0;
        assert_eq!(tracked(&searching, b"").pose.place.laser, None);
        let header = header(TrackState::Unique, f64::NAN);
        let nowhere = Tracked::new(&header, b"", &|_| None, i64::MIN);
        assert_eq!(nowhere.pose.place.probability, None);
    }
}
