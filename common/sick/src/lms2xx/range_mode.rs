//! Meaning of the 16 bits of a reading.
//!
//! The lower bits are the distance, the upper ones are field, dazzle or reflectivity bits, and the
//! nine largest distances are codes: 1FFF not valid, 1FFE dazzled, 1FFD overflow, 1FFB too noisy,
//! 1FFA channel failed, 1FF7 too far, and correspondingly in the other modes (SICK, "Telegrams for
//! configuring and operating the LMS 2xx").

use crate::SickError;
use crate::cursor::Cursor;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Unit {
    #[default]
    Centimetre,
    Millimetre,
}

impl Unit {
    pub(super) fn read(fields: &mut Cursor<'_>) -> Result<Self, SickError> {
        fields.known("unit", Self::from_code, "0 or 1")
    }

    pub const fn code(self) -> u8 {
        self as u8
    }

    pub const fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Unit::Centimetre),
            1 => Some(Unit::Millimetre),
            _ => None,
        }
    }

    pub const fn metres(self) -> f64 {
        match self {
            Unit::Centimetre => 0.01,
            Unit::Millimetre => 0.001,
        }
    }
}

/// Measuring mode: longest range and meaning of the upper bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum RangeMode {
    /// 8 m in millimetres or 80 m in centimetres; fields A, B and dazzle.
    Range8Fields = 0,
    /// The same range; reflectivity in eight levels.
    Range8Reflectivity = 1,
    /// The same range; fields A, B and C.
    Range8ThreeFields = 2,
    /// 16 m; reflectivity in four levels.
    Range16Reflectivity = 3,
    /// 16 m; fields A and B.
    Range16Fields = 4,
    /// 32 m; reflectivity in two levels.
    Range32Reflectivity = 5,
    /// 32 m; field A.
    Range32Field = 6,
    /// 32 m; sent at once, no other bits.
    Range32Immediate = 0x0f,
    /// Amplitudes of the echo, no distances.
    Amplitude = 0x3f,
}

impl RangeMode {
    pub(super) fn read(fields: &mut Cursor<'_>) -> Result<Self, SickError> {
        fields.known("measuring mode", Self::from_code, "0 to 6, 0x0f or 0x3f")
    }

    pub const ALL: [RangeMode; 9] = [
        RangeMode::Range8Fields,
        RangeMode::Range8Reflectivity,
        RangeMode::Range8ThreeFields,
        RangeMode::Range16Reflectivity,
        RangeMode::Range16Fields,
        RangeMode::Range32Reflectivity,
        RangeMode::Range32Field,
        RangeMode::Range32Immediate,
        RangeMode::Amplitude,
    ];

    pub const fn code(self) -> u8 {
        self as u8
    }

    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.code() == code)
    }

    /// Returns the mask of the distance bits; 0 for amplitudes.
    pub const fn mask(self) -> u16 {
        match self {
            RangeMode::Range8Fields
            | RangeMode::Range8Reflectivity
            | RangeMode::Range8ThreeFields => 0x1fff,
            RangeMode::Range16Reflectivity | RangeMode::Range16Fields => 0x3fff,
            RangeMode::Range32Reflectivity
            | RangeMode::Range32Field
            | RangeMode::Range32Immediate => 0x7fff,
            RangeMode::Amplitude => 0,
        }
    }

    /// Returns the largest distance; larger values are codes.
    pub const fn last_distance(self) -> u16 {
        self.mask().saturating_sub(9)
    }

    /// Returns the distance in a reading, or `None` if there was no echo.
    pub const fn distance(self, reading: u16) -> Option<u16> {
        let distance = reading & self.mask();
        if distance > self.last_distance() || self.mask() == 0 {
            return None;
        }
        Some(distance)
    }

    /// Encodes a distance as a reading; `None` means no echo.
    pub const fn reading(self, distance: Option<u16>) -> u16 {
        match distance {
            Some(distance) if distance <= self.last_distance() => distance,
            // Too far.
            Some(_) => self.mask().saturating_sub(8),
            // Not valid.
            None => self.mask(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_values_are_codes_in_every_mode() {
        let eight = RangeMode::Range8Fields;
        assert_eq!(eight.distance(8182), Some(8182));
        assert_eq!(eight.distance(8183), None);
        assert_eq!(eight.distance(0xffff), None);
        // Field and dazzle bits above the distance.
        assert_eq!(eight.distance(0xe000 | 1234), Some(1234));
        assert_eq!(RangeMode::Range16Fields.distance(0x4000 | 8191), Some(8191));
        assert_eq!(RangeMode::Range32Immediate.distance(0x7ff6), Some(0x7ff6));
        assert_eq!(RangeMode::Range32Immediate.distance(0x7ff7), None);
        assert_eq!(RangeMode::Amplitude.distance(7), None);
    }

    #[test]
    fn readings_and_codes_are_inverse() {
        for mode in RangeMode::ALL {
            assert_eq!(RangeMode::from_code(mode.code()), Some(mode));
            assert_eq!(mode.distance(mode.reading(None)), None);
            assert_eq!(mode.distance(mode.reading(Some(u16::MAX))), None);
            if mode != RangeMode::Amplitude {
                let last = mode.last_distance();
                assert_eq!(mode.distance(mode.reading(Some(last))), Some(last));
            }
        }
        assert_eq!(RangeMode::from_code(7), None);
        assert_eq!(
            Unit::from_code(Unit::Millimetre.code()),
            Some(Unit::Millimetre)
        );
    }
}
