//! What is expected of a scan, and found.

use messages::{HypothesesHeader, Hypothesis, Verdict, VotesHeader};
use serde::{Deserialize, Serialize};

/// The graph's answer to one scan. What is computed in integers must come out
/// exactly; the refined pose and what is judged there may differ by what other
/// mathematics libraries round.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// Of the laser in the map; absent where there is no hypothesis.
    pub(super) x_m: Option<f64>,
    pub(super) y_m: Option<f64>,
    pub(super) heading_deg: Option<f64>,
    pub(super) score: Option<f32>,
}

impl Answer {
    pub(super) fn of(
        votes: &VotesHeader,
        header: &HypothesesHeader,
        hypotheses: &[Hypothesis],
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
        }
    }
}
