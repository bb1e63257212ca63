//! The variables of a device that are understood.

use super::cursor::{Cursor, field_error};
use super::writer::Writer;
use super::{OutputRange, ScanConfig, ScanDataConfig};
use crate::SickError;

/// A variable by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// `DeviceIdent`: what the device is.
    DeviceIdent,
    /// `SCdevicestate`: whether it is ready.
    DeviceState,
    /// `LMPscancfg`: how it scans.
    ScanConfig,
    /// `LMDscandatacfg`: what scan telegrams carry.
    ScanDataConfig,
    /// `LMPoutputRange`: which part of a scan is sent.
    OutputRange,
    /// `EIHstCola`: which encoding the host's port speaks.
    HostEncoding,
}

impl Variable {
    /// All that are understood.
    pub const ALL: [Variable; 6] = [
        Variable::DeviceIdent,
        Variable::DeviceState,
        Variable::ScanConfig,
        Variable::ScanDataConfig,
        Variable::OutputRange,
        Variable::HostEncoding,
    ];

    /// As it is written in telegrams.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Variable::DeviceIdent => "DeviceIdent",
            Variable::DeviceState => "SCdevicestate",
            Variable::ScanConfig => "LMPscancfg",
            Variable::ScanDataConfig => "LMDscandatacfg",
            Variable::OutputRange => "LMPoutputRange",
            Variable::HostEncoding => "EIHstCola",
        }
    }

    pub(super) fn named(name: &[u8]) -> Option<Self> {
        let mut all = Variable::ALL.into_iter();
        all.find(|variable| variable.name().as_bytes() == name)
    }
}

/// What a variable holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Value<'a> {
    /// Name and version: u16 length and characters, each.
    DeviceIdent {
        /// Such as `LMS10x_FieldEval`.
        name: &'a [u8],
        /// Of the firmware.
        version: &'a [u8],
    },
    /// u8: 0 busy, 1 ready, 2 error, 3 standby.
    DeviceState(u8),
    /// See [`ScanConfig`].
    ScanConfig(ScanConfig),
    /// See [`ScanDataConfig`].
    ScanDataConfig(ScanDataConfig),
    /// See [`OutputRange`].
    OutputRange(OutputRange),
    /// u8: whether it is CoLa B.
    HostEncoding(bool),
}

/// A device state in a word.
#[must_use]
pub fn state_word(state: u8) -> &'static str {
    let words = ["busy", "ready", "error", "standby"];
    words.get(usize::from(state)).copied().unwrap_or("unknown")
}

impl<'a> Value<'a> {
    /// Whose value this is.
    #[must_use]
    pub fn variable(&self) -> Variable {
        match self {
            Value::DeviceIdent { .. } => Variable::DeviceIdent,
            Value::DeviceState(_) => Variable::DeviceState,
            Value::ScanConfig(_) => Variable::ScanConfig,
            Value::ScanDataConfig(_) => Variable::ScanDataConfig,
            Value::OutputRange(_) => Variable::OutputRange,
            Value::HostEncoding(_) => Variable::HostEncoding,
        }
    }

    pub(super) fn read(variable: Variable, cursor: &mut Cursor<'a>) -> Result<Self, SickError> {
        let value = match variable {
            Variable::DeviceIdent => Value::DeviceIdent {
                name: text(cursor, "name of the device")?,
                version: text(cursor, "version of the device")?,
            },
            Variable::DeviceState => {
                Value::DeviceState(cursor.u8_upto("device state", 3, "0 to 3")?)
            }
            Variable::ScanConfig => Value::ScanConfig(ScanConfig::read(cursor)?),
            Variable::ScanDataConfig => Value::ScanDataConfig(ScanDataConfig::read(cursor)?),
            Variable::OutputRange => Value::OutputRange(OutputRange::read(cursor)?),
            Variable::HostEncoding => Value::HostEncoding(cursor.bool("encoding")?),
        };
        cursor.end()?;
        Ok(value)
    }

    pub(super) fn write(&self, writer: &mut Writer<'_>) {
        match self {
            Value::DeviceIdent { name, version } => {
                for text in [name, version] {
                    writer.u16(text.len() as u16);
                    writer.characters(text);
                }
            }
            Value::DeviceState(state) => writer.u8(*state),
            Value::ScanConfig(config) => config.write(writer),
            Value::ScanDataConfig(config) => config.write(writer),
            Value::OutputRange(range) => range.write(writer),
            Value::HostEncoding(binary) => writer.bool(*binary),
        }
    }
}

/// The longest name of a device that is believed.
const LONGEST_TEXT: u16 = 256;

fn text<'a>(cursor: &mut Cursor<'a>, field: &'static str) -> Result<&'a [u8], SickError> {
    let offset = cursor.offset();
    let length = cursor.u16(field)?;
    if length > LONGEST_TEXT {
        let allowed = "at most 256 characters";
        return Err(field_error(field, offset, &length, allowed));
    }
    cursor.characters(field, usize::from(length))
}
