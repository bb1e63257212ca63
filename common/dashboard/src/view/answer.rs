//! Result of one scan: verdict and hypotheses.

use answers::{Candidate, ScanAnswer};
use messages::{HypothesesHeader, Hypothesis};
use serde::Serialize;

use super::ms;

/// Maximum number of hypotheses sent; the engine keeps 64.
const MAX_PLACES: usize = 64;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Answer {
    pub(crate) counter: u64,
    /// Time of measurement, in nanoseconds since 1970.
    pub(crate) stamp_ns: i64,
    #[serde(flatten)]
    pub(crate) answer: ScanAnswer,
    /// Share of the beams' weight that agrees with the best place.
    pub(crate) inlier_share: f32,
    /// Duration of the search, part of `cpu_ms`.
    pub(crate) search_cpu_ms: f64,
    /// Duration of the peak extraction, part of `cpu_ms`.
    pub(crate) extract_cpu_ms: f64,
    /// From the scan's entry into the graph to this message.
    pub(crate) age_ms: f64,
    /// Possible poses, best first.
    pub(crate) hypotheses: Vec<Candidate>,
}

impl Answer {
    /// Converts a message of `hypotheses`. `name_of` returns the name of one of several maps;
    /// `now_ns`: monotonic clock of the host.
    pub(crate) fn new(
        header: &HypothesesHeader,
        items: &[Hypothesis],
        name_of: &dyn Fn(u64) -> Option<String>,
        now_ns: i64,
    ) -> Self {
        let hypotheses = Candidate::all(header, items, name_of).take(MAX_PLACES);
        Answer {
            counter: header.stamp.counter,
            stamp_ns: header.stamp.measured_ns,
            answer: ScanAnswer::new(header, items, name_of),
            inlier_share: header.inlier_share,
            search_cpu_ms: header.search_ns as f64 / 1e6,
            extract_cpu_ms: header.extract_ns as f64 / 1e6,
            age_ms: ms(now_ns.saturating_sub(header.stamp.entered_ns)),
            hypotheses: hypotheses.collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, Stamp, Verdict};

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
            map_from_laser: Pose2::new(x, 2.0, 0.5),
            score: 0.9,
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn an_answer_is_reported_in_numbers_and_words() {
        let named = |map_id| (map_id == 0).then(|| "attic".to_owned());
        let items = [hypothesis(1.0)];
        let answer = Answer::new(&header(Verdict::Unique), &items, &named, 31_000_000);
        assert_eq!((answer.counter, answer.age_ms), (7, 30.0));
        let json = serde_json::to_value(&answer).unwrap();
        assert_eq!(json["says"], "one place, fit 0.90");
        assert_eq!(
            (&json["latency_ms"], &json["map"]),
            (&20.0.into(), &"attic".into())
        );
        let best = &json["hypotheses"][0];
        for key in [
            "map_id",
            "map",
            "laser",
            "base",
            "laser_covariance",
            "score",
        ] {
            assert_eq!(json[key], best[key], "{key}");
        }
        assert_eq!(
            (&json["laser"]["x"], &json["base"]),
            (&1.0.into(), &().into())
        );
    }

    #[test]
    fn few_places_are_sent() {
        let many = vec![hypothesis(1.0); 100_000];
        let answer = Answer::new(&header(Verdict::Ambiguous), &many, &|_| None, i64::MAX);
        assert_eq!(answer.hypotheses.len(), MAX_PLACES);
    }
}
