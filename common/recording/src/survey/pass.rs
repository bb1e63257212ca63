//! One pass over a recording's records, from start to end.
//!
//! The library finds the records and compares the checksums; this module checks the order of the
//! records, and reports damage with its position. Nothing after the first damage is read.

use std::ops::Range;

use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader};
use mcap::{MAGIC, McapError};

use super::Survey;
use crate::block::Block;
use crate::chunk::Chunk;
use crate::damage::shown;
use crate::feed::{feed, options};
use crate::parse::{name, parse, reason};
use crate::registry::Registry;
use crate::{Damage, MAX_CHUNK_BYTES};

pub(crate) struct Pass<'a> {
    bytes: &'a [u8],
    survey: Survey,
    part: Part,
    /// Messages outside of chunks since the last chunk.
    loose: Option<Block>,
    /// Number of blocks before the first record that no chunk checksum covers.
    unchecked_from: Option<usize>,
}

#[derive(Debug, Clone, Copy)]
enum Part {
    Start,
    Data,
    Summary { from: usize },
}

impl<'a> Pass<'a> {
    /// Surveys a file that starts with the magic, up to its damage.
    pub(crate) fn over(bytes: &'a [u8]) -> Survey {
        let mut pass = Pass {
            bytes,
            survey: Survey::default(),
            part: Part::Start,
            loose: None,
            unchecked_from: None,
        };
        let damage = pass.run().err();
        // Also before damage: everything read so far is sound.
        pass.close_loose();
        if let (Some(Damage::DataChecksum { .. }), Some(checked)) = (&damage, pass.unchecked_from) {
            // Only chunks with their own checksum, and with nothing unchecked before them, are
            // trusted.
            pass.survey.blocks.truncate(checked);
        }
        pass.survey.damage = damage;
        pass.survey
    }

    fn run(&mut self) -> Result<(), Damage> {
        let options = options()
            .with_emit_chunks(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_check_finishes_after_end_magic(true);
        let mut reader = LinearReader::new_with_options(options);
        let mut rest = self.bytes;
        let mut at = MAGIC.len();
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => feed(&mut reader, wanted, &mut rest),
                Ok(LinearReadEvent::Record { opcode, data }) => {
                    // The reader requests the bytes of one record at a time, so the bytes it was
                    // given end where this record ends.
                    let end = self.bytes.len() - rest.len();
                    self.record(opcode, data, at..end)?;
                    at = end;
                }
                Err(error) => return Err(self.damage(&error, at, rest.len())),
            }
        }
        Ok(())
    }

    fn record(&mut self, opcode: u8, body: &[u8], place: Range<usize>) -> Result<(), Damage> {
        let at = place.start as u64;
        let misplaced = |belongs: &str| {
            Err(Damage::Record {
                at,
                kind: "misplaced",
                reason: format!("a record of type {opcode:#04x} is {belongs}"),
            })
        };
        match (self.part, opcode) {
            (Part::Start, op::HEADER) => self.part = Part::Data,
            (Part::Start, _) => return misplaced("where the header belongs"),
            (Part::Data, op::SCHEMA | op::CHANNEL) => {
                self.mark_unchecked();
                self.survey.registry.add(opcode, body, at)?;
            }
            (Part::Data, op::MESSAGE) => self.loose_message(body, place)?,
            (Part::Data, op::CHUNK) => self.chunk(body, &place)?,
            (Part::Data, op::ATTACHMENT | op::METADATA) => {
                self.survey.extras.add(opcode, body, &place)?;
            }
            (Part::Data, op::FOOTER) => return misplaced("where data or its end belongs"),
            (Part::Data, op::DATA_END) => {
                self.close_loose();
                self.part = Part::Summary { from: place.end };
            }
            (Part::Summary { .. }, op::SCHEMA | op::CHANNEL) => {
                self.survey.registry.add(opcode, body, at)?;
            }
            (Part::Summary { .. }, op::STATISTICS) => self.check_count(body, at)?,
            (Part::Summary { .. }, op::DATA_END) => return misplaced("behind the data"),
            // Indexes hold no messages, and later versions of the format may add record types.
            _ => {}
        }
        Ok(())
    }

    fn chunk(&mut self, body: &[u8], place: &Range<usize>) -> Result<(), Damage> {
        self.close_loose();
        let at = place.start as u64;
        let chunk = Chunk::of(body, at)?;
        if !chunk.is_checked() {
            self.mark_unchecked();
        }
        let mut block = Block::chunk(place.start, place.end - body.len()..place.end);
        let registry = &mut self.survey.registry;
        chunk.each_record(|opcode, body| match opcode {
            op::SCHEMA | op::CHANNEL => registry.add(opcode, body, at),
            op::MESSAGE => add_message(&mut block, body, at, registry),
            _ => Ok(()),
        })?;
        self.push(block);
        Ok(())
    }

    fn loose_message(&mut self, body: &[u8], place: Range<usize>) -> Result<(), Damage> {
        self.mark_unchecked();
        let block = self.loose.get_or_insert_with(|| Block::loose(place.start));
        add_message(block, body, place.start as u64, &self.survey.registry)?;
        block.bytes.end = place.end;
        Ok(())
    }

    fn close_loose(&mut self) {
        if let Some(block) = self.loose.take() {
            self.push(block);
        }
    }

    fn push(&mut self, block: Block) {
        if !block.counts.is_empty() {
            self.survey.blocks.push(block);
        }
    }

    fn mark_unchecked(&mut self) {
        let blocks = self.survey.blocks.len();
        self.unchecked_from.get_or_insert(blocks);
    }

    fn check_count(&self, body: &[u8], at: u64) -> Result<(), Damage> {
        let Record::Statistics(statistics) = parse(op::STATISTICS, body, at)? else {
            return Ok(());
        };
        let claimed = statistics.message_count;
        let found: u64 = self.survey.blocks.iter().map(Block::messages).sum();
        if claimed == found {
            return Ok(());
        }
        Err(Damage::Other(format!(
            "the summary counts {claimed} messages, {found} are there"
        )))
    }

    /// Converts an error of the reader at the record at byte `at`; `left` is the number of bytes
    /// that it was not given.
    fn damage(&self, error: &McapError, at: usize, left: usize) -> Damage {
        let bytes = self.bytes;
        let end = |from: usize| {
            let found = shown(bytes.get(from..).unwrap_or_default());
            Damage::Other(format!(
                "the recording's last 8 bytes should begin at byte {at}, but found is {found}"
            ))
        };
        let (place, at, length) = (at, at as u64, bytes.len() as u64);
        let truncated = Damage::Truncated { length, at };
        match (error, self.part) {
            (McapError::UnexpectedEof, _) => truncated,
            (&McapError::RecordTooLarge { len, .. }, _) if len > left as u64 => truncated,
            (&McapError::RecordTooLarge { opcode, len }, _) => Damage::Record {
                at,
                kind: name(opcode),
                reason: format!("it has {len} bytes; at most {MAX_CHUNK_BYTES} are read"),
            },
            (&McapError::BadDataCrc { saved, calculated }, _) => Damage::DataChecksum {
                end: at,
                saved,
                found: calculated,
            },
            (&McapError::BadSummaryCrc { saved, calculated }, Part::Summary { from }) => {
                Damage::Other(format!(
                    "the summary at byte {from} is damaged: its checksum is {calculated:08x}, \
                     written was {saved:08x}"
                ))
            }
            (McapError::BadMagic, _) => end(place),
            (McapError::BytesAfterEndMagic, _) => end(place + MAGIC.len()),
            // The reader parses the data end and the footer itself.
            (other, _) => Damage::Record {
                at,
                kind: bytes.get(place).map_or("missing", |&opcode| name(opcode)),
                reason: reason(other),
            },
        }
    }
}

fn add_message(block: &mut Block, body: &[u8], at: u64, registry: &Registry) -> Result<(), Damage> {
    match parse(op::MESSAGE, body, at)? {
        Record::Message { header, .. } => block.add(&header, at, registry),
        _ => Ok(()),
    }
}
