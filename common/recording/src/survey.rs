//! The first pass over a recording: what it holds, and how far it is sound.
//!
//! Every chunk is unpacked and every checksum compared, because a reader in
//! time order meets the chunks in another order than the file has them: a
//! channel may be defined in one that is read later, and a claimed time may be
//! wrong. What lies after the first damage is not looked at.

use std::ops::Range;

use mcap::MAGIC;
use mcap::records::op;

use crate::block::Block;
use crate::damage::shown;
use crate::frames::{Frame, Frames};
use crate::registry::{Registry, damaged};
use crate::{Damage, chunk, layout};

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
            loose: None,
            unchecked_from: None,
        };
        let damage = pass.run().err();
        let mut survey = pass.survey;
        survey.damage = damage;
        for block in &survey.blocks {
            for (&channel, &count) in &block.counts {
                survey.registry.count(channel, count);
            }
        }
        survey.messages = survey.blocks.iter().map(Block::messages).sum();
        let order = |block: &Block| (block.first_ns, block.bytes.start);
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
    /// Messages outside of chunks since the last chunk.
    loose: Option<Block>,
    /// How many blocks lie before the first record that no chunk's checksum
    /// covers.
    unchecked_from: Option<usize>,
}

impl Pass<'_> {
    fn run(&mut self) -> Result<(), Damage> {
        let mut frames = Frames::new(self.bytes, MAGIC.len());
        let data = self.data(&mut frames);
        // Also before damage: what was read until then is sound.
        self.close_loose();
        let saved = data?;
        self.check_data(frames.position() - DATA_END_BYTES, saved)?;
        let summary_at = frames.position();
        let footer = self.summary(&mut frames)?;
        self.check_summary(summary_at, &footer)?;
        self.check_end(frames.position())
    }

    /// Reads up to the end of the data; gives the checksum that was written.
    fn data(&mut self, frames: &mut Frames<'_>) -> Result<u32, Damage> {
        let header = frames.expect()?;
        if header.opcode != op::HEADER {
            return Err(misplaced(&header, "where the header belongs"));
        }
        loop {
            let frame = frames.expect()?;
            let at = frame.at as u64;
            match frame.opcode {
                op::SCHEMA | op::CHANNEL => {
                    self.mark_unchecked();
                    define(&mut self.survey.registry, &frame, at)?;
                }
                op::MESSAGE => self.loose_message(&frame, frames.position())?,
                op::CHUNK => self.chunk(&frame)?,
                op::DATA_END if frame.body.len() == DATA_END_BYTES - 9 => {
                    return layout::data_checksum(frame.body)
                        .map_err(|bad| damaged(at, "data end", bad));
                }
                op::DATA_END | op::FOOTER => {
                    return Err(misplaced(&frame, "where the data goes on or ends"));
                }
                // Indexes and attachments hold no messages, and later versions
                // may add what this one does not know.
                _ => {}
            }
        }
    }

    fn chunk(&mut self, frame: &Frame<'_>) -> Result<(), Damage> {
        self.close_loose();
        let at = frame.at as u64;
        let record = layout::chunk(frame.body).map_err(|bad| damaged(at, "chunk", bad))?;
        let content = chunk::unpack(&record, at)?;
        if record.checksum == 0 {
            self.mark_unchecked();
        }
        let mut block = Block::new(frame.at, true);
        block.bytes.end += 9 + frame.body.len();
        let mut records = Frames::new(&content, 0);
        while let Some(inner) = records.next().map_err(|_| ends_within(at))? {
            match inner.opcode {
                op::SCHEMA | op::CHANNEL => define(&mut self.survey.registry, &inner, at)?,
                op::MESSAGE => block.add(inner.body, at, &self.survey.registry)?,
                _ => {}
            }
        }
        self.push(block);
        Ok(())
    }

    fn loose_message(&mut self, frame: &Frame<'_>, end: usize) -> Result<(), Damage> {
        self.mark_unchecked();
        let block = self
            .loose
            .get_or_insert_with(|| Block::new(frame.at, false));
        block.add(frame.body, frame.at as u64, &self.survey.registry)?;
        block.bytes.end = end;
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

    /// Reads the summary up to and with the footer, which it gives.
    fn summary<'a>(&mut self, frames: &mut Frames<'a>) -> Result<Frame<'a>, Damage> {
        loop {
            let frame = frames.expect()?;
            let at = frame.at as u64;
            match frame.opcode {
                op::SCHEMA | op::CHANNEL => define(&mut self.survey.registry, &frame, at)?,
                op::STATISTICS => self.check_count(&frame)?,
                op::FOOTER => return Ok(frame),
                _ => {}
            }
        }
    }

    fn check_count(&self, frame: &Frame<'_>) -> Result<(), Damage> {
        let claimed = layout::message_count(frame.body)
            .map_err(|bad| damaged(frame.at as u64, "statistics", bad))?;
        let found = self.survey.blocks.iter().map(Block::messages).sum();
        if claimed == found {
            return Ok(());
        }
        Err(Damage::MessageCount { claimed, found })
    }

    /// The checksum covers everything up to `end`. Where it differs, messages
    /// are believed only as far as a chunk's own checksum covers them, and
    /// nothing uncovered lies before them.
    fn check_data(&mut self, end: usize, saved: u32) -> Result<(), Damage> {
        let Some(found) = self.differs(0..end, saved) else {
            return Ok(());
        };
        if let Some(checked) = self.unchecked_from {
            self.survey.blocks.truncate(checked);
        }
        Err(Damage::DataChecksum {
            end: end as u64,
            saved,
            found,
        })
    }

    /// The checksum covers the summary and the footer up to the checksum.
    fn check_summary(&self, at: usize, footer: &Frame<'_>) -> Result<(), Damage> {
        let saved = layout::summary_checksum(footer.body)
            .map_err(|bad| damaged(footer.at as u64, "footer", bad))?;
        match self.differs(at..footer.at + 9 + 16, saved) {
            None => Ok(()),
            Some(found) => Err(Damage::SummaryChecksum {
                at: at as u64,
                saved,
                found,
            }),
        }
    }

    /// The checksum of some bytes, if it is not the one that was written; 0
    /// stands for none.
    fn differs(&self, bytes: Range<usize>, saved: u32) -> Option<u32> {
        if saved == 0 {
            return None;
        }
        let found = crc32fast::hash(self.bytes.get(bytes).unwrap_or_default());
        (found != saved).then_some(found)
    }

    fn check_end(&self, at: usize) -> Result<(), Damage> {
        let rest = self.bytes.get(at..).unwrap_or_default();
        if rest == MAGIC {
            return Ok(());
        }
        if MAGIC.starts_with(rest) {
            return Err(Damage::Truncated {
                length: self.bytes.len() as u64,
                at: at as u64,
            });
        }
        Err(Damage::End {
            at: at as u64,
            found: shown(rest),
        })
    }
}

/// Opcode, length and checksum.
const DATA_END_BYTES: usize = 9 + 4;

fn define(registry: &mut Registry, frame: &Frame<'_>, at: u64) -> Result<(), Damage> {
    match frame.opcode {
        op::SCHEMA => registry.add_schema(frame.body, at),
        _ => registry.add_channel(frame.body, at),
    }
}

fn misplaced(frame: &Frame<'_>, place: &str) -> Damage {
    Damage::Record {
        at: frame.at as u64,
        kind: "misplaced",
        reason: format!(
            "opcode {:#04x} with {} bytes stands {place}",
            frame.opcode,
            frame.body.len()
        ),
    }
}

fn ends_within(at: u64) -> Damage {
    Damage::Record {
        at,
        kind: "chunk",
        reason: "its content ends within a record".to_owned(),
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
        let reason = "its name needs 4294967295 bytes, 4 are left".to_owned();
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
        let mut statistics = record(op::STATISTICS, &3u64.to_le_bytes());
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
