//! Copies of joined scans, for a search that may be requested later.

use geometry::Pose;

use super::Seen;
use crate::observation::CarriedScan;
use crate::scan::Scan;

/// A copy of joined scans that outlives the joiner's buffers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Kept {
    scans: Vec<KeptScan>,
    is_carried: bool,
}

/// One scan, with the pose of its laser at each beam.
#[derive(Debug, Clone, PartialEq)]
struct KeptScan {
    /// Without its ranges.
    scan: Scan<'static>,
    ranges: Vec<f32>,
    target_from_laser: Vec<Pose>,
}

impl KeptScan {
    fn of(scan: &Scan<'_>, target_from_laser: &[Pose]) -> Self {
        KeptScan {
            scan: Scan {
                angle_min: scan.angle_min,
                angle_increment: scan.angle_increment,
                range_min_m: scan.range_min_m,
                range_max_m: scan.range_max_m,
                ranges: &[],
            },
            ranges: scan.ranges.to_vec(),
            target_from_laser: target_from_laser.to_vec(),
        }
    }

    fn scan(&self) -> Scan<'_> {
        Scan {
            ranges: &self.ranges,
            ..self.scan
        }
    }
}

impl Kept {
    /// Copies the scans.
    #[must_use]
    pub fn of(seen: &Seen<'_>) -> Self {
        match seen {
            Seen::Still(scan) => Kept {
                scans: vec![KeptScan::of(scan, &[])],
                is_carried: false,
            },
            Seen::Carried(scans) => Kept {
                scans: scans
                    .iter()
                    .map(|carried| KeptScan::of(&carried.scan, carried.target_from_laser))
                    .collect(),
                is_carried: true,
            },
        }
    }

    /// Returns the scans; none if nothing was copied.
    pub fn seen(&self) -> Seen<'_> {
        match &self.scans[..] {
            [one] if !self.is_carried => Seen::Still(one.scan()),
            scans => Seen::Carried(
                scans
                    .iter()
                    .map(|kept| CarriedScan {
                        scan: kept.scan(),
                        target_from_laser: &kept.target_from_laser,
                    })
                    .collect(),
            ),
        }
    }
}
