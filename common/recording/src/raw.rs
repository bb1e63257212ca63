//! The messages of a recording as they stand in the file, in the order of their
//! log times.
//!
//! A block (a chunk, or a run of messages outside of chunks) is unpacked when
//! its first message is next; of its messages, those that are wanted are kept.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use mcap::records::{Record, op};

use crate::block::Block;
use crate::parse::parse;
use crate::{Channel, Damage, Kind, Recording, RecordingError};

/// A message that is not decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawRecord<'a> {
    /// Its channel.
    pub channel: &'a Channel,
    /// When it was recorded, nanoseconds since 1970.
    pub log_time_ns: i64,
    /// When it was published, nanoseconds since 1970.
    pub publish_time_ns: u64,
    /// What it says, encoded as the channel says.
    pub body: Vec<u8>,
}

/// Iterates over a recording's messages by log time; where times are equal, in
/// the order of the file. Damage of the file is the last item.
pub struct RawRecords<'a> {
    recording: &'a Recording,
    /// Bits of the kinds that are wanted; all messages where there are none.
    kinds: Option<u8>,
    /// Blocks that are not unpacked yet, by first log time.
    blocks: std::slice::Iter<'a, Block>,
    next: BinaryHeap<Reverse<Pending>>,
    damage: Option<Damage>,
}

/// A message that waits for its turn.
struct Pending {
    /// Log time, then place: of the block, and within it.
    order: (i64, usize, usize),
    publish_time_ns: u64,
    channel: u16,
    body: Vec<u8>,
}

impl<'a> RawRecords<'a> {
    /// The messages of some kinds or of all channels, and at the end what is
    /// damaged.
    pub(crate) fn new(
        recording: &'a Recording,
        kinds: Option<&[Kind]>,
        damage: Option<Damage>,
    ) -> Self {
        let bits = |kinds: &[Kind]| kinds.iter().fold(0, |bits, kind| bits | kind.bit());
        RawRecords {
            recording,
            kinds: kinds.map(bits),
            blocks: recording.survey.blocks.iter(),
            next: BinaryHeap::new(),
            damage,
        }
    }

    pub(crate) fn recording(&self) -> &'a Recording {
        self.recording
    }

    /// Unpacks all blocks that may hold the next message.
    fn fill(&mut self) -> Result<(), Damage> {
        while let Some(block) = self.blocks.as_slice().first() {
            if let Some(Reverse(next)) = self.next.peek()
                && next.order.0 < block.first_ns
            {
                break;
            }
            self.blocks.next();
            if self.kinds.is_none_or(|kinds| block.kinds & kinds != 0) {
                self.unpack(block)?;
            }
        }
        Ok(())
    }

    fn unpack(&mut self, block: &Block) -> Result<(), Damage> {
        let registry = &self.recording.survey.registry;
        let kinds = self.kinds;
        let wanted = |channel: &Channel| {
            let bit = channel.kind.map_or(0, Kind::bit);
            kinds.is_none_or(|kinds| bit & kinds != 0)
        };
        let mut place = 0;
        block.each_record(self.recording.bytes(), |opcode, body| {
            place += 1;
            if opcode != op::MESSAGE {
                return Ok(());
            }
            let Record::Message { header, data } = parse(opcode, body, block.at as u64)? else {
                return Ok(());
            };
            let channel = header.channel_id;
            if registry.channel(channel).is_some_and(wanted) {
                // The survey has seen that the time fits.
                let log_time = i64::try_from(header.log_time).unwrap_or(i64::MAX);
                self.next.push(Reverse(Pending {
                    order: (log_time, block.at, place),
                    publish_time_ns: header.publish_time,
                    channel,
                    body: data.into_owned(),
                }));
            }
            Ok(())
        })
    }

    /// Ends the iteration.
    fn end(&mut self, damage: Damage) -> RecordingError {
        self.blocks = [].iter();
        self.next.clear();
        self.damage = None;
        RecordingError::Damaged {
            path: self.recording.path().to_owned(),
            readable: self.recording.survey.messages,
            damage,
        }
    }
}

impl<'a> Iterator for RawRecords<'a> {
    type Item = Result<RawRecord<'a>, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Err(damage) = self.fill() {
            return Some(Err(self.end(damage)));
        }
        match self.next.pop() {
            Some(Reverse(pending)) => Some(Ok(RawRecord {
                channel: self.recording.survey.registry.channel(pending.channel)?,
                log_time_ns: pending.order.0,
                publish_time_ns: pending.publish_time_ns,
                body: pending.body,
            })),
            None => {
                let damage = self.damage.take()?;
                Some(Err(self.end(damage)))
            }
        }
    }
}

impl PartialEq for Pending {
    fn eq(&self, other: &Self) -> bool {
        self.order == other.order
    }
}

impl Eq for Pending {}

impl PartialOrd for Pending {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pending {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.order.cmp(&other.order)
    }
}
