//! A section of a file that holds messages, and its statistics.

use std::collections::BTreeMap;
use std::ops::Range;

use mcap::records::MessageHeader;
use mcap::sans_io::LinearReader;

use crate::Damage;
use crate::chunk::Chunk;
use crate::feed::{each_record, part_options};
use crate::parse::reason;
use crate::registry::{Registry, undefined};

/// A part of the file that holds messages: a chunk, or a run of messages outside of chunks.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// File offset of its first record.
    pub(crate) at: usize,
    pub(crate) is_chunk: bool,
    /// Body of a chunk, or the records outside of chunks.
    pub(crate) bytes: Range<usize>,
    /// Earliest and latest log time of its messages, in nanoseconds.
    pub(crate) first_ns: i64,
    pub(crate) last_ns: i64,
    /// Number of messages with an earlier time than the one before them, and the log time of the
    /// last message that was added.
    pub(crate) unsorted: u64,
    newest_ns: i64,
    pub(crate) counts: BTreeMap<u16, u64>,
}

impl Block {
    pub(crate) fn chunk(at: usize, body: Range<usize>) -> Self {
        Block::new(at, true, body)
    }

    /// Starts the block of messages outside of chunks; the first is at byte `at`.
    pub(crate) fn loose(at: usize) -> Self {
        Block::new(at, false, at..at)
    }

    fn new(at: usize, is_chunk: bool, bytes: Range<usize>) -> Self {
        Block {
            at,
            is_chunk,
            bytes,
            first_ns: i64::MAX,
            last_ns: i64::MIN,
            unsorted: 0,
            newest_ns: i64::MIN,
            counts: BTreeMap::new(),
        }
    }

    pub(crate) fn messages(&self) -> u64 {
        self.counts.values().sum()
    }

    /// Adds a message record that starts at byte `at`, or whose chunk starts there.
    pub(crate) fn add(
        &mut self,
        header: &MessageHeader,
        at: u64,
        registry: &Registry,
    ) -> Result<(), Damage> {
        let log_time = i64::try_from(header.log_time).map_err(|_| Damage::Record {
            at,
            kind: "message",
            reason: format!(
                "its log time is {} ns, beyond {}",
                header.log_time,
                i64::MAX
            ),
        })?;
        let id = header.channel_id;
        if registry.channel(id).is_none() {
            return Err(undefined(at, "message", "channel", id));
        }
        self.unsorted += u64::from(log_time < self.newest_ns);
        self.newest_ns = log_time;
        self.first_ns = self.first_ns.min(log_time);
        self.last_ns = self.last_ns.max(log_time);
        *self.counts.entry(id).or_default() += 1;
        Ok(())
    }

    pub(crate) fn each_record(
        &self,
        file: &[u8],
        take: impl FnMut(u8, &[u8]) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        let bytes = file.get(self.bytes.clone()).unwrap_or_default();
        let at = self.at as u64;
        if self.is_chunk {
            return Chunk::of(bytes, at)?.each_record(take);
        }
        let reader = LinearReader::new_with_options(part_options().with_emit_chunks(true));
        each_record(reader, bytes, take, |error| Damage::Record {
            at,
            kind: "message",
            reason: reason(&error),
        })
    }
}
