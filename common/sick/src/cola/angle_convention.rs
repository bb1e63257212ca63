//! Conversion of a device's own angles to bearings from straight ahead.

use super::{Channel, OutputRange};

/// Zero point and direction of a device's angle scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleConvention {
    /// Device angle that points straight ahead, degrees.
    pub ahead_deg: f64,
    /// True if the device's angles grow clockwise, seen from above.
    pub clockwise: bool,
}

impl AngleConvention {
    /// Convention of most SICK devices: 0° is to the right, and angles grow counter-clockwise, so
    /// 90° is ahead.
    pub const USUAL: AngleConvention = AngleConvention {
        ahead_deg: 90.0,
        clockwise: false,
    };

    /// Returns the bearing of a device angle: degrees counter-clockwise from ahead.
    pub fn bearing_deg(self, device_deg: f64) -> f64 {
        match self.clockwise {
            true => self.ahead_deg - device_deg,
            false => device_deg - self.ahead_deg,
        }
    }

    /// Returns the bearing of the rightmost beam, from which the others follow counter-clockwise.
    /// Whole turns are removed so that the middle of the field is within 180° of ahead.
    pub fn rightmost_bearing_deg(self, field: Field) -> f64 {
        let rightmost_deg = self.bearing_deg(match self.clockwise {
            true => field.last_deg,
            false => field.first_deg,
        });
        let middle_deg = self.bearing_deg(field.middle_deg());
        match middle_deg.abs() <= 180.0 {
            true => rightmost_deg,
            false => rightmost_deg - 360.0 * (middle_deg / 360.0).round(),
        }
    }
}

impl std::fmt::Display for AngleConvention {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let direction = match self.clockwise {
            true => "clockwise",
            false => "counter-clockwise",
        };
        write!(f, "{}° is ahead, angles grow {direction}", self.ahead_deg)
    }
}

/// Angles that a scan covers, in device degrees, the smaller one first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    pub first_deg: f64,
    pub last_deg: f64,
}

impl Field {
    pub fn of(channel: &Channel<'_>) -> Self {
        let first_deg = f64::from(channel.start_angle_raw_1e4_deg) * 1e-4;
        let steps = channel.values.len().saturating_sub(1) as f64;
        Field {
            first_deg,
            last_deg: first_deg + steps * (f64::from(channel.step_raw_1e4_deg) * 1e-4),
        }
    }

    pub fn measured(range: &OutputRange) -> Self {
        Field {
            first_deg: f64::from(range.start_angle_raw_1e4_deg) * 1e-4,
            last_deg: f64::from(range.stop_angle_raw_1e4_deg) * 1e-4,
        }
    }

    pub fn middle_deg(self) -> f64 {
        0.5 * (self.first_deg + self.last_deg)
    }
}

impl std::fmt::Display for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // A hundredth of a degree is finer than the steps of these devices.
        let round = |deg: f64| (deg * 100.0).round() / 100.0;
        write!(f, "{}° to {}°", round(self.first_deg), round(self.last_deg))
    }
}

/// Returns the time that a device takes from the first value of a scan to the last, microseconds; 0
/// if it does not report its scan frequency.
pub fn sweep_us(channel: &Channel<'_>, scan_frequency_raw_1e2_hz: u32) -> i64 {
    if scan_frequency_raw_1e2_hz == 0 {
        return 0;
    }
    let field = Field::of(channel);
    let turns = (field.last_deg - field.first_deg) / 360.0;
    (turns * 1e8 / f64::from(scan_frequency_raw_1e2_hz)).round() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCKWISE: AngleConvention = AngleConvention {
        ahead_deg: 180.0,
        clockwise: true,
    };

    fn field(first_deg: f64, last_deg: f64) -> Field {
        Field {
            first_deg,
            last_deg,
        }
    }

    #[test]
    fn beams_begin_at_the_right_and_near_ahead() {
        let usual = AngleConvention::USUAL;
        assert_eq!(usual.rightmost_bearing_deg(field(-45.0, 225.0)), -135.0);
        assert_eq!(usual.rightmost_bearing_deg(field(0.0, 90.0)), -90.0);
        assert_eq!(CLOCKWISE.rightmost_bearing_deg(field(0.0, 359.75)), -179.75);
        assert_eq!(CLOCKWISE.rightmost_bearing_deg(field(30.0, 330.0)), -150.0);
        // The same geometry on a device that starts counting half a turn earlier.
        let other = AngleConvention {
            ahead_deg: 180.0,
            clockwise: false,
        };
        assert_eq!(other.rightmost_bearing_deg(field(-170.0, -10.0)), 10.0);
    }

    #[test]
    fn the_mirror_shows_how_long_a_scan_takes() {
        let values = [0; 181];
        let channel = Channel {
            name: *b"DIST1",
            scale_factor: 1.0,
            scale_offset: 0.0,
            start_angle_raw_1e4_deg: 0,
            step_raw_1e4_deg: 10_000,
            values: values[..].into(),
        };
        assert_eq!(sweep_us(&channel, 2500), 20_000);
        assert_eq!(sweep_us(&channel, 0), 0);
        assert_eq!(Field::of(&channel).to_string(), "0° to 180°");
    }
}
