//! `backcast_msgs/msg/TrackedPose`.

use super::Pose2D;
use crate::Header;
use crate::definition::Rows3;

declare! {
    /// Pose of the tracker at a scan and its certainty: topic `pose` of the graph.
    message TrackedPose = "backcast_msgs/msg/TrackedPose" with "\
# Where the tracker has the robot at a scan, and how sure it is.
uint32 SEARCHING=0
uint32 UNIQUE=1
uint32 DOUBTFUL=2
uint32 LOST=3
uint32 NO_SCAN=0
uint32 NO_MAP=1
uint32 ONE_PLACE=2
uint32 SEVERAL_PLACES=3
uint32 TOO_EARLY=4
uint32 POOR_FIT=5
uint32 ODOMETRY_JUMP=6
uint32 ANOTHER_PLACE=7
uint32 NO_PLACE=8
" [Header, Pose2D] {
        header: Header,
        entered_ns: i64,
        counter: u64,
        map_id: u64,
        sent_ns: i64,
        tracking_ns: u64,
        since_ns: i64,
        since_m: f64,
        map_from_laser: Pose2D,
        map_from_base: Pose2D,
        map_from_odom: Pose2D,
        laser_covariance: Rows3,
        base_covariance: Rows3,
        probability: f64,
        lead: f64,
        score: f64,
        state: u32,
        reason: u32,
        places: u32,
        pose_known: bool,
        mount_known: bool,
        odom_known: bool,
        words: String,
    }
}

impl TrackedPose {
    /// Converts the tracker's pose of the graph, with its text.
    pub fn of(header: Header, from: &messages::PoseHeader, words: &[u8]) -> Self {
        TrackedPose {
            header,
            entered_ns: from.stamp.entered_ns,
            counter: from.stamp.counter,
            map_id: from.map_id,
            sent_ns: from.sent_ns,
            tracking_ns: from.tracking_ns,
            since_ns: from.since_ns,
            since_m: from.since_m,
            map_from_laser: from.map_from_laser.into(),
            map_from_base: from.map_from_base.into(),
            map_from_odom: from.map_from_odom.into(),
            laser_covariance: from.laser_covariance,
            base_covariance: from.base_covariance,
            probability: from.probability,
            lead: from.lead,
            score: from.score,
            state: from.state,
            reason: from.reason,
            places: from.places,
            pose_known: from.pose_known != 0,
            mount_known: from.mount_known != 0,
            odom_known: from.odom_known != 0,
            words: String::from_utf8_lossy(words).into_owned(),
        }
    }
}
