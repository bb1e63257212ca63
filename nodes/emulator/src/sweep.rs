//! The recorded scans, as a device sees the world.
//!
//! All have the same beams. A beam is asked for by its angle, and there is none
//! between those that were recorded.

use std::path::Path;

use recording::ros::LaserScan;
use recording::{Kind, Message, Recording};

use crate::EmulatorError;

/// Straight ahead, in the device's convention.
pub(crate) const AHEAD_RAW: i32 = 900_000;

/// A turn to either side, 1/10000°.
const TURN: std::ops::RangeInclusive<i64> = -3_600_000..=3_600_000;

/// The scans of a recording. Angles are in 1/10000°, in the device's convention:
/// 0 is right, 90° ahead.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sweep {
    /// Of the first beam.
    pub(crate) start_raw: i32,
    /// From one beam to the next.
    pub(crate) step_raw: i32,
    /// Beams of each scan.
    pub(crate) count: usize,
    /// From one scan to the next, seconds.
    pub(crate) scan_time_s: f64,
    /// Log times, nanoseconds.
    pub(crate) times_ns: Vec<i64>,
    /// Metres; not finite where nothing came back.
    pub(crate) scans: Vec<Vec<f32>>,
}

impl Sweep {
    /// Reads all scans of a recording.
    ///
    /// # Errors
    /// If it cannot be read, holds no scans, or scans that differ in their beams.
    pub(crate) fn open(path: &Path) -> Result<Self, EmulatorError> {
        let recording = Recording::open(path)?;
        let topic = recording.required_topic(Kind::Scan)?;
        let mut sweep: Option<Sweep> = None;
        for record in recording.records_of(&[Kind::Scan]) {
            let record = record?;
            if let Message::Scan(scan) = record.message
                && record.topic == topic
            {
                match &mut sweep {
                    Some(sweep) => sweep.add(record.log_time_ns, scan)?,
                    None => sweep = Some(Sweep::first(record.log_time_ns, scan)?),
                }
            }
        }
        let mut sweep = sweep.ok_or_else(|| EmulatorError::Empty { path: path.into() })?;
        sweep.measure_time();
        Ok(sweep)
    }

    pub(crate) fn first(time_ns: i64, scan: LaserScan) -> Result<Self, EmulatorError> {
        let raw = |radians: f32| (f64::from(radians).to_degrees() * 1e4).round() as i32;
        let step_raw = raw(scan.angle_increment);
        if !(1..=65_535).contains(&step_raw) || scan.ranges.is_empty() {
            return Err(EmulatorError::Scan {
                scan: 0,
                field: "the angle from beam to beam",
                found: f64::from(step_raw) * 1e-4,
                allowed: "0.0001° to 6.5535°, counter-clockwise".into(),
            });
        }
        let start_raw = raw(scan.angle_min);
        let sweep_raw = (scan.ranges.len() as i64 - 1) * i64::from(step_raw);
        if !TURN.contains(&i64::from(start_raw)) || !TURN.contains(&sweep_raw) {
            return Err(EmulatorError::Scan {
                scan: 0,
                field: "the angle from the first beam to the last",
                found: sweep_raw as f64 * 1e-4,
                allowed: "0° to 360°, from -360° on".into(),
            });
        }
        Ok(Sweep {
            start_raw: start_raw + AHEAD_RAW,
            step_raw,
            count: scan.ranges.len(),
            scan_time_s: f64::from(scan.scan_time),
            times_ns: vec![time_ns],
            scans: vec![scan.ranges],
        })
    }

    fn add(&mut self, time_ns: i64, scan: LaserScan) -> Result<(), EmulatorError> {
        let index = self.scans.len();
        let other = Sweep::first(time_ns, scan)?;
        let differs = |field, found: f64, allowed: f64| EmulatorError::Scan {
            scan: index,
            field,
            found,
            allowed: format!("{allowed}, as in the first"),
        };
        let beams = [
            ("the number of beams", other.count as f64, self.count as f64),
            (
                "the first angle in 1/10000°",
                other.start_raw.into(),
                self.start_raw.into(),
            ),
            (
                "the step in 1/10000°",
                other.step_raw.into(),
                self.step_raw.into(),
            ),
        ];
        if let Some((field, found, allowed)) = beams.into_iter().find(|(_, a, b)| a != b) {
            return Err(differs(field, found, allowed));
        }
        self.times_ns.push(time_ns);
        self.scans.extend(other.scans);
        Ok(())
    }

    /// Where the recording does not say how long a scan takes, it is the usual
    /// time between two.
    fn measure_time(&mut self) {
        let mut gaps: Vec<i64> = self
            .times_ns
            .windows(2)
            .map(|w| w[1].saturating_sub(w[0]))
            .collect();
        gaps.sort_unstable();
        if self.scan_time_s.is_nan() || self.scan_time_s <= 0.0 {
            let median = gaps.get(gaps.len() / 2).copied().unwrap_or(0);
            self.scan_time_s = (median as f64 * 1e-9).max(0.001);
        }
    }

    /// Of the last beam.
    pub(crate) fn stop_raw(&self) -> i32 {
        self.start_raw + (self.count as i32 - 1) * self.step_raw
    }

    /// What a scan has at an angle: metres, `None` where nothing came back or no
    /// beam was recorded.
    pub(crate) fn range(&self, scan: usize, angle_raw: i32) -> Option<f32> {
        let from_start = angle_raw.checked_sub(self.start_raw)?;
        if from_start % self.step_raw != 0 {
            return None;
        }
        let beam = usize::try_from(from_start / self.step_raw).ok()?;
        let range = self.scans.get(scan)?.get(beam)?;
        range.is_finite().then_some(*range)
    }
}

/// A small world for the tests of this crate: five beams from right to left.
#[cfg(test)]
pub(crate) fn five_beams(angle_increment_deg: f32) -> Sweep {
    let scan = LaserScan {
        angle_min: (-2.0 * angle_increment_deg).to_radians(),
        angle_increment: angle_increment_deg.to_radians(),
        scan_time: 0.02,
        ranges: vec![1.0, f32::INFINITY, 2.004, 70.0, 0.001],
        ..LaserScan::default()
    };
    Sweep::first(0, scan).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beams_are_found_by_their_angle() {
        let sweep = five_beams(5.0);
        assert_eq!((sweep.start_raw, sweep.stop_raw()), (800_000, 1_000_000));
        assert_eq!(sweep.range(0, 800_000), Some(1.0));
        assert_eq!(sweep.range(0, 850_000), None);
        assert_eq!(sweep.range(0, 900_000), Some(2.004));
        assert_eq!(sweep.range(0, 900_001), None);
        assert_eq!(sweep.range(0, 750_000), None);
        assert_eq!(sweep.range(0, 1_050_000), None);
        assert_eq!(sweep.range(1, 800_000), None);
    }

    #[test]
    fn beams_that_no_device_has_are_refused() {
        let refuse = |angle_min: f32, angle_increment: f32, expected: &str| {
            let scan = LaserScan {
                angle_min,
                angle_increment,
                ranges: vec![1.0; 100],
                ..LaserScan::default()
            };
            let error = Sweep::first(0, scan).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(1.0, -0.01, "counter-clockwise");
        refuse(1.0, 0.2, "0.0001° to 6.5535°");
        refuse(1.0, 0.1, "is 567.2");
        refuse(1e9, 0.01, "0° to 360°");
    }
}
