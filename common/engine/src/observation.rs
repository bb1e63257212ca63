//! Input of a search: a scan without motion compensation, or scans carried to one time and place.
//!
//! A laser that moves during a scan measures each beam from a different pose, and several lasers
//! measure from several. Their readings are then carried, one by one, into the target frame.

use geometry::Pose;

use crate::EngineError;
use crate::scan::Scan;

/// Readings for which a pose is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observation<'a> {
    /// A scan whose laser stood still; the laser's pose is searched.
    Still(Scan<'a>),
    /// Scans carried into one frame, whose pose is searched. A single scan is thinned by its own
    /// beams, as if the laser stood still. Several scans are joined: the turn, seen from the
    /// frame's origin, is divided into sectors, and in each the nearest reading votes.
    Carried(&'a [CarriedScan<'a>]),
}

/// A scan with the poses of its laser.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarriedScan<'a> {
    /// Scan with the readings.
    pub scan: Scan<'a>,
    /// Pose of the laser in the target frame at each of the ranges, as many as there are ranges.
    pub target_from_laser: &'a [Pose],
}

impl Observation<'_> {
    /// Checks all scans, see [`Scan::check`].
    ///
    /// # Errors
    /// If a scan is rejected, there is none, or a pose is missing or not finite.
    pub fn check(&self) -> Result<(), EngineError> {
        match self {
            Observation::Still(scan) => scan.check(),
            Observation::Carried([]) => Err(EngineError::EmptyScan),
            Observation::Carried(scans) => scans.iter().try_for_each(CarriedScan::check),
        }
    }
}

impl<'a> From<&Scan<'a>> for Observation<'a> {
    fn from(scan: &Scan<'a>) -> Self {
        Observation::Still(*scan)
    }
}

impl CarriedScan<'_> {
    fn check(&self) -> Result<(), EngineError> {
        self.scan.check()?;
        let (places, ranges) = (self.target_from_laser.len(), self.scan.ranges.len());
        if places != ranges {
            return Err(EngineError::Places { places, ranges });
        }
        match self.target_from_laser.iter().find(|pose| !pose.is_finite()) {
            Some(&pose) => Err(EngineError::Odometry(pose)),
            None => Ok(()),
        }
    }

    /// Pose of the laser at beam `i`.
    pub(crate) fn laser(&self, i: usize) -> Pose {
        let pose = self.target_from_laser.get(self.scan.index(i));
        pose.copied().unwrap_or_default()
    }

    /// Returns the end of beam `i`, seen from the origin of the target frame: bearing in radians
    /// and distance in metres; `None` if nothing returned.
    pub(crate) fn end(&self, i: usize) -> Option<(f64, f64)> {
        let reading_m = self.scan.reading(i)?;
        let (sin, cos) = self.scan.bearing(i).sin_cos();
        let (x, y) = self.laser(i).transform(reading_m * cos, reading_m * sin);
        Some((y.atan2(x), x.hypot(y)))
    }
}
