//! The log of the graph's nodes on the topic on which ROS collects logs.

use messages::{LogLevel, topic};
use ros::{Log, Time};
use transport::{Graph, Subscriber, TransportError};
use zenoh_session::Report;

use crate::GatewayError;
use crate::config::NODE;
use crate::rmw::{Member, Publisher};

/// Lines that are kept for those who come late, as ROS has it.
const LINES: usize = 1000;

/// Publishes what the nodes log: the gateway's own lines by the name of the node in ROS, those
/// of the others by loggers below it, as `amcl.tracker`.
pub(super) struct Rosout {
    lines: Subscriber<topic::Log>,
    publisher: Publisher<Log>,
    logger: String,
}

impl Rosout {
    /// Of the node with this whole name.
    pub(super) fn open(
        graph: &Graph,
        member: &Member,
        topic: &str,
        node: &str,
    ) -> Result<Self, GatewayError> {
        Ok(Rosout {
            lines: graph.subscriber()?,
            publisher: Publisher::open_kept(member, topic, LINES)?,
            logger: node.trim_matches('/').replace('/', "."),
        })
    }

    /// Publishes the lines that have come.
    pub(super) fn send(&mut self, report: &mut Report) -> Result<(), TransportError> {
        while let Some(line) = self.lines.receive()? {
            let header = line.header();
            // As a node of ROS, unless somebody asks for more.
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
            match self.publisher.send(&log) {
                Ok(()) => report.sent(),
                Err(error) => report.refused(&error)?,
            }
        }
        Ok(())
    }
}
