//! Nodes of a graph and their states.

use std::collections::BTreeMap;

use messages::{HealthHeader, NodeState};
use serde::Serialize;

/// Maximum number of nodes; a graph has about a dozen.
const CAPACITY: usize = 64;

/// Age of the last report after which a node is silent; nodes report each second.
const SILENT_AFTER_NS: i64 = 2_500_000_000;

/// Minimum interval over which rates are computed.
const RATE_NS: i64 = 900_000_000;

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct NodeReport {
    pub(crate) name: String,
    /// `waiting`, `ready`, `busy`, `degraded`, `stopped`, or `silent` if reports stay away.
    pub(crate) state: &'static str,
    pub(crate) pid: u32,
    pub(crate) received: u64,
    pub(crate) sent: u64,
    pub(crate) dropped: u64,
    pub(crate) refused: u64,
    pub(crate) received_hz: f64,
    pub(crate) sent_hz: f64,
    /// Number of times another process took over since the monitor started.
    pub(crate) restarts: u32,
    /// Empty without an error.
    pub(crate) last_error: String,
    /// Age of the last report.
    pub(crate) quiet_s: f64,
}

/// Nodes by name.
#[derive(Debug, Default)]
pub(crate) struct Roster(BTreeMap<String, Entry>);

#[derive(Debug)]
struct Entry {
    report: NodeReport,
    received_ns: i64,
    /// Start of the interval for rates: time, and the counters received and sent.
    base: (i64, u64, u64),
}

impl Roster {
    /// Takes a report; `None` if there are too many nodes.
    pub(crate) fn receive(&mut self, header: &HealthHeader, error: &[u8]) -> Option<&NodeReport> {
        let name = header.node.as_str();
        if self.0.len() == CAPACITY && !self.0.contains_key(name) {
            return None;
        }
        let entry = self.0.entry(name.to_owned());
        let entry = entry.or_insert_with(|| Entry::new(header));
        entry.receive(header, error);
        Some(&entry.report)
    }

    /// Nodes that have become silent since the last call.
    pub(crate) fn newly_silent(&mut self, now_ns: i64) -> Vec<&NodeReport> {
        let mut silent = Vec::new();
        for entry in self.0.values_mut() {
            let quiet_ns = now_ns.saturating_sub(entry.received_ns);
            entry.report.quiet_s = (quiet_ns as f64 / 1e8).round() / 10.0;
            let is_expected = !matches!(entry.report.state, "silent" | "stopped");
            if is_expected && quiet_ns > SILENT_AFTER_NS {
                entry.report.state = "silent";
                entry.report.received_hz = 0.0;
                entry.report.sent_hz = 0.0;
                silent.push(&entry.report);
            }
        }
        silent
    }

    pub(crate) fn reports(&self) -> impl Iterator<Item = &NodeReport> {
        self.0.values().map(|entry| &entry.report)
    }
}

impl Entry {
    fn new(header: &HealthHeader) -> Self {
        Entry {
            report: NodeReport {
                name: header.node.as_str().to_owned(),
                state: "waiting",
                pid: header.pid,
                ..NodeReport::default()
            },
            received_ns: header.sent_ns,
            base: (header.sent_ns, header.received, header.sent),
        }
    }

    fn receive(&mut self, header: &HealthHeader, error: &[u8]) {
        let report = &mut self.report;
        if report.pid != header.pid {
            report.pid = header.pid;
            report.restarts = report.restarts.saturating_add(1);
            self.base = (header.sent_ns, header.received, header.sent);
        }
        let (since_ns, received, sent) = self.base;
        let passed_ns = header.sent_ns.saturating_sub(since_ns);
        if passed_ns >= RATE_NS {
            let rate = |now: u64, before: u64| {
                let count = now.saturating_sub(before) as f64;
                (count / (passed_ns as f64 / 1e9) * 10.0).round() / 10.0
            };
            report.received_hz = rate(header.received, received);
            report.sent_hz = rate(header.sent, sent);
            self.base = (header.sent_ns, header.received, header.sent);
        }
        // A state code that this version does not know shows as degraded.
        let state = NodeState::from_code(header.state).unwrap_or(NodeState::Degraded);
        report.state = state.as_str();
        report.received = header.received;
        report.sent = header.sent;
        report.dropped = header.dropped;
        report.refused = header.refused;
        let error = error.get(..HealthHeader::ERROR_CAPACITY).unwrap_or(error);
        report.last_error = String::from_utf8_lossy(error).into_owned();
        report.quiet_s = 0.0;
        self.received_ns = header.sent_ns;
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use messages::Name;

    use super::*;

    const SECOND: i64 = 1_000_000_000;

    fn report(name: &str, pid: u32, at_ns: i64, received: u64) -> HealthHeader {
        HealthHeader {
            node: Name::new(name),
            pid,
            sent_ns: at_ns,
            received,
            state: NodeState::Ready as u32,
            ..HealthHeader::zeroed()
        }
    }

    #[test]
    fn rates_come_from_the_counters_of_one_process() {
        let mut roster = Roster::default();
        roster.receive(&report("a", 1, 0, 100), b"");
        let entry = roster.receive(&report("a", 1, 2 * SECOND, 130), b"");
        assert_eq!(entry.unwrap().received_hz, 15.0);
        // The next process counts from zero.
        let entry = roster.receive(&report("a", 2, 3 * SECOND, 0), b"").unwrap();
        assert_eq!((entry.restarts, entry.received_hz), (1, 15.0));
        let entry = roster.receive(&report("a", 2, 4 * SECOND, 5), b"").unwrap();
        assert_eq!(entry.received_hz, 5.0);
    }

    #[test]
    fn a_node_that_does_not_report_is_silent_until_it_does() {
        let mut roster = Roster::default();
        roster.receive(&report("a", 1, 0, 0), b"");
        let ended = HealthHeader {
            state: NodeState::Stopped as u32,
            ..report("b", 1, 0, 0)
        };
        roster.receive(&ended, b"");
        assert!(roster.newly_silent(2 * SECOND).is_empty());
        let silent: Vec<String> = roster
            .newly_silent(3 * SECOND)
            .iter()
            .map(|report| report.name.clone())
            .collect();
        assert_eq!(silent, ["a"], "who said that it ends is expected to");
        assert!(roster.newly_silent(4 * SECOND).is_empty(), "reported once");
        let entry = roster.receive(&report("a", 1, 5 * SECOND, 0), b"").unwrap();
        assert_eq!(entry.state, "ready");
    }

    #[test]
    fn nodes_and_errors_are_bounded() {
        let mut roster = Roster::default();
        for i in 0..CAPACITY {
            let report = report(&i.to_string(), 1, 0, 0);
            assert!(roster.receive(&report, b"").is_some());
        }
        assert!(roster.receive(&report("one more", 1, 0, 0), b"").is_none());
        let long = vec![0xff; 10_000];
        let entry = roster.receive(&report("1", 1, 0, 0), &long).unwrap();
        let expected = HealthHeader::ERROR_CAPACITY;
        assert_eq!(entry.last_error.chars().count(), expected);
    }
}
