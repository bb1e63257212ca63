//! Log of the graph's nodes, on the topic on which ROS collects logs.

use messages::{LogLevel, topic};
use ros::{Log, Time};
use transport::{Graph, Subscriber, TransportError};
use zenoh_session::Report;

use crate::GatewayError;
use crate::config::NODE;
use crate::rmw::{Keeping, Member, Publisher};

/// Number of lines kept for late subscribers; the same as in ROS.
const LINES: usize = 1000;

/// Publishes the log of the nodes: the gateway's own lines under the name of the node in ROS, those
/// of the others under loggers below it, such as `amcl.tracker`.
pub(super) struct Rosout {
    lines: Subscriber<topic::Log>,
    publisher: Publisher<Log>,
    logger: String,
}

impl Rosout {
    pub(super) fn open(
        graph: &Graph,
        member: &Member,
        topic: &str,
        node: &str,
    ) -> Result<Self, GatewayError> {
        Ok(Rosout {
            lines: graph.subscriber()?,
            publisher: Publisher::open(member, topic, Keeping::Kept, LINES)?,
            logger: node.trim_matches('/').replace('/', "."),
        })
    }

    pub(super) fn send(&mut self, report: &mut Report) -> Result<(), TransportError> {
        while let Some(line) = self.lines.receive()? {
            let header = line.header();
            // Lines below level info are left out, like those of ROS nodes by default.
            if header.level < LogLevel::Info as u32 {
                continue;
            }
            let stamp = Time::from_ns(header.wall_ns).unwrap_or_default();
            let text = String::from_utf8_lossy(line.items());
            let mut log = Log::of(stamp, header, &text);
            log.name = match &*log.name {
                NODE => self.logger.clone(),
                other => format!("{}.{other}", self.logger),
            };
            report.outcome(self.publisher.send(&log))?;
        }
        Ok(())
    }
}
