//! Device state: the status byte after every answer, and the long status.

use super::range_mode::{RangeMode, Unit};
use crate::SickError;
use crate::cursor::Cursor;

/// Status byte after every answer.
///
/// | bits | |
/// |---|---|
/// | 0–2 | 0 in order, 1 information, 2 warning, 3 error, 4 fatal error |
/// | 6 | implausible measured values |
/// | 7 | the window is dirty |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status(pub u8);

impl Status {
    /// Returns the severity: 0 ok, 1 information, 2 warning, 3 error, 4 fatal error.
    pub const fn level(self) -> u8 {
        self.0 & 7
    }

    pub const fn is_implausible(self) -> bool {
        self.0 & 1 << 6 != 0
    }

    pub const fn is_polluted(self) -> bool {
        self.0 & 1 << 7 != 0
    }

    /// Returns true if neither an error nor a dirty window affects the readings.
    pub const fn is_in_order(self) -> bool {
        self.level() < 3 && !self.is_implausible() && !self.is_polluted()
    }
}

/// `B1`, reduced to the fields used here. Offsets count from the code.
///
/// | offset | bytes | field | |
/// |---|---|---|---|
/// | 1 | 7 | version of the software | characters |
/// | 8 | 1 | operating mode | see [`super::Mode`] |
/// | 9 | 1 | whether there is an error | u8 |
/// | 67 | 2 | turns of the mirror | u16, 1/min |
/// | 102 | 1 | measuring mode | see [`RangeMode`] |
/// | 107 | 2 | field | u16, degrees |
/// | 109 | 2 | resolution | u16, 1/100° |
/// | 122 | 1 | unit | see [`Unit`] |
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeviceStatus {
    pub version: [u8; 7],
    pub mode: u8,
    pub has_error: bool,
    pub turns: u16,
    pub range_mode: RangeMode,
    pub width_deg: u16,
    pub resolution_raw_1e2_deg: u16,
    pub unit: Unit,
}

/// Length of the answer without its status byte.
const LENGTH: usize = 150;

impl DeviceStatus {
    pub(super) fn read(fields: &mut Cursor<'_>) -> Result<Self, SickError> {
        let status = DeviceStatus {
            version: fields.array("version")?,
            mode: fields.u8("operating mode")?,
            has_error: fields.u8("error")? != 0,
            turns: fields.skip_to(67)?.u16("turns")?,
            range_mode: RangeMode::read(fields.skip_to(102)?)?,
            width_deg: fields.skip_to(107)?.u16("field")?,
            resolution_raw_1e2_deg: fields.u16("resolution")?,
            unit: Unit::read(fields.skip_to(122)?)?,
        };
        fields.take("the rest", fields.rest().len())?;
        Ok(status)
    }

    /// Writes fields that are not modelled as 0.
    pub(super) fn write(&self, out: &mut Vec<u8>) {
        let start = out.len() - 1;
        out.resize(start + LENGTH, 0);
        let mut put = |at: usize, bytes: &[u8]| {
            let place = out.get_mut(start + at..start + at + bytes.len());
            place.unwrap_or_default().copy_from_slice(bytes);
        };
        put(1, &self.version);
        put(8, &[self.mode, self.has_error.into()]);
        put(67, &self.turns.to_le_bytes());
        put(102, &[self.range_mode.code()]);
        put(107, &self.width_deg.to_le_bytes());
        put(109, &self.resolution_raw_1e2_deg.to_le_bytes());
        put(122, &[self.unit.code()]);
    }
}
