//! Telegrams that a device sends.

use super::configuration::Configuration;
use super::framing::{ACK, NACK, frame};
use super::scan::Scan;
use super::status::{DeviceStatus, Status};
use crate::SickError;
use crate::cursor::Cursor;

/// Anything that a device sends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reply<'a> {
    /// `06`: a telegram arrived.
    Acknowledged,
    /// `15`: a telegram arrived damaged or is not allowed now.
    Refused,
    /// Answer, followed by the status byte.
    Answer(Answer<'a>, Status),
}

/// Answer to a command, or an unsolicited scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer<'a> {
    /// `90`: the device has started; its type.
    Started(&'a [u8]),
    /// `A0`: u8, 0 if the mode was changed, 1 if the password was wrong or the mode not possible, 2
    /// if the device has an error.
    ModeSet(u8),
    /// `B0`: measured values.
    Scan(Scan<'a>),
    /// `B1`: status.
    Status(DeviceStatus),
    /// `BA`: the type, such as `LMS200;30106;V02.10`.
    Type(&'a [u8]),
    /// `BB`: u8, 1 if field and resolution were changed, then the values in force.
    VariantSet {
        done: bool,
        /// Width of the field: 100 or 180.
        width_deg: u16,
        /// Resolution: 25, 50 or 100.
        resolution_raw_1e2_deg: u16,
    },
    /// `F4`: configuration.
    Configuration(Configuration),
    /// `F7`: u8, 1 if the configuration was changed, then the one in force.
    ConfigurationSet {
        done: bool,
        configuration: Configuration,
    },
    /// Code and data of any other answer.
    Other(&'a [u8]),
}

impl<'a> Reply<'a> {
    /// Parses a payload or the single byte of an acknowledgement.
    ///
    /// Unsupported codes are accepted as they are.
    pub fn read(content: &'a [u8]) -> Result<Self, SickError> {
        match content {
            [ACK] => Ok(Reply::Acknowledged),
            [NACK] => Ok(Reply::Refused),
            [body @ .., status] if !body.is_empty() => {
                Ok(Reply::Answer(Answer::read(body)?, Status(*status)))
            }
            _ => Err(SickError::Short {
                field: "code and status",
                offset: 0,
                needed: 2,
                left: content.len(),
            }),
        }
    }

    /// Appends the whole telegram, or the single byte of an acknowledgement.
    pub fn frame(&self, out: &mut Vec<u8>) {
        match self {
            Reply::Acknowledged => out.push(ACK),
            Reply::Refused => out.push(NACK),
            Reply::Answer(answer, status) => frame(0x80, out, |out| {
                answer.write(out);
                out.push(status.0);
            }),
        }
    }
}

impl<'a> Answer<'a> {
    fn read(body: &'a [u8]) -> Result<Self, SickError> {
        let mut fields = Cursor::little_endian(body);
        let answer = match fields.u8("code")? {
            0x90 => return Ok(Answer::Started(fields.rest())),
            0xba => return Ok(Answer::Type(fields.rest())),
            0xa0 => Answer::ModeSet(fields.u8("result")?),
            0xb0 => Answer::Scan(Scan::read(&mut fields)?),
            0xb1 => Answer::Status(DeviceStatus::read(&mut fields)?),
            0xbb => Answer::VariantSet {
                done: done(&mut fields)?,
                width_deg: fields.u16("field")?,
                resolution_raw_1e2_deg: fields.u16("resolution")?,
            },
            0xf4 => Answer::Configuration(Configuration::read(&mut fields)?),
            0xf7 => Answer::ConfigurationSet {
                done: done(&mut fields)?,
                configuration: Configuration::read(&mut fields)?,
            },
            _ => return Ok(Answer::Other(body)),
        };
        fields.end()?;
        Ok(answer)
    }

    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Answer::Started(text) | Answer::Type(text) => {
                out.push(match self {
                    Answer::Started(_) => 0x90,
                    _ => 0xba,
                });
                out.extend_from_slice(text);
            }
            Answer::ModeSet(result) => out.extend_from_slice(&[0xa0, *result]),
            Answer::Scan(scan) => {
                out.push(0xb0);
                scan.write(out);
            }
            Answer::Status(status) => {
                out.push(0xb1);
                status.write(out);
            }
            Answer::VariantSet {
                done,
                width_deg,
                resolution_raw_1e2_deg,
            } => {
                out.extend_from_slice(&[0xbb, (*done).into()]);
                out.extend_from_slice(&width_deg.to_le_bytes());
                out.extend_from_slice(&resolution_raw_1e2_deg.to_le_bytes());
            }
            Answer::Configuration(configuration) => {
                out.push(0xf4);
                configuration.write(out);
            }
            Answer::ConfigurationSet {
                done,
                configuration,
            } => {
                out.extend_from_slice(&[0xf7, (*done).into()]);
                configuration.write(out);
            }
            Answer::Other(body) => out.extend_from_slice(body),
        }
    }
}

fn done(fields: &mut Cursor<'_>) -> Result<bool, SickError> {
    fields.known("result", |code| (code < 2).then_some(code == 1), "0 or 1")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lms2xx::{RangeMode, ReplyFramer, Unit};

    fn framed(reply: &Reply<'_>) -> Vec<u8> {
        let mut out = Vec::new();
        reply.frame(&mut out);
        out
    }

    fn scan(readings: &[u16]) -> Scan<'_> {
        Scan::new(Unit::Millimetre, readings)
    }

    #[test]
    fn every_answer_is_read_as_it_was_written() {
        let readings = [0, 1, 8191, 0xffff];
        let configuration = Configuration::new(RangeMode::Range8Fields, Unit::Centimetre);
        let answers = [
            Answer::Started(b"LMS291;S05"),
            Answer::ModeSet(1),
            Answer::Scan(scan(&readings)),
            Answer::Scan(Scan {
                part: Some(0),
                ..scan(&readings)
            }),
            Answer::Scan(Scan {
                unit: Unit::Centimetre,
                part: Some(3),
                counters: Some((255, 0)),
                ..scan(&readings)
            }),
            Answer::Status(DeviceStatus {
                version: *b"V02.10 ",
                mode: 0x25,
                has_error: false,
                turns: 4500,
                range_mode: RangeMode::Range32Field,
                width_deg: 180,
                resolution_raw_1e2_deg: 50,
                unit: Unit::Centimetre,
            }),
            Answer::Type(b"LMS200;30106;V02.10"),
            Answer::VariantSet {
                done: true,
                width_deg: 100,
                resolution_raw_1e2_deg: 25,
            },
            Answer::Configuration(configuration),
            Answer::ConfigurationSet {
                done: false,
                configuration,
            },
            Answer::Other(&[0x92]),
        ];
        let mut framer = ReplyFramer::default();
        for answer in answers {
            let reply = Reply::Answer(answer, Status(0x10));
            framer.push(&framed(&Reply::Acknowledged));
            framer.push(&framed(&reply));
            let acknowledged = framer.next_frame().unwrap().unwrap().telegram;
            assert_eq!(acknowledged, Reply::Acknowledged);
            assert_eq!(framer.next_frame().unwrap().unwrap().telegram, reply);
        }
    }

    #[test]
    fn the_head_of_a_scan_bit_by_bit() {
        let payload = [0xb0, 0x02, 0x78, 1, 0, 2, 0x20, 0x00];
        let Ok(Reply::Answer(Answer::Scan(scan), status)) = Reply::read(&payload) else {
            panic!("no scan");
        };
        assert_eq!((scan.unit, scan.part), (Unit::Millimetre, Some(3)));
        assert_eq!(scan.readings.collect::<Vec<_>>(), [1, 0x2002]);
        assert!(status.is_in_order() && scan.counters.is_none());
    }

    #[test]
    fn what_does_not_add_up_is_refused() {
        let refuse = |payload: &[u8], expected: &str| {
            let error = Reply::read(payload).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(&[0xb0], "`code and status` takes 2 bytes");
        refuse(
            &[0xb0, 2, 0, 1, 0, 0],
            "`readings` takes 4 bytes, 2 are left",
        );
        refuse(&[0xb0, 0, 0xc0, 0], "`unit` is 3, allowed is 0 or 1");
        refuse(&[0xb0, 0, 0, 1, 0], "`counter of telegrams` takes 1 bytes");
        refuse(&[0xa0, 0, 0, 0], "1 bytes follow the last field");
        refuse(&[0xbb, 2, 0, 0, 0, 0, 0], "`result` is 0x02");
    }

    #[test]
    fn a_dirty_window_and_errors_show_in_the_status() {
        assert!(Status(0x12).is_in_order());
        assert!(!Status(0x80).is_in_order() && Status(0x80).is_polluted());
        assert!(!Status(0x40).is_in_order() && Status(0x40).is_implausible());
        assert_eq!(Status(0x13).level(), 3);
        assert!(!Status(0x13).is_in_order());
    }
}
