//! What kind of telegram a content is, and how one is written.
//!
//! Only what a stream of scans needs is told apart; the rest stays `Other`.

use super::cursor::Cursor;
use super::framer::START;
use super::lmd_scan_data::LmdScanData;
use crate::LmsError;

/// The content that asks a device to send every scan from now on.
pub const START_SCAN_DATA: &[u8] = b"sEN LMDscandata \x01";

/// A content by its command.
#[derive(Debug, Clone)]
#[expect(
    clippy::large_enum_variant,
    reason = "it lives on the stack; a box would allocate for every scan"
)]
pub enum Telegram<'a> {
    /// A scan, pushed (`sSN`) or polled (`sRA`).
    ScanData(LmdScanData<'a>),
    /// The device's answer to [`START_SCAN_DATA`]: whether it sends scans.
    ScanDataStarted(bool),
    /// The device refused the last command: SICK's number of the error.
    Fault(u16),
    /// Anything else: its command, of three letters.
    Other(&'a [u8]),
}

impl<'a> Telegram<'a> {
    /// Reads a content.
    ///
    /// # Errors
    /// Where the parameters are not those of the command; of other commands
    /// nothing is known, so they pass.
    pub fn read(content: &'a [u8]) -> Result<Self, LmsError> {
        match content {
            [b's', b'S', b'N', rest @ ..] | [b's', b'R', b'A', rest @ ..]
                if rest.starts_with(b" LMDscandata ") =>
            {
                LmdScanData::read(content).map(Telegram::ScanData)
            }
            [b's', b'E', b'A', ..] => answer(content),
            [b's', b'F', b'A', rest @ ..] => Ok(Telegram::Fault(fault_code(rest))),
            _ => Ok(Telegram::Other(content.get(..3).unwrap_or(content))),
        }
    }
}

fn answer(content: &[u8]) -> Result<Telegram<'_>, LmsError> {
    let mut cursor = Cursor::new(content);
    let command: [u8; 16] = cursor.bytes("command and name")?;
    if &command != b"sEA LMDscandata " {
        return Ok(Telegram::Other(content.get(..3).unwrap_or(content)));
    }
    let on = cursor.u8_upto("start or stop", 1, "0 or 1")?;
    cursor.end()?;
    Ok(Telegram::ScanDataStarted(on == 1))
}

/// The code is the last two bytes, with or without a space before them.
fn fault_code(parameters: &[u8]) -> u16 {
    parameters
        .last_chunk::<2>()
        .map_or(0, |code| u16::from_be_bytes(*code))
}

/// A content with start, length and checksum around it. The content is ours,
/// so it is short.
#[must_use]
pub fn frame(content: &[u8]) -> Vec<u8> {
    let length = u32::try_from(content.len()).unwrap_or(u32::MAX);
    let checksum = content.iter().fold(0, |parity, byte| parity ^ byte);
    [&START[..], &length.to_be_bytes(), content, &[checksum]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_request_is_byte_for_byte_that_of_the_manual() {
        let request = [
            2, 2, 2, 2, 0, 0, 0, 0x11, 0x73, 0x45, 0x4e, 0x20, 0x4c, 0x4d, 0x44, 0x73, 0x63, 0x61,
            0x6e, 0x64, 0x61, 0x74, 0x61, 0x20, 0x01, 0x33,
        ];
        // The listing prints 0x33 for both request and answer; the XOR of the
        // request is 0x33 and that of the answer 0x3c.
        assert_eq!(frame(START_SCAN_DATA), request);
        assert_eq!(frame(b"sEA LMDscandata \x01").last(), Some(&0x3c));
    }

    #[test]
    fn kinds() {
        let kind = |content: &[u8]| match Telegram::read(content) {
            Ok(Telegram::ScanData(_)) => "scan".into(),
            Ok(Telegram::Other(command)) => format!("other {}", command.escape_ascii()),
            Ok(known) => format!("{known:?}"),
            Err(error) => error.to_string(),
        };
        assert_eq!(kind(b"sEA LMDscandata \x01"), "ScanDataStarted(true)");
        assert_eq!(kind(b"sEA LMDscandata \x00"), "ScanDataStarted(false)");
        assert!(kind(b"sEA LMDscandata \x02").contains("`start or stop` is 2"));
        assert!(kind(b"sEA LMDscandata \x01\x01").contains("1 bytes follow"));
        assert_eq!(kind(b"sEA LIDoutputstate \x01"), "other sEA");
        assert_eq!(kind(b"sFA\x00\x0d"), "Fault(13)");
        assert_eq!(kind(b"sFA \x00\x0d"), "Fault(13)");
        assert_eq!(kind(b"sRA LMDscandatacfg"), "other sRA");
        assert!(kind(b"sSN LMDscandata ").contains("`version` takes 2 bytes"));
        assert_eq!(kind(b"s"), "other s");
    }
}
