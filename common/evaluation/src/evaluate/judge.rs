//! Computes the figures of one file from results and true poses. Pure.

use answers::statistics::{Accuracy, Distribution, SUCCESS, Spread};
use engine::peaks::Places;
use geometry::Pose;
use messages::Verdict;
use schemars::JsonSchema;
use serde::Serialize;

use super::given::GivenPose;
use crate::trust::{Said, Trust};

/// Result for a scan with a true pose.
#[derive(Default)]
pub(super) struct Judged {
    truth: Pose,
    answer: answers::statistics::Answer,
    /// Probability of the best place, if it is known.
    probability: Option<f64>,
    /// CPU time of the search in milliseconds, if there was one.
    cpu_ms: Option<f64>,
    /// True if the verdict is Unique and the 95 % ellipse contains the truth.
    is_held: bool,
    /// Reason for the rejection of the scan, which counts as a failure.
    refusal: Option<String>,
}

/// Results of several files, with the largest map and peak.
#[derive(Default)]
pub(super) struct Total {
    pub(super) files: Vec<Vec<Judged>>,
    costs: Evaluation,
}

impl Total {
    pub(super) fn add(&mut self, judged: Vec<Judged>, of: &Evaluation) {
        self.files.push(judged);
        let all = &mut self.costs;
        all.map_cells = all.map_cells.max(of.map_cells);
        all.scans += of.scans;
        all.prepare_cpu_ms += of.prepare_cpu_ms;
        all.peak_rss_mb = all.peak_rss_mb.max(of.peak_rss_mb);
        all.searchable_cells = all.searchable_cells.max(of.searchable_cells);
        all.index_bytes = all.index_bytes.max(of.index_bytes);
    }

    pub(super) fn conclude(&self) -> Evaluation {
        let costs = Evaluation {
            bag: "total".to_owned(),
            ..self.costs.clone()
        };
        costs.with(&self.files)
    }
}

/// Figures of one file or of all; shares are 0..=1 of `truths`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
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

#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, JsonSchema)]
pub(super) struct Times {
    pub(super) median: Option<f64>,
    pub(super) p90: Option<f64>,
    pub(super) max: Option<f64>,
}

impl Judged {
    pub(super) fn answer(truth: Pose, found: &Places, cpu_ms: f64) -> Self {
        let poses = found.places.iter().map(|place| place.map_from_laser);
        let best = found.places.first();
        let is_held = best.is_some_and(|best| {
            answers::statistics::holds(best.covariance, best.map_from_laser, truth)
        });
        Judged {
            truth,
            answer: answers::statistics::Answer {
                poses: poses.collect(),
                verdict: Some(found.verdict),
            },
            probability: best.map(|best| best.probability),
            cpu_ms: Some(cpu_ms),
            is_held: is_held && found.verdict == Verdict::Unique,
            ..Judged::default()
        }
    }

    pub(super) fn given(truth: Pose, pose: Pose, given: &GivenPose) -> Self {
        let verdict = match given.is_unique {
            true => Verdict::Unique,
            false => Verdict::Ambiguous,
        };
        Judged {
            truth,
            answer: answers::statistics::Answer {
                poses: vec![pose],
                verdict: Some(verdict),
            },
            probability: given.probability,
            ..Judged::default()
        }
    }

    pub(super) fn refusal(truth: Pose, reason: String) -> Self {
        Judged {
            truth,
            refusal: Some(reason),
            ..Judged::default()
        }
    }
}

/// Sentence on the rejected scans; `None` if there are none.
pub(super) fn complaint(all: &[Judged]) -> Option<String> {
    let refusals = all.iter().filter_map(|judged| judged.refusal.as_ref());
    let refused = refusals.clone().count();
    let reason = refusals.clone().next()?;
    Some(format!("scans rejected: {refused}; the first: {reason}"))
}

impl Evaluation {
    /// Adds the figures of the results to properties and costs.
    pub(super) fn with(self, files: &[Vec<Judged>]) -> Self {
        let (mut accuracy, mut trust) = (Accuracy::new(1), Trust::default());
        let (mut error_m, mut error_deg) = (Vec::new(), Vec::new());
        for file in files {
            // A mean of several files is that of their sums, which are rounded.
            let mut of_file = Trust::default();
            for judged in file {
                accuracy.add(judged.truth, &judged.answer);
                let Some(best) = judged.answer.poses.first() else {
                    continue;
                };
                let is_right = best.is_within(judged.truth, SUCCESS.0, SUCCESS.1.to_radians());
                if is_right {
                    error_m.push(best.distance_to(judged.truth));
                    error_deg.push(best.angle_to(judged.truth).to_degrees());
                }
                if let Some(probability) = judged.probability {
                    of_file.add(probability, is_right);
                }
            }
            trust.merge(&of_file);
        }
        let all = || files.iter().flatten();
        let figures = accuracy.figures();
        let times = Distribution::from_iter(all().filter_map(|judged| judged.cpu_ms));
        let [median, p90, max] = times.percentiles([50.0, 90.0, 100.0]);
        Evaluation {
            truths: figures.truths,
            success_50cm_10deg: figures.success_50cm_10deg,
            success_20cm_3deg: figures.success_20cm_3deg,
            top16_recall: figures.top16_recall,
            unique: figures.unique,
            unique_wrong: figures.unique_wrong,
            cpu_ms: Times { median, p90, max },
            error_m: Distribution::from_iter(error_m).spread(),
            error_deg: Distribution::from_iter(error_deg).spread(),
            unique_in_ellipse: all().filter(|judged| judged.is_held).count() as u64,
            probabilities: trust.said().to_vec(),
            ..self
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use engine::peaks::Place;
    use geometry::Covariance;

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
    fn judged() -> (Vec<Judged>, Evaluation) {
        let truth = Pose::new(1.0, 2.0, 0.0);
        let beside = |x: f64| Pose::new(1.0 + x, 2.0, x.to_radians());
        let second = found(Verdict::Ambiguous, &[beside(5.0), beside(0.0)]);
        let judged = vec![
            Judged::answer(truth, &found(Verdict::Unique, &[beside(0.1)]), 4.0),
            Judged::answer(truth, &found(Verdict::Unique, &[beside(0.3)]), 1.0),
            Judged::answer(truth, &found(Verdict::Unique, &[beside(5.0)]), 2.0),
            Judged::answer(truth, &second, 3.0),
            Judged::refusal(truth, "empty".to_owned()),
        ];
        let costs = Evaluation {
            bag: "r.mcap".to_owned(),
            map_cells: 720,
            scans: 9,
            prepare_cpu_ms: 12.5,
            peak_rss_mb: 34.5,
            searchable_cells: 300,
            index_bytes: 9000,
            ..Evaluation::default()
        };
        (judged, costs)
    }

    pub(crate) fn evaluation() -> Evaluation {
        let (judged, costs) = judged();
        costs.with(&[judged])
    }

    #[test]
    fn a_total_is_of_the_scans_of_all_files() {
        let (judged, mut costs) = judged();
        let mut total = Total::default();
        total.add(judged, &costs);
        costs.map_cells = 700;
        let truth = Pose::new(1.0, 2.0, 0.0);
        let other = Judged::answer(truth, &found(Verdict::Unique, &[truth]), 9.0);
        total.add(vec![other], &costs);
        let all = total.conclude();
        assert_eq!((&*all.bag, total.files.len()), ("total", 2));
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
}
