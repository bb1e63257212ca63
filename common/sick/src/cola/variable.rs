//! Variables of a device that are supported.

use super::writer::Writer;
use super::{OutputRange, ScanConfig, ScanDataConfig};
use crate::SickError;
use crate::cursor::Cursor;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variable {
    /// `DeviceIdent`: name and firmware version.
    DeviceIdent,
    /// `SCdevicestate`: busy, ready, error or standby.
    DeviceState,
    /// `LMPscancfg`: scan configuration.
    ScanConfig,
    /// `LMDscandatacfg`: content of scan telegrams.
    ScanDataConfig,
    /// `LMPoutputRange`: part of a scan that is sent.
    OutputRange,
    /// `EIHstCola`: encoding of the host port.
    HostEncoding,
}

impl Variable {
    pub const ALL: [Variable; 6] = [
        Variable::DeviceIdent,
        Variable::DeviceState,
        Variable::ScanConfig,
        Variable::ScanDataConfig,
        Variable::OutputRange,
        Variable::HostEncoding,
    ];

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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Value<'a> {
    /// Name and version, each a u16 length and characters.
    DeviceIdent {
        /// Name such as `LMS10x_FieldEval`.
        name: &'a [u8],
        version: &'a [u8],
    },
    /// u8: 0 busy, 1 ready, 2 error, 3 standby.
    DeviceState(u8),
    ScanConfig(ScanConfig),
    ScanDataConfig(ScanDataConfig),
    OutputRange(OutputRange),
    /// u8: true for CoLa B.
    HostEncoding(bool),
}

/// Returns the word for a device state.
pub fn state_word(state: u8) -> &'static str {
    let words = ["busy", "ready", "error", "standby"];
    words.get(usize::from(state)).copied().unwrap_or("unknown")
}

impl<'a> Value<'a> {
    /// Returns the variable that holds this value.
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

fn text<'a>(cursor: &mut Cursor<'a>, field: &'static str) -> Result<&'a [u8], SickError> {
    let length = cursor.u16_upto(field, 256, "at most 256 characters")?;
    cursor.characters(field, usize::from(length))
}
