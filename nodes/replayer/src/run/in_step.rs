//! Nodes that only look on, and miss nothing all the same: the next scan waits for them.

use std::rc::Rc;

use messages::{Stamp, topic};
use transport::{Graph, Subscriber, TransportError};

/// How many scans each of these nodes has taken, by its reports in topic `health`.
pub(super) struct InStep {
    reports: Option<Rc<Subscriber<topic::Health>>>,
    nodes: Vec<(String, u64)>,
    /// The last scan that is answered.
    answered: Option<Stamp>,
}

impl InStep {
    /// Nodes by their names.
    pub(super) fn new(graph: &Graph, names: &[String]) -> Result<Self, TransportError> {
        Ok(InStep {
            reports: match names {
                [] => None,
                _ => Some(Rc::new(graph.subscriber()?)),
            },
            nodes: names.iter().map(|name| (name.clone(), 0)).collect(),
            answered: None,
        })
    }

    /// The reports of the nodes, to wake whoever waits for them.
    pub(super) fn reports(&self) -> Option<Rc<Subscriber<topic::Health>>> {
        self.reports.clone()
    }

    /// Takes the answer to a scan.
    pub(super) fn answer(&mut self, stamp: Stamp) {
        self.answered = Some(stamp);
    }

    /// The last scan that is answered, once all nodes have taken the answer.
    pub(super) fn done(&mut self) -> Result<Option<Stamp>, TransportError> {
        if let Some(reports) = &self.reports {
            while let Some(report) = reports.receive()? {
                let report = report.header();
                let mut nodes = self.nodes.iter_mut();
                if let Some((_, taken)) = nodes.find(|(name, _)| report.node.as_str() == name) {
                    *taken = report.received;
                }
            }
        }
        Ok(self.answered.take_if(|answered| {
            let mut nodes = self.nodes.iter();
            nodes.all(|(_, taken)| *taken > answered.counter)
        }))
    }
}
