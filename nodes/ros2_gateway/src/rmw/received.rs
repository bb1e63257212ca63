//! Messages from the robot, and the numbers of those that were lost.

use std::collections::BTreeMap;

use zenoh::bytes::ZBytes;

/// Number of senders of a topic whose sequence numbers are followed; with more of them, losses are
/// not counted reliably.
const MAX_SENDERS: usize = 64;

/// A message as it came.
pub(crate) struct Sample {
    /// Message in CDR with its header.
    pub(super) bytes: ZBytes,
    /// The sender, if it is known.
    pub(super) identity: Option<Identity>,
}

/// Sender of a message, and its number among those of the sender.
pub(super) type Identity = ([u8; 16], i64);

#[derive(Debug, Default)]
pub(super) struct Senders {
    last: BTreeMap<[u8; 16], i64>,
}

impl Senders {
    /// Returns the number of messages missing between the last one of this sender and this one.
    pub(super) fn lost_before(&mut self, (sender, sequence): Identity) -> u64 {
        if self.last.len() >= MAX_SENDERS && !self.last.contains_key(&sender) {
            self.last.clear();
        }
        let last = self.last.insert(sender, sequence);
        let between = last.and_then(|last| sequence.checked_sub(last));
        // A repeated or late message is no loss.
        let between = between.and_then(|between| u64::try_from(between).ok());
        between.unwrap_or(0).saturating_sub(1)
    }
}
