//! Configuration that can be read, changed in installation mode and written back.

use super::range_mode::{RangeMode, Unit};
use crate::SickError;
use crate::cursor::Cursor;

/// Largest size in bytes; devices differ in how much they send.
const LONGEST: usize = 64;
const MODE: usize = 5;
const UNIT: usize = 6;

/// `F4` and `F7`, from the first byte after the code. Bytes not named here are kept unchanged.
///
/// | offset | bytes | field | |
/// |---|---|---|---|
/// | 0 | 2 | blanking | u16 |
/// | 2 | 1 | stop threshold | u8 |
/// | 3 | 1 | peak threshold or sensitivity | u8 |
/// | 4 | 1 | availability | bit 1: counters behind the readings |
/// | 5 | 1 | measuring mode | see [`RangeMode`] |
/// | 6 | 1 | unit | see [`Unit`] |
/// | 7 | … | fields, restart, contours | 27 bytes on most devices |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Configuration {
    bytes: [u8; LONGEST],
    length: usize,
    /// Measuring mode, which sets the longest range.
    pub range_mode: RangeMode,
    pub unit: Unit,
}

impl Configuration {
    /// Returns the configuration of a device with only these two values set.
    pub fn new(range_mode: RangeMode, unit: Unit) -> Self {
        Configuration {
            bytes: [0; LONGEST],
            length: 34,
            range_mode,
            unit,
        }
    }

    pub(super) fn read(fields: &mut Cursor<'_>) -> Result<Self, SickError> {
        let all = fields.rest();
        let length = all.len().min(LONGEST);
        let mut bytes = [0; LONGEST];
        let kept = bytes.iter_mut().zip(all);
        kept.for_each(|(place, byte)| *place = *byte);
        fields.take("blanking and thresholds", MODE)?;
        let range_mode = RangeMode::read(fields)?;
        let unit = Unit::read(fields)?;
        fields.take("the rest", length.saturating_sub(UNIT + 1))?;
        // These two are stored only in the fields that may be changed.
        bytes[MODE] = 0;
        bytes[UNIT] = 0;
        Ok(Configuration {
            bytes,
            length,
            range_mode,
            unit,
        })
    }

    pub(super) fn write(&self, out: &mut Vec<u8>) {
        let mut bytes = self.bytes;
        bytes[MODE] = self.range_mode.code();
        bytes[UNIT] = self.unit.code();
        out.extend(bytes.iter().take(self.length));
    }
}
