//! The input of a search: a scan as it came, or one that was brought to one
//! time and place.
//!
//! A laser that moves while it turns measures each beam from another place, and
//! several lasers measure from several. What they saw is then carried, reading by
//! reading, into the target frame.

use geometry::Pose;

use crate::EngineError;
use crate::scan::Scan;

/// What a pose is searched for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observation<'a> {
    /// A scan whose laser stood still; the laser's pose is searched.
    Still(Scan<'a>),
    /// Scans carried into one frame, whose pose is searched. One alone is thinned by
    /// its own beams, as if it stood still; several are joined: seen from the
    /// frame's origin, of the readings in a sector the nearest votes.
    Carried(&'a [CarriedScan<'a>]),
}

/// A scan, and where its laser was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarriedScan<'a> {
    /// The readings.
    pub scan: Scan<'a>,
    /// The laser's pose in the target frame, when it measured each of the
    /// ranges; as many as there are ranges.
    pub target_from_laser: &'a [Pose],
}

impl Observation<'_> {
    /// Checks all scans, see [`Scan::check`].
    ///
    /// # Errors
    /// If a scan is refused, there is none, or a place is missing or not finite.
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

    /// Where the laser was when it measured beam `i`.
    pub(crate) fn laser(&self, i: usize) -> Pose {
        let pose = self.target_from_laser.get(self.scan.index(i));
        pose.copied().unwrap_or_default()
    }

    /// Where beam `i` ends, seen from the origin of the target frame: bearing in
    /// radians and distance in metres.
    pub(crate) fn end(&self, i: usize) -> Option<(f64, f64)> {
        let reading_m = self.scan.reading(i)?;
        let (sin, cos) = self.scan.bearing(i).sin_cos();
        let (x, y) = self.laser(i).transform(reading_m * cos, reading_m * sin);
        Some((y.atan2(x), x.hypot(y)))
    }
}
