//! Receives messages of the graph and enters them in the journal.

use messages::{HealthHeader, MapSet, topic};
use transport::{Graph, Input, Subscriber, TransportError};

use super::journal::Journal;

pub(crate) struct Watch {
    first_laser: Option<String>,
    maps: Subscriber<topic::Maps>,
    scans: Subscriber<topic::Scan>,
    truths: Subscriber<topic::GroundTruthTopic>,
    hypotheses: Subscriber<topic::Hypotheses>,
    poses: Subscriber<topic::Tracked>,
    health: Subscriber<topic::Health>,
    /// Subscriber to the nodes' log, if it is written to files.
    logs: Option<Subscriber<topic::Log>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Received {
    /// True if any answer or pose came.
    pub answers: bool,
    /// Number of scans answered so far, by the counter of their player; 0 if no answer came now.
    pub taken: u64,
}

impl Watch {
    /// Subscribes, before any node publishes; answers are for the scans of `first_laser`.
    pub(crate) fn new(
        graph: &Graph,
        first_laser: Option<String>,
        logs: bool,
    ) -> Result<Self, TransportError> {
        Ok(Watch {
            first_laser,
            maps: graph.subscriber()?,
            scans: graph.subscriber()?,
            truths: graph.subscriber()?,
            hypotheses: graph.subscriber()?,
            poses: graph.subscriber()?,
            health: graph.subscriber()?,
            logs: logs.then(|| graph.subscriber()).transpose()?,
        })
    }

    /// Inputs that wake the launcher. Scans need not, as their answers do.
    pub(crate) fn inputs(&self) -> [&dyn Input; 4] {
        [&self.truths, &self.hypotheses, &self.poses, &self.health]
    }

    /// Receives all pending messages; calls `on_health` for each health message.
    pub(crate) fn take(
        &self,
        journal: &mut Journal,
        mut on_health: impl FnMut(&HealthHeader),
    ) -> Result<Received, TransportError> {
        while let Some(maps) = self.maps.receive()? {
            // The nodes that search them report a set that is invalid.
            if let Ok(set) = MapSet::split(maps.header(), maps.items()) {
                journal.report.maps(&set);
            }
        }
        let mut newest = None;
        while let Some(scan) = self.scans.receive()? {
            let laser = scan.header().laser;
            let first = self.first_laser.as_ref();
            if first.is_none_or(|first| laser.as_str() == first) {
                newest = Some(scan);
            }
        }
        if let Some(scan) = newest {
            journal.report.scan(scan.header().stamp);
        }
        while let Some(truth) = self.truths.receive()? {
            journal.report.truth(truth.header());
        }
        let mut received = Received {
            answers: false,
            taken: 0,
        };
        while let Some(found) = self.hypotheses.receive()? {
            received.answers = true;
            received.taken = found.header().stamp.counter.saturating_add(1);
            journal.answer(found.header(), found.items());
        }
        // Poses come after the answers that they are based on.
        while let Some(pose) = self.poses.receive()? {
            received.answers = true;
            journal.pose(pose.header(), pose.items());
        }
        while let Some(health) = self.health.receive()? {
            journal.report.health(health.header());
            on_health(health.header());
        }
        if let Some(logs) = &self.logs {
            while let Some(line) = logs.receive()? {
                journal.log(line.header(), line.items());
            }
        }
        Ok(received)
    }
}
