//! Results that are expected and found for each scan.

use messages::{
    HypothesesHeader, Hypothesis, PoseHeader, TrackReason, TrackState, Verdict, VotesHeader,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Expected result of a scan; values that this version does not know are not compared.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct Expected {
    pub(super) stamp_ns: i64,
    #[serde(flatten)]
    pub(super) values: Map<String, Value>,
}

/// Result of the graph for one scan. Integers must be exactly equal; the refined pose and the
/// scores may differ by the rounding of other math libraries.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub(super) struct Answer {
    pub(super) stamp_ns: i64,
    pub(super) best: u32,
    pub(super) floor: u32,
    pub(super) certified_floor: u32,
    pub(super) highest_possible: u32,
    pub(super) votes: u64,
    pub(super) beams_used: u32,
    pub(super) verdict: String,
    pub(super) alternatives: u32,
    pub(super) hypotheses: usize,
    pub(super) confidence: f32,
    /// Pose of the laser in the map; `None` without hypotheses.
    pub(super) x_m: Option<f64>,
    pub(super) y_m: Option<f64>,
    pub(super) heading_deg: Option<f64>,
    pub(super) score: Option<f32>,
    /// Pose of the tracker at this scan; `None` if the graph has no tracker.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) pose: Option<TrackedPose>,
}

/// Result of the tracker for a scan.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub(super) struct TrackedPose {
    pub(super) state: String,
    pub(super) reason: String,
    pub(super) places: u32,
    pub(super) probability: f64,
    /// Pose of the laser in the map; `None` if no place is known.
    pub(super) x_m: Option<f64>,
    pub(super) y_m: Option<f64>,
    pub(super) heading_deg: Option<f64>,
}

impl TrackedPose {
    fn of(header: &PoseHeader) -> Self {
        let state = TrackState::from_code(header.state);
        let reason = TrackReason::from_code(header.reason);
        let laser = header.laser();
        TrackedPose {
            state: state.map_or("unknown", TrackState::as_str).to_owned(),
            reason: reason.map_or("unknown".to_owned(), |reason| format!("{reason:?}")),
            places: header.places,
            probability: header.probability,
            x_m: laser.map(|laser| laser.x),
            y_m: laser.map(|laser| laser.y),
            heading_deg: laser.map(|laser| laser.yaw.to_degrees()),
        }
    }
}

impl Answer {
    pub(super) fn of(
        votes: &VotesHeader,
        header: &HypothesesHeader,
        hypotheses: &[Hypothesis],
        pose: Option<&PoseHeader>,
    ) -> Self {
        let best = hypotheses.first();
        let verdict = Verdict::from_code(header.verdict);
        Answer {
            stamp_ns: header.stamp.measured_ns,
            best: votes.best,
            floor: votes.floor,
            certified_floor: votes.certified_floor,
            highest_possible: votes.highest_possible,
            votes: votes.total,
            beams_used: votes.beams_used,
            verdict: verdict.map_or("unknown", Verdict::as_str).to_owned(),
            alternatives: header.alternatives,
            hypotheses: hypotheses.len(),
            confidence: header.confidence,
            x_m: best.map(|best| best.map_from_laser.x),
            y_m: best.map(|best| best.map_from_laser.y),
            heading_deg: best.map(|best| best.map_from_laser.yaw.to_degrees()),
            score: best.map(|best| best.score),
            pose: pose.map(TrackedPose::of),
        }
    }
}
