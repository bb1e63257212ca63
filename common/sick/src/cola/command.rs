//! Commands that a host sends.

use super::writer::Writer;
use super::{Encoding, ScanConfig, Value, Variable, lmd_scan_data};
use crate::SickError;
use crate::cursor::Cursor;

/// User level that may change settings.
pub const AUTHORIZED_CLIENT: u8 = 3;

/// Password hash of that level in the factory settings (`client`).
pub const PASSWORD_AUTHORIZED_CLIENT: u32 = 0xf472_4744;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command<'a> {
    /// `sRN`: read a variable.
    Read(Variable),
    /// `sWN`: write a variable.
    Write(Value<'a>),
    /// `sMN`: call a method.
    Call(Method),
    /// `sEN LMDscandata`: start or stop sending every scan.
    SubscribeScans(bool),
}

/// A method and its arguments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// `SetAccessMode`: log in.
    SetAccessMode {
        /// 2 maintenance, 3 authorized client, 4 service.
        level: u8,
        /// Hash of the level's password.
        password: u32,
    },
    /// `mLMPsetscancfg`: change how the device scans.
    SetScanConfig(ScanConfig),
    /// `Run`: leave set-up and log out.
    Run,
}

impl Method {
    pub(super) const fn name(&self) -> &'static str {
        match self {
            Method::SetAccessMode { .. } => "SetAccessMode",
            Method::SetScanConfig(_) => "mLMPsetscancfg",
            Method::Run => "Run",
        }
    }

    fn read(name: &[u8], cursor: &mut Cursor<'_>) -> Result<Option<Self>, SickError> {
        let method = match name {
            b"SetAccessMode" => Method::SetAccessMode {
                level: cursor.u8("user level")?,
                password: cursor.u32("password")?,
            },
            b"mLMPsetscancfg" => Method::SetScanConfig(ScanConfig::read(cursor)?),
            b"Run" => Method::Run,
            _ => return Ok(None),
        };
        cursor.end()?;
        Ok(Some(method))
    }

    fn write(&self, encoding: Encoding, out: &mut Vec<u8>) {
        let name = self.name().as_bytes();
        match self {
            Method::SetAccessMode { level, password } => {
                let mut writer = Writer::command(encoding, b"sMN", name, out);
                writer.u8(*level);
                writer.u32(*password);
            }
            Method::SetScanConfig(config) => {
                config.write(&mut Writer::command(encoding, b"sMN", name, out));
            }
            Method::Run => Writer::bare(b"sMN", name, out),
        }
    }
}

impl<'a> Command<'a> {
    /// Parses the parameters of a command; `None` for an unsupported command.
    pub(super) fn read(
        letters: &[u8; 3],
        name: &[u8],
        cursor: &mut Cursor<'a>,
    ) -> Result<Option<Self>, SickError> {
        let variable = Variable::named(name);
        Ok(match (letters, variable) {
            (b"sRN", Some(variable)) => {
                cursor.end()?;
                Some(Command::Read(variable))
            }
            (b"sWN", Some(variable)) => Some(Command::Write(Value::read(variable, cursor)?)),
            (b"sMN", _) => Method::read(name, cursor)?.map(Command::Call),
            (b"sEN", _) if name == lmd_scan_data::NAME => {
                let on = cursor.bool("start or stop")?;
                cursor.end()?;
                Some(Command::SubscribeScans(on))
            }
            _ => None,
        })
    }

    pub fn write(&self, encoding: Encoding, out: &mut Vec<u8>) {
        match self {
            Command::Read(variable) => Writer::bare(b"sRN", variable.name().as_bytes(), out),
            Command::Write(value) => {
                let name = value.variable().name().as_bytes();
                value.write(&mut Writer::command(encoding, b"sWN", name, out));
            }
            Command::Call(method) => method.write(encoding, out),
            Command::SubscribeScans(on) => {
                Writer::command(encoding, b"sEN", lmd_scan_data::NAME, out).bool(*on);
            }
        }
    }
}
