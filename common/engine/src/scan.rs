//! One laser scan, and what can be wrong with it.

use std::f64::consts::TAU;

use messages::ScanHeader;

use crate::EngineError;

/// A scan in the laser's frame, borrowed from wherever it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan<'a> {
    /// Bearing of the first beam, radians counter-clockwise from ahead.
    pub angle_min: f64,
    /// From one beam to the next, radians, above zero.
    pub angle_increment: f64,
    /// Readings below are no returns, metres.
    pub range_min_m: f32,
    /// Readings above are no returns, metres.
    pub range_max_m: f32,
    /// Metres; NaN, infinite, zero and negative ones are no returns.
    pub ranges: &'a [f32],
}

/// Most readings of a scan.
const MAX_RANGES: usize = 65_536;

impl<'a> Scan<'a> {
    /// The scan of a message, which is not copied; [`Scan::check`] is still to
    /// come.
    #[must_use]
    pub fn of(header: &ScanHeader, ranges: &'a [f32]) -> Self {
        Scan {
            angle_min: header.angle_min,
            angle_increment: header.angle_increment,
            range_min_m: header.range_min_m,
            range_max_m: header.range_max_m,
            ranges,
        }
    }

    /// Checks what all readings share; single readings may be anything.
    ///
    /// # Errors
    /// If the scan is empty or too long, an angle is not finite, the increment
    /// is not above zero, the beams cover more than a turn, or the range limits
    /// contradict each other.
    pub fn check(&self) -> Result<(), EngineError> {
        let beams = self.ranges.len();
        if beams == 0 {
            return Err(EngineError::EmptyScan);
        }
        if beams > MAX_RANGES {
            return Err(EngineError::TooManyRanges(beams));
        }
        if !self.angle_min.is_finite() || self.angle_min.abs() > 2.0 * TAU {
            return Err(EngineError::AngleMin(self.angle_min));
        }
        let angle_increment = self.angle_increment;
        if !angle_increment.is_finite() || angle_increment <= 0.0 {
            return Err(EngineError::AngleIncrement(angle_increment));
        }
        // Drivers that close the turn send its first bearing twice, and store
        // the increment in 32 bits: half a step more than that is let through.
        let turns = (beams as f64 - 1.5) * angle_increment / TAU;
        if turns > 1.0 {
            return Err(EngineError::FieldOfView {
                beams,
                angle_increment,
                turns,
            });
        }
        let (min, max) = (self.range_min_m, self.range_max_m);
        if !(min >= 0.0 && min < max) {
            return Err(EngineError::RangeLimits { min, max });
        }
        Ok(())
    }

    /// The reading of beam `i` in metres, if something came back.
    #[must_use]
    pub fn reading(&self, i: usize) -> Option<f64> {
        let range = *self.ranges.get(i)?;
        let returned = range.is_finite() && range > 0.0;
        (returned && range >= self.range_min_m && range <= self.range_max_m)
            .then(|| f64::from(range))
    }

    /// Bearing of beam `i` in radians.
    #[must_use]
    pub fn bearing(&self, i: usize) -> f64 {
        self.angle_min + i as f64 * self.angle_increment
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(ranges: &[f32]) -> Scan<'_> {
        Scan {
            angle_min: -1.0,
            angle_increment: 0.1,
            range_min_m: 0.1,
            range_max_m: 30.0,
            ranges,
        }
    }

    #[track_caller]
    fn check(scan: Scan<'_>, expected: &str) {
        assert_eq!(scan.check().unwrap_err().to_string(), expected);
    }

    #[test]
    fn says_what_is_wrong_with_a_scan() {
        let sound = scan(&[1.0; 3]);
        assert_eq!(sound.check(), Ok(()));
        check(scan(&[]), "the scan is empty: it has no ranges");
        check(
            Scan {
                angle_increment: 0.0,
                ..sound
            },
            "angle_increment is 0: it must be finite and above zero, in radians, counter-clockwise",
        );
        check(
            Scan {
                angle_increment: -0.1,
                ..sound
            },
            "angle_increment is -0.1: it must be finite and above zero, in radians, counter-clockwise",
        );
        check(
            Scan {
                angle_min: f64::NAN,
                ..sound
            },
            "angle_min is NaN: it must be finite, in radians, within two turns",
        );
        check(
            Scan {
                range_min_m: 5.0,
                range_max_m: 1.0,
                ..sound
            },
            "range_min 5 and range_max 1: 0 <= range_min < range_max is needed, in metres",
        );
        check(
            Scan {
                angle_increment: 7.0,
                ..sound
            },
            "3 beams of 7 rad cover 1.67 turns: at most one is allowed",
        );
    }

    #[test]
    fn a_closed_turn_may_repeat_its_first_bearing() {
        let increment = f64::from((TAU / 360.0) as f32);
        let closed = Scan {
            angle_increment: increment,
            ..scan(&[1.0; 361])
        };
        assert_eq!(closed.check(), Ok(()));
    }

    #[test]
    fn readings_that_say_nothing_are_none() {
        let ranges = [
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            -1.0,
            0.0,
            0.05,
            30.5,
            2.5,
        ];
        let scan = scan(&ranges);
        let readings: Vec<_> = (0..9).map(|i| scan.reading(i)).collect();
        assert_eq!(readings[..7], [None; 7]);
        assert_eq!(readings[7..], [Some(2.5), None]);
    }
}
