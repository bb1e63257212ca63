//! The messages of a recording in the order of their log times.
//!
//! A block (a chunk, or a run of messages outside of chunks) is unpacked when
//! its first message is next, and kept until its last one has been given out.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;
use std::rc::Rc;

use mcap::records::op;

use crate::block::Block;
use crate::frames::Frames;
use crate::registry::damaged;
use crate::{Damage, Kind, Message, Record, Recording, RecordingError, chunk, layout};

/// Iterates over a recording's messages by log time; where times are equal, in
/// the order of the file.
///
/// A message that does not decode is an error in its place, and the next one
/// follows. Damage of the file is the last item.
pub struct Records<'a> {
    recording: &'a Recording,
    /// Bits of the kinds that are wanted.
    kinds: u8,
    /// Blocks that are not unpacked yet, by first log time.
    blocks: std::slice::Iter<'a, Block>,
    next: BinaryHeap<Reverse<Pending<'a>>>,
    damage: Option<Damage>,
}

/// A message that waits for its turn.
struct Pending<'a> {
    /// Log time, then place: of the block, and within it.
    order: (i64, usize, usize),
    channel: u16,
    content: Rc<Cow<'a, [u8]>>,
    body: Range<usize>,
}

impl<'a> Records<'a> {
    /// The messages of some kinds, and at the end what is damaged.
    pub(crate) fn new(recording: &'a Recording, kinds: &[Kind], damage: Option<Damage>) -> Self {
        Records {
            recording,
            kinds: kinds.iter().fold(0, |bits, kind| bits | kind.bit()),
            blocks: recording.survey.blocks.iter(),
            next: BinaryHeap::new(),
            damage,
        }
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
            if block.kinds & self.kinds != 0 {
                self.unpack(block)?;
            }
        }
        Ok(())
    }

    fn unpack(&mut self, block: &Block) -> Result<(), Damage> {
        let at = block.bytes.start;
        let content = Rc::new(self.content(block)?);
        let mut frames = Frames::new(&content, 0);
        while let Some(frame) = frames.next()? {
            if frame.opcode != op::MESSAGE {
                continue;
            }
            let bad = |bad| damaged(at as u64, "message", bad);
            let message = layout::message(frame.body).map_err(bad)?;
            if self.kind(message.channel).is_none() {
                continue;
            }
            // The survey has seen that the time fits.
            let log_time = i64::try_from(message.log_time).unwrap_or(i64::MAX);
            let end = frames.position();
            self.next.push(Reverse(Pending {
                order: (log_time, at, frame.at),
                channel: message.channel,
                content: Rc::clone(&content),
                body: end - message.body.len()..end,
            }));
        }
        Ok(())
    }

    fn content(&self, block: &Block) -> Result<Cow<'a, [u8]>, Damage> {
        let bytes = self.recording.bytes();
        let records = bytes.get(block.bytes.clone()).unwrap_or_default();
        if !block.is_chunk {
            return Ok(Cow::Borrowed(records));
        }
        let at = block.bytes.start as u64;
        let frame = Frames::new(records, 0).expect()?;
        let record = layout::chunk(frame.body).map_err(|bad| damaged(at, "chunk", bad))?;
        chunk::unpack(&record, at)
    }

    /// The kind of a channel's messages, if it is wanted.
    fn kind(&self, channel: u16) -> Option<Kind> {
        let kind = self.recording.survey.registry.channel(channel)?.kind?;
        (kind.bit() & self.kinds != 0).then_some(kind)
    }

    fn decode(&self, pending: &Pending<'_>) -> Option<Result<Record, RecordingError>> {
        let channel = self.recording.survey.registry.channel(pending.channel)?;
        let kind = channel.kind?;
        let path = self.recording.path();
        if channel.encoding != "cdr" {
            return Some(Err(RecordingError::NotCdr {
                path: path.to_owned(),
                topic: channel.topic.to_string(),
                schema: channel.schema.clone(),
                encoding: channel.encoding.clone(),
            }));
        }
        let log_time_ns = pending.order.0;
        let bytes = pending.content.get(pending.body.clone())?;
        Some(match Message::decode(kind, bytes) {
            Ok(message) => Ok(Record {
                topic: channel.topic.clone(),
                log_time_ns,
                message,
            }),
            Err(reason) => Err(RecordingError::Message {
                path: path.to_owned(),
                topic: channel.topic.to_string(),
                log_time_ns,
                kind,
                reason,
            }),
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

impl Iterator for Records<'_> {
    type Item = Result<Record, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Err(damage) = self.fill() {
            return Some(Err(self.end(damage)));
        }
        match self.next.pop() {
            Some(Reverse(pending)) => self.decode(&pending),
            None => {
                let damage = self.damage.take()?;
                Some(Err(self.end(damage)))
            }
        }
    }
}

impl PartialEq for Pending<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.order == other.order
    }
}

impl Eq for Pending<'_> {}

impl PartialOrd for Pending<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pending<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.order.cmp(&other.order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use crate::write::{Packing, RecordingWriter};

    const PACKINGS: [Packing; 4] = [Packing::Loose, Packing::Plain, Packing::Zstd, Packing::Lz4];

    fn open(bytes: Vec<u8>) -> Recording {
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    #[test]
    fn messages_come_by_time_out_of_every_packing() {
        for packing in PACKINGS {
            let recording = open(sample::bytes(packing));
            let records: Vec<Record> = recording.records().map(Result::unwrap).collect();
            assert_eq!(records.len(), sample::records().len(), "{packing:?}");
            let times = records.iter().map(|record| record.log_time_ns);
            assert!(times.is_sorted(), "{packing:?}");
            for record in sample::records() {
                assert!(records.contains(&record), "{packing:?}: {record:?}");
            }
        }
    }

    #[test]
    fn equal_times_keep_the_order_of_the_file() {
        for packing in PACKINGS {
            let mut writer = RecordingWriter::in_memory(packing).unwrap();
            // Two chunks that overlap in time; the topics name the places.
            let pose = &sample::records().pop().unwrap().message;
            for (topic, time) in [("/a", 5), ("/b", 3), ("/c", 5)] {
                writer.write(topic, time, pose).unwrap();
            }
            writer.flush().unwrap();
            for (topic, time) in [("/d", 5), ("/e", 3), ("/f", 1)] {
                writer.write(topic, time, pose).unwrap();
            }
            let recording = open(writer.finish().unwrap().into_inner());
            let topics: Vec<String> = recording
                .records()
                .map(|record| record.unwrap().topic.to_string())
                .collect();
            assert_eq!(topics, ["/f", "/b", "/e", "/a", "/c", "/d"], "{packing:?}");
        }
    }

    #[test]
    fn only_the_kinds_that_are_wanted_come() {
        let recording = open(sample::bytes(Packing::Zstd));
        let records = recording.records_of(&[Kind::Scan, Kind::Map]);
        let kinds: Vec<Kind> = records
            .map(|record| record.unwrap().message.kind())
            .collect();
        assert_eq!(kinds.len(), sample::SCANS + 1);
        assert!(
            kinds
                .iter()
                .all(|kind| matches!(kind, Kind::Scan | Kind::Map))
        );
        assert_eq!(recording.records_of(&[]).count(), 0);
    }

    #[test]
    fn a_message_that_does_not_decode_does_not_end_the_recording() {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        let pose = &sample::records().pop().unwrap().message;
        let schema = Kind::Scan.schema();
        writer.write("/pose", 1, pose).unwrap();
        writer
            .write_bytes("/scan", schema, "", "cdr", 2, &[0, 1, 0, 0, 7])
            .unwrap();
        writer.write("/pose", 3, pose).unwrap();
        let recording = open(writer.finish().unwrap().into_inner());
        let items: Vec<_> = recording.records().collect();
        assert!(items[0].is_ok() && items[2].is_ok());
        assert_eq!(
            items[1].as_ref().unwrap_err().to_string(),
            "r.mcap: the message of /scan at log time 2 ns is no sensor_msgs/msg/LaserScan: \
             unexpected end of input"
        );
    }

    #[test]
    fn a_ros_1_channel_is_refused_with_the_reason() {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        writer
            .write_bytes("/scan", "sensor_msgs/LaserScan", "", "ros1", 1, b"...")
            .unwrap();
        let recording = open(writer.finish().unwrap().into_inner());
        let error = recording.records().next().unwrap().unwrap_err();
        assert_eq!(
            error.to_string(),
            "r.mcap: /scan has sensor_msgs/LaserScan encoded as \"ros1\"; \
             allowed: \"cdr\", as ROS 2 writes it"
        );
    }
}
