//! The newest scan of one laser, and the pose of the laser at each beam.

use bytemuck::Zeroable;
use geometry::Pose;
use messages::{FrameName, Name, ScanHeader};

use super::{LeftOut, ScanStamp};
use crate::EngineError;
use crate::observation::CarriedScan;
use crate::scan::Scan;

/// Longest plausible time of a scan; larger time increments are ignored as wrong.
const MAX_SCAN_TIME_NS: f64 = 1e9;

/// Largest age of a scan that can be joined, in periods of its laser.
const MAX_AGE_PERIODS: f64 = 1.5;

#[derive(Debug, Clone)]
pub(super) struct Laser {
    pub(super) name: Name,
    /// `None` before the first scan.
    header: Option<ScanHeader>,
    ranges: Vec<f32>,
    /// Time of the first range, in nanoseconds.
    first_beam_ns: i64,
    /// Time from one range to the next, in nanoseconds; 0 if all have the same time.
    beam_ns: f64,
    /// Time from the scan before to this one, in nanoseconds; 0 if there was none.
    period_ns: i64,
    target_from_laser: Vec<Pose>,
}

impl Laser {
    pub(super) fn new(name: Name) -> Self {
        Laser {
            name,
            header: None,
            ranges: Vec::new(),
            first_beam_ns: 0,
            beam_ns: 0.0,
            period_ns: 0,
            target_from_laser: Vec::new(),
        }
    }

    pub(super) fn take(&mut self, header: &ScanHeader, ranges: &[f32], stamp: ScanStamp) {
        let stamp_ns = header.stamp.measured_ns;
        if let Some(before) = &self.header {
            self.period_ns = stamp_ns.saturating_sub(before.stamp.measured_ns).max(0);
        }
        self.header = Some(*header);
        self.ranges.clear();
        self.ranges.extend_from_slice(ranges);
        let steps = ranges.len().saturating_sub(1) as f64;
        let beam_ns = header.time_increment_s * 1e9;
        let is_sound = (beam_ns * steps).abs() <= MAX_SCAN_TIME_NS;
        self.beam_ns = if is_sound { beam_ns } else { 0.0 };
        let before = match stamp {
            ScanStamp::First => 0.0,
            ScanStamp::Middle => 0.5,
            ScanStamp::Last => 1.0,
        };
        self.first_beam_ns = stamp_ns.saturating_sub((before * steps * self.beam_ns) as i64);
    }

    fn header(&self) -> ScanHeader {
        self.header.unwrap_or_else(ScanHeader::zeroed)
    }

    pub(super) fn stamp_ns(&self) -> i64 {
        self.header().stamp.measured_ns
    }

    pub(super) fn takes_time(&self) -> bool {
        self.header.is_some() && self.beam_ns != 0.0
    }

    pub(super) fn last_beam_ns(&self) -> Option<i64> {
        let last = self.ranges.len().checked_sub(1)?;
        Some(self.first_beam_ns.max(self.beam_at_ns(last)))
    }

    /// Time of the middle of the scan.
    pub(super) fn middle_ns(&self) -> i64 {
        let last = self.ranges.len().saturating_sub(1);
        i64::midpoint(self.first_beam_ns, self.beam_at_ns(last))
    }

    fn beam_at_ns(&self, range: usize) -> i64 {
        self.first_beam_ns
            .saturating_add((range as f64 * self.beam_ns) as i64)
    }

    pub(super) fn is_mounted(&self) -> bool {
        self.header().mount_known == 1
    }

    pub(super) fn base_from_laser(&self) -> Pose {
        match self.is_mounted() {
            true => self.header().base_from_laser.into(),
            false => Pose::IDENTITY,
        }
    }

    pub(super) fn has_frame(&self, frame: FrameName) -> bool {
        self.header.is_some_and(|header| header.frame == frame)
    }

    pub(super) fn scan(&self) -> Scan<'_> {
        Scan::of(&self.header(), &self.ranges)
    }

    pub(super) fn carried(&self) -> CarriedScan<'_> {
        CarriedScan {
            scan: self.scan(),
            target_from_laser: &self.target_from_laser,
        }
    }

    pub(super) fn check(&self) -> Result<(), EngineError> {
        self.scan().check()?;
        let mount = self.base_from_laser();
        match mount.is_finite() {
            true => Ok(()),
            false => Err(EngineError::Mount(mount)),
        }
    }

    /// Checks if the newest scan can be joined with one of that time.
    pub(super) fn check_for(&self, stamp_ns: i64) -> Result<(), LeftOut> {
        let header = self.header.ok_or(LeftOut::NoScan)?;
        self.check().map_err(LeftOut::Refused)?;
        if !self.is_mounted() {
            return Err(LeftOut::NoMount);
        }
        let age_ns = stamp_ns.saturating_sub(header.stamp.measured_ns);
        // The stated scan time may be the device's period although some scans are left out.
        let period_ns = (header.scan_time_s * 1e9).max(self.period_ns as f64);
        if period_ns > 0.0 && age_ns as f64 > MAX_AGE_PERIODS * period_ns {
            return Err(LeftOut::Old {
                age_ms: age_ns / 1_000_000,
            });
        }
        Ok(())
    }

    /// Sets one pose in the target frame for all beams.
    pub(super) fn stand(&mut self, at: Pose) {
        self.target_from_laser.clear();
        self.target_from_laser.resize(self.ranges.len(), at);
    }

    /// Sets the pose for the time of each beam; `None` if `at` has none for one of them.
    pub(super) fn carry(&mut self, mut at: impl FnMut(i64) -> Option<Pose>) -> Option<()> {
        if self.beam_ns == 0.0 {
            let place = at(self.first_beam_ns)?;
            self.stand(place);
            return Some(());
        }
        self.target_from_laser.clear();
        for range in 0..self.ranges.len() {
            let place = at(self.beam_at_ns(range))?;
            self.target_from_laser.push(place);
        }
        Some(())
    }
}
