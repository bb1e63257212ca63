//! Nodes that only watch but must not miss anything: the next scan waits for them.

use std::rc::Rc;

use messages::{Stamp, topic};
use transport::{Graph, Subscriber, TransportError};

/// Number of answers that each of these nodes has received, according to its reports on `health`.
pub(super) struct InStep {
    reports: Option<Rc<Subscriber<topic::Health>>>,
    nodes: Vec<(String, u64)>,
    answered: Option<Stamp>,
}

impl InStep {
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

    /// Returns the subscription to the reports, so that the event loop can wait for it.
    pub(super) fn reports(&self) -> Option<Rc<Subscriber<topic::Health>>> {
        self.reports.clone()
    }

    pub(super) fn answer(&mut self, stamp: Stamp) {
        self.answered = Some(stamp);
    }

    /// Returns the last answered scan once all nodes have received the answer.
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
