//! `backcast_msgs/msg/Hypotheses`.

use serde::{Deserialize, Serialize};

use super::Pose2D;
use crate::definition::definition;
use crate::{Header, RosMessage};

/// Possible poses of the robot by one scan: topic `hypotheses` of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Hypotheses {
    /// Time of the scan, and the frame of the map.
    pub header: Header,
    /// The host's `CLOCK_MONOTONIC` in nanoseconds when the scan entered the graph.
    pub entered_ns: i64,
    /// Number of the scan.
    pub counter: u64,
    /// Id of the map that was searched; 0 if there was none.
    pub map_id: u64,
    /// `CLOCK_MONOTONIC` in nanoseconds when the hypotheses were sent.
    pub sent_ns: i64,
    /// Computing time from scan to votes, in nanoseconds.
    pub search_ns: u64,
    /// Computing time from votes to hypotheses, in nanoseconds.
    pub extract_ns: u64,
    /// A `messages::Verdict`.
    pub verdict: u32,
    /// Number of other places that fit about as well as the best.
    pub alternatives: u32,
    /// Probability of the best pose, 0..=1.
    pub confidence: f32,
    /// Share of the beams' weight that agrees with the best pose, 0..=1.
    pub inlier_share: f32,
    /// Highest intensity of any pose.
    pub best: u32,
    /// Intensity of a pose that every beam agrees with fully.
    pub highest_possible: u32,
    /// True if the laser's mount was given.
    pub mount_known: bool,
    pub hypotheses: Vec<Hypothesis>,
}

/// `backcast_msgs/msg/Hypothesis`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Hypothesis {
    /// Pose of the laser in the map.
    pub map_from_laser: Pose2D,
    /// Pose of the robot's base in the map.
    pub map_from_base: Pose2D,
    /// Covariance of the laser's pose, row by row over x, y and yaw: m², m·rad, rad².
    pub covariance: [f64; 9],
    /// Fit of the scan to the map at this pose, at most 1.
    pub score: f32,
    /// Probability that the robot is there, 0..=1.
    pub probability: f32,
    /// Intensity of the best search pose that led to this hypothesis.
    pub intensity: u64,
    /// Number of search poses that led to this hypothesis.
    pub support: u64,
}

impl Hypotheses {
    /// Converts the hypotheses of a scan of the graph; if several maps were searched, only those on
    /// the map of the best one.
    #[must_use]
    pub fn of(
        header: Header,
        from: &messages::HypothesesHeader,
        items: &[messages::Hypothesis],
    ) -> Self {
        let hypothesis = |item: &messages::Hypothesis| Hypothesis {
            map_from_laser: item.map_from_laser.into(),
            map_from_base: item.map_from_base.into(),
            covariance: item.covariance,
            score: item.score,
            probability: item.probability,
            intensity: item.intensity,
            support: item.support,
        };
        Hypotheses {
            header,
            entered_ns: from.stamp.entered_ns,
            counter: from.stamp.counter,
            map_id: from.map_id,
            sent_ns: from.sent_ns,
            search_ns: from.search_ns,
            extract_ns: from.extract_ns,
            verdict: from.verdict,
            alternatives: from.alternatives,
            confidence: from.confidence,
            inlier_share: from.inlier_share,
            best: from.best,
            highest_possible: from.highest_possible,
            mount_known: from.mount_known != 0,
            hypotheses: from.on_map(items).map(hypothesis).collect(),
        }
    }
}

impl RosMessage for Hypotheses {
    const SCHEMA: &'static str = "backcast_msgs/msg/Hypotheses";
    const DEFINITION: &'static str = definition!(
        "\
# Where the robot may be, by one scan.
uint32 NO_SCAN=0
uint32 UNIQUE=1
uint32 AMBIGUOUS=2
uint32 POOR_FIT=3
std_msgs/Header header
int64 entered_ns
uint64 counter
uint64 map_id
int64 sent_ns
uint64 search_ns
uint64 extract_ns
uint32 verdict
uint32 alternatives
float32 confidence
float32 inlier_share
uint32 best
uint32 highest_possible
bool mount_known
backcast_msgs/Hypothesis[] hypotheses
",
        Header,
        "\
backcast_msgs/Hypothesis
geometry_msgs/Pose2D map_from_laser
geometry_msgs/Pose2D map_from_base
float64[9] covariance
float32 score
float32 probability
uint64 intensity
uint64 support
",
        Pose2D,
    );
}
