//! Collects the messages of a run into figures. Pure.

use std::collections::HashMap;

use answers::statistics::{Answer, Distribution};
use answers::{ScanAnswer, TrackedPose};
use messages::{
    GroundTruth, HealthHeader, HypothesesHeader, Hypothesis, MapSet, PoseHeader, Stamp, Verdict,
};

use super::{pairs::Pairs, summary::Summary, tracking::Tracking};

/// Number of newest scans for percentiles, some hours, so that memory stays bounded.
const WINDOW: usize = 200_000;

pub(crate) struct Report {
    /// Names of the maps of a set, by their ids; empty for a single map.
    maps: HashMap<u64, String>,
    /// Scans of publishers that were restarted since.
    earlier_scans: u64,
    newest_scan: Option<Stamp>,
    newest_answer: Option<Stamp>,
    newest_pose: Option<Stamp>,
    /// True if the graph has a tracker; then each scan waits for its pose.
    is_tracked: bool,
    answered: u64,
    tracking: Tracking,
    pairs: Pairs,
    latency_ms: Distribution,
    cpu_ms: Distribution,
    graph_ms: Distribution,
    /// Dropped and refused samples, by process id.
    losses: HashMap<u32, (u64, u64)>,
}

impl Report {
    pub(crate) fn new(is_tracked: bool) -> Self {
        Report {
            maps: HashMap::new(),
            earlier_scans: 0,
            newest_scan: None,
            newest_answer: None,
            newest_pose: None,
            is_tracked,
            answered: 0,
            tracking: Tracking::new(WINDOW),
            pairs: Pairs::new(WINDOW),
            latency_ms: Distribution::new(WINDOW),
            cpu_ms: Distribution::new(WINDOW),
            graph_ms: Distribution::new(WINDOW),
            losses: HashMap::new(),
        }
    }

    pub(crate) fn maps(&mut self, set: &MapSet<'_>) {
        let maps = set.maps.iter();
        let names = maps.map(|(map, _)| (map.map_id, map.name.to_string()));
        self.maps = names.collect();
    }

    fn map(&self, map_id: u64) -> Option<String> {
        self.maps.get(&map_id).cloned()
    }

    pub(crate) fn scan(&mut self, stamp: Stamp) {
        if let Some(last) = self.newest_scan
            && stamp.counter <= last.counter
            && stamp != last
        {
            // The sender was restarted and counts from 0 again.
            let sent = last.counter.saturating_add(1);
            self.earlier_scans = self.earlier_scans.saturating_add(sent);
        }
        self.newest_scan = Some(stamp);
    }

    pub(crate) fn answer(&mut self, header: &HypothesesHeader, found: &[Hypothesis]) -> ScanAnswer {
        let line = ScanAnswer::new(header, found, &|map_id| self.map(map_id));
        self.newest_answer = Some(header.stamp);
        self.answered += 1;
        let latency_ms = line.latency_ms.unwrap_or_default();
        self.latency_ms.add(latency_ms);
        self.cpu_ms.add(line.cpu_ms);
        self.graph_ms.add(latency_ms - line.cpu_ms);
        let has_pose = line.best.laser.is_some();
        let found = found.iter().filter(|_| has_pose);
        let answer = Answer {
            poses: found.map(|h| h.map_from_laser.into()).collect(),
            verdict: Verdict::from_code(header.verdict),
        };
        self.pairs.answer(header.stamp.measured_ns, answer);
        line
    }

    pub(crate) fn pose(&mut self, header: &PoseHeader, words: &[u8]) -> TrackedPose {
        let mut pose = TrackedPose::new(header, words);
        pose.place.map = pose.place.laser.and_then(|_| self.map(header.map_id));
        self.newest_pose = Some(header.stamp);
        self.tracking.pose(header, pose.latency_ms);
        pose
    }

    pub(crate) fn truth(&mut self, truth: &GroundTruth) {
        let pose = truth.map_from_laser.into();
        self.tracking.truth(truth.stamp.measured_ns, pose);
        self.pairs.truth(truth.stamp.measured_ns, pose);
    }

    /// Records a node's health message; its counters are cumulative.
    pub(crate) fn health(&mut self, health: &HealthHeader) {
        let losses = (health.dropped, health.refused);
        self.losses.insert(health.pid, losses);
    }

    pub(crate) fn any_answer(&self) -> bool {
        self.answered > 0
    }

    /// True if the newest scan has its answer, which is its pose if the graph has a tracker.
    pub(crate) fn all_answered(&self) -> bool {
        let newest = match self.is_tracked {
            true => self.newest_pose,
            false => self.newest_answer,
        };
        let answers = |scan: Stamp| newest.is_some_and(|answer| answer.is_of(scan));
        self.newest_scan.is_none_or(answers)
    }

    pub(crate) fn summary(&self) -> Summary {
        let newest = self.newest_scan.map_or(0, |s| s.counter.saturating_add(1));
        let sum = |pick: fn(&(u64, u64)) -> u64| {
            self.losses.values().map(pick).fold(0, u64::saturating_add)
        };
        let tracking = self.tracking.figures();
        let tracked = tracking.as_ref().map_or(0, |tracking| tracking.scans);
        let answered = match self.is_tracked {
            true => tracked,
            false => self.answered,
        };
        let scans = self.earlier_scans.saturating_add(newest);
        Summary {
            // An answer counts as a scan if the scan itself was not received.
            scans: scans.max(self.answered).max(tracked),
            answered,
            searched: self.answered,
            tracking,
            dropped: sum(|losses| losses.0),
            refused: sum(|losses| losses.1),
            accuracy: self.pairs.figures(),
            latency_ms: self.latency_ms.tail(),
            cpu_ms: self.cpu_ms.tail(),
            graph_ms: self.graph_ms.tail(),
        }
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::{Pose2, TrackState};

    use answers::testing::{message, pose};

    use super::*;

    fn truth(measured_ns: i64, x: f64) -> GroundTruth {
        let mut truth = GroundTruth::zeroed();
        truth.stamp.measured_ns = measured_ns;
        truth.map_from_laser = Pose2::new(x, -2.0, std::f64::consts::PI);
        truth
    }

    fn answer(report: &mut Report, measured_ns: i64, counter: u64, verdict: Verdict) -> ScanAnswer {
        let (header, found) = message(measured_ns, counter, verdict as u32);
        report.answer(&header, &found)
    }

    fn scan(report: &mut Report, measured_ns: i64, counter: u64) {
        report.scan(message(measured_ns, counter, 0).0.stamp);
    }

    #[test]
    fn answers_meet_their_truths_in_either_order() {
        let mut report = Report::new(false);
        report.truth(&truth(1, 1.0));
        answer(&mut report, 1, 0, Verdict::Unique);
        answer(&mut report, 2, 1, Verdict::Unique);
        report.truth(&truth(2, 9.0));
        answer(&mut report, 3, 2, Verdict::NoScan);
        report.truth(&truth(3, 1.0));
        answer(&mut report, 4, 3, Verdict::Unique);
        let summary = report.summary();
        assert_eq!(summary.answered, 4);
        assert_eq!(summary.accuracy.truths, 3);
        assert_eq!(summary.accuracy.success_50cm_10deg, Some(1.0 / 3.0));
        assert_eq!(summary.accuracy.unique_wrong, 1);
    }

    #[test]
    fn scans_are_counted_by_their_counters() {
        let mut report = Report::new(false);
        assert!(report.all_answered());
        scan(&mut report, 10, 0);
        scan(&mut report, 50, 4);
        assert!(!report.all_answered());
        answer(&mut report, 50, 4, Verdict::Unique);
        assert!(report.all_answered());
        assert_eq!((report.summary().scans, report.summary().answered), (5, 1));
        scan(&mut report, 60, 1);
        assert!(!report.all_answered());
        assert_eq!(report.summary().scans, 7, "two more after a restart");
    }

    #[test]
    fn a_loop_repeats_times_but_not_counters() {
        let mut report = Report::new(false);
        scan(&mut report, 10, 0);
        answer(&mut report, 10, 0, Verdict::Unique);
        scan(&mut report, 10, 1);
        assert!(!report.all_answered());
    }

    #[test]
    fn an_answer_may_come_from_a_machine_with_another_clock() {
        let mut report = Report::new(false);
        scan(&mut report, 10, 0);
        let (mut header, found) = message(10, 0, Verdict::Unique as u32);
        header.stamp.entered_ns += 1_000;
        report.answer(&header, &found);
        assert!(report.all_answered());
    }

    #[test]
    fn losses_add_up_over_processes() {
        let mut report = Report::new(false);
        let mut health = |pid, dropped, refused| {
            let mut header = HealthHeader::zeroed();
            (header.pid, header.dropped, header.refused) = (pid, dropped, refused);
            report.health(&header);
        };
        health(1, 1, 0);
        health(1, 2, 5);
        health(2, 3, 0);
        let summary = report.summary();
        assert_eq!((summary.dropped, summary.refused), (5, 5));
    }

    #[test]
    fn with_a_tracker_the_poses_are_awaited_and_counted() {
        let mut report = Report::new(true);
        report.truth(&truth(1, 1.0));
        report.truth(&truth(2, 1.0));
        scan(&mut report, 1, 0);
        scan(&mut report, 2, 1);
        answer(&mut report, 2, 1, Verdict::Unique);
        assert!(!report.all_answered(), "the tracker has not");
        let header = pose(1, 0, TrackState::Searching);
        report.pose(&header, b"");
        let header = pose(2, 1, TrackState::Unique);
        report.pose(&header, b"");
        assert!(report.all_answered());
        report.pose(&pose(3, 2, TrackState::Unique), b"");
        report.truth(&truth(3, 9.0));
        let summary = report.summary();
        assert_eq!((summary.scans, summary.answered), (3, 3));
        assert_eq!(summary.searched, 1, "not every scan is");
        let tracking = summary.tracking.unwrap();
        assert_eq!(tracking.states["Unique"], 2.0 / 3.0);
        assert_eq!((tracking.accuracy.truths, tracking.accuracy.unique), (3, 2));
        assert_eq!(tracking.accuracy.unique_wrong, 1);
        assert_eq!(summary.accuracy.truths, 1);
    }
}
