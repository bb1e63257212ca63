//! Result of one scan: verdict and hypotheses.

use engine::peaks::sentence::{PlaceSummary, sentence};
use geometry::{Covariance, Pose};
use messages::{HypothesesHeader, Hypothesis, Verdict};
use serde::Serialize;

use super::{Ellipse, PoseJson, ms};

/// Maximum number of hypotheses sent; the engine keeps 64.
const MAX_PLACES: usize = 64;

/// Result of one scan.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Answer {
    /// Number of the scan.
    pub(crate) counter: u64,
    /// Time of measurement, in seconds since 1970.
    pub(crate) stamp_s: f64,
    /// Map that was searched, in hexadecimal.
    pub(crate) map_id: String,
    /// The verdict; `?` if this version does not know its code.
    pub(crate) verdict: &'static str,
    /// The verdict in words.
    pub(crate) says: String,
    /// Number of other places that fit about as well.
    pub(crate) alternatives: u32,
    /// Probability of the best place.
    pub(crate) confidence: f32,
    /// Share of the beams' weight that agrees with the best place.
    pub(crate) inlier_share: f32,
    /// From the scan's entry into the graph to the result.
    pub(crate) latency_ms: f64,
    /// Duration of the search, part of the latency.
    pub(crate) search_ms: f64,
    /// Duration of the peak extraction, part of the latency.
    pub(crate) extract_ms: f64,
    /// From the scan's entry into the graph to this message.
    pub(crate) age_ms: f64,
    /// Possible poses, best first.
    pub(crate) hypotheses: Vec<Place>,
}

/// One hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Place {
    /// Map of the pose, in hexadecimal.
    pub(crate) map_id: String,
    /// Pose of the laser.
    pub(crate) laser: PoseJson,
    /// Pose of the robot's base; `None` if the laser's mount is not known.
    pub(crate) base: Option<PoseJson>,
    /// Fit of the scan.
    pub(crate) score: f32,
    pub(crate) probability: f32,
    /// Number of votes for the place.
    pub(crate) support: u64,
    /// One-sigma ellipse of the laser's pose.
    pub(crate) ellipse: Option<Ellipse>,
    /// One-sigma ellipse of the base's pose; `None` if the laser's mount is not known.
    pub(crate) base_ellipse: Option<Ellipse>,
}

impl Answer {
    /// Converts a message of `hypotheses`. `now_ns`: monotonic clock of the host.
    pub(crate) fn new(header: &HypothesesHeader, items: &[Hypothesis], now_ns: i64) -> Self {
        let verdict = Verdict::from_code(header.verdict);
        let since_entry = |ns: i64| ms(ns.saturating_sub(header.stamp.entered_ns));
        let shown = items.iter().filter(is_pose).take(MAX_PLACES);
        let mount_known = header.mount_known == 1;
        let summaries: Vec<PlaceSummary> = shown.clone().filter_map(summary).collect();
        let meant = summaries.len().min(1 + header.alternatives as usize);
        Answer {
            counter: header.stamp.counter,
            stamp_s: header.stamp.measured_ns as f64 / 1e9,
            map_id: format!("{:016x}", header.map_id),
            verdict: verdict.map_or("?", Verdict::as_str),
            says: verdict.map_or_else(String::new, |verdict| {
                sentence(verdict, summaries.get(..meant).unwrap_or_default())
            }),
            alternatives: header.alternatives,
            confidence: header.confidence,
            inlier_share: header.inlier_share,
            latency_ms: since_entry(header.sent_ns),
            search_ms: header.search_ns as f64 / 1e6,
            extract_ms: header.extract_ns as f64 / 1e6,
            age_ms: since_entry(now_ns),
            hypotheses: match verdict {
                Some(Verdict::NoScan) => Vec::new(),
                _ => shown.map(|h| place(h, mount_known)).collect(),
            },
        }
    }
}

fn is_pose(hypothesis: &&Hypothesis) -> bool {
    Pose::from(hypothesis.map_from_laser).is_finite()
}

fn covariance(hypothesis: &Hypothesis) -> Option<Covariance> {
    let is_finite = hypothesis.covariance.iter().all(|c| c.is_finite());
    is_finite.then(|| Covariance::from_rows(hypothesis.covariance))
}

fn summary(hypothesis: &Hypothesis) -> Option<PlaceSummary> {
    Some(PlaceSummary {
        map: hypothesis.map_id,
        map_from_laser: hypothesis.map_from_laser.into(),
        covariance: covariance(hypothesis)?,
        score: hypothesis.score.into(),
    })
}

fn place(hypothesis: &Hypothesis, mount_known: bool) -> Place {
    let (laser, base) = (hypothesis.map_from_laser, hypothesis.map_from_base);
    let of_base = covariance(hypothesis).filter(|_| mount_known);
    let of_base = of_base.map(|known| known.carried(laser.into(), base.into()).to_rows());
    Place {
        map_id: format!("{:016x}", hypothesis.map_id),
        laser: laser.into(),
        base: mount_known.then(|| base.into()),
        score: hypothesis.score,
        probability: hypothesis.probability,
        support: hypothesis.support,
        ellipse: Ellipse::new(hypothesis.covariance),
        base_ellipse: of_base.and_then(Ellipse::new),
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, Stamp};

    use super::*;

    fn header(verdict: Verdict) -> HypothesesHeader {
        HypothesesHeader {
            stamp: Stamp {
                measured_ns: 1_500_000_000,
                entered_ns: 1_000_000,
                counter: 7,
            },
            sent_ns: 21_000_000,
            verdict: verdict as u32,
            ..Zeroable::zeroed()
        }
    }

    fn hypothesis(x: f64) -> Hypothesis {
        Hypothesis {
            map_from_laser: Pose2 {
                x,
                y: 2.0,
                yaw: 0.5,
            },
            covariance: [0.04, 0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0009],
            score: 0.9,
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn an_answer_is_reported_in_numbers_and_words() {
        let answer = Answer::new(&header(Verdict::Unique), &[hypothesis(1.0)], 31_000_000);
        assert_eq!((answer.counter, answer.verdict), (7, "Unique"));
        assert_eq!((answer.latency_ms, answer.age_ms), (20.0, 30.0));
        assert_eq!(answer.says, "one place, fit 0.90");
        let ellipse = answer.hypotheses[0].ellipse.unwrap();
        assert!((ellipse.major_m - 0.2).abs() < 1e-12);
        assert!((ellipse.yaw - 0.03).abs() < 1e-12);
        assert_eq!(answer.hypotheses[0].base, None, "no mount is known");
    }

    #[test]
    fn the_base_behind_a_laser_is_less_sure_across() {
        let mounted = HypothesesHeader {
            mount_known: 1,
            ..header(Verdict::Unique)
        };
        let mut place = hypothesis(1.0);
        // The laser looks along x, two metres ahead of the base: 0.06 m per sigma of yaw.
        place.map_from_laser.yaw = 0.0;
        place.covariance = [1e-4, 0.0, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0, 0.0009];
        place.map_from_base = Pose2 {
            x: -1.0,
            y: 2.0,
            yaw: 0.0,
        };
        let answer = Answer::new(&mounted, &[place], 0);
        let ellipse = answer.hypotheses[0].base_ellipse.unwrap();
        assert!((ellipse.major_m - 0.0037f64.sqrt()).abs() < 1e-9);
        assert!((ellipse.minor_m - 0.01).abs() < 1e-9);
        let wild = Hypothesis {
            map_from_base: Pose2 {
                x: f64::NAN,
                ..place.map_from_base
            },
            ..place
        };
        let answer = Answer::new(&mounted, &[wild], 0);
        assert_eq!(answer.hypotheses[0].base_ellipse, None);
    }

    #[test]
    fn what_is_no_pose_is_left_out_and_what_is_no_spread_has_no_ellipse() {
        let mut spread = hypothesis(3.0);
        spread.covariance[0] = f64::NAN;
        let items = [hypothesis(f64::NAN), hypothesis(f64::INFINITY), spread];
        let answer = Answer::new(&header(Verdict::PoorFit), &items, 0);
        assert_eq!(answer.hypotheses.len(), 1);
        assert_eq!(answer.hypotheses[0].ellipse, None);
        let many = vec![hypothesis(1.0); 100_000];
        let answer = Answer::new(&header(Verdict::Ambiguous), &many, i64::MAX);
        assert_eq!(answer.hypotheses.len(), MAX_PLACES);
    }

    #[test]
    fn without_a_verdict_there_is_no_place() {
        let answer = Answer::new(&header(Verdict::NoScan), &[hypothesis(1.0)], 0);
        assert!(answer.hypotheses.is_empty());
        let unknown = HypothesesHeader {
            verdict: 99,
            ..header(Verdict::NoScan)
        };
        assert_eq!(Answer::new(&unknown, &[], 0).verdict, "?");
    }
}
