//! Commands that a host sends.

use std::str::FromStr;

use super::configuration::Configuration;
use super::framing::frame;
use crate::SickError;
use crate::cursor::Cursor;

/// Factory password of every device.
pub const DEFAULT_PASSWORD: [u8; 8] = *b"SICK_LMS";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command<'a> {
    /// `20`: change the operating mode.
    SetMode(Mode),
    /// `30 01`: send one scan.
    RequestScan,
    /// `31`: send the status.
    RequestStatus,
    /// `3A`: send the type.
    RequestType,
    /// `3B`: change field and resolution until the next power-off.
    SetVariant {
        /// Width of the field: 100 or 180.
        width_deg: u16,
        /// Resolution: 25, 50 or 100.
        resolution_raw_1e2_deg: u16,
    },
    /// `74`: send the configuration.
    RequestConfiguration,
    /// `77`: change the configuration.
    SetConfiguration(Configuration),
    /// Code and data of any other command.
    Other(&'a [u8]),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// `00`: installation mode, in which settings may be changed.
    Installation {
        /// Password, by default [`DEFAULT_PASSWORD`].
        password: [u8; 8],
    },
    /// `24`: sends every scan.
    Continuous,
    /// `25`: sends a scan on request.
    OnRequest,
    /// `2A`: sends every partial scan.
    PartialScans,
    /// `40` to `42` and `48`: keeps the mode, changes the baud rate.
    Baud(Baud),
    /// Code of any other mode.
    Other(u8),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Baud {
    /// 9600, the rate after power-on.
    B9600,
    B19200,
    B38400,
    /// 500000: RS-422 only.
    B500000,
}

impl Baud {
    /// All rates, most likely first.
    pub const ALL: [Baud; 4] = [Baud::B38400, Baud::B9600, Baud::B500000, Baud::B19200];

    /// Returns the rate in bits per second.
    pub const fn rate(self) -> u32 {
        match self {
            Baud::B9600 => 9600,
            Baud::B19200 => 19_200,
            Baud::B38400 => 38_400,
            Baud::B500000 => 500_000,
        }
    }

    pub fn from_rate(rate: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|baud| baud.rate() == rate)
    }

    const fn code(self) -> u8 {
        match self {
            Baud::B9600 => 0x42,
            Baud::B19200 => 0x41,
            Baud::B38400 => 0x40,
            Baud::B500000 => 0x48,
        }
    }
}

impl FromStr for Baud {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let baud = text.parse().ok().and_then(Self::from_rate);
        baud.ok_or("allowed are 9600, 19200, 38400 and 500000")
    }
}

impl Mode {
    pub const fn code(self) -> u8 {
        match self {
            Mode::Installation { .. } => 0x00,
            Mode::Continuous => 0x24,
            Mode::OnRequest => 0x25,
            Mode::PartialScans => 0x2a,
            Mode::Baud(baud) => baud.code(),
            Mode::Other(code) => code,
        }
    }

    fn read(fields: &mut Cursor<'_>) -> Result<Self, SickError> {
        let code = fields.u8("mode")?;
        let baud = Baud::ALL.into_iter().find(|baud| baud.code() == code);
        Ok(match (code, baud) {
            (_, Some(baud)) => Mode::Baud(baud),
            (0x00, _) => Mode::Installation {
                password: fields.array("password")?,
            },
            (0x24, _) => Mode::Continuous,
            (0x25, _) => Mode::OnRequest,
            (0x2a, _) => Mode::PartialScans,
            _ => {
                fields.take("parameters", fields.rest().len())?;
                Mode::Other(code)
            }
        })
    }
}

impl<'a> Command<'a> {
    /// Parses a payload.
    ///
    /// Unsupported codes are accepted as they are.
    pub fn read(payload: &'a [u8]) -> Result<Self, SickError> {
        let mut fields = Cursor::little_endian(payload);
        let command = match fields.u8("code")? {
            0x20 => Command::SetMode(Mode::read(&mut fields)?),
            0x30 => {
                let kind = fields.known("kind", |code| (code == 1).then_some(()), "1");
                kind.map(|()| Command::RequestScan)?
            }
            0x31 => Command::RequestStatus,
            0x3a => Command::RequestType,
            0x3b => Command::SetVariant {
                width_deg: fields.u16("field")?,
                resolution_raw_1e2_deg: fields.u16("resolution")?,
            },
            0x74 => Command::RequestConfiguration,
            0x77 => Command::SetConfiguration(Configuration::read(&mut fields)?),
            _ => return Ok(Command::Other(payload)),
        };
        fields.end()?;
        Ok(command)
    }

    /// Appends the whole telegram.
    pub fn frame(&self, out: &mut Vec<u8>) {
        frame(0x00, out, |out| self.write(out));
    }

    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Command::SetMode(mode) => {
                out.extend_from_slice(&[0x20, mode.code()]);
                if let Mode::Installation { password } = mode {
                    out.extend_from_slice(password);
                }
            }
            Command::RequestScan => out.extend_from_slice(&[0x30, 0x01]),
            Command::RequestStatus => out.push(0x31),
            Command::RequestType => out.push(0x3a),
            Command::SetVariant {
                width_deg,
                resolution_raw_1e2_deg,
            } => {
                out.push(0x3b);
                out.extend_from_slice(&width_deg.to_le_bytes());
                out.extend_from_slice(&resolution_raw_1e2_deg.to_le_bytes());
            }
            Command::RequestConfiguration => out.push(0x74),
            Command::SetConfiguration(configuration) => {
                out.push(0x77);
                configuration.write(out);
            }
            Command::Other(payload) => out.extend_from_slice(payload),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lms2xx::{CommandFramer, RangeMode, Unit};

    fn framed(command: &Command<'_>) -> Vec<u8> {
        let mut out = Vec::new();
        command.frame(&mut out);
        out
    }

    #[test]
    fn the_telegrams_of_the_manual() {
        let is = |command: Command<'_>, bytes: &[u8]| assert_eq!(framed(&command), bytes);
        let mode = |mode, rest: &[u8]| {
            is(
                Command::SetMode(mode),
                &[&[2, 0, 2, 0, 0x20], rest].concat(),
            );
        };
        mode(Mode::Continuous, &[0x24, 0x34, 0x08]);
        mode(Mode::OnRequest, &[0x25, 0x35, 0x08]);
        mode(Mode::Baud(Baud::B9600), &[0x42, 0x52, 0x08]);
        mode(Mode::Baud(Baud::B38400), &[0x40, 0x50, 0x08]);
        mode(Mode::Baud(Baud::B500000), &[0x48, 0x58, 0x08]);
        is(Command::RequestScan, &[2, 0, 2, 0, 0x30, 1, 0x31, 0x18]);
        is(Command::RequestStatus, &[2, 0, 1, 0, 0x31, 0x15, 0x12]);
    }

    #[test]
    fn every_command_is_read_as_it_was_written() {
        let configuration = Configuration::new(RangeMode::Range16Fields, Unit::Millimetre);
        let commands = [
            Command::SetMode(Mode::Installation {
                password: DEFAULT_PASSWORD,
            }),
            Command::SetMode(Mode::Continuous),
            Command::SetMode(Mode::OnRequest),
            Command::SetMode(Mode::PartialScans),
            Command::SetMode(Mode::Baud(Baud::B19200)),
            Command::SetMode(Mode::Other(0x10)),
            Command::RequestScan,
            Command::RequestStatus,
            Command::RequestType,
            Command::SetVariant {
                width_deg: 180,
                resolution_raw_1e2_deg: 50,
            },
            Command::RequestConfiguration,
            Command::SetConfiguration(configuration),
            Command::Other(&[0x10]),
        ];
        let mut framer = CommandFramer::default();
        for command in commands {
            framer.push(&framed(&command));
            let frame = framer.next_frame().unwrap().unwrap();
            assert_eq!(frame.telegram, command);
        }
    }

    #[test]
    fn parameters_that_a_code_does_not_have_are_refused() {
        let refuse = |payload: &[u8], expected: &str| {
            let error = Command::read(payload).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(&[], "`code` takes 1 bytes");
        refuse(&[0x20, 0, 1], "`password` takes 8 bytes, 1 are left");
        refuse(
            &[0x30, 2],
            "byte 1 of the telegram: `kind` is 0x02, allowed is 1",
        );
        refuse(&[0x31, 0], "1 bytes follow the last field");
        refuse(&[0x77, 0, 0, 0, 0, 0, 9, 0], "`measuring mode` is 0x09");
    }
}
