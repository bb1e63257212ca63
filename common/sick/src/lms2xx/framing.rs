//! Telegrams in a stream, of either direction.

use super::{Command, Reply, crc};
use crate::SickError;
use crate::framer::{Framer, Judgement, Pending, Protocol};

/// The longest payload.
pub const MAX_PAYLOAD: usize = 812;

/// Bytes of a payload with twenty readings.
const SHORTEST_SCAN: usize = 44;

const START: u8 = 2;
/// Bytes before the payload: start, address and length.
const PREFIX: usize = 4;
/// Bytes after it.
const SUFFIX: usize = 2;
pub(super) const ACK: u8 = 0x06;
pub(super) const NACK: u8 = 0x15;

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

fn judge(pending: Pending<'_>, is_address: impl Fn(u8) -> bool) -> Judgement {
    let offset = pending.offset;
    let refuse = |found| {
        Judgement::Rejected(SickError::NoTelegram {
            offset,
            found,
            expected: "an LMS2xx telegram starts with 02 and an address",
        })
    };
    let (length, rest) = match *pending.bytes {
        [] | [START] => return Judgement::Incomplete,
        [START, address, ref rest @ ..] if is_address(address) => match rest {
            [low, high, rest @ ..] => (u16::from_le_bytes([*low, *high]), rest),
            _ => return Judgement::Incomplete,
        },
        [found, ..] => return refuse(found),
    };
    if !(1..=MAX_PAYLOAD).contains(&usize::from(length)) {
        return Judgement::Rejected(SickError::PayloadLength {
            offset,
            found: length,
        });
    }
    let length = usize::from(length);
    let Some(&[low, high]) = rest.get(length..).and_then(<[u8]>::first_chunk) else {
        return Judgement::Incomplete;
    };
    let found = u16::from_le_bytes([low, high]);
    let computed = crc(pending.bytes.get(..PREFIX + length).unwrap_or_default());
    if computed == found {
        return Judgement::Frame {
            prefix: PREFIX,
            length,
            suffix: SUFFIX,
        };
    }
    Judgement::Rejected(SickError::Checksum {
        offset,
        length,
        found,
        computed,
    })
}

/// Appends a telegram around the payload that `write` appends, which is at most
/// [`MAX_PAYLOAD`] bytes.
pub(super) fn frame(address: u8, out: &mut Vec<u8>, write: impl FnOnce(&mut Vec<u8>)) {
    let start = out.len();
    out.extend_from_slice(&[START, address, 0, 0]);
    write(out);
    let length = (out.len() - start - PREFIX) as u16;
    if let Some(claim) = out.get_mut(start + 2..start + PREFIX) {
        claim.copy_from_slice(&length.to_le_bytes());
    }
    let checksum = crc(out.get(start..).unwrap_or_default());
    out.extend_from_slice(&checksum.to_le_bytes());
}
