//! Framing of LMS2xx telegrams in a stream, of either direction.

use super::framing::{ACK, NACK, judge};
use super::{Command, Reply};
use crate::SickError;
use crate::framer::{Framer, Judgement, Pending, Protocol};

/// Payload length of a scan with twenty readings, bytes.
const SHORTEST_SCAN: usize = 44;

/// Protocol of the stream that a device sends.
#[derive(Debug, Default)]
pub struct FromDevice;

/// Protocol of the stream that a host sends.
#[derive(Debug, Default)]
pub struct FromHost;

pub type ReplyFramer = Framer<FromDevice>;

pub type CommandFramer = Framer<FromHost>;

impl Protocol for FromDevice {
    type Telegram<'a> = Reply<'a>;

    fn judge(&self, pending: Pending<'_>) -> Judgement {
        // After garbage these are as likely to be any other byte.
        if pending.in_step && matches!(pending.bytes, [ACK | NACK, ..]) {
            return Judgement::Frame {
                prefix: 0,
                length: 1,
                suffix: 0,
            };
        }
        judge(pending, |address| matches!(address, 0x80 | 0x81))
    }

    fn stands_alone(&self, content: &[u8]) -> bool {
        // Shorter ones may occur by chance: the checksum has only 16 bits.
        matches!(content, [0xb0, ..]) && content.len() >= SHORTEST_SCAN
    }

    fn read<'a>(&self, content: &'a [u8]) -> Result<Reply<'a>, SickError> {
        Reply::read(content)
    }
}

impl Protocol for FromHost {
    type Telegram<'a> = Command<'a>;

    fn judge(&self, pending: Pending<'_>) -> Judgement {
        judge(pending, |address| matches!(address, 0x00 | 0x01))
    }

    fn read<'a>(&self, content: &'a [u8]) -> Result<Command<'a>, SickError> {
        Command::read(content)
    }
}
