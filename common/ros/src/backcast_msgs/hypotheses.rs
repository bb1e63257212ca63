//! `backcast_msgs/msg/Hypotheses`.

use super::Pose2D;
use crate::Header;
use crate::definition::Rows3;

declare! {
    #[derive(Copy)]
    part Hypothesis = "backcast_msgs/Hypothesis" [Pose2D] {
        map_from_laser: Pose2D,
        map_from_base: Pose2D,
        covariance: Rows3,
        score: f32,
        probability: f32,
        intensity: u64,
        support: u64,
    }

    /// Possible poses of the robot by one scan: topic `hypotheses` of the graph.
    message Hypotheses = "backcast_msgs/msg/Hypotheses" with "\
# Where the robot may be, by one scan.
uint32 NO_SCAN=0
uint32 UNIQUE=1
uint32 AMBIGUOUS=2
uint32 POOR_FIT=3
" [Header, Hypothesis] {
        header: Header,
        entered_ns: i64,
        counter: u64,
        map_id: u64,
        sent_ns: i64,
        search_ns: u64,
        extract_ns: u64,
        verdict: u32,
        alternatives: u32,
        confidence: f32,
        inlier_share: f32,
        best: u32,
        highest_possible: u32,
        mount_known: bool,
        hypotheses: Vec<Hypothesis>,
    }
}

impl Hypotheses {
    /// Converts the hypotheses of a scan of the graph; if several maps were searched, only those on
    /// the map of the best one.
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
