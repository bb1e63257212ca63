//! Figures on the tracker's poses of a run: states, latency and accuracy. Pure.

use std::collections::BTreeMap;

use answers::statistics::{Answer, Distribution, Figures, Tail};
use geometry::Pose;
use messages::{PoseHeader, TrackState, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

use super::pairs::Pairs;

#[derive(Debug)]
pub(crate) struct Tracking {
    states: BTreeMap<&'static str, u64>,
    scans: u64,
    pairs: Pairs,
    latency_ms: Distribution,
}

/// The tracker's figures of a run.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct TrackingFigures {
    /// Scans that the tracker answered, including those without a pose.
    pub scans: u64,
    /// Share of each state in the scans, 0..=1.
    pub states: BTreeMap<&'static str, f64>,
    /// Poses compared with the truth, if the recording holds it.
    #[serde(flatten)]
    pub accuracy: Figures,
    /// Time from the scan's entry into the graph to the tracker's pose.
    pub latency_ms: Tail,
}

impl Tracking {
    pub(crate) fn new(window: usize) -> Self {
        Tracking {
            states: BTreeMap::new(),
            scans: 0,
            pairs: Pairs::new(window),
            latency_ms: Distribution::new(window),
        }
    }

    pub(crate) fn pose(&mut self, header: &PoseHeader, latency_ms: f64) {
        let state = TrackState::from_code(header.state);
        self.scans += 1;
        let word = state.map_or("?", TrackState::as_str);
        *self.states.entry(word).or_default() += 1;
        self.latency_ms.add(latency_ms);
        let pose = header.laser().map(Into::into);
        let answer = Answer {
            poses: pose.into_iter().collect(),
            // The statistics count confident poses that are wrong.
            verdict: (state == Some(TrackState::Unique)).then_some(Verdict::Unique),
        };
        self.pairs.answer(header.stamp.measured_ns, answer);
    }

    pub(crate) fn truth(&mut self, measured_ns: i64, truth: Pose) {
        self.pairs.truth(measured_ns, truth);
    }

    pub(crate) fn figures(&self) -> Option<TrackingFigures> {
        let share = |count: u64| count as f64 / self.scans as f64;
        let states = self.states.iter();
        (self.scans > 0).then(|| TrackingFigures {
            scans: self.scans,
            states: states
                .map(|(state, count)| (*state, share(*count)))
                .collect(),
            accuracy: self.pairs.figures(),
            latency_ms: self.latency_ms.tail(),
        })
    }
}
