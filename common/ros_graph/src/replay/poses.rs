//! Publishes the messages of a recording other than scans.

use messages::{GroundTruth, Odometry, topic};
use transport::{Graph, Publisher, TransportError, monotonic_ns};

pub struct Poses {
    odometry: Publisher<topic::OdometryTopic>,
    truths: Publisher<topic::GroundTruthTopic>,
    odometry_sent: u64,
    truths_sent: u64,
}

impl Poses {
    pub fn open(graph: &Graph) -> Result<Self, TransportError> {
        Ok(Poses {
            odometry: graph.publisher()?,
            truths: graph.publisher()?,
            odometry_sent: 0,
            truths_sent: 0,
        })
    }

    /// Publishes odometry now, with the next counter.
    pub fn send_odometry(&mut self, mut odometry: Odometry) -> Result<(), TransportError> {
        odometry.stamp.counter = self.odometry_sent;
        odometry.stamp.entered_ns = monotonic_ns();
        self.odometry_sent += 1;
        self.odometry.send(odometry, &[])
    }

    /// Publishes a true pose now, with the next counter.
    pub fn send_truth(&mut self, mut truth: GroundTruth) -> Result<(), TransportError> {
        truth.stamp.counter = self.truths_sent;
        truth.stamp.entered_ns = monotonic_ns();
        self.truths_sent += 1;
        self.truths.send(truth, &[])
    }
}
