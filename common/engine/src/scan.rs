//! One laser scan and its checks.

use std::f64::consts::TAU;

use messages::ScanHeader;

use crate::EngineError;

/// A borrowed scan in the laser's frame, as seen from above. Beams are numbered counter-clockwise,
/// for any direction of rotation of the laser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scan<'a> {
    /// Bearing of the first range, radians counter-clockwise from ahead.
    pub angle_min: f64,
    /// Angle from one range to the next, in radians; negative if they run clockwise.
    pub angle_increment: f64,
    /// Readings below this are no returns, in metres.
    pub range_min_m: f32,
    /// Readings at or above this are no returns, in metres: many drivers report this value if
    /// nothing came back.
    pub range_max_m: f32,
    /// Ranges in metres; NaN, infinite, zero and negative ones are no returns.
    pub ranges: &'a [f32],
}

/// Largest number of readings of a scan.
pub const MAX_RANGES: usize = 65_536;

impl<'a> Scan<'a> {
    /// Makes a scan from a message without copying; [`Scan::check`] has still to be called. The
    /// scan of a laser that hangs upside down is mirrored.
    #[must_use]
    pub fn of(header: &ScanHeader, ranges: &'a [f32]) -> Self {
        let as_measured = Scan {
            angle_min: header.angle_min,
            angle_increment: header.angle_increment,
            range_min_m: header.range_min_m,
            range_max_m: header.range_max_m,
            ranges,
        };
        as_measured.seen_from_above(header.upside_down == 1)
    }

    /// Converts a scan from the laser's own frame to the view from above: mirrors it if the laser
    /// hangs upside down.
    #[must_use]
    pub fn seen_from_above(self, is_upside_down: bool) -> Self {
        let side = if is_upside_down { -1.0 } else { 1.0 };
        Scan {
            angle_min: side * self.angle_min,
            angle_increment: side * self.angle_increment,
            ..self
        }
    }

    /// Checks the values that all readings share; single readings may have any value.
    ///
    /// # Errors
    /// If the scan is empty or too long, an angle is not finite, the increment
    /// is zero, the beams cover more than a turn, or the range limits
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
        if !angle_increment.is_finite() || angle_increment == 0.0 {
            return Err(EngineError::AngleIncrement(angle_increment));
        }
        // Drivers that close the turn send its first bearing twice, and store the increment in 32
        // bits: half a step more than that is accepted.
        let turns = (beams as f64 - 1.5) * angle_increment.abs() / TAU;
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

    /// Number of beams.
    pub fn beams(&self) -> usize {
        self.ranges.len()
    }

    /// Reading of beam `i` in metres; `None` if nothing came back.
    #[must_use]
    pub fn reading(&self, i: usize) -> Option<f64> {
        let range = *self.ranges.get(self.index(i))?;
        let returned = range.is_finite() && range > 0.0;
        (returned && range >= self.range_min_m && range < self.range_max_m)
            .then(|| f64::from(range))
    }

    /// Bearing of beam `i` in radians.
    #[must_use]
    pub fn bearing(&self, i: usize) -> f64 {
        self.bearing_between(i as f64)
    }

    /// Bearing between two beams, at a fractional index, in radians.
    pub(crate) fn bearing_between(&self, i: f64) -> f64 {
        let index = match self.angle_increment < 0.0 {
            true => (self.ranges.len() as f64 - 1.0) - i,
            false => i,
        };
        self.angle_min + index * self.angle_increment
    }

    /// Index of beam `i` among the ranges, which are in the order of measurement; beyond the last
    /// range for a beam that does not exist.
    pub(crate) fn index(&self, i: usize) -> usize {
        match self.angle_increment < 0.0 {
            true => self.ranges.len().checked_sub(i + 1).unwrap_or(usize::MAX),
            false => i,
        }
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

    #[test]
    fn says_what_is_wrong_with_a_scan() {
        let sound = scan(&[1.0; 3]);
        assert_eq!(sound.check(), Ok(()));
        let check = |scan: Scan<'_>, expected| assert_eq!(scan.check(), Err(expected));
        check(scan(&[]), EngineError::EmptyScan);
        let turned = |angle_increment| Scan {
            angle_increment,
            ..sound
        };
        check(turned(0.0), EngineError::AngleIncrement(0.0));
        let nowhere = Scan {
            angle_min: f64::NAN,
            ..sound
        };
        assert!(matches!(nowhere.check(), Err(EngineError::AngleMin(angle)) if angle.is_nan()));
        let (min, max) = (5.0, 1.0);
        let limited = Scan {
            range_min_m: min,
            range_max_m: max,
            ..sound
        };
        check(limited, EngineError::RangeLimits { min, max });
        for increment in [7.0, -7.0] {
            assert!(matches!(
                turned(increment).check(),
                Err(EngineError::FieldOfView { beams: 3, angle_increment, turns })
                    if angle_increment == increment && (turns - 1.67).abs() < 0.01
            ));
        }
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
    fn beams_run_counter_clockwise_whichever_way_the_laser_turns() {
        let clockwise = Scan {
            angle_min: 0.5,
            angle_increment: -0.25,
            ..scan(&[1.0, 2.0, 3.0])
        };
        assert_eq!(clockwise.check(), Ok(()));
        let beams: Vec<_> = (0..3)
            .map(|i| (clockwise.bearing(i), clockwise.reading(i)))
            .collect();
        assert_eq!(
            beams,
            [(0.0, Some(3.0)), (0.25, Some(2.0)), (0.5, Some(1.0))]
        );
        assert_eq!(clockwise.reading(3), None);
    }

    #[test]
    fn a_laser_upside_down_sees_its_left_on_the_right() {
        let header = ScanHeader {
            angle_min: -0.5,
            angle_increment: 0.25,
            range_max_m: 30.0,
            upside_down: 1,
            ..bytemuck::Zeroable::zeroed()
        };
        let mirrored = Scan::of(&header, &[1.0, 2.0]);
        assert_eq!(
            (mirrored.bearing(0), mirrored.reading(0)),
            (0.25, Some(2.0))
        );
        assert_eq!((mirrored.bearing(1), mirrored.reading(1)), (0.5, Some(1.0)));
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
            30.0,
            2.5,
        ];
        let scan = scan(&ranges);
        let readings: Vec<_> = (0..10).map(|i| scan.reading(i)).collect();
        assert_eq!(readings[..8], [None; 8]);
        assert_eq!(readings[8..], [Some(2.5), None]);
    }
}
