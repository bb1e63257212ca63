//! Listens to the graph: takes what has come and enters it in the journal.

use messages::{HealthHeader, topic};
use transport::{Graph, Input, Subscriber, TransportError};

use super::{journal::Journal, output::Reader};

/// The topics that the launcher subscribes to.
pub(crate) struct Watch {
    first_laser: Option<String>,
    scans: Subscriber<topic::Scan>,
    truths: Subscriber<topic::GroundTruthTopic>,
    hypotheses: Subscriber<topic::Hypotheses>,
    poses: Subscriber<topic::Tracked>,
    health: Subscriber<topic::Health>,
    /// Where what the nodes log is wanted.
    logs: Option<Subscriber<topic::Log>>,
}

/// What came of one look at the topics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Received {
    /// Any answer.
    pub answers: bool,
    /// Scans of which the answer came, as their player counts them; 0 where none came now.
    pub taken: u64,
    /// Whether somebody reads them.
    pub reader: Reader,
}

impl Watch {
    /// Subscribes; to be called before any node sends.
    ///
    /// # Errors
    /// The graph refuses.
    ///
    /// `first_laser` is the one whose scans are answered, where there are several; what the
    /// nodes log is received where `logs` says so.
    pub(crate) fn new(
        graph: &Graph,
        first_laser: Option<String>,
        logs: bool,
    ) -> Result<Self, TransportError> {
        Ok(Watch {
            first_laser,
            scans: graph.subscriber()?,
            truths: graph.subscriber()?,
            hypotheses: graph.subscriber()?,
            poses: graph.subscriber()?,
            health: graph.subscriber()?,
            logs: logs.then(|| graph.subscriber()).transpose()?,
        })
    }

    /// What should wake the launcher. Scans need not: their answers will.
    pub(crate) fn inputs(&self) -> [&dyn Input; 4] {
        [&self.truths, &self.hypotheses, &self.poses, &self.health]
    }

    /// Takes all that has come, and calls for each report of a node on itself.
    ///
    /// # Errors
    /// A topic cannot be read.
    pub(crate) fn take(
        &self,
        journal: &mut Journal,
        mut on_health: impl FnMut(&HealthHeader),
    ) -> Result<Received, TransportError> {
        let mut newest = None;
        while let Some(scan) = self.scans.receive()? {
            let laser = scan.header().laser;
            if self
                .first_laser
                .as_ref()
                .is_none_or(|first| laser.as_str() == first)
            {
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
            reader: Reader::Reads,
        };
        while let Some(found) = self.hypotheses.receive()? {
            received.answers = true;
            received.taken = found.header().stamp.counter.saturating_add(1);
            received.reader = journal.answer(found.header(), found.items());
        }
        // A pose follows the answer that it was made of.
        while let Some(pose) = self.poses.receive()? {
            received.answers = true;
            let reader = journal.pose(pose.header(), pose.items());
            if reader == Reader::Gone {
                received.reader = reader;
            }
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
