//! Report of a run. Pure.

use answers::statistics::Distribution;
use serde::Serialize;

use super::launched::Losses;
use super::recorded::Recorded;
use super::tally::{Tally, gap};
use super::usage::Usage;

#[derive(Debug, Serialize)]
pub(super) struct Report {
    pub(super) seconds: f64,
    pub(super) seed: u64,
    #[serde(flatten)]
    pub(super) tally: Tally,
    /// From the summaries of launchers that ended regularly; a killed one prints none.
    #[serde(flatten)]
    pub(super) losses: Losses,
    /// Time from the end of a killed launcher to that of its last node, in seconds.
    #[serde(serialize_with = "gap")]
    pub(super) nodes_ended_s: Distribution,
    pub(super) restarts: u64,
    pub(super) usage: Usage,
    /// Figures of the recording; `None` without `--record`.
    pub(super) recorded: Option<Recorded>,
    pub(super) leftovers: Vec<String>,
    /// Failures in addition to wrong poses and leftovers.
    pub(super) failures: Vec<String>,
}

impl Report {
    /// True if the graph met its guarantees.
    pub(super) fn is_good(&self) -> bool {
        self.tally.wrong == 0 && self.leftovers.is_empty() && self.failures.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::time::Duration;

    use super::*;

    #[test]
    fn wrong_poses_leftovers_and_failures_are_no_success() {
        let good = || Report {
            seconds: 0.0,
            seed: 1,
            tally: Tally::new(BTreeMap::new(), 0, Duration::from_secs(1)),
            losses: Losses::default(),
            nodes_ended_s: Distribution::new(1),
            restarts: 0,
            usage: Usage::default(),
            recorded: None,
            leftovers: Vec::new(),
            failures: Vec::new(),
        };
        assert!(good().is_good());
        for spoil in [
            |report: &mut Report| report.tally.wrong = 1,
            |report: &mut Report| report.leftovers.push("/dev/shm/x".into()),
            |report: &mut Report| report.failures.push("no pose".into()),
        ] {
            let mut report = good();
            spoil(&mut report);
            assert!(!report.is_good());
        }
    }
}
