//! A topic from the robot.

use transport::Graph;

use super::node::Shown;
use super::reader::Reader;
use super::{Member, quality};
use crate::GatewayError;
use crate::rmw::Keeping;
use crate::rmw::description::TypeInfo;
use crate::rmw::received::Identity;

pub(crate) struct Subscription {
    reader: Reader,
    depth: usize,
    _shown: Shown,
}

impl Subscription {
    /// Takes messages of at most `max_bytes`.
    pub(crate) fn open(
        graph: &Graph,
        member: &Member,
        (topic, info): (&str, &TypeInfo),
        (keeping, depth): (Keeping, usize),
        max_bytes: usize,
    ) -> Result<Self, GatewayError> {
        let quality = quality::requested((keeping, depth));
        let names = (&*format!("rt{topic}"), &*info.name, topic);
        let reader = member.reader(graph, names, &quality, max_bytes)?;
        Ok(Subscription {
            _shown: member.node().show_reader(reader.guid()),
            reader,
            depth,
        })
    }

    /// Returns the largest number of queued messages.
    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    /// Passes the next message to `decode`.
    pub(crate) fn next<M>(
        &self,
        decode: impl FnOnce(&[u8], Option<Identity>) -> Result<M, GatewayError>,
    ) -> Option<Result<M, GatewayError>> {
        let sample = self.reader.next()?;
        Some(sample.and_then(|sample| {
            let sender = sample.identity.writer_guid.to_bytes();
            let sequence = sample.identity.sequence_number.into();
            decode(&sample.bytes, Some((sender, sequence)))
        }))
    }
}
