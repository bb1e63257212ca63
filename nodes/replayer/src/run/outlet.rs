//! Where messages leave the node and troubles are reported.

use messages::{GroundTruth, NodeState, Odometry, ScanHeader, Stamp, topic};
use transport::{Graph, Health, Publisher, TransportError, monotonic_ns, with_causes};

use super::Summary;
use crate::ReplayerError;
use crate::source::{Content, Timed};

pub(super) struct Outlet {
    scans: Publisher<topic::Scan>,
    odometry: Publisher<topic::OdometryTopic>,
    truths: Publisher<topic::GroundTruthTopic>,
    odometry_sent: u64,
    truths_sent: u64,
    pub(super) health: Health,
    pub(super) summary: Summary,
}

impl Outlet {
    pub(super) fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Outlet {
            scans: graph.publisher()?,
            odometry: graph.publisher()?,
            truths: graph.publisher()?,
            odometry_sent: 0,
            truths_sent: 0,
            health: graph.health()?,
            summary: Summary::default(),
        })
    }

    /// Whether anybody gets the scans.
    pub(super) fn is_heard(&self) -> bool {
        self.scans.has_subscribers()
    }

    /// Sends a message now; returns the stamp that its answer will carry.
    pub(super) fn send(&mut self, timed: Timed) -> Result<Option<Stamp>, TransportError> {
        self.health.count_sent(1);
        match timed.content {
            Content::Scan(header, ranges) => self.send_scan(*header, &ranges).map(Some),
            Content::Odometry(odometry) => self.send_odometry(*odometry).map(|()| None),
            Content::GroundTruth(truth) => self.send_truth(*truth).map(|()| None),
        }
    }

    fn send_scan(
        &mut self,
        mut header: ScanHeader,
        ranges: &[f32],
    ) -> Result<Stamp, TransportError> {
        let mut loan = self.scans.loan(ranges.len())?;
        loan.items_mut().copy_from_slice(ranges);
        header.stamp.counter = self.summary.scans;
        header.stamp.entered_ns = monotonic_ns();
        *loan.header_mut() = header;
        loan.send()?;
        self.summary.scans += 1;
        Ok(header.stamp)
    }

    fn send_odometry(&mut self, mut odometry: Odometry) -> Result<(), TransportError> {
        let mut loan = self.odometry.loan(0)?;
        odometry.stamp.counter = self.odometry_sent;
        odometry.stamp.entered_ns = monotonic_ns();
        *loan.header_mut() = odometry;
        self.odometry_sent += 1;
        loan.send()
    }

    fn send_truth(&mut self, mut truth: GroundTruth) -> Result<(), TransportError> {
        let mut loan = self.truths.loan(0)?;
        truth.stamp.counter = self.truths_sent;
        truth.stamp.entered_ns = monotonic_ns();
        *loan.header_mut() = truth;
        self.truths_sent += 1;
        loan.send()
    }

    /// An answer came, to whichever scan.
    pub(super) fn count_answer(&mut self) -> Result<(), TransportError> {
        self.summary.answers += 1;
        self.health.count_received(1);
        self.health.state(NodeState::Ready)
    }

    /// A message of the recording cannot be used.
    pub(super) fn refuse(&mut self, error: &ReplayerError) -> Result<(), TransportError> {
        self.summary.refused += 1;
        self.health.count_refused(1);
        self.complain(&with_causes(error))
    }

    /// A scan got no answer in time.
    pub(super) fn give_up(&mut self, stamp: Stamp, patience_s: f64) -> Result<(), TransportError> {
        self.summary.unanswered += 1;
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
