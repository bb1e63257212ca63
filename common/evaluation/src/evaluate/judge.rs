//! Computes the figures of one file from results and true poses. Pure.

use engine::peaks::Places;
use geometry::Pose;
use messages::Verdict;
use schemars::JsonSchema;
use serde::Serialize;
use statistics::{Accuracy, Distribution, SUCCESS, Spread};

use crate::trust::{Said, Trust};

/// Collects results of one file, or of several.
pub(super) struct Judge {
    accuracy: Accuracy,
    cpu_ms: Distribution,
    error_m: Distribution,
    error_deg: Distribution,
    trust: Trust,
    /// Number of truths inside the 95 % ellipse of a result with the verdict Unique.
    in_ellipse: u64,
    refused: u64,
    first_refusal: Option<String>,
}

/// Properties and costs of an evaluation; of several files, the largest map and peak.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Effort {
    pub(super) bag: String,
    pub(super) map_cells: u64,
    pub(super) scans: u64,
    pub(super) prepare_cpu_ms: f64,
    pub(super) peak_rss_mb: f64,
    pub(super) searchable_cells: u64,
    pub(super) index_bytes: u64,
}

impl Effort {
    fn merge(&mut self, other: &Self) {
        self.map_cells = self.map_cells.max(other.map_cells);
        self.scans += other.scans;
        self.prepare_cpu_ms += other.prepare_cpu_ms;
        self.peak_rss_mb = self.peak_rss_mb.max(other.peak_rss_mb);
        self.searchable_cells = self.searchable_cells.max(other.searchable_cells);
        self.index_bytes = self.index_bytes.max(other.index_bytes);
    }
}

pub(super) struct Total {
    judge: Judge,
    effort: Effort,
    pub(super) files: u64,
}

impl Total {
    pub(super) fn new() -> Self {
        Total {
            judge: Judge::new(),
            effort: Effort {
                bag: "total".to_owned(),
                ..Effort::default()
            },
            files: 0,
        }
    }

    pub(super) fn add(&mut self, judge: &Judge, effort: &Effort) {
        self.judge.merge(judge);
        self.effort.merge(effort);
        self.files += 1;
    }

    pub(super) fn conclude(&self) -> Evaluation {
        self.judge.conclude(&self.effort)
    }
}

/// Figures of one file or of all; shares are 0..=1 of `truths`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Evaluation {
    /// The file, as given by the user.
    pub(super) bag: String,
    pub(super) map_cells: u64,
    /// Number of scans read.
    pub(super) scans: u64,
    /// Number of scans with a true pose; only these are searched and judged.
    pub(super) truths: u64,
    /// Share of scans whose best pose is within 0.5 m and 10°.
    pub(super) success_50cm_10deg: Option<f64>,
    /// Share of scans whose best pose is within 0.2 m and 3°.
    pub(super) success_20cm_3deg: Option<f64>,
    /// Share of scans with any of the best 16 poses within 0.5 m and 10°.
    pub(super) top16_recall: Option<f64>,
    /// Number of results with the verdict Unique.
    pub(super) unique: u64,
    /// Number of Unique results beyond 0.5 m or 10°.
    pub(super) unique_wrong: u64,
    /// CPU time of this thread from scan to verdict, in milliseconds, without rejected scans.
    pub(super) cpu_ms: Times,
    /// CPU time of this thread to prepare the map, in milliseconds.
    pub(super) prepare_cpu_ms: f64,
    /// Peak memory of the process, in megabytes of 10⁶ bytes.
    pub(super) peak_rss_mb: f64,
    /// Number of cells in which poses are searched, at the resolution of the search.
    pub(super) searchable_cells: u64,
    /// Size of the search index of the map.
    pub(super) index_bytes: u64,
    /// Distance of the best pose from the truth, in metres, over the results within 0.5 m and 10°:
    /// the accuracy once a place is found.
    pub(super) error_m: Spread,
    /// Angle between the best pose and the truth, in degrees, over the same results.
    pub(super) error_deg: Spread,
    /// Number of Unique results whose 95 % ellipse contains the true position.
    pub(super) unique_in_ellipse: u64,
    /// Probabilities of the best places, and how many of these were right.
    pub(super) probabilities: Vec<Said>,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub(super) struct Times {
    pub(super) median: Option<f64>,
    pub(super) p90: Option<f64>,
    pub(super) max: Option<f64>,
}

impl Judge {
    pub(super) fn new() -> Self {
        // Keeps all values, since a file is finite.
        let all = || Distribution::new(usize::MAX);
        Judge {
            accuracy: Accuracy::new(usize::MAX),
            cpu_ms: all(),
            error_m: all(),
            error_deg: all(),
            trust: Trust::default(),
            in_ellipse: 0,
            refused: 0,
            first_refusal: None,
        }
    }

    pub(super) fn answer(&mut self, truth: Pose, found: &Places, cpu_ms: f64) {
        let poses = found.places.iter().map(|place| place.map_from_laser);
        let judged = statistics::Answer {
            poses: poses.collect(),
            verdict: Some(found.verdict),
        };
        self.cpu_ms.add(cpu_ms);
        let place = found.places.first();
        self.judge(truth, &judged, place.map(|place| place.probability));
        if let Some(place) = place
            && found.verdict == Verdict::Unique
        {
            let is_held = statistics::holds(place.covariance, place.map_from_laser, truth);
            self.in_ellipse += u64::from(is_held);
        }
    }

    pub(super) fn given(
        &mut self,
        truth: Pose,
        pose: Pose,
        (is_unique, probability): (bool, Option<f64>),
    ) {
        let verdict = match is_unique {
            true => Verdict::Unique,
            false => Verdict::Ambiguous,
        };
        let judged = statistics::Answer {
            poses: vec![pose],
            verdict: Some(verdict),
        };
        self.judge(truth, &judged, probability);
    }

    fn judge(&mut self, truth: Pose, judged: &statistics::Answer, probability: Option<f64>) {
        self.accuracy.add(truth, judged);
        let Some(best) = judged.poses.first() else {
            return;
        };
        let (metres, degrees) = SUCCESS;
        let is_right = best.is_within(truth, metres, degrees.to_radians());
        if is_right {
            self.error_m.add(best.distance_to(truth));
            self.error_deg.add(best.angle_to(truth).to_degrees());
        }
        if let Some(probability) = probability {
            self.trust.add(probability, is_right);
        }
    }

    /// Counts a rejected scan as a failure.
    pub(super) fn refusal(&mut self, truth: Pose, reason: String) {
        self.refused += 1;
        self.first_refusal.get_or_insert(reason);
        let nothing = statistics::Answer {
            poses: Vec::new(),
            verdict: None,
        };
        self.accuracy.add(truth, &nothing);
    }

    fn merge(&mut self, other: &Self) {
        self.accuracy.merge(&other.accuracy);
        self.cpu_ms.merge(&other.cpu_ms);
        self.error_m.merge(&other.error_m);
        self.error_deg.merge(&other.error_deg);
        self.trust.merge(&other.trust);
        self.in_ellipse += other.in_ellipse;
    }

    pub(super) fn truths(&self) -> u64 {
        self.accuracy.figures().truths
    }

    pub(super) fn complaint(&self) -> Option<String> {
        let reason = self.first_refusal.as_ref()?;
        let refused = self.refused;
        Some(format!("scans rejected: {refused}; the first: {reason}"))
    }

    pub(super) fn conclude(&self, effort: &Effort) -> Evaluation {
        let figures = self.accuracy.figures();
        let [median, p90, max] = self.cpu_ms.percentiles([50.0, 90.0, 100.0]);
        Evaluation {
            bag: effort.bag.clone(),
            map_cells: effort.map_cells,
            scans: effort.scans,
            truths: figures.truths,
            success_50cm_10deg: figures.success_50cm_10deg,
            success_20cm_3deg: figures.success_20cm_3deg,
            top16_recall: figures.top16_recall,
            unique: figures.unique,
            unique_wrong: figures.unique_wrong,
            cpu_ms: Times { median, p90, max },
            prepare_cpu_ms: effort.prepare_cpu_ms,
            peak_rss_mb: effort.peak_rss_mb,
            searchable_cells: effort.searchable_cells,
            index_bytes: effort.index_bytes,
            error_m: self.error_m.spread(),
            error_deg: self.error_deg.spread(),
            unique_in_ellipse: self.in_ellipse,
            probabilities: self.trust.said().to_vec(),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use engine::peaks::Place;
    use geometry::Covariance;
    use messages::Verdict;

    use super::*;

    fn found(verdict: Verdict, poses: &[Pose]) -> Places {
        let place = |&map_from_laser: &Pose| Place {
            map: 0,
            map_from_laser,
            covariance: Covariance::from_deviations(0.1, 0.1, 0.01),
            score: 0.75,
            probability: 0.5,
            intensity: 100,
            possible: 200,
            drawn_doubt: 0.0,
            support: 1,
        };
        Places {
            places: poses.iter().map(place).collect(),
            verdict,
            alternatives: 0,
            confidence: 0.5,
            inlier_share: 0.75,
            classes: Vec::new(),
        }
    }

    /// Five scans: one off by 0.1 m, one by 0.3 m, two at a wrong place, one rejected.
    fn judged() -> (Judge, Effort) {
        let truth = Pose::new(1.0, 2.0, 0.0);
        let beside = |x: f64| Pose::new(1.0 + x, 2.0, x.to_radians());
        let mut judge = Judge::new();
        judge.answer(truth, &found(Verdict::Unique, &[beside(0.1)]), 4.0);
        judge.answer(truth, &found(Verdict::Unique, &[beside(0.3)]), 1.0);
        judge.answer(truth, &found(Verdict::Unique, &[beside(5.0)]), 2.0);
        let second = found(Verdict::Ambiguous, &[beside(5.0), beside(0.0)]);
        judge.answer(truth, &second, 3.0);
        judge.refusal(truth, "empty".to_owned());
        let effort = Effort {
            bag: "r.mcap".to_owned(),
            map_cells: 720,
            scans: 9,
            prepare_cpu_ms: 12.5,
            peak_rss_mb: 34.5,
            searchable_cells: 300,
            index_bytes: 9000,
        };
        (judge, effort)
    }

    pub(crate) fn evaluation() -> Evaluation {
        let (judge, effort) = judged();
        judge.conclude(&effort)
    }

    #[test]
    fn a_total_is_of_the_scans_of_all_files() {
        let (judge, mut effort) = judged();
        let mut total = Total::new();
        total.add(&judge, &effort);
        effort.map_cells = 700;
        let mut other = Judge::new();
        let truth = Pose::new(1.0, 2.0, 0.0);
        other.answer(truth, &found(Verdict::Unique, &[truth]), 9.0);
        total.add(&other, &effort);
        let all = total.conclude();
        assert_eq!((&*all.bag, total.files), ("total", 2));
        assert_eq!((all.map_cells, all.scans, all.truths), (720, 18, 6));
        assert_eq!(all.success_50cm_10deg, Some(0.5));
        assert_eq!((all.unique, all.unique_in_ellipse), (4, 2));
        assert_eq!((all.cpu_ms.max, all.prepare_cpu_ms), (Some(9.0), 25.0));
    }

    #[test]
    fn figures_are_of_the_truths_and_errors_of_the_successes() {
        let evaluation = evaluation();
        assert_eq!((evaluation.scans, evaluation.truths), (9, 5));
        assert_eq!(evaluation.success_50cm_10deg, Some(0.4));
        assert_eq!(evaluation.success_20cm_3deg, Some(0.2));
        assert_eq!(evaluation.top16_recall, Some(0.6));
        assert_eq!((evaluation.unique, evaluation.unique_wrong), (3, 1));
        // Off by 0.1 m is one sigma, by 0.3 m three sigma; the 95 % ellipse ends at 2.4 sigma.
        assert_eq!(evaluation.unique_in_ellipse, 1);
        let Times { median, p90, max } = evaluation.cpu_ms;
        assert_eq!(
            (median, p90, max),
            (Some(2.0), Some(4.0), Some(4.0)),
            "of four: the refused scan has none"
        );
        // Differences of numbers near 1 are off by a few units in the last place.
        assert!((evaluation.error_m.median.unwrap() - 0.1).abs() < 1e-12);
        assert!((evaluation.error_m.p90.unwrap() - 0.3).abs() < 1e-12);
        assert!((evaluation.error_deg.p90.unwrap() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn what_was_said_is_kept_beside_what_was_right() {
        let said = evaluation().probabilities;
        assert_eq!((said[2].from, said[2].to), (0.4, 0.6));
        let half = (said[2].answers, said[2].right, said[2].mean);
        assert_eq!(half, (4, 2, Some(0.5)));
        let others = said.iter().map(|said| said.answers).sum::<u64>() - 4;
        assert_eq!(others, 0);
    }

    #[test]
    fn refused_scans_are_counted_and_the_first_reason_kept() {
        let mut judge = Judge::new();
        assert_eq!(judge.complaint(), None);
        judge.refusal(Pose::IDENTITY, "empty".to_owned());
        judge.refusal(Pose::IDENTITY, "too long".to_owned());
        let complaint = judge.complaint().unwrap();
        assert_eq!(complaint, "scans rejected: 2; the first: empty");
    }
}
