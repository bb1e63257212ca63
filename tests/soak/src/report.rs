//! Report of a run. Pure.

use serde::Serialize;

use super::launched::Losses;
use super::recorded::Recorded;
use super::tally::{FaultFigures, Gap, PoseFigures};
use super::usage::Usage;

#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Report {
    pub(super) seconds: f64,
    pub(super) seed: u64,
    #[serde(flatten)]
    pub(super) poses: PoseFigures,
    /// From the summaries of launchers that ended regularly; a killed one prints none.
    #[serde(flatten)]
    pub(super) losses: Losses,
    pub(super) faults: Vec<FaultFigures>,
    /// Time from the end of a killed launcher to that of its last node, in seconds.
    pub(super) nodes_ended_s: Gap,
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
        self.poses.wrong == 0 && self.leftovers.is_empty() && self.failures.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_poses_leftovers_and_failures_are_no_success() {
        assert!(Report::default().is_good());
        for spoil in [
            |report: &mut Report| report.poses.wrong = 1,
            |report: &mut Report| report.leftovers.push("/dev/shm/x".into()),
            |report: &mut Report| report.failures.push("no pose".into()),
        ] {
            let mut report = Report::default();
            spoil(&mut report);
            assert!(!report.is_good());
        }
    }
}
