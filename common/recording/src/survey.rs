//! The first pass over a recording: what it holds, and how far it is sound.
//!
//! Every chunk is unpacked and every checksum compared, because a reader in
//! time order meets the chunks in another order than the file has them: a
//! channel may be defined in one that is read later, and a claimed time may be
//! wrong. What lies after the first damage is not looked at.

use std::ops::Range;

use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader};
use mcap::{MAGIC, McapError};

use crate::block::Block;
use crate::chunk::Chunk;
use crate::damage::shown;
use crate::feed::{feed, options};
use crate::parse::{name, parse, reason};
use crate::registry::Registry;
use crate::{Damage, MAX_CHUNK_BYTES};

/// What the first pass found.
#[derive(Debug, Default)]
pub(crate) struct Survey {
    pub(crate) registry: Registry,
    /// The sound parts with messages, by first log time, then place.
    pub(crate) blocks: Vec<Block>,
    /// Messages in them.
    pub(crate) messages: u64,
    /// What ends the sound part, if it is not the end.
    pub(crate) damage: Option<Damage>,
}

impl Survey {
    /// Looks at a whole file.
    ///
    /// # Errors
    /// If it is no recording at all; other damage is part of what was found.
    pub(crate) fn of(bytes: &[u8]) -> Result<Self, Damage> {
        if !bytes.starts_with(MAGIC) {
            return Err(Damage::NotMcap {
                found: shown(bytes),
            });
        }
        let mut pass = Pass {
            bytes,
            survey: Survey::default(),
            part: Part::Start,
            loose: None,
            unchecked_from: None,
        };
        let damage = pass.run().err();
        // Also before damage: what was read until then is sound.
        pass.close_loose();
        if let Some(Damage::DataChecksum { .. }) = damage {
            pass.drop_unchecked();
        }
        let mut survey = pass.survey;
        survey.damage = damage;
        for block in &survey.blocks {
            for (&channel, &count) in &block.counts {
                survey.registry.count(channel, count);
            }
        }
        survey.messages = survey.blocks.iter().map(Block::messages).sum();
        let order = |block: &Block| (block.first_ns, block.at);
        survey.blocks.sort_by_key(order);
        Ok(survey)
    }

    /// Log times of the first and the last message, nanoseconds.
    pub(crate) fn time_range_ns(&self) -> Option<(i64, i64)> {
        let last = self.blocks.iter().map(|block| block.last_ns).max()?;
        Some((self.blocks.first()?.first_ns, last))
    }
}

struct Pass<'a> {
    bytes: &'a [u8],
    survey: Survey,
    part: Part,
    /// Messages outside of chunks since the last chunk.
    loose: Option<Block>,
    /// How many blocks lie before the first record that no chunk's checksum
    /// covers.
    unchecked_from: Option<usize>,
}

/// Where in the file the pass is.
#[derive(Debug, Clone, Copy)]
enum Part {
    Start,
    Data,
    Summary {
        /// Its first byte.
        from: usize,
    },
}

impl Pass<'_> {
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
                    // The reader asks for the bytes of one record at a time, so
                    // what it has been given ends where this one does.
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
                reason: format!("a record of type {opcode:#04x} stands {belongs}"),
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
            (Part::Data, op::FOOTER) => return misplaced("where the data goes on or ends"),
            (Part::Data, op::DATA_END) => {
                self.close_loose();
                self.part = Part::Summary { from: place.end };
            }
            (Part::Summary { .. }, op::SCHEMA | op::CHANNEL) => {
                self.survey.registry.add(opcode, body, at)?;
            }
            (Part::Summary { .. }, op::STATISTICS) => self.check_count(body, at)?,
            (Part::Summary { .. }, op::DATA_END) => return misplaced("behind the data"),
            // Indexes and attachments hold no messages, and later versions may
            // add what this one does not know.
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

    /// Where the data's checksum is wrong, messages are believed only as far as
    /// a chunk's own checksum covers them, and nothing uncovered lies before
    /// them.
    fn drop_unchecked(&mut self) {
        if let Some(checked) = self.unchecked_from {
            self.survey.blocks.truncate(checked);
        }
    }

    fn check_count(&self, body: &[u8], at: u64) -> Result<(), Damage> {
        let Record::Statistics(statistics) = parse(op::STATISTICS, body, at)? else {
            return Ok(());
        };
        let claimed = statistics.message_count;
        let found = self.survey.blocks.iter().map(Block::messages).sum();
        if claimed == found {
            return Ok(());
        }
        Err(Damage::MessageCount { claimed, found })
    }

    /// What it means that the reader stopped at the record at byte `at`, with
    /// `left` bytes that it was not given.
    fn damage(&self, error: &McapError, at: usize, left: usize) -> Damage {
        let bytes = self.bytes;
        let from = |at| shown(bytes.get(at..).unwrap_or_default());
        let truncated = Damage::Truncated {
            length: bytes.len() as u64,
            at: at as u64,
        };
        match (error, self.part) {
            (McapError::UnexpectedEof, _) => truncated,
            (&McapError::RecordTooLarge { len, .. }, _) if len > left as u64 => truncated,
            (&McapError::RecordTooLarge { opcode, len }, _) => Damage::Record {
                at: at as u64,
                kind: name(opcode),
                reason: format!("it has {len} bytes; at most {MAX_CHUNK_BYTES} are read"),
            },
            (&McapError::BadDataCrc { saved, calculated }, _) => Damage::DataChecksum {
                end: at as u64,
                saved,
                found: calculated,
            },
            (&McapError::BadSummaryCrc { saved, calculated }, Part::Summary { from }) => {
                Damage::SummaryChecksum {
                    at: from as u64,
                    saved,
                    found: calculated,
                }
            }
            (McapError::BadMagic, _) => Damage::End {
                at: at as u64,
                found: from(at),
            },
            (McapError::BytesAfterEndMagic, _) => Damage::End {
                at: at as u64,
                found: from(at + MAGIC.len()),
            },
            // The reader itself looks into the data end and the footer.
            (other, _) => Damage::Record {
                at: at as u64,
                kind: bytes.get(at).map_or("missing", |&opcode| name(opcode)),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn record(opcode: u8, body: &[u8]) -> Vec<u8> {
        [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat()
    }

    fn file(records: &[Vec<u8>]) -> Vec<u8> {
        let header = record(op::HEADER, &[0; 8]);
        [MAGIC, &header, &records.concat()].concat()
    }

    fn end() -> Vec<u8> {
        let tail = [record(op::DATA_END, &[0; 4]), record(op::FOOTER, &[0; 20])];
        [&tail.concat(), MAGIC].concat()
    }

    fn damage(records: &[Vec<u8>]) -> Damage {
        Survey::of(&file(records)).unwrap().damage.unwrap()
    }

    #[test]
    fn an_empty_recording_is_sound() {
        let survey = Survey::of(&file(&[end()])).unwrap();
        assert_eq!((survey.damage.as_ref(), survey.messages), (None, 0));
        assert_eq!(survey.time_range_ns(), None);
    }

    #[test]
    fn what_starts_otherwise_is_no_recording() {
        for (bytes, shown) in [(&b""[..], "nothing"), (b"#ROSBAG V2.0", "\"#ROSBAG \"")] {
            let found = shown.to_owned();
            assert_eq!(Survey::of(bytes).unwrap_err(), Damage::NotMcap { found });
        }
    }

    #[test]
    fn absurd_claims_are_refused() {
        let mut chunk = vec![0; 16];
        chunk.extend(u64::MAX.to_le_bytes());
        chunk.extend([0; 4]);
        chunk.extend([4, 0, 0, 0]);
        chunk.extend(b"zstd");
        chunk.extend(0u64.to_le_bytes());
        assert!(matches!(
            damage(&[record(op::CHUNK, &chunk)]),
            Damage::ChunkSize {
                claimed: u64::MAX,
                ..
            }
        ));
        // A name of four gigabytes, in a record of ten bytes.
        let name = [&[1, 0][..], &u32::MAX.to_le_bytes(), b"/sca"].concat();
        let reason = "it ends within a field, or a field claims more bytes than are left";
        let reason = reason.to_owned();
        assert_eq!(
            damage(&[record(op::SCHEMA, &name)]),
            Damage::Record {
                at: 25,
                kind: "schema",
                reason
            }
        );
        let mut endless = record(op::MESSAGE, &[]);
        endless[1..].fill(0xff);
        assert!(matches!(
            damage(&[endless]),
            Damage::Truncated { at: 25, .. }
        ));
    }

    #[test]
    fn records_that_refer_to_nothing_or_stand_wrong_are_refused() {
        let message = record(op::MESSAGE, &[0xff; 30]);
        assert!(matches!(
            damage(&[message]),
            Damage::Record {
                kind: "message",
                ..
            }
        ));
        let mut body = [0; 22];
        body[0] = 9;
        assert!(matches!(
            damage(&[record(op::MESSAGE, &body)]),
            Damage::Undefined {
                missing: "channel",
                id: 9,
                ..
            }
        ));
        let footer_first = record(op::FOOTER, &[0; 20]);
        assert!(matches!(
            damage(&[footer_first]),
            Damage::Record {
                kind: "misplaced",
                ..
            }
        ));
        let headless = [MAGIC, &record(op::DATA_END, &[0; 4])].concat();
        assert!(matches!(
            Survey::of(&headless).unwrap().damage,
            Some(Damage::Record {
                kind: "misplaced",
                ..
            })
        ));
        assert!(matches!(
            damage(&[end(), b"more".to_vec()]),
            Damage::End { .. }
        ));
        // The count, then all that is not looked at.
        let mut statistics = record(
            op::STATISTICS,
            &[&3u64.to_le_bytes()[..], &[0; 38]].concat(),
        );
        statistics.extend(record(op::FOOTER, &[0; 20]));
        assert_eq!(
            damage(&[record(op::DATA_END, &[0; 4]), statistics]),
            Damage::MessageCount {
                claimed: 3,
                found: 0
            }
        );
    }
}
