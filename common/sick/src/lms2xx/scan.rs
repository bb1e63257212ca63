//! Measured values: whole scans and partial ones.

use super::range_mode::Unit;
use crate::SickError;
use crate::cola::Values;
use crate::cursor::{Cursor, field_error};

/// Mask of the count: bits 0 to 9 of the head.
const COUNT: u16 = 0x03ff;
/// Flag of a partial scan: bit 13 of the head.
const IS_PARTIAL: u16 = 1 << 13;

/// Measured values: `B0`.
///
/// | bytes | field | |
/// |---|---|---|
/// | 1 | code | `B0` |
/// | 2 | head | bits 0–9 count, 11–12 partial scan, 13 whether it is one, 14–15 unit |
/// | 2 · count | readings | u16 each, right to left |
/// | 2 | counters of scan and telegram | u8 each, if the device is set to send them |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan<'a> {
    pub unit: Unit,
    /// Start of a partial scan, which has one value per degree: 0 to 3 quarters of a degree.
    pub part: Option<u8>,
    /// Readings, right to left; at most 401 fit into a telegram.
    pub readings: Values<'a>,
    /// Counters of scans and of telegrams, if the device sends them.
    pub counters: Option<(u8, u8)>,
}

impl<'a> Scan<'a> {
    pub fn new(unit: Unit, readings: &'a [u16]) -> Self {
        Scan {
            unit,
            part: None,
            readings: readings.into(),
            counters: None,
        }
    }

    pub(super) fn read(fields: &mut Cursor<'a>) -> Result<Self, SickError> {
        let offset = fields.offset();
        let head = fields.u16("count and unit")?;
        let unit = (head >> 14) as u8;
        let refused = || field_error("unit", offset, &unit, "0 or 1");
        let unit = Unit::from_code(unit).ok_or_else(refused)?;
        let readings = fields.take("readings", usize::from(head & COUNT) * 2)?;
        let counters = match fields.rest() {
            [] => None,
            _ => Some((
                fields.u8("counter of scans")?,
                fields.u8("counter of telegrams")?,
            )),
        };
        Ok(Scan {
            unit,
            part: (head & IS_PARTIAL != 0).then_some((head >> 11 & 3) as u8),
            readings: Values::little_endian(readings),
            counters,
        })
    }

    pub(super) fn write(&self, out: &mut Vec<u8>) {
        let mut u16 = |value: u16| out.extend_from_slice(&value.to_le_bytes());
        let part = self
            .part
            .map_or(0, |quarter| IS_PARTIAL | u16::from(quarter & 3) << 11);
        let count = self.readings.len() as u16 & COUNT;
        u16(count | part | u16::from(self.unit.code()) << 14);
        self.readings.for_each(u16);
        if let Some((scan, telegram)) = self.counters {
            out.extend_from_slice(&[scan, telegram]);
        }
    }
}
