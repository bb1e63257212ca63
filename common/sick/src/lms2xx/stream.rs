//! Telegrams in a stream, of either direction.

use super::framing::{ACK, NACK, judge};
use super::{Command, Reply};
use crate::SickError;
use crate::framer::{Framer, Judgement, Pending, Protocol};

/// Bytes of a payload with twenty readings.
const SHORTEST_SCAN: usize = 44;

/// The stream that a device sends.
#[derive(Debug, Default)]
pub struct FromDevice;

/// The stream that a host sends.
#[derive(Debug, Default)]
pub struct FromHost;

/// Finds what a device says.
pub type ReplyFramer = Framer<FromDevice>;

/// Finds what a host says.
pub type CommandFramer = Framer<FromHost>;

impl Protocol for FromDevice {
    type Telegram<'a> = Reply<'a>;

    fn judge(&self, pending: Pending<'_>) -> Judgement {
        // Out of step these are as likely to be any other byte.
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
        // Shorter ones may come about by chance: the checksum has 16 bits.
        matches!(content, [0xb0 | 0xb7, ..]) && content.len() >= SHORTEST_SCAN
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
