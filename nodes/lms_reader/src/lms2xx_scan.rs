//! Converts the readings of an LMS2xx to the message of topic `scan`.
//!
//! Pure: the caller passes the time of reception. It only distinguishes distances from codes.

use messages::ScanHeader;
use sick::cola::USUAL_REACH_M;
use sick::lms2xx::Scan;

use crate::LmsError;
use crate::lms2xx_setup::Format;
use crate::scan::{Beams, Received, ScanSettings};

/// Time of one turn of the mirror, seconds: it turns 75 times per second.
const TURN_S: f64 = 1.0 / 75.0;

#[derive(Debug, Clone, Copy)]
pub(crate) struct WholeScan<'a> {
    pub(crate) format: Format,
    pub(crate) scan: Scan<'a>,
    /// Time of the telegram on the serial line, nanoseconds.
    pub(crate) line_ns: i64,
}

impl WholeScan<'_> {
    pub(crate) fn len(&self) -> usize {
        self.scan.readings.len()
    }

    /// Returns the header of the scan, with counter 0.
    ///
    /// The stamp is the time of reception minus the time on the line and the time of the scan.
    /// Below one degree the mirror turns several times per scan, so the beams are not in order of
    /// time.
    pub(crate) fn header(
        &self,
        settings: &ScanSettings,
        received: Received,
    ) -> Result<ScanHeader, LmsError> {
        let Format {
            width_deg,
            resolution_raw_1e2_deg: step,
            ..
        } = self.format;
        let expected = usize::from(width_deg) * 100 / usize::from(step.max(1)) + 1;
        if self.len() != expected {
            return Err(LmsError::Other(format!(
                "the device sent {} readings, {width_deg}° at {step}/100° are {expected}",
                self.len()
            )));
        }
        let step_deg = f64::from(step) * 0.01;
        let start_deg = -0.5 * f64::from(width_deg);
        let turns = 100.0 / f64::from(step);
        let scan_time_s = TURN_S * turns;
        let before_ns = self.line_ns + (scan_time_s * 1e9) as i64;
        let beams = Beams {
            angle_min: start_deg.to_radians(),
            angle_increment: step_deg.to_radians(),
            time_increment_s: if turns == 1.0 { TURN_S / 360.0 } else { 0.0 },
            scan_time_s,
        };
        let measured_ns = received.realtime_ns - before_ns;
        Ok(settings.header(&beams, measured_ns, received.monotonic_ns, USUAL_REACH_M))
    }

    /// Writes the distances in metres, infinity for no return; `ranges` has one element per
    /// reading.
    pub(crate) fn fill_ranges(&self, ranges: &mut [f32]) {
        let metres = self.scan.unit.metres();
        for (range, reading) in ranges.iter_mut().zip(self.scan.readings) {
            let distance = self.format.range_mode.distance(reading);
            *range = distance.map_or(f32::INFINITY, |d| (f64::from(d) * metres) as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use sick::lms2xx::{RangeMode, Unit};

    use super::*;
    use crate::scan::tests::{RECEIVED, settings};

    fn scan(readings: &[u16], width_deg: u16, resolution_raw_1e2_deg: u16) -> WholeScan<'_> {
        WholeScan {
            format: Format {
                range_mode: RangeMode::Range8Fields,
                width_deg,
                resolution_raw_1e2_deg,
            },
            scan: Scan::new(Unit::Centimetre, readings),
            line_ns: 1_000_000,
        }
    }

    #[test]
    fn the_middle_reading_is_ahead() {
        for (count, width, step) in [(361, 180, 50), (181, 180, 100), (401, 100, 25)] {
            let readings = vec![0; count];
            let header = scan(&readings, width, step)
                .header(&settings(), RECEIVED)
                .unwrap();
            let middle = header.angle_min + (count / 2) as f64 * header.angle_increment;
            // Single precision has 24 bits, and so have the steps to the middle.
            assert!(middle.abs() < 3e-7, "{middle}");
        }
    }

    #[test]
    fn codes_and_field_bits_are_no_distances() {
        let readings = [0, 1, 0xe000 | 1234, 8182, 8183, 0x1fff];
        let mut ranges = [0.0; 6];
        scan(&readings, 180, 100).fill_ranges(&mut ranges);
        let inf = f32::INFINITY;
        assert_eq!(ranges, [0.0, 0.01, 12.34, 81.82, inf, inf]);
    }

    #[test]
    fn the_stamp_is_back_at_the_first_beam() {
        let readings = [0; 361];
        let header = scan(&readings, 180, 50)
            .header(&settings(), RECEIVED)
            .unwrap();
        // One millisecond on the line and two turns of the mirror.
        let before = RECEIVED.realtime_ns - header.stamp.measured_ns;
        assert_eq!((before, header.stamp.entered_ns), (27_666_666, 77));
        assert_eq!(header.time_increment_s, 0.0);
    }

    #[test]
    fn another_number_of_readings_is_refused() {
        let error = scan(&[0; 91], 180, 100)
            .header(&settings(), RECEIVED)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("91 readings, 180° at 100/100° are 181"),
            "{error}"
        );
    }
}
