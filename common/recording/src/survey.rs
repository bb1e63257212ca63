//! Survey of a file: its content, and the position of the first damage.
//!
//! It is made in one pass when the recording is opened. Every chunk is unpacked and every checksum
//! compared, because a reader in time order visits the chunks in another order than the file has
//! them: a channel may be defined in a chunk that is read later, and a claimed time may be wrong.

mod pass;

use mcap::MAGIC;

use crate::Damage;
use crate::block::Block;
use crate::damage::shown;
use crate::extras::Extras;
use crate::registry::Registry;
use pass::Pass;

#[derive(Debug, Default)]
pub(crate) struct Survey {
    pub(crate) registry: Registry,
    pub(crate) extras: Extras,
    /// The sound parts with messages, by first log time, then position.
    pub(crate) blocks: Vec<Block>,
    pub(crate) messages: u64,
    /// Damage that ends the sound part; `None` if the whole file is sound.
    pub(crate) damage: Option<Damage>,
}

impl Survey {
    pub(crate) fn of(bytes: &[u8]) -> Result<Self, Damage> {
        if !bytes.starts_with(MAGIC) {
            let found = shown(bytes);
            return Err(Damage::Other(format!(
                "the file starts with {found}; a recording starts with \"\\x89MCAP0\\r\\n\""
            )));
        }
        let mut survey = Pass::over(bytes);
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

    /// Log times of the first and the last message, in nanoseconds.
    pub(crate) fn time_range_ns(&self) -> Option<(i64, i64)> {
        let last = self.blocks.iter().map(|block| block.last_ns).max()?;
        Some((self.blocks.first()?.first_ns, last))
    }
}

#[cfg(test)]
mod tests {
    use mcap::records::op;

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
        for (bytes, shown) in [
            (&b""[..], "nothing, as it is empty"),
            (b"#ROSBAG V2.0", "\"#ROSBAG \""),
        ] {
            let found = Survey::of(bytes).unwrap_err().to_string();
            let expected = format!("the file starts with {shown}; a recording starts with");
            assert!(found.starts_with(&expected), "{found}");
        }
    }

    #[test]
    fn records_that_refer_to_nothing_or_stand_wrong_are_refused() {
        let check = |damage: Damage, expected: &str| {
            let damage = damage.to_string();
            assert!(damage.contains(expected), "{damage}");
        };
        let broken = record(op::MESSAGE, &[0xff; 30]);
        check(
            damage(&[broken]),
            "the message record at byte 25 is damaged",
        );
        let mut body = [0; 22];
        body[0] = 9;
        let lost = record(op::MESSAGE, &body);
        check(damage(&[lost]), "refers to channel 9, which is not defined");
        let footer_first = record(op::FOOTER, &[0; 20]);
        check(damage(&[footer_first]), "the misplaced record at byte 25");
        let headless = [MAGIC, &record(op::DATA_END, &[0; 4])].concat();
        let headless = Survey::of(&headless).unwrap().damage.unwrap();
        check(headless, "the misplaced record at byte 8");
        // After the magic (8 bytes), header (17), data end (13) and footer (29).
        check(
            damage(&[end(), b"more".to_vec()]),
            "begin at byte 67, but found is \"more\"",
        );
        // The message count, then fields that are not checked.
        let statistics = [&3u64.to_le_bytes()[..], &[0; 38]].concat();
        let statistics = record(op::STATISTICS, &statistics);
        let footer = record(op::FOOTER, &[0; 20]);
        check(
            damage(&[record(op::DATA_END, &[0; 4]), statistics, footer]),
            "the summary counts 3 messages, 0 are there",
        );
    }
}
