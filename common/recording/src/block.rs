//! A stretch of a file that holds messages, and what is in it.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::registry::{Registry, damaged};
use crate::{Damage, Kind, layout};

/// A part of the file that holds messages.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Its records: a chunk, or messages that stand outside of chunks.
    pub(crate) bytes: Range<usize>,
    pub(crate) is_chunk: bool,
    /// Log times of its messages, nanoseconds.
    pub(crate) first_ns: i64,
    pub(crate) last_ns: i64,
    /// The kinds among them, as bits.
    pub(crate) kinds: u8,
    /// Messages by channel.
    pub(crate) counts: BTreeMap<u16, u64>,
}

impl Block {
    pub(crate) fn new(start: usize, is_chunk: bool) -> Self {
        Block {
            bytes: start..start,
            is_chunk,
            first_ns: i64::MAX,
            last_ns: i64::MIN,
            kinds: 0,
            counts: BTreeMap::new(),
        }
    }

    pub(crate) fn messages(&self) -> u64 {
        self.counts.values().sum()
    }

    /// Adds a message record that starts at byte `at`, or whose chunk does.
    pub(crate) fn add(&mut self, body: &[u8], at: u64, registry: &Registry) -> Result<(), Damage> {
        let message = layout::message(body).map_err(|bad| damaged(at, "message", bad))?;
        let log_time = i64::try_from(message.log_time).map_err(|_| Damage::Record {
            at,
            kind: "message",
            reason: format!(
                "its log time is {} ns, beyond {}",
                message.log_time,
                i64::MAX
            ),
        })?;
        let channel = registry.channel(message.channel).ok_or(Damage::Undefined {
            at,
            kind: "message",
            missing: "channel",
            id: message.channel,
        })?;
        self.first_ns = self.first_ns.min(log_time);
        self.last_ns = self.last_ns.max(log_time);
        self.kinds |= channel.kind.map_or(0, Kind::bit);
        *self.counts.entry(message.channel).or_default() += 1;
        Ok(())
    }
}
