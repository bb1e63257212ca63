//! Answers of a device to commands.

use super::writer::Writer;
use super::{Encoding, Fault, ScanConfig, Value, Variable, lmd_scan_data};
use crate::SickError;
use crate::cursor::Cursor;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer<'a> {
    /// `sRA`: value of a variable.
    Value(Value<'a>),
    /// `sWA`: a variable was written.
    Written(Variable),
    /// `sAN SetAccessMode`: true if the login succeeded.
    AccessMode(bool),
    /// `sAN mLMPsetscancfg`: u8 status, 0 if the device now scans with `config`.
    ScanConfigSet {
        /// 0 done, 1 wrong frequency, 2 wrong resolution, 3 wrong resolution and field, 4 wrong
        /// field, 5 other error.
        status: u8,
        config: ScanConfig,
    },
    /// `sAN Run`: true if the device is running.
    Running(bool),
    /// `sEA LMDscandata`: true if the device now sends every scan.
    ScansSubscribed(bool),
    /// `sFA`: the device rejects the command.
    Fault(Fault),
}

impl<'a> Answer<'a> {
    /// Parses the parameters of an answer; `None` for an unsupported answer.
    pub(super) fn read(
        letters: &[u8; 3],
        name: &[u8],
        cursor: &mut Cursor<'a>,
    ) -> Result<Option<Self>, SickError> {
        let answer = match (letters, name, Variable::named(name)) {
            (b"sRA", _, Some(variable)) => Answer::Value(Value::read(variable, cursor)?),
            (b"sWA", _, Some(variable)) => Answer::Written(variable),
            (b"sAN", b"SetAccessMode", _) => Answer::AccessMode(cursor.bool("success")?),
            (b"sAN", b"mLMPsetscancfg", _) => Answer::ScanConfigSet {
                status: cursor.u8_upto("status", 5, "0 to 5")?,
                config: ScanConfig::read(cursor)?,
            },
            (b"sAN", b"Run", _) => Answer::Running(cursor.bool("success")?),
            (b"sEA", lmd_scan_data::NAME, _) => {
                Answer::ScansSubscribed(cursor.bool("start or stop")?)
            }
            _ => return Ok(None),
        };
        cursor.end()?;
        Ok(Some(answer))
    }

    /// Parses the error code after `sFA`: in CoLa B two bytes, with or without a leading space.
    pub(super) fn read_fault(encoding: Encoding, rest: &[u8]) -> Result<Self, SickError> {
        let code = match rest {
            [b' ', code @ ..] if encoding == Encoding::Text || rest.len() == 3 => code,
            code => code,
        };
        let mut cursor = Cursor::new(encoding, code, 3 + rest.len() - code.len());
        let fault = cursor.u16("error code")?;
        cursor.end()?;
        Ok(Answer::Fault(Fault(fault)))
    }

    pub fn write(&self, encoding: Encoding, out: &mut Vec<u8>) {
        match self {
            Answer::Value(value) => {
                let name = value.variable().name().as_bytes();
                value.write(&mut Writer::command(encoding, b"sRA", name, out));
            }
            Answer::Written(variable) => Writer::bare(b"sWA", variable.name().as_bytes(), out),
            Answer::AccessMode(success) => {
                Writer::command(encoding, b"sAN", b"SetAccessMode", out).bool(*success);
            }
            Answer::ScanConfigSet { status, config } => {
                let mut writer = Writer::command(encoding, b"sAN", b"mLMPsetscancfg", out);
                writer.u8(*status);
                config.write(&mut writer);
            }
            Answer::Running(success) => {
                Writer::command(encoding, b"sAN", b"Run", out).bool(*success);
            }
            Answer::ScansSubscribed(on) => {
                Writer::command(encoding, b"sEA", lmd_scan_data::NAME, out).bool(*on);
            }
            Answer::Fault(fault) => Writer::fault(encoding, fault.0, out),
        }
    }
}
