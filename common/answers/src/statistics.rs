//! Statistics over many scans: percentiles, success rates and errors of poses. Pure; used by the
//! launcher and the evaluation.

use std::collections::VecDeque;

use geometry::{Covariance, Pose};
use messages::Verdict;
use schemars::JsonSchema;
use serde::Serialize;

/// Error in metres and degrees up to which a pose is a success.
pub const SUCCESS: (f64, f64) = (0.5, 10.0);
/// Error in metres and degrees up to which a pose is a close success.
pub const CLOSE_SUCCESS: (f64, f64) = (0.2, 3.0);

/// Share of the truths that error ellipses should contain.
const HELD: f64 = 0.95;

/// True if the true position is inside the 95 % ellipse of a pose.
pub fn holds(covariance: Covariance, pose: Pose, truth: Pose) -> bool {
    let off = (truth.x - pose.x, truth.y - pose.y);
    // χ² with two degrees of freedom is exponentially distributed.
    covariance.squared_deviations(off) <= -2.0 * (1.0 - HELD).ln()
}
/// Number of hypotheses that count for recall.
const RECALL_DEPTH: usize = 16;

#[derive(Debug, Clone)]
pub struct Distribution {
    values: VecDeque<f64>,
    capacity: usize,
}

impl Distribution {
    /// Keeps the newest `capacity` values, at least one.
    pub fn new(capacity: usize) -> Self {
        Distribution {
            values: VecDeque::new(),
            capacity: capacity.max(1),
        }
    }

    /// Adds a value; NaN is ignored.
    pub fn add(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        if self.values.len() >= self.capacity {
            self.values.pop_front();
        }
        self.values.push_back(value);
    }

    /// Nearest-rank percentiles, in per cent 0..=100: the smallest value with at least that share
    /// of values at or below it. `None` without values.
    pub fn percentiles<const N: usize>(&self, percents: [f64; N]) -> [Option<f64>; N] {
        let mut sorted: Vec<f64> = self.values.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        percents.map(|percent| {
            let rank = (percent / 100.0 * sorted.len() as f64).ceil() as usize;
            sorted.get(rank.max(1) - 1).copied()
        })
    }

    pub fn tail(&self) -> Tail {
        let [median, p99] = self.percentiles([50.0, 99.0]);
        Tail { median, p99 }
    }

    pub fn spread(&self) -> Spread {
        let [median, p90] = self.percentiles([50.0, 90.0]);
        Spread { median, p90 }
    }
}

/// Keeps all values.
impl FromIterator<f64> for Distribution {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut all = Distribution::new(usize::MAX);
        values.into_iter().for_each(|value| all.add(value));
        all
    }
}

/// Two percentiles of a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Tail {
    /// Half of the values are at or below it.
    pub median: Option<f64>,
    /// 99 % of the values are at or below it.
    pub p99: Option<f64>,
}

/// Two percentiles of an error.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, JsonSchema)]
pub struct Spread {
    /// Half of the values are at or below it.
    pub median: Option<f64>,
    /// 90 % of the values are at or below it.
    pub p90: Option<f64>,
}

/// Result of one scan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Answer {
    /// Poses `map_from_laser`, best first.
    pub poses: Vec<Pose>,
    pub verdict: Option<Verdict>,
}

#[derive(Debug, Clone)]
pub struct Accuracy {
    truths: u64,
    successes: u64,
    close_successes: u64,
    recalled: u64,
    unique: u64,
    unique_wrong: u64,
    error_m: Distribution,
    error_deg: Distribution,
}

impl Accuracy {
    /// Errors keep the newest `capacity` values.
    pub fn new(capacity: usize) -> Self {
        Accuracy {
            truths: 0,
            successes: 0,
            close_successes: 0,
            recalled: 0,
            unique: 0,
            unique_wrong: 0,
            error_m: Distribution::new(capacity),
            error_deg: Distribution::new(capacity),
        }
    }

    /// Judges one result. A result without a pose is a failure without an error value.
    pub fn add(&mut self, truth: Pose, answer: &Answer) {
        let success = |pose: &Pose| within(truth, *pose, SUCCESS);
        self.truths += 1;
        self.recalled += u64::from(answer.poses.iter().take(RECALL_DEPTH).any(success));
        let Some(best) = answer.poses.first() else {
            return;
        };
        let right = success(best);
        self.successes += u64::from(right);
        self.close_successes += u64::from(within(truth, *best, CLOSE_SUCCESS));
        if answer.verdict == Some(Verdict::Unique) {
            self.unique += 1;
            self.unique_wrong += u64::from(!right);
        }
        self.error_m.add(truth.distance_to(*best));
        self.error_deg.add(truth.angle_to(*best).to_degrees());
    }

    pub fn figures(&self) -> Figures {
        let share = |count| (self.truths > 0).then(|| count as f64 / self.truths as f64);
        Figures {
            truths: self.truths,
            success_50cm_10deg: share(self.successes),
            success_20cm_3deg: share(self.close_successes),
            top16_recall: share(self.recalled),
            unique: self.unique,
            unique_wrong: self.unique_wrong,
            error_m: self.error_m.spread(),
            error_deg: self.error_deg.spread(),
        }
    }
}

fn within(a: Pose, b: Pose, (metres, degrees): (f64, f64)) -> bool {
    a.is_within(b, metres, f64::to_radians(degrees))
}

/// Accuracy over all results; shares are 0..=1 of `truths`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Figures {
    /// Number of results with a known truth.
    pub truths: u64,
    /// Share of results whose best pose is within 0.5 m and 10°.
    pub success_50cm_10deg: Option<f64>,
    /// Share of results whose best pose is within 0.2 m and 3°.
    pub success_20cm_3deg: Option<f64>,
    /// Share of results with any of the best 16 poses within 0.5 m and 10°.
    pub top16_recall: Option<f64>,
    /// Number of results with the verdict Unique.
    pub unique: u64,
    /// Number of Unique results beyond 0.5 m or 10°.
    pub unique_wrong: u64,
    /// Distance of the best pose from the truth, in metres.
    pub error_m: Spread,
    /// Angle between the best pose and the truth, in degrees.
    pub error_deg: Spread,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distribution(values: &[f64]) -> Distribution {
        values.iter().copied().collect()
    }

    #[test]
    fn percentiles_are_of_the_nearest_rank() {
        let five = distribution(&[15.0, 50.0, 20.0, 40.0, 35.0]);
        let percents = [0.0, 5.0, 30.0, 40.0, 50.0, 99.0, 100.0];
        let expected = [15.0, 15.0, 20.0, 20.0, 35.0, 50.0, 50.0].map(Some);
        assert_eq!(five.percentiles(percents), expected);
        let tail = distribution(&[7.0]).tail();
        assert_eq!((tail.median, tail.p99), (Some(7.0), Some(7.0)));
        assert_eq!(distribution(&[]).spread(), Spread::default());
    }

    #[test]
    fn the_oldest_values_make_room() {
        let mut last = Distribution::new(2);
        [9.0, 1.0, f64::NAN, 2.0].iter().for_each(|v| last.add(*v));
        assert_eq!(last.percentiles([0.0, 100.0]), [Some(1.0), Some(2.0)]);
    }

    fn answer(verdict: Verdict, poses: &[(f64, f64, f64)]) -> Answer {
        Answer {
            poses: poses
                .iter()
                .map(|&(x, y, deg)| Pose::new(x, y, f64::to_radians(deg)))
                .collect(),
            verdict: Some(verdict),
        }
    }

    #[test]
    fn answers_are_judged_by_distance_and_angle() {
        let truth = Pose::new(1.0, 1.0, std::f64::consts::PI);
        let mut accuracy = Accuracy::new(10);
        for found in [
            answer(Verdict::Unique, &[(1.1, 1.0, -179.0)]),
            answer(Verdict::Unique, &[(1.0, 1.4, 175.0)]),
            answer(Verdict::Unique, &[(1.0, 1.0, 160.0), (1.0, 1.0, 180.0)]),
            answer(Verdict::Ambiguous, &[(9.0, 1.0, 180.0)]),
            answer(Verdict::NoScan, &[]),
        ] {
            accuracy.add(truth, &found);
        }
        let figures = accuracy.figures();
        assert_eq!(figures.truths, 5);
        assert_eq!(figures.success_50cm_10deg, Some(0.4));
        assert_eq!(figures.success_20cm_3deg, Some(0.2));
        assert_eq!(figures.top16_recall, Some(0.6));
        assert_eq!((figures.unique, figures.unique_wrong), (3, 1));
        // Errors are 0.1, 0.4, 0 and 8 m; rounded by one sum and one root.
        assert!((figures.error_m.median.unwrap() - 0.1).abs() < 1e-12);
        assert!((figures.error_m.p90.unwrap() - 8.0).abs() < 1e-12);
        // Errors are 1, 5, 20 and 0 degrees, rounded by the conversion to radians and back.
        assert!((figures.error_deg.median.unwrap() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn recall_looks_no_deeper_than_sixteen() {
        let mut far = vec![(9.0, 9.0, 0.0); 16];
        far.push((0.0, 0.0, 0.0));
        let mut accuracy = Accuracy::new(10);
        accuracy.add(Pose::IDENTITY, &answer(Verdict::Ambiguous, &far));
        assert_eq!(accuracy.figures().top16_recall, Some(0.0));
        far.remove(0);
        accuracy.add(Pose::IDENTITY, &answer(Verdict::Ambiguous, &far));
        assert_eq!(accuracy.figures().top16_recall, Some(0.5));
    }

    #[test]
    fn nothing_judged_gives_no_shares() {
        assert_eq!(Accuracy::new(1).figures().success_50cm_10deg, None);
    }
}
