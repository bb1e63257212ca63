//! Recorded scans, addressed like the beams of a device.
//!
//! All scans have the same beams. A beam is selected by its angle; there is no interpolation
//! between recorded beams.

use messages::ScanHeader;

use crate::EmulatorError;

/// Straight ahead in the device's convention.
pub(crate) const AHEAD_RAW: i32 = 900_000;

/// One turn to either side, 1/10000°.
const TURN: std::ops::RangeInclusive<i64> = -3_600_000..=3_600_000;

/// Scans of a recording. Angles are in 1/10000°, in the device's convention: 0 is right, 90° ahead.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Sweep {
    pub(crate) start_raw: i32,
    pub(crate) step_raw: i32,
    pub(crate) count: usize,
    pub(crate) scan_time_s: f64,
    /// True if the recording states the scan time; false if it is estimated.
    pub(crate) says_time: bool,
    times_ns: Vec<i64>,
    /// Times of measurement, microseconds since 1970.
    pub(crate) stamps_us: Vec<i64>,
    /// Ranges in metres; not finite for no return.
    pub(crate) scans: Vec<Vec<f32>>,
}

impl Sweep {
    /// Creates the sweep from its first scan, recorded at `time_ns`.
    pub(crate) fn first(
        time_ns: i64,
        scan: &ScanHeader,
        ranges: Vec<f32>,
    ) -> Result<Self, EmulatorError> {
        let raw = |radians: f64| (radians.to_degrees() * 1e4).round() as i32;
        let step_raw = raw(scan.angle_increment);
        if !(1..=65_535).contains(&step_raw) || ranges.is_empty() {
            let allowed = "0.0001° to 6.5535°, counter-clockwise";
            let found = f64::from(step_raw) * 1e-4;
            let field = "the angle from beam to beam";
            return Err(EmulatorError::scan(0, field, found, allowed));
        }
        let start_raw = raw(scan.angle_min);
        let sweep_raw = (ranges.len() as i64 - 1) * i64::from(step_raw);
        if !TURN.contains(&i64::from(start_raw)) || !TURN.contains(&sweep_raw) {
            let field = "the angle from the first beam to the last";
            let found = sweep_raw as f64 * 1e-4;
            let allowed = "0° to 360°, from -360° on";
            return Err(EmulatorError::scan(0, field, found, allowed));
        }
        Ok(Sweep {
            start_raw: start_raw + AHEAD_RAW,
            step_raw,
            count: ranges.len(),
            scan_time_s: scan.scan_time_s,
            says_time: scan.scan_time_s > 0.0,
            times_ns: vec![time_ns],
            stamps_us: vec![scan.stamp.measured_ns.div_euclid(1000)],
            scans: vec![ranges],
        })
    }

    pub(crate) fn add(
        &mut self,
        time_ns: i64,
        scan: &ScanHeader,
        ranges: Vec<f32>,
    ) -> Result<(), EmulatorError> {
        let index = self.scans.len();
        let other = Sweep::first(time_ns, scan, ranges)?;
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
            let allowed = format!("{allowed}, as in the first");
            return Err(EmulatorError::scan(index, field, found, &allowed));
        }
        self.times_ns.push(time_ns);
        self.stamps_us.extend(other.stamps_us);
        self.scans.extend(other.scans);
        Ok(())
    }

    /// Estimates the scan time as the median interval between scans if the recording does not state
    /// it.
    pub(crate) fn measure_time(&mut self) {
        if self.scan_time_s.is_nan() || self.scan_time_s <= 0.0 {
            let gaps = self.times_ns.windows(2);
            let mut gaps: Vec<i64> = gaps.map(|w| w[1].saturating_sub(w[0])).collect();
            gaps.sort_unstable();
            let median = gaps.get(gaps.len() / 2).copied().unwrap_or(0);
            self.scan_time_s = (median as f64 * 1e-9).max(0.001);
        }
    }

    pub(crate) fn stop_raw(&self) -> i32 {
        self.start_raw + (self.count as i32 - 1) * self.step_raw
    }

    /// Returns the range of a scan at an angle, metres; `None` for no return or no such beam.
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

/// Returns a small test world: five beams from right to left.
#[cfg(test)]
pub(crate) fn five_beams(angle_increment_deg: f64) -> Sweep {
    let ranges = vec![1.0, f32::INFINITY, 2.004, 70.0, 0.001];
    beams(
        -2.0 * angle_increment_deg,
        angle_increment_deg,
        0.02,
        ranges,
    )
    .unwrap()
}

/// Returns a scan measured at 2006-01-20 15:59:53.5, for tests.
#[cfg(test)]
pub(crate) fn beams(
    first_deg: f64,
    step_deg: f64,
    scan_time_s: f64,
    ranges: Vec<f32>,
) -> Result<Sweep, EmulatorError> {
    let mut header: ScanHeader = bytemuck::Zeroable::zeroed();
    header.angle_min = first_deg.to_radians();
    header.angle_increment = step_deg.to_radians();
    header.scan_time_s = scan_time_s;
    header.stamp.measured_ns = 1_137_772_793_500_000_999;
    Sweep::first(0, &header, ranges)
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
        let refuse = |angle_min: f64, angle_increment: f64, expected: &str| {
            let (first, step) = (angle_min.to_degrees(), angle_increment.to_degrees());
            let error = beams(first, step, 0.1, vec![1.0; 100]).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
        };
        refuse(1.0, -0.01, "counter-clockwise");
        refuse(1.0, 0.2, "0.0001° to 6.5535°");
        refuse(1.0, 0.1, "is 567.2");
        refuse(1e9, 0.01, "0° to 360°");
    }
}
