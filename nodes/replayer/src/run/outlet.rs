//! Publishes messages and reports errors.

use std::collections::BTreeMap;

use messages::{Name, NodeState, ScanHeader, Stamp, topic};
use ros_graph::replay::{Content, PlaybackError, Poses, Timed};
use transport::{Graph, Health, Publisher, TransportError, monotonic_ns, with_causes};

/// Most beams that lasers have, so that the publisher need not grow for a scan: it gets this room at
/// the start, of which only what is used takes memory.
const USUAL_BEAMS: usize = 4096;

#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    pub(super) scans: u64,
    pub(super) answers: u64,
    /// Number of scans without an answer.
    pub(super) unanswered: u64,
    /// Number of messages that could not be used.
    pub(super) refused: u64,
}

pub(super) struct Outlet {
    scans: Publisher<topic::Scan>,
    poses: Poses,
    pub(super) health: Health,
    pub(super) tally: Tally,
    pub(super) first_laser: Name,
    /// Number of scans sent, by the name of each further laser.
    others: BTreeMap<String, u64>,
}

impl Outlet {
    pub(super) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Outlet {
            scans: graph.publisher_for(USUAL_BEAMS)?,
            poses: Poses::open(graph)?,
            health: graph.health()?,
            tally: Tally::default(),
            first_laser: Name::new(""),
            others: BTreeMap::new(),
        })
    }

    pub(super) fn has_subscribers(&self) -> bool {
        self.scans.has_subscribers()
    }

    /// Sends a message now; returns the stamp of the answer to expect, if any.
    pub(super) fn send(&mut self, timed: Timed) -> Result<Option<Stamp>, TransportError> {
        self.health.count_sent(1);
        match timed.content {
            Content::Scan(header, ranges) => self.send_scan(*header, &ranges),
            Content::Odometry(odometry) => self.poses.send_odometry(*odometry).map(|()| None),
            Content::GroundTruth(truth) => self.poses.send_truth(*truth).map(|()| None),
        }
    }

    fn send_scan(
        &mut self,
        mut header: ScanHeader,
        ranges: &[f32],
    ) -> Result<Option<Stamp>, TransportError> {
        let mut loan = self.scans.loan(ranges.len())?;
        loan.items_mut().copy_from_slice(ranges);
        // Each laser counts its own scans, and those of the first one are answered.
        let is_first = header.laser == self.first_laser;
        let count = match is_first {
            true => &mut self.tally.scans,
            false => self.others.entry(header.laser.to_string()).or_default(),
        };
        header.stamp.counter = *count;
        *count += 1;
        header.stamp.entered_ns = monotonic_ns();
        *loan.header_mut() = header;
        loan.send()?;
        Ok(is_first.then_some(header.stamp))
    }

    pub(super) fn count_answer(&mut self) -> Result<(), TransportError> {
        self.tally.answers += 1;
        self.health.count_received(1);
        self.health.state(NodeState::Ready)
    }

    pub(super) fn refuse(&mut self, error: &PlaybackError) -> Result<(), TransportError> {
        self.tally.refused += 1;
        self.health.count_refused(1);
        self.complain(&with_causes(error))
    }

    pub(super) fn give_up(&mut self, stamp: Stamp, patience_s: f64) -> Result<(), TransportError> {
        self.tally.unanswered += 1;
        self.health.count_dropped(1);
        let (counter, measured_ns) = (stamp.counter, stamp.measured_ns);
        self.complain(&format!(
            "scan {counter}, measured at {measured_ns} ns, got no answer on `hypotheses` within \
             {patience_s} s (--patience)"
        ))
    }

    fn complain(&mut self, problem: &str) -> Result<(), TransportError> {
        tracing::warn!("{problem}");
        self.health.error(problem)?;
        self.health.state(NodeState::Degraded)
    }
}
