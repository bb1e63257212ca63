//! Summary that is printed when a run is over. Pure.

use answers::number;
use answers::statistics::{CLOSE_SUCCESS, Figures, SUCCESS, Tail};
use messages::TrackState;
use schemars::JsonSchema;
use serde::Serialize;

use super::tracking::TrackingFigures;

const STATES: [TrackState; 4] = [
    TrackState::Unique,
    TrackState::Doubtful,
    TrackState::Searching,
    TrackState::Lost,
];

/// Figures of a run. Times are in milliseconds.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Summary {
    /// Scans that entered the graph.
    pub scans: u64,
    /// Scans that were answered, even with NoScan; with a tracker, the scans that it answered.
    pub answered: u64,
    /// Scans that were searched one by one, without the tracker.
    pub searched: u64,
    /// Samples dropped on any topic because a node was too slow.
    pub dropped: u64,
    /// Samples that nodes rejected as unusable.
    pub refused: u64,
    /// The tracker's figures, if there is one.
    #[serde(rename = "pose", skip_serializing_if = "Option::is_none")]
    pub tracking: Option<TrackingFigures>,
    /// Answers to single scans compared with the truth, if the recording holds it.
    #[serde(flatten)]
    pub accuracy: Figures,
    /// Time from the scan's entry into the graph to the pose.
    pub latency_ms: Tail,
    /// Part of the latency that is computing.
    pub cpu_ms: Tail,
    /// Rest of the latency: the overhead of the graph.
    pub graph_ms: Tail,
}

impl Summary {
    /// True if anything was lost between scan and pose.
    pub(crate) fn lost_data(&self) -> bool {
        self.dropped > 0 || self.answered < self.scans
    }

    pub(crate) fn text(&self) -> String {
        let counts = format!(
            "scans      {}, answered {}, dropped samples {}, refused {}",
            self.scans, self.answered, self.dropped, self.refused
        );
        let mut lines = vec![String::new(), counts];
        if let Some(tracking) = &self.tracking {
            lines.extend(tracking_lines(tracking));
            let searched = self.searched;
            lines.push(format!("single     {searched} scans, each by itself:"));
        }
        lines.extend(accuracy_lines(&self.accuracy));
        if self.searched > 0 {
            let latency = tail(self.latency_ms);
            lines.push(format!("latency    {latency} from scan to pose"));
            lines.push(format!("engine     {} of it", tail(self.cpu_ms)));
            lines.push(format!("graph      {} on top", tail(self.graph_ms)));
        }
        lines.join("\n")
    }
}

fn tracking_lines(tracking: &TrackingFigures) -> Vec<String> {
    let shares = STATES.map(|state| {
        let share = tracking.states.get(state.as_str()).copied();
        format!("{state} {} %", percent(Some(share.unwrap_or_default())))
    });
    let (shares, scans) = (shares.join(", "), tracking.scans);
    let mut lines = vec![format!("tracker    {shares} of {scans} scans")];
    lines.extend(accuracy_lines(&tracking.accuracy));
    let latency = tail(tracking.latency_ms);
    let of_tracker = "from scan to the tracker's pose";
    lines.push(format!("latency    {latency} {of_tracker}"));
    lines
}

fn accuracy_lines(figures: &Figures) -> Vec<String> {
    if figures.truths == 0 {
        return vec!["truth      none received, so poses are not judged".to_owned()];
    }
    let error = |m, deg| format!("{} m, {} deg", number(m, 3), number(deg, 2));
    vec![
        format!(
            "success    {} % within {} m and {} deg, {} % within {} m and {} deg, of {} with known truth",
            percent(figures.success_50cm_10deg),
            SUCCESS.0,
            SUCCESS.1,
            percent(figures.success_20cm_3deg),
            CLOSE_SUCCESS.0,
            CLOSE_SUCCESS.1,
            figures.truths,
        ),
        format!(
            "unique     {}, of them wrong {}",
            figures.unique, figures.unique_wrong
        ),
        format!(
            "error      median {}; 90 % below {}",
            error(figures.error_m.median, figures.error_deg.median),
            error(figures.error_m.p90, figures.error_deg.p90),
        ),
    ]
}

fn percent(share: Option<f64>) -> String {
    number(share.map(|share| 100.0 * share), 1)
}

fn tail(tail: Tail) -> String {
    let [median, p99] = [tail.median, tail.p99].map(|ms| number(ms, 2));
    format!("p50 {median} ms, p99 {p99} ms")
}

#[cfg(test)]
mod tests {
    use geometry::Pose;

    use super::*;
    use answers::statistics::{Accuracy, Answer};

    fn summary(accuracy: &Accuracy) -> Summary {
        let tail = |ms| Tail {
            median: Some(ms),
            p99: Some(10.0 * ms),
        };
        Summary {
            scans: 12,
            answered: 10,
            searched: 10,
            tracking: None,
            dropped: 2,
            refused: 1,
            accuracy: accuracy.figures(),
            latency_ms: tail(20.0),
            cpu_ms: tail(19.5),
            graph_ms: tail(0.5),
        }
    }

    fn judged() -> Accuracy {
        let mut accuracy = Accuracy::new(10);
        let answer = Answer {
            poses: vec![Pose::new(0.1, 0.0, 0.0)],
            verdict: Some(messages::Verdict::Unique),
        };
        accuracy.add(Pose::IDENTITY, &answer);
        accuracy
    }

    #[test]
    fn a_gap_anywhere_is_lost_data() {
        let mut figures = summary(&judged());
        assert!(figures.lost_data());
        figures.answered = 12;
        assert!(figures.lost_data(), "a topic was dropped");
        figures.dropped = 0;
        assert!(!figures.lost_data(), "refused is answered");
    }

    #[test]
    fn the_trackers_figures_stand_before_those_of_single_scans() {
        let mut figures = summary(&judged());
        figures.searched = 4;
        figures.tracking = Some(TrackingFigures {
            scans: 10,
            states: [("Unique", 0.75), ("Searching", 0.25)].into(),
            accuracy: judged().figures(),
            latency_ms: Tail {
                median: Some(21.0),
                p99: Some(25.0),
            },
        });
        let text = figures.text();
        let expected = "
scans      12, answered 10, dropped samples 2, refused 1
tracker    Unique 75.0 %, Doubtful 0.0 %, Searching 25.0 %, Lost 0.0 % of 10 scans
success    100.0 % within 0.5 m and 10 deg, 100.0 % within 0.2 m and 3 deg, of 1 with known truth
unique     1, of them wrong 0
error      median 0.100 m, 0.00 deg; 90 % below 0.100 m, 0.00 deg
latency    p50 21.00 ms, p99 25.00 ms from scan to the tracker's pose
single     4 scans, each by itself:
success    100.0 % within";
        assert!(text.starts_with(expected), "{text}");
        let json = serde_json::to_value(figures).unwrap();
        assert_eq!(json["pose"]["states"]["Unique"], 0.75);
        assert_eq!(json["pose"]["error_m"]["median"], 0.1);
        assert_eq!(json["error_m"]["median"], 0.1, "of single scans");
    }
}
