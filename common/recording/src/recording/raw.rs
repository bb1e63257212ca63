//! Undecoded messages of a recording, in the order of their log times.
//!
//! A block (a chunk, or a run of messages outside of chunks) is unpacked when its first message is
//! next; only its wanted messages are kept.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use mcap::records::{Record, op};

use super::Recording;
use crate::block::Block;
use crate::file::RecordedFile;
use crate::parse::parse;
use crate::{Channel, Damage, RecordingError};

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawRecord<'a> {
    /// Its channel, with the number of messages that its file has on it.
    pub channel: &'a Channel,
    /// Time of recording, in nanoseconds since 1970.
    pub log_time_ns: i64,
    /// Time of publication, in nanoseconds since 1970.
    pub publish_time_ns: u64,
    /// Content, in the encoding of the channel.
    pub body: Vec<u8>,
}

/// Iterator over a recording's messages by log time; messages with equal times come in the order of
/// the files, then of their positions there. Damage is the last item.
pub struct RawRecords<'a> {
    recording: &'a Recording,
    is_wanted: Box<dyn Fn(&Channel) -> bool + 'a>,
    /// Blocks that are not unpacked yet, each with the number of its file; the next one is last.
    blocks: Vec<(usize, &'a Block)>,
    next: BinaryHeap<Reverse<Pending>>,
    damage: Option<RecordingError>,
}

#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Pending {
    /// Sort key: log time, file, block, index within the block; never equal.
    order: (i64, usize, usize, usize),
    publish_time_ns: u64,
    channel: u16,
    body: Vec<u8>,
}

impl<'a> RawRecords<'a> {
    /// Iterates over the messages of the wanted channels; `damage` is the last item.
    pub(crate) fn new(
        recording: &'a Recording,
        is_wanted: impl Fn(&Channel) -> bool + 'a,
        damage: Option<RecordingError>,
    ) -> Self {
        let mut blocks = Vec::new();
        for (index, file) in recording.files().iter().enumerate() {
            let channel = |id: &u16| file.survey.registry.channel(*id);
            let has_wanted =
                |block: &&Block| block.counts.keys().filter_map(channel).any(&is_wanted);
            let wanted = file.survey.blocks.iter().filter(has_wanted);
            blocks.extend(wanted.map(|block| (index, block)));
        }
        blocks.sort_by_key(|(file, block)| Reverse((block.first_ns, *file, block.at)));
        RawRecords {
            recording,
            is_wanted: Box::new(is_wanted),
            blocks,
            next: BinaryHeap::new(),
            damage,
        }
    }

    pub(crate) fn recording(&self) -> &'a Recording {
        self.recording
    }

    fn fill(&mut self) -> Result<(), RecordingError> {
        while let Some(&(index, block)) = self.blocks.last() {
            if let Some(Reverse(next)) = self.next.peek()
                && next.order.0 < block.first_ns
            {
                break;
            }
            self.blocks.pop();
            let file = &self.recording.files()[index];
            self.unpack((index, file), block)
                .map_err(|damage| RecordingError::Damaged {
                    path: file.path.clone(),
                    readable: self.recording.messages(),
                    damage,
                })?;
        }
        Ok(())
    }

    fn unpack(
        &mut self,
        (index, file): (usize, &RecordedFile),
        block: &Block,
    ) -> Result<(), Damage> {
        let registry = &file.survey.registry;
        let (is_wanted, next) = (&self.is_wanted, &mut self.next);
        let mut place = 0;
        file.ensure_long(block.bytes.end, block.at)?;
        block.each_record(file.bytes(), |opcode, body| {
            place += 1;
            if opcode != op::MESSAGE {
                return Ok(());
            }
            let Record::Message { header, data } = parse(opcode, body, block.at as u64)? else {
                return Ok(());
            };
            let channel = header.channel_id;
            if registry.channel(channel).is_some_and(is_wanted) {
                // The survey has checked that the time fits.
                let log_time = i64::try_from(header.log_time).unwrap_or(i64::MAX);
                next.push(Reverse(Pending {
                    order: (log_time, index, block.at, place),
                    publish_time_ns: header.publish_time,
                    channel,
                    body: data.into_owned(),
                }));
            }
            Ok(())
        })
    }

    fn end(&mut self, error: RecordingError) -> RecordingError {
        self.blocks.clear();
        self.next.clear();
        self.damage = None;
        error
    }
}

impl<'a> Iterator for RawRecords<'a> {
    type Item = Result<RawRecord<'a>, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Err(error) = self.fill() {
            return Some(Err(self.end(error)));
        }
        match self.next.pop() {
            Some(Reverse(pending)) => {
                let (log_time_ns, file, ..) = pending.order;
                let registry = &self.recording.files().get(file)?.survey.registry;
                Some(Ok(RawRecord {
                    channel: registry.channel(pending.channel)?,
                    log_time_ns,
                    publish_time_ns: pending.publish_time_ns,
                    body: pending.body,
                }))
            }
            None => {
                let damage = self.damage.take()?;
                Some(Err(self.end(damage)))
            }
        }
    }
}
