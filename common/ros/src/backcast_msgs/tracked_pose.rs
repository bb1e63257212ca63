//! `backcast_msgs/msg/TrackedPose`.

use serde::{Deserialize, Serialize};

use super::Pose2D;
use crate::definition::definition;
use crate::{Header, RosMessage};

/// Pose of the tracker at a scan and its certainty: topic `pose` of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TrackedPose {
    /// Time of the scan, and the frame of the map.
    pub header: Header,
    /// The host's `CLOCK_MONOTONIC` in nanoseconds when the scan entered the graph.
    pub entered_ns: i64,
    /// Number of the scan.
    pub counter: u64,
    /// Id of the map of the pose; 0 if there is none.
    pub map_id: u64,
    /// `CLOCK_MONOTONIC` in nanoseconds when the pose was sent.
    pub sent_ns: i64,
    /// Computing time without the search, in nanoseconds.
    pub tracking_ns: u64,
    /// Start of the state by the stamps of scans, in nanoseconds since 1970.
    pub since_ns: i64,
    /// Distance that the robot has travelled since then, in metres.
    pub since_m: f64,
    /// Pose of the laser in the map, if one is known.
    pub map_from_laser: Pose2D,
    /// Pose of the robot's base in the map; the laser's if no mount is known.
    pub map_from_base: Pose2D,
    /// Pose of the odometry frame in the map, if odometry is known.
    pub map_from_odom: Pose2D,
    /// Covariance of the laser's pose, row by row over x, y and yaw: m², m·rad, rad².
    pub laser_covariance: [f64; 9],
    /// Covariance of the base's pose, in the same form.
    pub base_covariance: [f64; 9],
    /// Probability that the robot is there, 0..=1.
    pub probability: f64,
    /// Natural logarithm of the odds of `probability`.
    pub lead: f64,
    /// Fit of the scan to the map at this pose, at most 1.
    pub score: f64,
    /// A `messages::TrackState`.
    pub state: u32,
    /// A `messages::TrackReason`.
    pub reason: u32,
    /// Number of places that are still possible, including the best.
    pub places: u32,
    /// True if there is a pose.
    pub pose_known: bool,
    /// True if the laser's mount was given.
    pub mount_known: bool,
    /// True if odometry was given.
    pub odom_known: bool,
    /// Reason and advice, in words.
    pub words: String,
}

impl TrackedPose {
    /// Converts the tracker's pose of the graph, with its text.
    #[must_use]
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

impl RosMessage for TrackedPose {
    const SCHEMA: &'static str = "backcast_msgs/msg/TrackedPose";
    const DEFINITION: &'static str = definition!(
        "\
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
std_msgs/Header header
int64 entered_ns
uint64 counter
uint64 map_id
int64 sent_ns
uint64 tracking_ns
int64 since_ns
float64 since_m
geometry_msgs/Pose2D map_from_laser
geometry_msgs/Pose2D map_from_base
geometry_msgs/Pose2D map_from_odom
float64[9] laser_covariance
float64[9] base_covariance
float64 probability
float64 lead
float64 score
uint32 state
uint32 reason
uint32 places
bool pose_known
bool mount_known
bool odom_known
string words
",
        Header,
        Pose2D,
    );
}
