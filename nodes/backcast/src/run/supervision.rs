//! What happens when a process ends, and when the run is over. Pure: no clock,
//! no process.

use std::time::Duration;

use dataflow::{Node, Restart, RestartPolicy};
use messages::{Topic, topic};

/// What follows when a process has ended by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AfterEnd {
    /// It is started again, so much later.
    Restart(Duration),
    /// It has done its work.
    Done,
    /// It failed for good.
    Failed,
}

/// Counts the restarts of one node and decides on the next, as dora does.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Restarts {
    rules: Restart,
    used: u32,
}

impl Restarts {
    /// Doublings of the delay after which it stays; dora's number.
    const MAX_DOUBLINGS: u32 = 16;

    /// None used yet.
    pub(crate) fn new(rules: Restart) -> Self {
        Restarts { rules, used: 0 }
    }

    /// How often the node was started again.
    pub(crate) fn used(&self) -> u32 {
        self.used
    }

    /// Decides after an end with or without success, and counts the restart.
    pub(crate) fn after_end(&mut self, success: bool) -> AfterEnd {
        let wanted = match self.rules.policy {
            RestartPolicy::Never => false,
            RestartPolicy::OnFailure => !success,
            RestartPolicy::Always => true,
        };
        let allowed = self.rules.max_restarts == 0 || self.used < self.rules.max_restarts;
        if wanted && allowed {
            let doublings = self.used.min(Self::MAX_DOUBLINGS);
            self.used = self.used.saturating_add(1);
            return AfterEnd::Restart(self.rules.delay.saturating_mul(1 << doublings));
        }
        if success {
            AfterEnd::Done
        } else {
            AfterEnd::Failed
        }
    }
}

/// What is measured enters the graph with these; all else follows from them.
pub(crate) const MEASUREMENTS: [&str; 3] = [
    topic::Scan::NAME,
    topic::OdometryTopic::NAME,
    topic::GroundTruthTopic::NAME,
];

/// Whether a node feeds the graph.
pub(crate) fn is_source(node: &Node) -> bool {
    node.outputs
        .iter()
        .any(|o| MEASUREMENTS.contains(&o.as_str()))
}

/// Whether nothing more can come: every source is done, or every node is.
/// Takes for each node whether it is a source and whether it is done.
pub(crate) fn is_over(nodes: impl Iterator<Item = (bool, bool)>) -> bool {
    let (mut sources, mut sources_done, mut all_done) = (0, 0, true);
    for (source, done) in nodes {
        sources += u32::from(source);
        sources_done += u32::from(source && done);
        all_done &= done;
    }
    all_done || (sources > 0 && sources == sources_done)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn restarts(policy: RestartPolicy, max_restarts: u32, delay_ms: u64) -> Restarts {
        Restarts::new(Restart {
            policy,
            max_restarts,
            delay: Duration::from_millis(delay_ms),
        })
    }

    const AT_ONCE: AfterEnd = AfterEnd::Restart(Duration::ZERO);

    #[test]
    fn policies_look_at_success() {
        use RestartPolicy::{Always, Never, OnFailure};
        for (policy, on_success, on_failure) in [
            (Never, AfterEnd::Done, AfterEnd::Failed),
            (OnFailure, AfterEnd::Done, AT_ONCE),
            (Always, AT_ONCE, AT_ONCE),
        ] {
            assert_eq!(restarts(policy, 0, 0).after_end(true), on_success);
            assert_eq!(restarts(policy, 0, 0).after_end(false), on_failure);
        }
    }

    #[test]
    fn restarts_run_out() {
        let mut two = restarts(RestartPolicy::Always, 2, 0);
        let ends = [false, true, false].map(|success| two.after_end(success));
        assert_eq!(ends, [AT_ONCE, AT_ONCE, AfterEnd::Failed]);
        assert_eq!(two.used(), 2);
        assert_eq!(two.after_end(true), AfterEnd::Done);
    }

    #[test]
    fn without_a_limit_they_do_not() {
        let mut endless = restarts(RestartPolicy::OnFailure, 0, 0);
        assert!((0..1000).all(|_| endless.after_end(false) == AT_ONCE));
    }

    #[test]
    fn the_delay_doubles_up_to_a_point() {
        let mut delayed = restarts(RestartPolicy::OnFailure, 0, 100);
        let delays: Vec<_> = (0..20).map(|_| delayed.after_end(false)).collect();
        for (i, factor) in [(0, 1), (1, 2), (2, 4), (16, 65_536), (19, 65_536)] {
            let expected = Duration::from_millis(100 * factor);
            assert_eq!(delays[i], AfterEnd::Restart(expected), "{i}");
        }
    }

    #[test]
    fn a_run_is_over_when_its_sources_are() {
        let over = |nodes: &[(bool, bool)]| is_over(nodes.iter().copied());
        assert!(over(&[(true, true), (false, false)]));
        assert!(!over(&[(true, true), (true, false), (false, true)]));
        assert!(!over(&[(false, true), (false, false)]));
        assert!(over(&[(false, true), (false, true)]));
    }

    #[test]
    fn sources_are_told_by_what_they_send() {
        let topics = dataflow::Topics {
            names: messages::topic::NAMES,
            shared: &[],
            several: &[],
        };
        let text = "nodes:
  - {id: a, path: x, outputs: [odometry]}
  - {id: b, path: x, outputs: [map]}
";
        let nodes = dataflow::parse(text, &topics).unwrap().nodes;
        assert!(is_source(&nodes[0]));
        assert!(!is_source(&nodes[1]));
    }
}
