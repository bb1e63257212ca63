//! Counts the poses of a run, and the time without poses after each fault. Pure.

use std::collections::BTreeMap;
use std::time::Duration;

use answers::statistics::{Distribution, SUCCESS};
use geometry::Pose;
use messages::TrackState;
use serde::{Serialize, Serializer};

use super::fault::Fault;
use super::launched::SentPose;

/// Number of parts of a run for which latencies are listed.
const PARTS: usize = 10;
/// Maximum number of wrong poses that are listed.
const MAX_WRONG_LISTED: usize = 20;
/// Maximum number of values kept per figure: more than a part of a run of days has.
const WINDOW: usize = 1_000_000;
const NS_PER_S: f64 = 1e9;

/// Figures of a run so far, which are a part of its report.
#[derive(Debug, Serialize)]
pub(super) struct Tally {
    #[serde(skip)]
    truths: BTreeMap<i64, Pose>,
    #[serde(skip)]
    begin_ns: i64,
    #[serde(skip)]
    planned: Duration,
    /// Number of poses of scans, in any state.
    poses: u64,
    /// Number of poses with a position and a known truth.
    judged: u64,
    /// Number of judged poses that were Unique.
    unique: u64,
    /// Number of Unique poses beyond 0.5 m or 10°.
    pub(super) wrong: u64,
    first_wrong: Vec<Wrong>,
    /// Latency from the scan's entry into the graph to its pose, for each tenth of the run.
    #[serde(serialize_with = "tails")]
    latency_ms: Vec<Distribution>,
    faults: Vec<FaultEffect>,
    /// Faults from which the graph has not fully recovered.
    #[serde(skip)]
    open: Vec<Open>,
    /// Time from the end of the last fault to the next pose, in seconds.
    #[serde(skip)]
    last_gap_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Wrong {
    /// Stamp of its scan, in nanoseconds since 1970.
    stamp_ns: i64,
    /// Time at which it was sent, in seconds after the start.
    after_s: f64,
    off_m: f64,
    off_deg: f64,
}

#[derive(Debug, Clone, Copy)]
struct Open {
    fault: Fault,
    over_ns: i64,
    /// True if a pose came since; none of them was Unique.
    any: bool,
}

#[derive(Debug, Serialize)]
struct FaultEffect {
    fault: Fault,
    times: u64,
    /// Number of processes of nodes that it killed.
    killed: u64,
    /// Time from the end of the fault to a pose of a later scan, in seconds.
    #[serde(serialize_with = "gap")]
    to_pose_s: Distribution,
    /// Time from the end of the fault to a Unique pose of a later scan, in seconds.
    #[serde(serialize_with = "gap")]
    to_unique_s: Distribution,
}

/// Writes median and maximum of times in seconds.
pub(super) fn gap<S: Serializer>(seconds: &Distribution, to: S) -> Result<S::Ok, S::Error> {
    let [median, max] = seconds.percentiles([50.0, 100.0]);
    BTreeMap::from([("median", median), ("max", max)]).serialize(to)
}

fn tails<S: Serializer>(all: &[Distribution], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(all.iter().map(Distribution::tail))
}

impl Tally {
    /// Tally of a run that begins at `now_ns` of the monotonic clock, with these truths.
    pub(super) fn new(truths: BTreeMap<i64, Pose>, now_ns: i64, planned: Duration) -> Self {
        Tally {
            truths,
            begin_ns: now_ns,
            planned,
            poses: 0,
            judged: 0,
            unique: 0,
            wrong: 0,
            first_wrong: Vec::new(),
            latency_ms: vec![Distribution::new(WINDOW); PARTS],
            open: Vec::new(),
            faults: Vec::new(),
            last_gap_s: 0.0,
        }
    }

    /// Adds a fault that ended at `over_ns` and killed this many processes of nodes.
    pub(super) fn suffered(&mut self, fault: Fault, killed: usize, over_ns: i64) {
        if self.faults.iter().all(|effect| effect.fault != fault) {
            self.faults.push(FaultEffect {
                fault,
                times: 0,
                killed: 0,
                to_pose_s: Distribution::new(WINDOW),
                to_unique_s: Distribution::new(WINDOW),
            });
        }
        let effects = self.faults.iter_mut();
        for effect in effects.filter(|effect| effect.fault == fault) {
            effect.times += 1;
            effect.killed += killed as u64;
        }
        self.open.push(Open {
            fault,
            over_ns,
            any: false,
        });
    }

    pub(super) fn pose(&mut self, pose: &SentPose) {
        self.poses += 1;
        let since_s = self.since_s(pose.sent_ns);
        let part = since_s / self.planned.as_secs_f64() * PARTS as f64;
        // Poses after the planned end belong to the last part.
        let part = (part.max(0.0) as usize).min(PARTS - 1);
        self.latency_ms[part].add(pose.latency_ms);
        let is_unique = pose.state == TrackState::Unique.as_str();
        self.judge(pose, is_unique);
        self.close(pose, is_unique);
    }

    fn judge(&mut self, pose: &SentPose, is_unique: bool) {
        let truth = self.truths.get(&pose.stamp_ns);
        let (Some(truth), Some(found)) = (truth, pose.laser) else {
            return;
        };
        self.judged += 1;
        if !is_unique {
            return;
        }
        self.unique += 1;
        let (metres, degrees) = SUCCESS;
        if truth.is_within(found, metres, degrees.to_radians()) {
            return;
        }
        self.wrong += 1;
        if self.first_wrong.len() < MAX_WRONG_LISTED {
            self.first_wrong.push(Wrong {
                stamp_ns: pose.stamp_ns,
                after_s: self.since_s(pose.sent_ns),
                off_m: truth.distance_to(found),
                off_deg: truth.angle_to(found).to_degrees(),
            });
        }
    }

    /// Ends the effect of faults that were over before the pose's scan entered the graph.
    fn close(&mut self, pose: &SentPose, is_unique: bool) {
        let (faults, entered_ns) = (&mut self.faults, pose.entered_ns());
        let last_gap_s = &mut self.last_gap_s;
        self.open.retain_mut(|open| {
            let effect = faults.iter_mut().find(|effect| effect.fault == open.fault);
            let (true, Some(effect)) = (open.over_ns <= entered_ns, effect) else {
                return true;
            };
            let seconds = (pose.sent_ns - open.over_ns) as f64 / NS_PER_S;
            if !std::mem::replace(&mut open.any, true) {
                effect.to_pose_s.add(seconds);
                *last_gap_s = seconds;
            }
            if is_unique {
                effect.to_unique_s.add(seconds);
            }
            !is_unique
        });
    }

    /// True if a pose came since every fault.
    pub(super) fn has_recovered(&self) -> bool {
        self.open.iter().all(|open| open.any)
    }

    /// Time without poses after the last fault from which the graph has recovered, in seconds.
    pub(super) fn last_gap_s(&self) -> f64 {
        self.last_gap_s
    }

    /// True if a Unique pose came since every fault.
    pub(super) fn is_sure(&self) -> bool {
        self.unique > 0 && self.open.is_empty()
    }

    pub(super) fn not_overcome(&self) -> Vec<Fault> {
        self.open.iter().map(|open| open.fault).collect()
    }

    fn since_s(&self, at_ns: i64) -> f64 {
        (at_ns - self.begin_ns) as f64 / NS_PER_S
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    /// A pose at `(x, 0)` of the scan `stamp_ns`, which entered at `entered_s` seconds.
    fn pose(stamp_ns: i64, entered_s: i64, x: f64, state: TrackState) -> SentPose {
        SentPose {
            stamp_ns,
            state: state.as_str().to_owned(),
            laser: Some(Pose::new(x, 0.0, 0.0)),
            latency_ms: 500.0,
            sent_ns: entered_s * SECOND + SECOND / 2,
        }
    }

    fn tally() -> Tally {
        let truths = [(1, Pose::IDENTITY), (2, Pose::IDENTITY)];
        Tally::new(truths.into(), 0, Duration::from_secs(100))
    }

    #[test]
    fn only_poses_that_are_sure_and_off_the_truth_are_wrong() {
        let mut tally = tally();
        tally.pose(&pose(1, 1, 0.4, TrackState::Unique));
        tally.pose(&pose(1, 2, 3.0, TrackState::Unique));
        tally.pose(&pose(2, 3, 3.0, TrackState::Doubtful));
        tally.pose(&pose(3, 4, 9.0, TrackState::Unique));
        let counts = [tally.poses, tally.judged, tally.unique, tally.wrong];
        assert_eq!(counts, [4, 3, 2, 1]);
        let expected = Wrong {
            stamp_ns: 1,
            after_s: 2.5,
            off_m: 3.0,
            off_deg: 0.0,
        };
        assert_eq!(tally.first_wrong, [expected]);
    }

    #[test]
    fn a_fault_is_overcome_by_a_pose_of_a_later_scan() {
        let mut tally = tally();
        tally.suffered(Fault::Kill, 1, 10 * SECOND);
        // Its scan entered before the fault ended, so it proves no recovery.
        tally.pose(&pose(1, 9, 0.0, TrackState::Unique));
        assert!(!tally.has_recovered());
        tally.pose(&pose(1, 11, 0.0, TrackState::Searching));
        assert!(tally.has_recovered() && !tally.is_sure());
        assert_eq!(tally.not_overcome(), [Fault::Kill]);
        tally.suffered(Fault::Kill, 1, 12 * SECOND);
        tally.pose(&pose(1, 13, 0.0, TrackState::Unique));
        assert!(tally.is_sure());
        let report = serde_json::to_value(&tally).unwrap();
        let expected = json!([{
            "fault": "kill",
            "times": 2,
            "killed": 2,
            "to_pose_s": {"median": 1.5, "max": 1.5},
            "to_unique_s": {"median": 1.5, "max": 3.5},
        }]);
        assert_eq!(report["faults"], expected);
    }

    #[test]
    fn latencies_are_reported_for_each_tenth_of_the_run() {
        let mut tally = tally();
        tally.pose(&pose(1, 5, 0.0, TrackState::Unique));
        let mut late = pose(1, 200, 0.0, TrackState::Unique);
        late.latency_ms = 7.0;
        tally.pose(&late);
        let report = serde_json::to_value(&tally).unwrap();
        let medians = |part: usize| &report["latency_ms"][part]["median"];
        assert_eq!((medians(0), medians(1)), (&json!(500.0), &json!(null)));
        assert_eq!(medians(PARTS - 1), 7.0, "after the planned end");
    }
}
