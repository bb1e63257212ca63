//! A message from the robot, and how many its sender lost before it.

use std::collections::BTreeMap;

use crate::GatewayError;

/// Senders of a topic whose sequence is followed; who has more is not informed what it
/// lost.
const MAX_SENDERS: usize = 64;

/// One message, or why there is none, and how many were lost before it.
pub(crate) struct Received<M> {
    pub(crate) message: Result<M, GatewayError>,
    pub(crate) lost: u64,
}

/// The last sequence number of each sender of a topic.
#[derive(Debug, Default)]
pub(super) struct Senders {
    last: BTreeMap<[u8; 16], i64>,
}

impl Senders {
    /// Messages that are missing between the last one of this sender and this one.
    pub(super) fn lost_before(&mut self, sender: [u8; 16], sequence: i64) -> u64 {
        if self.last.len() >= MAX_SENDERS && !self.last.contains_key(&sender) {
            self.last.clear();
        }
        let last = self.last.insert(sender, sequence);
        let between = last.and_then(|last| sequence.checked_sub(last));
        // What came again, or late, is no loss.
        let between = between.and_then(|between| u64::try_from(between).ok());
        between.unwrap_or(0).saturating_sub(1)
    }
}
