//! Framing of a payload: start, address, length and checksum.

use crate::SickError;
use crate::framer::{Judgement, Pending};

/// Longest payload, bytes.
const MAX_PAYLOAD: usize = 812;

const START: u8 = 2;
/// Number of bytes before the payload: start, address and length.
const PREFIX: usize = 4;
/// Number of bytes after the payload: the checksum.
const SUFFIX: usize = 2;
pub(super) const ACK: u8 = 0x06;
pub(super) const NACK: u8 = 0x15;

pub(super) fn judge(pending: Pending<'_>, is_address: impl Fn(u8) -> bool) -> Judgement {
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
    let allowed = 1..=MAX_PAYLOAD;
    if !allowed.contains(&usize::from(length)) {
        return Judgement::Rejected(SickError::Length {
            offset,
            found: length.into(),
            part: "payload",
            allowed,
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

/// Appends a telegram; `write` appends its payload of at most [`MAX_PAYLOAD`] bytes.
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

/// Returns the CRC with polynomial x¹⁶ + x¹⁵ + x² + 1 and initial value 0; each step combines the
/// current byte and, in the high half, the previous one.
fn crc(bytes: &[u8]) -> u16 {
    let mut crc = 0u16;
    let mut before = 0u16;
    for &byte in bytes {
        let overflow = (crc >> 15) * 0x8005;
        let byte = u16::from(byte);
        crc = crc << 1 ^ overflow ^ before << 8 ^ byte;
        before = byte;
    }
    crc
}
